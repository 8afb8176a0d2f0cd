// From what hexes are asked to become to wished cells.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "hextwist/base/memory.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/refine/levels/forest.h"

namespace hextwist {
namespace {

/// Cells of one level, ascending, each with a level that is asked for in it.
struct Asked {
  std::vector<CellNumber> cell;
  std::vector<int> level;

  void add(CellNumber number, int wanted) {
    if (!cell.empty() && cell.back() == number) {
      level.back() = std::max(level.back(), wanted);
    } else {
      cell.push_back(number);
      level.push_back(wanted);
    }
  }
  /// -1 where the cell is not here.
  int find(CellNumber number) const {
    const Index at = position_in(cell, number);
    return at < 0 ? -1 : level[at];
  }
};

/// Two lists of the cells of a level that have no cell in common.
Asked merged(const Asked& a, const Asked& b) {
  Asked both;
  std::size_t i = 0, j = 0;
  while (i < a.cell.size() || j < b.cell.size())
    if (j == b.cell.size() || (i < a.cell.size() && a.cell[i] < b.cell[j])) {
      both.add(a.cell[i], a.level[i]);
      ++i;
    } else {
      both.add(b.cell[j], b.level[j]);
      ++j;
    }
  return both;
}

/// Cells with levels asked for in them, in any order.
using AskedCells = std::vector<std::pair<CellNumber, int>>;
Asked in_order(AskedCells cells) {
  if (!std::ranges::is_sorted(cells)) std::ranges::sort(cells);
  Asked result;
  for (const auto& [cell, level] : cells) result.add(cell, level);
  return result;
}

/// Leaves of each level with the finest level that any of their hexes asks for. asked(hex, its leaf): the level, or -1
/// to leave the hex out. Of hexes of the base, those in `whole` (ascending) are asked.
template <class AskedLevel>
std::vector<Asked> asked_of_leaves(const HandedHexes& hexes, std::span<const Index> whole, const AskedLevel& asked) {
  std::vector<std::array<AskedCells, 2>> cells(1);  // per level: whole ones, and those of which there are pieces
  const auto add = [](AskedCells& list, CellNumber cell, int level) {  // pieces of a cell mostly follow each other
    if (!list.empty() && list.back().first == cell)
      list.back().second = std::max(list.back().second, level);
    else
      list.emplace_back(cell, level);
  };
  for (const Index h : whole)
    if (const int level = asked(h, hexes.leaf(h)); level >= 0) add(cells[0][0], hexes.leaf(h).cell, level);
  for (std::size_t i = 0; i < hexes.cell.size(); ++i) {
    const LevelPieces::Leaf leaf = hexes.leaf_of_piece(i);
    const int level = asked(hexes.n_whole() + static_cast<Index>(i), leaf);
    if (level < 0) continue;
    if (cells.size() <= static_cast<std::size_t>(leaf.level)) cells.resize(leaf.level + std::size_t{1});
    add(cells[leaf.level][leaf.level != hexes.block(i)], leaf.cell, level);
  }
  std::vector<Asked> result;
  for (auto& [of_whole, of_pieces] : cells)
    result.push_back(merged(in_order(std::move(of_whole)), in_order(std::move(of_pieces))));
  return result;
}

/// Gives up cells of these roots (ascending) in which nobody asks to be finer than they are whole. What is left of a
/// wished cell itself, and not of its children, are pieces of one that is cut at some corners only.
LevelMarks without_given_up(const LevelMarks& wished, std::vector<Asked> leaves, std::span<const Index> roots) {
  LevelMarks rest(wished.size());
  leaves.resize(std::max(leaves.size(), wished.size()));
  Asked inside;  // cut cells of the level, with the finest level asked for inside
  for (std::size_t k = leaves.size(); k-- > 0;) {
    const auto level = static_cast<int>(k);
    for (std::size_t i = 0; k < wished.size() && i < wished[k].size(); ++i) {
      const CellNumber cell = wished[k].cell[i];
      const int of_leaf = leaves[k].find(cell), of_inside = inside.find(cell);
      if (!std::ranges::binary_search(roots, root_of({level, cell})) || of_leaf > level || of_inside > level)
        rest[k].add(cell, wished[k].corners[i]);
    }
    Asked above;
    const Asked all = merged(leaves[k], inside);
    for (std::size_t i = 0; i < all.cell.size(); ++i) above.add(cell_parent(all.cell[i]), all.level[i]);
    inside = std::move(above);
  }
  trim(rest);
  return rest;
}

}  // namespace

LevelMarks closed(LevelMarks marks) {
  for (CellMarks& each : marks) normalize(each);
  for (std::size_t k = marks.size(); k-- > 1;) {
    CellMarks parents;
    for (const CellNumber cell : marks[k].cell)
      if (parents.empty() || parents.cell.back() != cell_parent(cell)) parents.add(cell_parent(cell));
    marks[k - 1] = united(marks[k - 1], parents);
  }
  return marks;
}

namespace {

/// The cells that must be cut for these leaves to have the levels asked for: where they are that fine already, if
/// `all`.
LevelMarks needed(const std::vector<Asked>& leaves, Index n_base_hexes, bool all) {
  std::vector<std::int64_t> n_cut;  // by how often
  for (std::size_t k = 0; k < leaves.size(); ++k)
    for (const int wanted : leaves[k].level)
      if (const int times = wanted - static_cast<int>(k); times > 0) {
        if (std::ssize(n_cut) <= times) n_cut.resize(static_cast<std::size_t>(times) + 1);
        ++n_cut[times];
      }
  double n_hexes = 0;  // at least, of which each has about a node
  for (std::size_t times = 0; times < n_cut.size(); ++times)
    n_hexes += static_cast<double>(n_cut[times]) * std::pow(27, times);
  check_memory(n_hexes, n_hexes, "at least ");
  LevelMarks marks;
  for (std::size_t k = 0; k < leaves.size(); ++k)
    for (std::size_t i = 0; i < leaves[k].cell.size(); ++i) {
      const int wanted = leaves[k].level[i], level = static_cast<int>(k);
      if (wanted == 0 || (wanted <= level && !all)) continue;
      check_levels(wanted, n_base_hexes);
      if (marks.size() < static_cast<std::size_t>(wanted)) marks.resize(static_cast<std::size_t>(wanted));
      CellNumber begin = leaves[k].cell[i];
      for (int up = level; up >= wanted; --up) begin = cell_parent(begin);
      CellNumber end = begin + 1;
      for (int at = std::min(level, wanted - 1); at < wanted; ++at) {
        CellMarks& here = marks[static_cast<std::size_t>(at)];
        for (CellNumber cell = begin; cell < end; ++cell)
          if (here.empty() || here.cell.back() != cell) here.add(cell);
        begin = first_cell_child(begin);
        end = first_cell_child(end);
      }
    }
  return closed(std::move(marks));
}

}  // namespace

namespace {

/// Throws Error when there is not one value per hex.
void check_values(const HandedHexes& hexes, std::size_t n) {
  if (n != static_cast<std::size_t>(hexes.n_hexes()))
    throw Error("there are " + std::to_string(n) + " levels for " + std::to_string(hexes.n_hexes()) + " hexes");
}

}  // namespace

std::vector<std::uint8_t> by_level(const Forest& forest, std::span<const std::uint8_t> values) {
  check_values(forest.grown->hexes, values.size());
  const std::vector<Index>& order = forest.grown->hex_order;
  std::vector<std::uint8_t> result(values.begin(), values.end());
  if (!order.empty()) parallel_each(order.size(), [&](std::size_t i) { result[order[i]] = values[i]; });
  return result;
}

LevelMarks wishes(const Forest& forest, std::span<const std::int8_t> change) {
  const HandedHexes& hexes = forest.grown->hexes;
  check_values(hexes, change.size());
  std::vector<Index> coarser;  // roots
  for (std::size_t i = 0; i < hexes.cell.size(); ++i)
    if (change[hexes.n_whole() + i] < 0)
      if (const Index root = hexes.root_of_piece(i); coarser.empty() || coarser.back() != root) coarser.push_back(root);
  sort_unique(coarser);
  const std::vector<Index> whole = indices_where(hexes.n_whole(), [&](Index h) { return change[h] > 0; });
  const auto finer = [&](Index h, const LevelPieces::Leaf& leaf) {
    return change[h] > 0 ? leaf.level + change[h] : -1;
  };
  const LevelMarks wanted = needed(asked_of_leaves(hexes, whole, finer), forest.base->mesh.n_hexes(), false);
  if (coarser.empty()) return united(forest.wished, wanted);
  // Pieces of a cell that is wished to be cut at some corners are finer than the cell by what the wish makes of it.
  const auto is_cut_by_wish = [&](const LevelPieces::Leaf& leaf) {
    const auto level = static_cast<std::size_t>(leaf.level);
    return level < forest.wished.size() && std::ranges::binary_search(forest.wished[level].cell, leaf.cell);
  };
  const std::vector<Asked> leaves = asked_of_leaves(hexes, whole, [&](Index h, const LevelPieces::Leaf& leaf) {
    if (change[h] == 0 && !std::ranges::binary_search(coarser, hexes.root(h))) return -1;
    return std::max(0, leaf.level + is_cut_by_wish(leaf) + change[h]);
  });
  return united(without_given_up(forest.wished, leaves, coarser), wanted);
}

LevelMarks wishes(const Forest& forest, std::span<const Index> hexes, int change) {
  std::vector<std::int8_t> changes(static_cast<std::size_t>(forest.grown->hexes.n_hexes()), 0);
  for (const Index h : hexes) changes[h] = static_cast<std::int8_t>(change);
  return wishes(forest, changes);
}

LevelMarks wishes_of_levels(const Forest& forest, std::span<const std::uint8_t> levels) {
  const HandedHexes& hexes = forest.grown->hexes;
  check_values(hexes, levels.size());
  const std::vector<Index> whole = indices_where(hexes.n_whole(), [&](Index h) { return levels[h] > 0; });
  const auto asked = [&](Index h, const LevelPieces::Leaf&) { return levels[h] > 0 ? levels[h] : -1; };
  return needed(asked_of_leaves(hexes, whole, asked), forest.base->mesh.n_hexes(), true);
}

}  // namespace hextwist
