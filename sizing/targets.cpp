#include "hextwist/sizing/targets.h"

#include <algorithm>
#include <numeric>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/refine/templates/split_table.h"
#include "hextwist/sizing/target_distance.h"

namespace hextwist {
namespace {

int cad_dimension(EntityKind kind) {
  switch (kind) {
    case EntityKind::vertex:
      return 0;
    case EntityKind::curve:
      return 1;
    case EntityKind::surface:
      return 2;
    case EntityKind::volume:
      return 3;
    default:
      return -1;
  }
}

/// Each kind fills what it names; nodes of edges and faces are added by the caller.
void add_cad_entity(const MeshedModel& input, Owner entity, CombinationTarget& target) {
  const Association& association = input.association;
  const std::vector<Index> nodes = nodes_on(association, *input.model, entity);
  target.nodes.insert(target.nodes.end(), nodes.begin(), nodes.end());
  if (entity.dim == 1)
    for (std::size_t i = 0; i < association.curve_edges.size(); ++i)
      if (association.edge_curve[i] == entity.id) target.edges.push_back(association.curve_edges[i]);
  if (entity.dim == 2)
    for (std::size_t i = 0; i < association.surface_faces.size(); ++i)
      if (association.face_surface[i] == entity.id) {
        const Side side = association.surface_faces[i];
        target.faces.push_back(face_nodes(input.mesh.hexes[side.hex], side.face));
      }
}

void finish(CombinationTarget& target) {
  for (const Edge& edge : target.edges) target.nodes.insert(target.nodes.end(), edge.begin(), edge.end());
  for (const Quad& quad : target.faces) target.nodes.insert(target.nodes.end(), quad.begin(), quad.end());
  sort_unique(target.nodes);
  sort_unique(target.edges);
}

/// Hexes whose centroid lies within the request's radius of its targets.
std::vector<Index> hexes_within(const MeshedModel& input, const Target& target) {
  const TargetDistance from(input, target.kind, target.ids);
  const auto distances = [&](std::span<const Index> hexes) {
    std::vector<double> distance(hexes.size());
    from.evaluate(centroids(input.mesh, hexes), distance);
    return distance;
  };
  std::vector<Index> found = indices_where(
      input.mesh.n_hexes(), [&](Index h) { return from.at_least(centroid(input.mesh, h)) <= *target.radius; });
  const std::vector<double> distance = distances(found);
  std::size_t n = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (distance[i] <= *target.radius) found[n++] = found[i];
  found.resize(n);
  if (found.empty()) {
    std::vector<Index> all(input.mesh.hexes.size());
    std::iota(all.begin(), all.end(), 0);
    throw Error("no hex has its centroid within " + std::to_string(*target.radius) + " of the target: the nearest is " +
                std::to_string(std::ranges::min(distances(all))) + " away");
  }
  return found;
}

}  // namespace

Vec3 centroid(const Mesh& mesh, Index hex) {
  Vec3 sum = Vec3::Zero();
  for (const Index n : mesh.hexes[hex]) sum += mesh.points[n];
  return sum / n_hex_corners;
}

std::vector<Vec3> centroids(const Mesh& mesh, std::span<const Index> hexes) {
  std::vector<Vec3> result(hexes.size());
  parallel_each(hexes.size(), [&](std::size_t i) { result[i] = centroid(mesh, hexes[i]); });
  return result;
}

std::vector<Vec3> centroids(const Mesh& mesh) {
  std::vector<Index> all(mesh.hexes.size());
  std::iota(all.begin(), all.end(), 0);
  return centroids(mesh, all);
}

bool is_whole_model(const MeshedModel& input, const Target& target) {
  return target.kind == EntityKind::volume && input.model &&
         static_cast<int>(target.ids.size()) == input.model->count(3);
}

void check_targets(const MeshedModel& input, const Target& target) {
  const std::string kind(name(target.kind));
  if (target.ids.empty()) throw Error("no " + kind + " to refine");
  const auto check = [&](std::int64_t first, std::int64_t n) {
    for (const Index id : target.ids)
      if (id < first || id >= first + n)
        throw Error("there is no " + kind + " " + std::to_string(id - first + 1) + ": " +
                    (n == 0 ? "there are none" : kind + " ids go from 1 to " + std::to_string(n)));
  };
  const int dim = cad_dimension(target.kind);
  if (dim >= 0 && !input.model) throw Error("there is no model at all: refine by hex, face, edge or node");
  if (dim >= 0)
    check(1, input.model->count(dim));
  else if (target.kind == EntityKind::node)
    check(0, input.mesh.n_nodes());
  else if (target.kind == EntityKind::hex)
    check(0, input.mesh.n_hexes());  // edges and faces are counted only when they are wanted: sub_element_target()
}

std::vector<Index> solid_target(const MeshedModel& input, const Target& target) {
  if (target.kind == EntityKind::hex) return target.ids;
  std::vector<Index> result;
  for (Index h = 0; h < input.mesh.n_hexes(); ++h)
    if (std::ranges::binary_search(target.ids, input.association.hex_volume[h])) result.push_back(h);
  if (result.empty()) throw Error("no hex of the mesh lies in volume " + std::to_string(target.ids.front()));
  return result;
}

std::vector<Index> region_target(const MeshedModel& input, const Target& target, std::vector<std::string>& notices) {
  if (target.radius) {
    if (target.kind == EntityKind::edge || target.kind == EntityKind::face)
      sub_element_target(input, target, notices);  // checks that they exist
    return hexes_within(input, target);
  }
  if (is_solid(target.kind)) return with_layers(input.mesh, solid_target(input, target), target.depth.value_or(0));
  return layers_around(input.mesh, sub_element_target(input, target, notices).nodes, target.depth.value_or(1));
}

CombinationTarget sub_element_target(const MeshedModel& input, const Target& wanted,
                                     std::vector<std::string>& notices) {
  CombinationTarget target;
  const std::string kind(name(wanted.kind));
  const auto check = [&](std::size_t n) {
    for (const Index i : wanted.ids)
      if (i < 0 || i >= static_cast<Index>(n))
        throw Error("there is no " + kind + " " + std::to_string(i + 1) + ": " + kind + " ids go from 1 to " +
                    std::to_string(n));
  };
  switch (wanted.kind) {
    case EntityKind::node:
      target.nodes = wanted.ids;
      if (const auto& owner = input.association.node_owner;
          !owner.empty() && std::ranges::none_of(wanted.ids, [&](Index n) { return static_cast<bool>(owner[n]); }))
        throw Error("none of the nodes belongs to a hex: there is nothing to refine");
      break;
    case EntityKind::edge: {
      const Edges all = edges(input.mesh);
      check(all.nodes.size());
      for (const Index e : wanted.ids) target.edges.push_back(all.nodes[e]);
      break;
    }
    case EntityKind::face: {
      const Faces all = faces(input.mesh);
      check(all.nodes.size());
      for (const Index f : wanted.ids) target.faces.push_back(all.nodes[f]);
      break;
    }
    default: {
      std::string without;
      for (const Index id : wanted.ids) {
        const std::size_t before = target.nodes.size();
        add_cad_entity(input, {cad_dimension(wanted.kind), id}, target);
        if (target.nodes.size() == before) without += " " + std::to_string(id);
      }
      if (target.nodes.empty())
        throw Error("no node of the mesh lies on " + kind + without +
                    ": the mesh does not resolve it, so there is nothing to refine");
      if (!without.empty()) notices.push_back("no node of the mesh lies on " + kind + without);
    }
  }
  finish(target);
  return target;
}

namespace {

/// The hex that was cut: every corner is a corner of one of its children.
Hex parent_of(const CutHex& cut, const HexTemplate& parts, const Mesh& refined) {
  Hex parent{};
  for (std::size_t i = 0; i < parts.children.size(); ++i)
    for (int c = 0; c < n_hex_corners; ++c)
      if (const LocalNode local = parts.children[i][c]; local < n_hex_corners)
        parent[local] = refined.hexes[cut.first_child + static_cast<Index>(i)][c];
  return parent;
}

/// Children of the faces that were cut, the others as they are. (Lineage::faces has only those with nodes inside.)
void carry_faces(const std::vector<Quad>& faces, const Lineage& lineage, const Mesh& refined,
                 std::vector<Quad>& carried) {
  const auto sorted = [](Quad quad) {
    std::ranges::sort(quad);
    return quad;
  };
  std::vector<std::pair<Quad, bool>> wanted;  // nodes ascending; children found
  std::vector<std::uint8_t> has_target(refined.points.size(), 0);
  for (const Quad& quad : faces) {
    wanted.emplace_back(sorted(quad), false);
    for (const Index n : quad) has_target[n] = 1;
  }
  std::ranges::sort(wanted);
  const auto find = [&](const Quad& quad) {
    const auto found = std::ranges::lower_bound(wanted, sorted(quad), {}, &std::pair<Quad, bool>::first);
    return found != wanted.end() && found->first == sorted(quad) ? found : wanted.end();
  };
  for (const CutHex& cut : lineage.hexes) {
    const HexTemplate& parts = lineage.table->hex(cut.code);
    const Hex parent = parent_of(cut, parts, refined);
    if (std::ranges::count_if(parent, [&](Index n) { return has_target[n] != 0; }) < 4) continue;
    for (int f = 0; f < n_hex_faces; ++f) {
      const auto found = find(face_nodes(parent, f));
      if (found == wanted.end() || found->second) continue;
      found->second = true;
      for (const ChildSide& child : parts.side[f])
        carried.push_back(face_nodes(refined.hexes[cut.first_child + child.child], child.face));
    }
  }
  for (const Quad& quad : faces)
    if (!find(quad)->second) carried.push_back(quad);
}

}  // namespace

CombinationTarget carried_target(const CombinationTarget& target, const Lineage& lineage, const Mesh& refined) {
  CombinationTarget carried;
  carried.nodes = target.nodes;
  for (const Edge& edge : target.edges)
    for_each_child_edge(lineage, edge, [&](const Edge& child) { carried.edges.push_back(child); });
  carry_faces(target.faces, lineage, refined, carried.faces);
  finish(carried);
  return carried;
}

}  // namespace hextwist
