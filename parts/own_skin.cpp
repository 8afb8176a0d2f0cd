#include "hextwist/parts/own_skin.h"

#include <algorithm>

#include "hextwist/base/sorted.h"
#include "hextwist/geom/facet/model.h"
#include "hextwist/mesh/association/meant.h"
#include "hextwist/mesh/association/parameters.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/topology.h"

namespace hextwist {

bool has_block_each(const Mesh& part) {
  std::vector<std::uint8_t> n(part.hexes.size(), 0);
  for (const Block& block : part.blocks)
    for (const Index h : block.hexes)
      if (n[h]++) return false;
  return std::ranges::find(n, 0) == n.end();
}

std::vector<int> volumes_of_blocks(const Mesh& part, std::span<const std::int64_t> block_sizes) {
  std::vector<int> volume(part.hexes.size(), 1);
  int n = 0;
  for (std::size_t b = 0; b < block_sizes.size(); ++b) {
    if (block_sizes[b] == 0) continue;
    ++n;
    for (const Index h : part.blocks[b].hexes) volume[h] = n;
  }
  return volume;
}

void find_faces(const Mesh& part, std::span<const int> hex_volume, std::vector<SkinFace>& open,
                std::vector<SkinFace>& walls) {
  const Faces all = faces(part);
  for (const auto& [first, second] : all.sides) {
    const int front = second.hex < 0 ? 0 : hex_volume[second.hex];
    if (front == hex_volume[first.hex]) continue;
    SkinFace face;
    const auto cycle = face_node_cycle(part.hexes[first.hex], first.face);
    for (std::size_t k = 0; k < cycle.size(); ++k) {
      face.nodes[k] = node_id(part, cycle[k]);
      const Vec3& at = part.points[cycle[k]];
      face.points[k] = {at[0], at[1], at[2]};
    }
    face.hex = hex_id(part, first.hex);
    face.face = first.face;
    face.volume = hex_volume[first.hex];
    face.front = front;
    (front == 0 ? open : walls).push_back(face);
  }
}

std::vector<SkinFace> skin_among(std::vector<SkinFace> open) {
  // Their nodes, ascending; then the hex.
  std::vector<std::array<std::int64_t, 5>> keys;
  std::vector<Index> order(open.size());
  keys.reserve(open.size());
  for (std::size_t i = 0; i < open.size(); ++i) {
    auto nodes = open[i].nodes;
    std::ranges::sort(nodes);
    keys.push_back({nodes[0], nodes[1], nodes[2], nodes[3], open[i].hex});
    order[i] = static_cast<Index>(i);
  }
  std::ranges::sort(order, [&](Index a, Index b) { return keys[a] < keys[b]; });
  const auto is_same_face = [&](Index a, Index b) {
    return std::equal(keys[a].begin(), keys[a].begin() + 4, keys[b].begin());
  };
  std::vector<SkinFace> skin;
  for (std::size_t i = 0, j = 0; i < order.size(); i = j) {
    for (j = i + 1; j < order.size() && is_same_face(order[i], order[j]);) ++j;
    SkinFace face = open[order[i]];
    if (j - i > 1) face.front = open[order[i + 1]].volume;
    if (face.front != face.volume) skin.push_back(face);
  }
  return skin;
}

WholeSkin make_skin_model(std::vector<SkinFace> quads) {
  std::ranges::sort(quads, {}, [](const SkinFace& quad) { return std::pair(quad.hex, quad.face); });
  WholeSkin skin;
  for (const SkinFace& quad : quads) skin.nodes.insert(skin.nodes.end(), quad.nodes.begin(), quad.nodes.end());
  sort_unique(skin.nodes);
  std::vector<Vec3> points(skin.nodes.size());
  for (const SkinFace& quad : quads) {
    auto& nodes = skin.quad_nodes.emplace_back();
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      nodes[k] = position_in(skin.nodes, quad.nodes[k]);
      points[nodes[k]] = Vec3(quad.points[k][0], quad.points[k][1], quad.points[k][2]);
    }
    skin.quad_volumes.push_back({quad.volume, quad.front});
    skin.quads.push_back({quad.hex, quad.face, 0});
  }
  quads = {};
  FacetImport import = facet_model(points, skin.quad_nodes, skin.quad_volumes);
  FacetClassification& pieces = import.classification;
  for (std::size_t q = 0; q < skin.quads.size(); ++q) skin.quads[q].surface = pieces.quad_surface[q];
  // The lowest dimension wins.
  skin.node_owner.resize(skin.nodes.size());
  for (std::size_t q = 0; q < skin.quads.size(); ++q)
    for (const Index n : skin.quad_nodes[q]) skin.node_owner[n] = {2, pieces.quad_surface[q]};
  for (std::size_t e = 0; e < pieces.edges.size(); ++e)
    for (const Index n : pieces.edges[e]) skin.node_owner[n] = {1, pieces.edge_curve[e]};
  for (std::size_t v = 0; v < pieces.vertex_nodes.size(); ++v)
    skin.node_owner[pieces.vertex_nodes[v]] = {0, static_cast<std::int32_t>(v + 1)};
  skin.edges = std::move(pieces.edges);
  skin.edge_curve = std::move(pieces.edge_curve);
  skin.model = std::move(import.model);
  return skin;
}

void put_on_skin(const WholeSkin& skin, std::vector<int> hex_volume, MeshedModel& part) {
  const Mesh& mesh = part.mesh;
  Association of;
  of.hex_volume = std::move(hex_volume);
  of.node_owner.resize(mesh.points.size());
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (const Index n : mesh.hexes[h]) of.node_owner[n] = {3, of.hex_volume[h]};
  // Both lists of nodes ascend by ids.
  std::vector<Index> on_skin(skin.nodes.size(), -1);
  for (std::size_t s = 0, n = 0; s < skin.nodes.size(); ++s) {
    while (n < mesh.points.size() && node_id(mesh, static_cast<Index>(n)) < skin.nodes[s]) ++n;
    if (n == mesh.points.size()) break;
    if (node_id(mesh, static_cast<Index>(n)) != skin.nodes[s]) continue;
    on_skin[s] = static_cast<Index>(n);
    of.node_owner[n] = skin.node_owner[s];
  }
  for (std::size_t e = 0; e < skin.edges.size(); ++e) {
    const Index a = on_skin[skin.edges[e][0]], b = on_skin[skin.edges[e][1]];
    if (a < 0 || b < 0) continue;
    of.curve_edges.push_back({a, b});
    of.edge_curve.push_back(skin.edge_curve[e]);
  }
  for (const WholeSkin::Quad& quad : skin.quads) {
    const Index h = find_hex(mesh, quad.hex);
    if (h < 0) continue;
    of.surface_faces.push_back({h, quad.face});
    of.face_surface.push_back(quad.surface);
  }
  of.node_parameters = projected_parameters(*skin.model, mesh, of.node_owner);
  part.association = std::move(of);
  part.model = skin.model;
}

std::vector<std::int64_t> inner_members(const MeshedModel& part, const NodeSet& set, int n_volumes) {
  std::vector<std::int64_t> flags(static_cast<std::size_t>(n_volumes) + 1, 0);
  std::vector<std::uint8_t> is_member(part.mesh.points.size(), 0);
  for (const Index n : set.nodes) is_member[n] = 1;
  const auto& owners = part.association.node_owner;
  for (std::size_t n = 0; n < owners.size(); ++n)
    if (owners[n].dim == 3) flags[owners[n].id] |= is_member[n] ? 1 : 2;
  return flags;
}

std::vector<Owner> meant_on_skin(const WholeSkin& skin, std::span<const std::int64_t> members,
                                 std::span<const std::int64_t> inner) {
  // A mesh with the skin's nodes, surfaces and curves: of each hex only one face is looked at. Of nodes inside volumes
  // one stands for all that are in the set and one for those that are not; volumes have the nodes of their skin.
  Mesh mesh;
  mesh.points.assign(skin.nodes.size(), Vec3::Zero());
  Association of;
  of.node_owner = skin.node_owner;
  of.curve_edges = skin.edges;
  of.edge_curve = skin.edge_curve;
  std::vector<Index> set;
  for (const std::int64_t id : members)
    if (const Index n = position_in(skin.nodes, id); n >= 0) set.push_back(n);
  constexpr Hex corner = {0, 1, 2, 3, 4, 5, 6, 7};
  const auto cycle = face_node_cycle(corner, 0);
  const auto add_hex = [&](const std::array<std::int32_t, 4>& nodes, int volume) {
    Hex hex;
    hex.fill(nodes[0]);
    for (std::size_t k = 0; k < nodes.size(); ++k) hex[cycle[k]] = nodes[k];
    mesh.hexes.push_back(hex);
    of.hex_volume.push_back(volume);
  };
  for (std::size_t q = 0; q < skin.quads.size(); ++q) {
    of.surface_faces.push_back({mesh.n_hexes(), 0});
    of.face_surface.push_back(skin.quads[q].surface);
    add_hex(skin.quad_nodes[q], skin.quad_volumes[q][0]);
    if (skin.quad_volumes[q][1] > 0) add_hex(skin.quad_nodes[q], skin.quad_volumes[q][1]);
  }
  for (std::size_t v = 1; v < inner.size(); ++v)
    for (const int flag : {1, 2}) {
      if (!(inner[v] & flag)) continue;
      const Index n = mesh.n_nodes();
      mesh.points.push_back(Vec3::Zero());
      of.node_owner.push_back({3, static_cast<std::int32_t>(v)});
      if (flag == 1) set.push_back(n);
      add_hex({n, n, n, n}, static_cast<int>(v));
    }
  return meant_entities(mesh, of, set);
}

}  // namespace hextwist
