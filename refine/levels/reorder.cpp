#include "hextwist/refine/levels/reorder.h"

#include <algorithm>
#include <numeric>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/others.h"

namespace hextwist {
namespace {

/// One kind of entity: where each place takes from, and where each went.
struct Order {
  std::span<const Index> from;
  std::vector<Index> to;

  explicit Order(std::span<const Index> order) : from(order), to(order.size()) {
    parallel_each(order.size(), [&](std::size_t i) { to[order[i]] = static_cast<Index>(i); });
  }
  Index operator()(Index old) const { return to.empty() ? old : to[old]; }

  template <class T>
  std::vector<T> values(const std::vector<T>& old, std::size_t width = 1) const {
    if (from.empty() || old.empty()) return old;
    std::vector<T> result;
    resize_for_overwrite(result, old.size());
    parallel_each(from.size(), [&](std::size_t i) {
      for (std::size_t c = 0; c < width; ++c)
        result[i * width + c] = old[static_cast<std::size_t>(from[i]) * width + c];
    });
    return result;
  }
  std::vector<Index> members(std::vector<Index> list) const {
    if (from.empty()) return list;
    for (Index& member : list) member = to[member];
    std::ranges::sort(list);
    return list;
  }
};

/// Sorts a list and what stands beside it.
template <class Item>
void sort_both(std::vector<Item>& items, std::vector<int>& values) {
  std::vector<Index> order(items.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](Index i) { return items[i]; });
  const std::vector<Item> old_items = items;
  const std::vector<int> old_values = values;
  for (std::size_t i = 0; i < order.size(); ++i) {
    items[i] = old_items[order[i]];
    values[i] = old_values[order[i]];
  }
}

Association reordered(const Association& old, const Mesh& mesh, const Order& nodes, const Order& hexes,
                      const std::vector<int>* inner) {
  Association result;
  result.node_owner = nodes.values(old.node_owner);
  result.node_parameters = nodes.values(old.node_parameters);
  result.hex_volume = hexes.values(old.hex_volume);
  result.curve_edges = old.curve_edges;
  result.edge_curve = old.edge_curve;
  for (Edge& edge : result.curve_edges) {
    edge = {nodes(edge[0]), nodes(edge[1])};
    if (edge[0] > edge[1]) std::swap(edge[0], edge[1]);
  }
  sort_both(result.curve_edges, result.edge_curve);
  result.surface_faces = old.surface_faces;
  result.face_surface = old.face_surface;
  for (Side& side : result.surface_faces) side.hex = hexes(side.hex);
  // A face inside the mesh, between two volumes or on a surface within one, is a side of the lower hex.
  std::vector<std::size_t> of_two;
  std::vector<Quad> quads;
  for (std::size_t i = 0; i < result.surface_faces.size(); ++i) {
    if (inner && !std::ranges::binary_search(*inner, result.face_surface[i])) continue;
    const Side side = result.surface_faces[i];
    of_two.push_back(i);
    quads.push_back(face_nodes(mesh.hexes[side.hex], side.face));
  }
  const std::vector<Side> sides = find_sides(mesh, quads);
  for (std::size_t i = 0; i < sides.size(); ++i) result.surface_faces[of_two[i]] = sides[i];
  sort_both(result.surface_faces, result.face_surface);
  return result;
}

}  // namespace

std::vector<int> inner_surfaces(const MeshedModel& meshed, const CompressedRows& corners) {
  const Association& of = meshed.association;
  std::vector<int> result;
  for (std::size_t i = 0; i < of.surface_faces.size(); ++i) {
    if (!result.empty() && result.back() == of.face_surface[i]) continue;
    const Side side = of.surface_faces[i];
    const Quad quad = face_nodes(meshed.mesh.hexes[side.hex], side.face);
    const auto has_all = [&](Index corner) {
      const Hex& hex = meshed.mesh.hexes[corner >> 3];
      return corner >> 3 != side.hex &&
             std::ranges::all_of(quad, [&](Index n) { return std::ranges::find(hex, n) != hex.end(); });
    };
    if (std::ranges::any_of(corners[quad[0]], has_all)) result.push_back(of.face_surface[i]);
  }
  return sorted_unique(std::move(result));
}

MeshedModel reordered(const MeshedModel& meshed, std::span<const Index> node_order, std::span<const Index> hex_order,
                      const std::vector<int>* inner) {
  const Mesh& old = meshed.mesh;
  const Order nodes(node_order), hexes(hex_order);
  MeshedModel result{{}, meshed.model, {}};
  Mesh& mesh = result.mesh;
  mesh.points = nodes.values(old.points);
  mesh.hexes = hexes.values(old.hexes);
  if (!node_order.empty())
    parallel_each(mesh.hexes.size(), [&](std::size_t h) {
      for (Index& node : mesh.hexes[h]) node = nodes.to[node];
    });
  mesh.node_ids = old.node_ids;
  mesh.hex_ids = old.hex_ids;
  for (const Block& block : old.blocks) mesh.blocks.push_back({block.id, block.name, hexes.members(block.hexes)});
  for (const NodeSet& set : old.node_sets)
    mesh.node_sets.push_back({set.id, set.name, nodes.members(set.nodes), set.meant});
  for (const SideSet& set : old.side_sets) {
    mesh.side_sets.push_back(set);
    for (Side& side : mesh.side_sets.back().sides) side.hex = hexes(side.hex);
    std::ranges::sort(mesh.side_sets.back().sides);
  }
  for (const Field& field : old.fields)
    mesh.fields.push_back(
        {field.name, field.on, field.components,
         (field.on == Field::On::node ? nodes : hexes).values(field.values, static_cast<std::size_t>(field.components)),
         field.integer});
  mesh.others = node_order.empty() ? old.others : renumbered(old.others, nodes.to);
  mesh.results = old.results;
  mesh.file_hexes = hexes.values(old.file_hexes);
  if (!meshed.association.empty()) result.association = reordered(meshed.association, mesh, nodes, hexes, inner);
  return result;
}

}  // namespace hextwist
