#include "hextwist/refine/levels/forest.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "hextwist/base/memory.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/loose_topology.h"
#include "hextwist/mesh/others.h"
#include "hextwist/refine/levels/gradation.h"
#include "hextwist/refine/levels/reorder.h"
#include "hextwist/refine/levels/transfer.h"

namespace hextwist {
namespace {

std::shared_ptr<GrownForest> bare(const Mesh& base) {
  auto grown = std::make_shared<GrownForest>();
  grown->has_stack = true;
  grown->pieces = level_pieces({}, base.n_hexes());
  grown->hexes.n_base = base.n_hexes();
  grown->next_node_id = base.points.empty() ? 1 : node_id(base, base.n_nodes() - 1) + 1;
  grown->next_hex_id = highest_element_id(base) + 1;
  return grown;
}

/// Places in the mesh handed out, per place level by level.
std::vector<Index> handed_out(const std::vector<Index>& order) {
  std::vector<Index> place(order.size());
  parallel_each(order.size(), [&](std::size_t i) { place[order[i]] = static_cast<Index>(i); });
  return place;
}
void rename(std::vector<Index>& items, const std::vector<Index>& names) {
  if (names.empty()) return;
  parallel_each(items.size(), [&](std::size_t i) {
    if (items[i] >= 0) items[i] = names[items[i]];
  });
}

/// How nodes or hexes of a step are handed out: those of the base, then those that were there before, in the order that
/// they had, then new ones. Each with its id.
struct Numbering {
  std::vector<Index> order;       ///< empty: level by level
  std::vector<std::int64_t> ids;  ///< per place of the order
};

/// old: per item, level by level, its place in the mesh before, -1; base_id: per item 0 .. n_base - 1.
template <class BaseId, class OldId>
Numbering number(std::span<const Index> old, Index n_base, Index n_before, std::int64_t& next, const BaseId& base_id,
                 const OldId& old_id) {
  Numbering result;
  const auto n = static_cast<Index>(old.size());
  std::vector<Index> now_of(static_cast<std::size_t>(n_before), -1);
  for (Index i = n_base; i < n; ++i)
    if (old[i] >= 0) now_of[old[i]] = i;
  result.order.reserve(old.size());
  result.ids.reserve(old.size());
  const auto take = [&](Index i, std::int64_t id) {
    result.order.push_back(i);
    result.ids.push_back(id);
  };
  for (Index i = 0; i < n_base; ++i) take(i, base_id(i));
  for (Index place = 0; place < n_before; ++place)
    if (now_of[place] >= 0) take(now_of[place], old_id(place));
  for (Index i = n_base; i < n; ++i)
    if (old[i] < 0) take(i, next++);
  if (std::ranges::is_sorted(result.order)) result.order.clear();
  return result;
}

LevelOrigin reordered(LevelOrigin origin, const std::vector<Index>& hex_order) {
  if (hex_order.empty()) return origin;
  LevelOrigin result{{}, {}, std::move(origin.several)};
  for (const Index h : hex_order) {
    result.kind.push_back(origin.kind[h]);
    result.at.push_back(origin.at[h]);
  }
  return result;
}

}  // namespace

Forest plant(std::shared_ptr<const MeshedModel> base) {
  Forest forest;
  forest.base = std::move(base);
  forest.grown = bare(forest.base->mesh);
  return forest;
}

Forest plant(std::shared_ptr<const MeshedModel> base, std::span<const Index> hexes, int numsplit) {
  const Mesh& mesh = base->mesh;
  check_levels(numsplit, mesh.n_hexes());
  Forest forest;
  forest.base = std::move(base);
  CellMarks marks;
  for (const Index h : hexes) marks.add(h);
  for (int level = 0; level < numsplit && !marks.empty(); ++level) {
    CellMarks next;
    for (const CellNumber cell : marks.cell)
      for (int child = 0; level + 1 < numsplit && child < n_cell_children; ++child)
        next.add(first_cell_child(cell) + child);
    forest.wished.push_back(std::exchange(marks, std::move(next)));
  }
  return forest;
}

LevelMarks with_gradation(Forest& forest) {
  if (forest.wished.empty() || (forest.wished.size() < 2 && !forest.mirror)) return forest.wished;
  const Mesh& base = forest.base->mesh;
  if (!forest.base_corners) forest.base_corners = std::make_shared<const CompressedRows>(node_corners(base));
  return graded(forest.wished, base.hexes, *forest.base_corners, forest.mirror.get());
}

std::span<const int> repeated_surfaces(const Forest& forest) {
  if (!forest.mirror) return {};
  return forest.mirror->surfaces;
}

MeshedModel grown_mesh(Forest& forest, GrownForest& grown, const std::vector<Index>& fixed) {
  const Mesh& base = forest.base->mesh;
  grown = *bare(base);
  grown.marks = with_gradation(forest);
  LevelledMesh built =
      build_levels(*forest.base, grown.marks, {}, {.fixed = fixed, .repeated_surfaces = repeated_surfaces(forest)});
  grown.stack = std::move(built.stack);
  grown.pieces = level_pieces(grown.stack, base.n_hexes());
  grown.next_node_id += built.mesh.mesh.n_nodes() - base.n_nodes();
  grown.next_hex_id += built.mesh.mesh.n_hexes() - grown.pieces.first[1];  // as change() gives them
  grown.hexes = handed_hexes(grown.pieces, {}, base.n_hexes());
  return std::move(built.mesh);
}

Forest grown(Forest forest, const std::vector<Index>& fixed) {
  if (forest.grown) return forest;
  if (forest.is_bare()) {
    forest.grown = bare(forest.base->mesh);
    return forest;
  }
  auto made = std::make_shared<GrownForest>();
  const WithoutHexLimit is_there;
  grown_mesh(forest, *made, fixed);
  forest.grown = std::move(made);
  return forest;
}

Forest with_stack(Forest forest, const Mesh& mesh) {
  if (forest.grown->has_stack) return forest;
  const WithoutHexLimit is_there;
  auto grown = std::make_shared<GrownForest>(*forest.grown);
  LevelledMesh built = build_levels(*forest.base, grown->marks, {}, {.topology_only = true});
  grown->stack = std::move(built.stack);
  grown->pieces = level_pieces(grown->stack, forest.base->mesh.n_hexes());
  grown->hex_order = hex_order(grown->hexes);
  const std::vector<Hex>& by_level = built.mesh.mesh.hexes;
  assert(by_level.size() == mesh.hexes.size() && built.mesh.mesh.points.size() == mesh.points.size());
  grown->node_order.resize(mesh.points.size());
  std::iota(grown->node_order.begin(), grown->node_order.end(), 0);  // nodes of the base that no hex has
  for (std::size_t h = 0; h < by_level.size(); ++h) {
    const Hex& hex = by_level[grown->hex_order.empty() ? h : static_cast<std::size_t>(grown->hex_order[h])];
    for (std::size_t c = 0; c < hex.size(); ++c) grown->node_order[mesh.hexes[h][c]] = hex[c];
  }
  if (std::ranges::is_sorted(grown->node_order)) grown->node_order.clear();
  grown->has_stack = true;
  forest.grown = std::move(grown);
  return forest;
}

std::vector<std::uint8_t> levels_of(const Forest& forest) {
  const HandedHexes& hexes = forest.grown->hexes;
  std::vector<std::uint8_t> level(static_cast<std::size_t>(hexes.n_hexes()), 0);
  parallel_each(hexes.cell.size(), [&](std::size_t i) {
    level[hexes.n_whole() + i] = static_cast<std::uint8_t>(hexes.leaf_of_piece(i).level);
  });
  return level;
}

std::vector<Index> with_siblings(const Forest& forest, std::span<const Index> asked, int n_levels) {
  const HandedHexes& hexes = forest.grown->hexes;
  using Leaf = LevelPieces::Leaf;
  // The cell that a cell was cut out of; level -1: one of the base.
  const auto parent = [](const Leaf& leaf) {
    return leaf.level == 0 ? Leaf{-1, leaf.cell} : Leaf{leaf.level - 1, cell_parent(leaf.cell)};
  };
  std::vector<Index> result;
  std::vector<Leaf> cells;
  for (const Index h : asked) {
    if (h < hexes.n_whole()) {
      result.push_back(h);
      continue;
    }
    Leaf cell = hexes.leaf_of_piece(static_cast<std::size_t>(h - hexes.n_whole()));
    for (int i = 0; i < n_levels && cell.level >= 0; ++i) cell = parent(cell);
    cells.push_back(cell);
  }
  sort_unique(cells);
  for (std::size_t i = 0; i < hexes.cell.size(); ++i)
    for (Leaf cell = hexes.leaf_of_piece(i); cell.level >= 0;) {
      cell = parent(cell);
      if (!std::ranges::binary_search(cells, cell)) continue;
      result.push_back(hexes.n_whole() + static_cast<Index>(i));
      break;
    }
  return result;
}

LevelStep change(const Forest& from, const Mesh& current, LevelMarks wished, const LevelOptions& options) {
  const Forest forest = with_stack(from, current);
  const GrownForest& before = *forest.grown;
  const MeshedModel& base = *forest.base;
  LevelStep step;
  step.forest = forest;
  step.forest.wished = std::move(wished);
  const LevelMarks& wishes = step.forest.wished;
  const auto grown = std::make_shared<GrownForest>();
  grown->marks = options.graded ? *options.graded : with_gradation(step.forest);
  grown->has_stack = true;
  for (std::size_t k = 0; k < wishes.size(); ++k) step.n_forced += n_forced(grown->marks[k], wishes[k]);
  LevelledMesh built = build_levels(base, grown->marks, options.reuse.empty() ? before.stack : options.reuse,
                                    {.keep_meshes = options.keep_meshes,
                                     .fixed = options.fixed,
                                     .progress = options.progress,
                                     .keep_jumps = options.keep_jumps,
                                     .repeated_surfaces = repeated_surfaces(forest)});
  grown->stack = std::move(built.stack);
  grown->pieces = level_pieces(grown->stack, base.mesh.n_hexes());

  // What it has in common with the mesh before, as that was handed out.
  step.old_node = matching_nodes(grown->stack, before.stack, base.mesh.n_nodes());
  rename(step.old_node, handed_out(before.node_order));
  step.origin = level_origin(grown->pieces, before.pieces);
  const std::vector<Index> old_places = handed_out(before.hex_order);
  rename(step.origin.several.items, old_places);
  for (Index row = 0; !old_places.empty() && row < step.origin.several.size(); ++row)
    std::sort(step.origin.several.items.begin() + step.origin.several.first[row],
              step.origin.several.items.begin() + step.origin.several.first[row + 1]);
  for (std::size_t h = 0; !old_places.empty() && h < step.origin.at.size(); ++h)
    if (step.origin.kind[h] != HexOrigin::coarser) step.origin.at[h] = old_places[step.origin.at[h]];

  built.mesh.mesh.fields =
      transferred_fields({current, built.mesh.mesh, step.old_node, step.origin}, options.extensive);
  carry_results(current, step.origin, options.extensive, built.mesh.mesh);
  for (const auto& pass : grown->stack) {
    step.off_nodes.insert(step.off_nodes.end(), pass->off_nodes.begin(), pass->off_nodes.end());
    step.is_repaired |= pass->is_repaired;
  }

  if (grown->marks.empty()) {  // as if nothing had ever been cut
    step.forest.grown = bare(base.mesh);
    step.mesh = std::move(built.mesh);
    return step;
  }
  grown->next_node_id = before.next_node_id;
  grown->next_hex_id = before.next_hex_id;
  Numbering nodes = number(
      step.old_node, base.mesh.n_nodes(), current.n_nodes(), grown->next_node_id,
      [&](Index i) { return node_id(base.mesh, i); }, [&](Index place) { return node_id(current, place); });
  std::vector<Index> same_hex(step.origin.at);
  for (std::size_t h = 0; h < same_hex.size(); ++h)
    if (step.origin.kind[h] != HexOrigin::same) same_hex[h] = -1;
  Numbering hexes = number(
      same_hex, grown->pieces.first[1], current.n_hexes(), grown->next_hex_id,
      [&](Index i) { return hex_id(base.mesh, static_cast<Index>(grown->pieces.cell[i])); },
      [&](Index place) { return hex_id(current, place); });
  if (nodes.order.empty() && hexes.order.empty()) {
    step.mesh = std::move(built.mesh);
  } else {
    Forest& after = step.forest;
    if (!after.base_corners) after.base_corners = std::make_shared<const CompressedRows>(node_corners(base.mesh));
    if (!after.inner_surfaces)
      after.inner_surfaces = std::make_shared<const std::vector<int>>(inner_surfaces(base, *after.base_corners));
    step.mesh = reordered(built.mesh, nodes.order, hexes.order, after.inner_surfaces.get());
  }
  // As carry() has it: where the base has no ids, nodes have none until one is missing.
  const bool by_index = base.mesh.node_ids.empty() && nodes.ids.back() == static_cast<std::int64_t>(nodes.ids.size());
  step.mesh.mesh.node_ids = by_index ? std::vector<std::int64_t>{} : std::move(nodes.ids);
  step.mesh.mesh.hex_ids = std::move(hexes.ids);
  step.origin = reordered(std::move(step.origin), hexes.order);
  if (!nodes.order.empty()) {
    const std::vector<Index> old_node = std::move(step.old_node);
    step.old_node.clear();
    for (const Index n : nodes.order) step.old_node.push_back(old_node[n]);
    const std::vector<Index> places = handed_out(nodes.order);
    for (OffOwner& row : step.off_nodes) row.node = places[row.node];
  }
  grown->node_order = std::move(nodes.order);
  grown->hex_order = std::move(hexes.order);
  grown->hexes = handed_hexes(grown->pieces, grown->hex_order, base.mesh.n_hexes());
  step.forest.grown = grown;
  return step;
}

}  // namespace hextwist
