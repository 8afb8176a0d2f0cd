// The messages of association: the error for a mesh that is not on the CAD, tags that were overruled, entities that got
// nothing.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/association/association_internal.h"
#include "hextwist/mesh/quality/quality.h"

namespace hextwist::detail {
namespace {

std::string number(double value) {
  return short_number(value, 6);
}

std::string moved_by(const Vec3& way) {
  return number(way.x()) + " " + number(way.y()) + " " + number(way.z());
}

/// Guesses why a mesh lies elsewhere: units, or a move.
std::string hint(const ModelFacts& facts, const Mesh& mesh) {
  struct Unit {
    double factor;
    const char* reason;
  };
  constexpr std::array<Unit, 5> units = {{{1000, "millimetres and metres"},
                                          {25.4, "millimetres and inches"},
                                          {10, "millimetres and centimetres"},
                                          {304.8, "millimetres and feet"},
                                          {1000 / 25.4, "metres and inches"}}};
  constexpr double alike = 0.03;  // a coarse mesh of a round body is a little smaller
  const Box mesh_box = box(mesh), model_box = facts.model.box();
  const double ratio = mesh_box.diagonal() / model_box.diagonal();
  for (const auto& [factor, reason] : units)
    for (const bool larger : {true, false})
      if (std::abs(ratio / (larger ? factor : 1 / factor) - 1) < alike)
        return "; the mesh is " + number(factor) + " times " + (larger ? "larger" : "smaller") +
               " than the model: " + reason + " mixed up? 'import mesh ... scale " +
               number(larger ? 1 / factor : factor) + "' mends that";
  const Vec3 mesh_centre = (mesh_box.min + mesh_box.max) / 2, model_centre = (model_box.min + model_box.max) / 2;
  if (std::abs(ratio - 1) < alike && (mesh_centre - model_centre).norm() > alike * facts.size)
    return "; the mesh is as large as the model, but its centre is at " + point_text(mesh_centre, 6) + " instead of " +
           point_text(model_centre, 6) + ": read the mesh before the CAD and 'move " +
           moved_by(model_centre - mesh_centre) + "' it";
  if (std::abs(ratio - 1) >= alike)
    return "; the boxes of mesh and model are " + number(mesh_box.diagonal()) + " and " + number(facts.size) +
           " across: another model?";
  return "";
}

/// Closest surface, whatever the distance. Only those near enough are projected onto.
std::pair<int, double> nearest_surface(const ModelFacts& facts, const Vec3& p) {
  std::pair<int, double> best = {0, std::numeric_limits<double>::infinity()};
  for (double reach = 16 * facts.tolerance; best.second > reach; reach *= 16) {
    for (const int s : facts.model.near(2, p, reach)) {
      const double distance = facts.model.project(Owner{2, s}, p).distance;
      if (distance < best.second) best = {s, distance};
    }
    if (reach > 1e6 * (facts.size + p.norm())) break;
  }
  return best;
}

/// One line per kind of tag: how many were overruled, and the first.
struct Overruled {
  Index count = 0;
  std::string first;
  void add(const std::string& text) {
    if (count++ == 0) first = text;
  }
  void report(const char* kind, std::vector<std::string>& notices) const {
    if (count)
      notices.push_back(counted(count, kind) + (count == 1 ? " of the file numbers" : " of the file number") +
                        " the CAD in another way: matched by geometry (first: " + first + ")");
  }
};

std::string edge_name(const Mesh& mesh, const Edge& edge) {
  return "edge between nodes " + std::to_string(node_id(mesh, edge[0])) + " and " +
         std::to_string(node_id(mesh, edge[1]));
}

void name_missing(const Model& model, int dim, const std::vector<char>& used, const char* lacks,
                  std::vector<std::string>& notices) {
  std::vector<std::int64_t> ids;
  for (int id = 1; id <= model.count(dim); ++id)
    if (!used[id]) ids.push_back(id);
  static constexpr const char* plural[] = {"vertices", "curves", "surfaces", "volumes"};
  if (ids.empty()) return;
  notices.push_back(std::to_string(ids.size()) +
                    (ids.size() == 1 ? std::string(" ") + dimension_name(dim) + " has no "
                                     : std::string(" ") + plural[dim] + " have no ") +
                    lacks + ": " + first_ids(ids));
}

}  // namespace

std::string first_ids(std::span<const std::int64_t> ids) {
  if (ids.size() <= 5) return joined(ids);
  return joined(ids.first(5)) + " ... (" + std::to_string(ids.size()) + " in all)";
}

void throw_off_model(const ModelFacts& facts, const Mesh& mesh, const Skin& skin, std::span<const int> quad_surface) {
  std::vector<char> suspect(skin.nodes.size(), 0);
  for (Index q = 0; q < skin.n_quads(); ++q)
    if (quad_surface[q] == 0)
      for (const Index node : skin.quads[q]) suspect[node] = 1;
  std::vector<Index> nodes;
  for (Index n = 0; n < skin.n_nodes(); ++n)
    if (suspect[n]) nodes.push_back(n);
  // Thousands of far nodes would take long and tell nothing more.
  constexpr std::size_t max_asked = 1000;
  const std::size_t step = nodes.size() / max_asked + 1;
  Index off = 0, worst = -1;
  std::pair<int, double> worst_at = {0, 0};
  for (std::size_t i = 0; i < nodes.size(); i += step) {
    const auto at = nearest_surface(facts, skin.points[nodes[i]]);
    if (at.second > (at.first ? facts.node_tolerance(2, at.first) : facts.tolerance)) ++off;
    if (worst < 0 || at.second > worst_at.second) {
      worst = nodes[i];
      worst_at = at;
    }
  }
  const std::string node = "node " + std::to_string(node_id(mesh, skin.nodes[worst]));
  if (off > 0)
    throw Error("the mesh does not lie on the model: " + node + " at " + point_text(skin.points[worst], 6) + " is " +
                number(worst_at.second) + " from the nearest surface, " + std::to_string(worst_at.first) +
                " (tolerance " + number(facts.tolerance) + "); of " + std::to_string(skin.nodes.size()) +
                " boundary nodes " + (step > 1 ? "about " : "") + std::to_string(off * static_cast<Index>(step)) +
                (off * step == 1 ? " is" : " are") + " off" + hint(facts, mesh));
  // Every node is on the model, but some quad's corners share no surface.
  const auto quad = static_cast<Index>(std::ranges::find(quad_surface, 0) - quad_surface.begin());
  std::string text = "the mesh does not follow the curves of the model: face of hex " +
                     std::to_string(hex_id(mesh, skin.sides[quad].hex)) + " lies across surfaces, node";
  for (const Index n : skin.quads[quad])
    text += " " + std::to_string(node_id(mesh, skin.nodes[n])) + " on surface " +
            std::to_string(nearest_surface(facts, skin.points[n]).first) + (n == skin.quads[quad][3] ? "" : ", node");
  throw Error(text);
}

Tags usable_tags(const Mesh& mesh, const Faces& faces, const Model& model, const Association& given,
                 std::vector<std::string>& notices) {
  Tags tags;
  std::array<std::vector<std::int64_t>, 4> unknown;
  const auto known = [&](int dim, int id) {
    if (id >= 1 && id <= model.count(dim)) return true;
    if (id != 0 && std::ranges::find(unknown[dim], id) == unknown[dim].end()) unknown[dim].push_back(id);
    return false;
  };
  if (given.hex_volume.size() == mesh.hexes.size() &&
      std::ranges::count_if(given.hex_volume, [&](int id) { return known(3, id); }) == mesh.n_hexes())
    tags.hex_volume = given.hex_volume;
  for (std::size_t i = 0; i < std::min(given.surface_faces.size(), given.face_surface.size()); ++i) {
    const Side side = given.surface_faces[i];
    if (side.hex >= 0 && side.hex < mesh.n_hexes() && side.face >= 0 && side.face < 6 &&
        known(2, given.face_surface[i]))
      tags.face_surface.emplace_back(faces.of_hex[side.hex][side.face], given.face_surface[i]);
  }
  for (std::size_t i = 0; i < std::min(given.curve_edges.size(), given.edge_curve.size()); ++i)
    if (known(1, given.edge_curve[i])) tags.edge_curve.emplace_back(given.curve_edges[i], given.edge_curve[i]);
  if (given.node_owner.size() == mesh.points.size())
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      if (given.node_owner[n].dim == 0 && known(0, given.node_owner[n].id))
        tags.node_vertex.emplace_back(n, given.node_owner[n].id);
  std::ranges::sort(tags.face_surface);
  std::ranges::sort(tags.edge_curve);
  for (int dim = 0; dim < 4; ++dim)
    if (!unknown[dim].empty()) {
      std::ranges::sort(unknown[dim]);
      notices.push_back("tags name " + std::string(dimension_name(dim)) + " " + first_ids(unknown[dim]) +
                        ", the model has " + std::to_string(model.count(dim)) + ": ignored");
    }
  return tags;
}

void compare_with_tags(const Mesh& mesh, const Faces& faces, const Tags& tags, const Association& association,
                       std::vector<std::string>& notices) {
  Overruled hexes, quads, edges, nodes;
  for (std::size_t h = 0; h < tags.hex_volume.size(); ++h)
    if (tags.hex_volume[h] != association.hex_volume[h])
      hexes.add("hex " + std::to_string(hex_id(mesh, static_cast<Index>(h))) + ", tag " +
                std::to_string(tags.hex_volume[h]) + ", in volume " + std::to_string(association.hex_volume[h]));
  for (const auto& [face, tag] : tags.face_surface) {
    const Owner owner = owner_of_face(association, faces, face);
    if (owner != Owner{2, tag})
      quads.add("face of hex " + std::to_string(hex_id(mesh, faces.sides[face][0].hex)) + ", tag " +
                std::to_string(tag) + ", on " + to_string(owner));
  }
  for (const auto& [edge, tag] : tags.edge_curve) {
    const int curve = value_of(association.curve_edges, association.edge_curve, edge);
    if (curve != tag)
      edges.add(edge_name(mesh, edge) + ", tag " + std::to_string(tag) + ", on " +
                (curve ? "curve " + std::to_string(curve) : std::string("no curve")));
  }
  for (const auto& [node, tag] : tags.node_vertex)
    if (association.node_owner[node] != Owner{0, tag})
      nodes.add("node " + std::to_string(node_id(mesh, node)) + ", tag " + std::to_string(tag) + ", on " +
                to_string(association.node_owner[node]));
  hexes.report("volume tag", notices);
  quads.report("surface tag", notices);
  edges.report("curve tag", notices);
  nodes.report("vertex tag", notices);
}

void notice_coverage(const ModelFacts& facts, const Mesh& mesh, const Association& association,
                     std::vector<std::string>& notices) {
  const Model& model = facts.model;
  std::array<std::vector<char>, 4> used;
  for (int dim = 0; dim < 4; ++dim) used[dim].assign(model.count(dim) + 1, 0);
  for (const Owner owner : association.node_owner)
    if (owner.dim == 0) used[0][owner.id] = 1;
  for (const int curve : association.edge_curve) used[1][curve] = 1;
  for (const int surface : association.face_surface) used[2][surface] = 1;
  std::vector<double> volume_of(model.count(3) + 1, 0);
  const std::vector<double> volumes = quality(Metric::volume, mesh);
  constexpr Index size = 1 << 14;
  struct Sum {
    double volume = 0;
    Index n_hexes = 0;
  };
  std::vector<std::vector<Sum>> sums(n_chunks(mesh.n_hexes(), size), std::vector<Sum>(volume_of.size()));
  parallel_chunks(mesh.n_hexes(), size, [&](Index chunk, Index begin, Index end) {
    for (Index h = begin; h < end; ++h) {
      Sum& sum = sums[chunk][association.hex_volume[h]];
      sum.volume += volumes[h];
      ++sum.n_hexes;
    }
  });
  for (const auto& of_chunk : sums)
    for (std::size_t id = 0; id < volume_of.size(); ++id) {
      volume_of[id] += of_chunk[id].volume;
      if (of_chunk[id].n_hexes > 0) used[3][id] = 1;
    }
  // Seams, poles, and vertices on nothing else need no notice.
  for (int curve = 1; curve <= model.count(1); ++curve)
    if (facts.degenerate[curve - 1] || facts.curve_surfaces[curve - 1].size() < 2) used[1][curve] = 1;
  for (int vertex = 1; vertex <= model.count(0); ++vertex)
    if (std::ranges::all_of(facts.vertex_curves[vertex - 1], [&](int curve) {
          return facts.degenerate[curve - 1] || facts.curve_surfaces[curve - 1].size() < 2;
        }))
      used[0][vertex] = 1;
  name_missing(model, 3, used[3], "hex", notices);
  name_missing(model, 2, used[2], "face of the mesh", notices);
  name_missing(model, 1, used[1], "edge of the mesh", notices);
  name_missing(model, 0, used[0], "node of the mesh", notices);
  constexpr double alike = 0.1;  // coarse meshes of round bodies lose some
  for (int id = 1; id <= model.count(3); ++id) {
    const double exact = model.measure({3, id});
    if (used[3][id] && std::abs(volume_of[id] - exact) > alike * exact)
      notices.push_back("volume " + std::to_string(id) + " of the model is " + number(exact) + ", its hexes are " +
                        number(volume_of[id]));
  }
}

}  // namespace hextwist::detail
