// The parts of a scene that are arrays of the mesh.
#include <algorithm>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/session/view/scene.h"

namespace hextwist {
namespace {

std::vector<double> ids_of(const std::vector<std::int64_t>& ids, std::span<const Index> which) {
  std::vector<double> result;
  result.reserve(which.size());
  for (const Index i : which) result.push_back(static_cast<double>(ids[static_cast<std::size_t>(i)]));
  return result;
}

/// Faces on surfaces, those that nothing covers first.
struct SkinFaces {
  std::vector<Side> sides;
  std::vector<Index> faces;
  std::vector<std::uint32_t> surfaces;
  std::uint32_t n_open = 0;  ///< that nothing covers
};

SkinFaces skin_faces(const SceneSource& source) {
  const Association& association = source.selector.meshed.association;
  const Faces& faces = source.selector.topology.faces();
  SkinFaces result;
  for (const bool covered : {false, true})
    for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
      const Side side = association.surface_faces[i];
      const Index face = faces.of_hex[side.hex][side.face];
      if ((faces.sides[face][1].hex >= 0) != covered) continue;
      result.sides.push_back(side);
      result.faces.push_back(face);
      result.surfaces.push_back(static_cast<std::uint32_t>(association.face_surface[i]));
      if (!covered) ++result.n_open;
    }
  return result;
}

}  // namespace

Box scene_box(const SceneSource& source) {
  const MeshedModel& meshed = source.selector.meshed;
  return meshed.mesh.n_hexes() == 0 && meshed.model ? meshed.model->box() : box(meshed.mesh);
}

Vec3 scene_origin(const SceneSource& source) {
  const Box all = scene_box(source);
  return all.empty() ? Vec3(Vec3::Zero()) : Vec3((all.min + all.max) / 2);
}

PackedBlock skin_block(const SceneSource& source, const std::string& meta) {
  const MeshedModel& meshed = source.selector.meshed;
  const Mesh& mesh = meshed.mesh;
  const Vec3 origin = scene_origin(source);
  const SkinFaces skin = skin_faces(source);
  const Edges& edges = source.selector.topology.edges();

  std::vector<char> has_node(mesh.points.size(), 0), has_edge(edges.nodes.size(), 0);
  for (const Side& side : skin.sides) {
    for (const Index n : face_nodes(mesh.hexes[side.hex], side.face)) has_node[n] = 1;
    for (int j = 0; j < 4; ++j) has_edge[edges.of_hex[side.hex][face_edge(side.face, j)]] = 1;
  }
  const std::vector<Index> nodes = indices_where(mesh.n_nodes(), [&](Index n) { return has_node[n] != 0; });
  const std::vector<Index> edge_ids =
      indices_where(static_cast<Index>(edges.nodes.size()), [&](Index e) { return has_edge[e] != 0; });
  std::vector<Index> local(mesh.points.size(), -1);
  std::vector<float> points;
  std::vector<std::uint8_t> owner_dim;
  std::vector<std::uint32_t> owner_id;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    local[nodes[i]] = static_cast<Index>(i);
    add_point(points, mesh.points[nodes[i]] - origin);
    const Owner owner = owner_of_node(meshed.association, nodes[i]);
    owner_dim.push_back(static_cast<std::uint8_t>(owner ? owner.dim : 4));
    owner_id.push_back(static_cast<std::uint32_t>(owner.id));
  }
  std::vector<Index> quads, edge_nodes, hexes;
  std::vector<std::uint8_t> sides;
  for (const Side& side : skin.sides) {
    for (const Index n : face_node_cycle(mesh.hexes[side.hex], side.face)) quads.push_back(local[n]);
    hexes.push_back(side.hex);
    sides.push_back(static_cast<std::uint8_t>(side.face));
  }
  for (const Index e : edge_ids)
    for (const Index n : edges.nodes[e]) edge_nodes.push_back(local[n]);
  std::vector<Index> curve_edges;
  std::vector<std::uint32_t> curves;
  for (std::size_t i = 0; i < meshed.association.curve_edges.size(); ++i) {
    for (const Index n : meshed.association.curve_edges[i]) curve_edges.push_back(n);
    curves.push_back(static_cast<std::uint32_t>(meshed.association.edge_curve[i]));
  }

  PackedBlock block{"skin", {}};
  block.arrays = {packed("meta", std::vector<std::uint8_t>(meta.begin(), meta.end())),
                  packed("node", nodes),
                  packed("point", points, 3),
                  packed("owner_dim", owner_dim),
                  packed("owner_id", owner_id),
                  packed("quad", quads, 4),
                  packed("quad_hex", hexes),
                  packed("quad_side", sides),
                  packed("quad_face", skin.faces),
                  packed("quad_surface", skin.surfaces),
                  packed("edge", edge_nodes, 2),
                  packed("edge_index", edge_ids),
                  packed("curve_edge", curve_edges, 2),
                  packed("curve_of_edge", curves),
                  packed("n_open", std::vector<std::uint32_t>{skin.n_open})};
  if (!mesh.node_ids.empty()) block.arrays.push_back(packed("node_id", ids_of(mesh.node_ids, nodes)));
  if (!mesh.hex_ids.empty()) block.arrays.push_back(packed("quad_hex_id", ids_of(mesh.hex_ids, hexes)));
  return block;
}

PackedBlock inside_block(const SceneSource& source) {
  const MeshedModel& meshed = source.selector.meshed;
  const Mesh& mesh = meshed.mesh;
  const Vec3 origin = scene_origin(source);
  std::vector<float> points(3 * mesh.points.size());
  std::vector<std::uint8_t> owner_dim(mesh.points.size());
  std::vector<std::uint32_t> owner_id(mesh.points.size()), volumes(mesh.hexes.size(), 0);
  parallel_each(mesh.points.size(), [&](std::size_t i) {
    for (int k = 0; k < 3; ++k) points[3 * i + k] = static_cast<float>(mesh.points[i][k] - origin[k]);
    const Owner owner = owner_of_node(meshed.association, static_cast<Index>(i));
    owner_dim[i] = static_cast<std::uint8_t>(owner ? owner.dim : 4);
    owner_id[i] = static_cast<std::uint32_t>(owner.id);
  });
  std::vector<Index> hexes(8 * mesh.hexes.size());
  parallel_each(mesh.hexes.size(), [&](std::size_t h) {
    std::ranges::copy(mesh.hexes[h], hexes.begin() + static_cast<std::ptrdiff_t>(8 * h));
    if (h < meshed.association.hex_volume.size())
      volumes[h] = static_cast<std::uint32_t>(meshed.association.hex_volume[h]);
  });
  PackedBlock block{"inside", {}};
  block.arrays = {packed("point", points, 3), packed("owner_dim", owner_dim), packed("owner_id", owner_id),
                  packed("hex", hexes, 8), packed("volume", volumes)};
  const auto as_double = [](const std::vector<std::int64_t>& ids) {
    return std::vector<double>(ids.begin(), ids.end());
  };
  if (!mesh.node_ids.empty()) block.arrays.push_back(packed("node_id", as_double(mesh.node_ids)));
  if (!mesh.hex_ids.empty()) block.arrays.push_back(packed("hex_id", as_double(mesh.hex_ids)));
  return block;
}

GroupShape shape_of(const Selector& selector, const Group& group) {
  GroupShape shape;
  for (int k = 0; k < static_cast<int>(EntityKind::group); ++k) {
    const auto kind = static_cast<EntityKind>(k);
    const std::vector<Index> positions = members(selector, group, kind);
    if (positions.empty()) continue;
    const auto add = [&](std::vector<Index>& to, EntityKind part) {
      const std::vector<Index> more = related(selector, kind, positions, part);
      to.insert(to.end(), more.begin(), more.end());
    };
    if (kind == EntityKind::sheet || dimension(kind) == 3)
      add(shape.hexes, EntityKind::hex);
    else if (dimension(kind) == 2)
      add(shape.faces, EntityKind::face);
    else
      add(shape.nodes, EntityKind::node);
  }
  for (std::vector<Index>* list : {&shape.hexes, &shape.faces, &shape.nodes}) sort_unique(*list);
  return shape;
}

PackedBlock sets_block(const SceneSource& source) {
  const Mesh& mesh = source.selector.meshed.mesh;
  PackedBlock block{"sets", {}};
  for (const Block& each : mesh.blocks) block.arrays.push_back(packed("block " + std::to_string(each.id), each.hexes));
  for (const NodeSet& each : mesh.node_sets)
    block.arrays.push_back(packed("nodeset " + std::to_string(each.id), each.nodes));
  for (const SideSet& each : mesh.side_sets) {
    std::vector<Index> sides;
    for (const Side& side : each.sides) sides.push_back(n_hex_faces * side.hex + side.face);
    block.arrays.push_back(packed("sideset " + std::to_string(each.id), sides));
  }
  for (const Group& group : source.selector.groups) {
    GroupShape shape = shape_of(source.selector, group);
    for (Index& face : shape.faces) {
      const Side side = source.selector.topology.faces().sides[face][0];
      face = n_hex_faces * side.hex + side.face;
    }
    const std::string id = "group " + std::to_string(group.id);
    block.arrays.push_back(packed(id + " hexes", shape.hexes));
    block.arrays.push_back(packed(id + " sides", shape.faces));
    block.arrays.push_back(packed(id + " nodes", shape.nodes));
    for (int k = 0; k < static_cast<int>(EntityKind::block); ++k) {
      const auto kind = static_cast<EntityKind>(k);
      const std::vector<Index> positions = members(source.selector, group, kind);
      if (positions.empty()) continue;
      block.arrays.push_back(packed(id + " " + std::string(name(kind)), positions));
    }
  }
  return block;
}

}  // namespace hextwist
