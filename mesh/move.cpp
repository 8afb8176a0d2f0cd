#include "hextwist/mesh/move.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

/// Sides, and what they carry, in ascending order again.
void sort_sides(std::vector<Side>& sides, std::vector<int>* values) {
  std::vector<Index> order(sides.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](Index i) { return sides[i]; });
  sides = items_at(sides, order);
  if (values) *values = items_at(*values, order);
}

/// Positions now of those that are still there.
std::vector<Index> renumbered(std::span<const Index> items, std::span<const Index> now) {
  std::vector<Index> result;
  for (const Index i : items)
    if (now[i] >= 0) result.push_back(now[i]);
  return result;
}

std::vector<std::int64_t> ids_of(std::span<const Index> items, const std::vector<std::int64_t>& ids) {
  std::vector<std::int64_t> result;
  result.reserve(items.size());
  for (const Index i : items) result.push_back(ids.empty() ? i + 1 : ids[i]);
  return result;
}

}  // namespace

void move(Mesh& mesh, const Similarity& similarity) {
  parallel_each(mesh.points.size(), [&](std::size_t n) { mesh.points[n] = similarity.of(mesh.points[n]); });
  if (!similarity.mirrors()) return;
  parallel_each(mesh.hexes.size(), [&](std::size_t h) {
    const Hex hex = mesh.hexes[h];
    for (int c = 0; c < n_hex_corners; ++c) mesh.hexes[h][c] = hex[mirrored_corner(c)];
  });
  for (SideSet& set : mesh.side_sets) {
    for (Side& side : set.sides) side.face = mirrored_face(side.face);
    sort_sides(set.sides, nullptr);
  }
}

void move(Association& association, const Similarity& similarity) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::ranges::fill(association.node_parameters, Parameters{nan, nan});
  if (!similarity.mirrors()) return;
  for (Side& side : association.surface_faces) side.face = mirrored_face(side.face);
  sort_sides(association.surface_faces, &association.face_surface);
}

MeshedModel part_of(const MeshedModel& meshed, std::span<const Index> hexes) {
  const Mesh& mesh = meshed.mesh;
  std::vector<Index> hex_now(mesh.hexes.size(), -1), node_now(mesh.points.size(), -1);
  for (std::size_t i = 0; i < hexes.size(); ++i) {
    hex_now[hexes[i]] = static_cast<Index>(i);
    for (const Index n : mesh.hexes[hexes[i]]) node_now[n] = 0;
  }
  const std::vector<Index> nodes = indices_where(mesh.n_nodes(), [&](Index n) { return node_now[n] == 0; });
  for (std::size_t i = 0; i < nodes.size(); ++i) node_now[nodes[i]] = static_cast<Index>(i);

  MeshedModel part;
  part.model = meshed.model;
  Mesh& out = part.mesh;
  out.points = items_at(mesh.points, nodes);
  out.hexes = items_at(mesh.hexes, hexes);
  for (Hex& hex : out.hexes)
    for (Index& n : hex) n = node_now[n];
  out.node_ids = ids_of(nodes, mesh.node_ids);
  out.hex_ids = ids_of(hexes, mesh.hex_ids);
  out.results = mesh.results;
  if (mesh.file_hexes.size() == mesh.hexes.size()) out.file_hexes = items_at(mesh.file_hexes, hexes);
  for (const Block& block : mesh.blocks)
    if (auto own = renumbered(block.hexes, hex_now); !own.empty()) out.blocks.push_back({block.id, block.name, own});
  for (const NodeSet& set : mesh.node_sets)
    if (auto own = renumbered(set.nodes, node_now); !own.empty())
      out.node_sets.push_back({set.id, set.name, own, set.meant});
  const auto now = [&](std::vector<Side> sides) {
    std::erase_if(sides, [&](const Side& side) { return hex_now[side.hex] < 0; });
    for (Side& side : sides) side.hex = hex_now[side.hex];
    return sides;
  };
  for (const SideSet& set : mesh.side_sets)
    if (auto own = now(set.sides); !own.empty()) out.side_sets.push_back({set.id, set.name, own});
  for (const Field& field : mesh.fields) {
    Field copy = field;
    copy.values = items_at(field.values, field.on == Field::On::node ? std::span<const Index>(nodes) : hexes,
                           static_cast<std::size_t>(field.components));
    out.fields.push_back(std::move(copy));
  }

  const Association& whole = meshed.association;
  if (whole.empty()) return part;
  Association& own = part.association;
  own.node_owner = items_at(whole.node_owner, nodes);
  own.node_parameters = items_at(whole.node_parameters, nodes);
  if (!whole.hex_volume.empty()) own.hex_volume = items_at(whole.hex_volume, hexes);
  const Edges here = edges(out);
  for (std::size_t i = 0; i < whole.curve_edges.size(); ++i) {
    const Edge edge = {node_now[whole.curve_edges[i][0]], node_now[whole.curve_edges[i][1]]};
    if (edge[0] < 0 || edge[1] < 0 || find_edge(here, edge[0], edge[1]) < 0) continue;
    own.curve_edges.push_back(edge);
    own.edge_curve.push_back(whole.edge_curve[i]);
  }
  // A face stands as a side of its lower hex, which may be gone where the other is still there.
  std::vector<Quad> quads;
  for (const Side& side : whole.surface_faces) {
    Quad quad = face_nodes(mesh.hexes[side.hex], side.face);
    for (Index& n : quad) n = node_now[n];
    quads.push_back(std::ranges::min(quad) < 0 ? Quad{-1, -1, -1, -1} : quad);
  }
  const Faces around = faces(out);
  for (std::size_t i = 0; i < quads.size(); ++i) {
    const Index face = quads[i][0] < 0 ? -1 : find_face(around, quads[i]);
    if (face < 0) continue;
    own.surface_faces.push_back(around.sides[face][0]);
    own.face_surface.push_back(whole.face_surface[i]);
  }
  sort_sides(own.surface_faces, &own.face_surface);
  return part;
}

}  // namespace hextwist
