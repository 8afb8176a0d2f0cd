// From what hexes are asked to become to wished cells.
#include <algorithm>

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

/// Leaves of each level with the finest level that any of their hexes asks for. asked(hex, level of its leaf): the
/// level, or -1 to leave the hex out.
template <class AskedLevel>
std::vector<Asked> asked_of_leaves(const LevelPieces& pieces, const AskedLevel& asked) {
  std::vector<Asked> whole(static_cast<std::size_t>(pieces.n_levels())), cut(whole.size());
  for (int block = 0; block < pieces.n_levels(); ++block)
    for (Index h = pieces.first[block]; h < pieces.first[block + 1]; ++h) {
      const LevelPieces::Leaf leaf = pieces.leaf(block, h);
      const int level = asked(h, leaf.level);
      if (level >= 0) (leaf.level == block ? whole : cut)[leaf.level].add(leaf.cell, level);
    }
  for (std::size_t level = 0; level < whole.size(); ++level) whole[level] = merged(whole[level], cut[level]);
  return whole;
}

/// Gives up cells in which nobody asks to be finer than they are.
LevelMarks without_given_up(const LevelMarks& wished, const std::vector<Asked>& leaves) {
  LevelMarks rest(wished.size());
  Asked inside;  // cut cells of the level, with the finest level asked for inside
  for (std::size_t k = leaves.size(); k-- > 0;) {
    const auto level = static_cast<int>(k);
    for (std::size_t i = 0; k < wished.size() && i < wished[k].size(); ++i) {
      const CellNumber cell = wished[k].cell[i];
      const int of_leaf = leaves[k].find(cell), of_inside = inside.find(cell);
      if (of_leaf >= level || of_inside > level) rest[k].add(cell, wished[k].corners[i]);
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

template <class T>
std::vector<T> by_level(const Forest& forest, std::span<const T> values) {
  const std::vector<Index>& order = forest.grown->hex_order;
  if (values.size() != forest.grown->pieces.cell.size())
    throw Error("there are " + std::to_string(values.size()) + " levels for " +
                std::to_string(forest.grown->pieces.cell.size()) + " hexes");
  std::vector<T> result(values.begin(), values.end());
  if (!order.empty()) parallel_each(order.size(), [&](std::size_t i) { result[order[i]] = values[i]; });
  return result;
}
template std::vector<std::int8_t> by_level(const Forest&, std::span<const std::int8_t>);
template std::vector<std::uint8_t> by_level(const Forest&, std::span<const std::uint8_t>);

LevelMarks wishes(const Forest& forest, std::span<const std::int8_t> change) {
  const std::vector<std::int8_t> changes = by_level(forest, change);
  const bool coarser = std::ranges::any_of(change, [](std::int8_t by) { return by < 0; });
  const std::vector<Asked> leaves = asked_of_leaves(forest.grown->pieces, [&](Index h, int level) {
    return coarser || changes[h] != 0 ? std::max(0, level + changes[h]) : -1;
  });
  return united(coarser ? without_given_up(forest.wished, leaves) : forest.wished,
                needed(leaves, forest.base->mesh.n_hexes(), false));
}

LevelMarks wishes(const Forest& forest, std::span<const Index> hexes, int change) {
  std::vector<std::int8_t> changes(forest.grown->pieces.cell.size(), 0);
  for (const Index h : hexes) changes[h] = static_cast<std::int8_t>(change);
  return wishes(forest, changes);
}

LevelMarks wishes_of_levels(const Forest& forest, std::span<const std::uint8_t> levels) {
  const std::vector<std::uint8_t> wanted = by_level(forest, levels);
  const auto asked = [&](Index h, int) { return wanted[h] > 0 ? wanted[h] : -1; };
  return needed(asked_of_leaves(forest.grown->pieces, asked), forest.base->mesh.n_hexes(), true);
}

}  // namespace hextwist
