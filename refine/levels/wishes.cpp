// From what hexes are asked to become to wished cells.
#include <algorithm>

#include "hextwist/base/parallel.h"
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
    const auto found = std::ranges::lower_bound(cell, number);
    return found != cell.end() && *found == number ? level[found - cell.begin()] : -1;
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

/// Leaves of each level with the finest level that any of their hexes asks for; all of them, or those that ask.
std::vector<Asked> asked_of_leaves(const LevelPieces& pieces, std::span<const std::int8_t> levels, bool all) {
  std::vector<Asked> whole(static_cast<std::size_t>(pieces.n_levels())), cut(whole.size());
  for (int block = 0; block < pieces.n_levels(); ++block)
    for (Index h = pieces.first[block]; h < pieces.first[block + 1]; ++h) {
      if (!all && levels[h] == 0) continue;
      const LevelPieces::Leaf leaf = pieces.leaf(block, h);
      (leaf.level == block ? whole : cut)[leaf.level].add(leaf.cell, std::max(0, leaf.level + levels[h]));
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

/// With each cell its parent, and theirs.
void add_parents(LevelMarks& marks) {
  for (std::size_t k = marks.size(); k-- > 1;) {
    CellMarks parents;
    for (const CellNumber cell : marks[k].cell)
      if (parents.empty() || parents.cell.back() != cell_parent(cell)) parents.add(cell_parent(cell));
    marks[k - 1] = united(marks[k - 1], parents);
  }
}

LevelMarks finer(const std::vector<Asked>& leaves, int highest) {
  LevelMarks more;
  for (std::size_t k = 0; k < leaves.size(); ++k)
    for (std::size_t i = 0; i < leaves[k].cell.size(); ++i) {
      const int wanted = leaves[k].level[i];
      if (wanted <= static_cast<int>(k)) continue;
      if (wanted > highest)
        throw Error("cells of this mesh cannot be cut more than " + std::to_string(highest) + " times");
      if (more.size() < static_cast<std::size_t>(wanted)) more.resize(static_cast<std::size_t>(wanted));
      CellNumber begin = leaves[k].cell[i], end = begin + 1;
      for (auto level = k; level < static_cast<std::size_t>(wanted); ++level) {
        for (CellNumber cell = begin; cell < end; ++cell) more[level].add(cell);
        begin = first_cell_child(begin);
        end = first_cell_child(end);
      }
    }
  for (CellMarks& marks : more) normalize(marks);
  add_parents(more);
  return more;
}

}  // namespace

LevelMarks wishes(const Forest& forest, std::span<const std::int8_t> levels) {
  const LevelPieces& pieces = forest.grown->pieces;
  if (levels.size() != pieces.cell.size())
    throw Error("there are " + std::to_string(levels.size()) + " flags for " + std::to_string(pieces.cell.size()) +
                " hexes");
  const std::vector<Index>& order = forest.grown->hex_order;
  std::vector<std::int8_t> by_level(levels.begin(), levels.end());
  if (!order.empty()) parallel_each(order.size(), [&](std::size_t i) { by_level[order[i]] = levels[i]; });
  const bool coarser = std::ranges::any_of(levels, [](std::int8_t by) { return by < 0; });
  const std::vector<Asked> leaves = asked_of_leaves(pieces, by_level, coarser);
  return united(coarser ? without_given_up(forest.wished, leaves) : forest.wished,
                finer(leaves, max_level(forest.base->mesh.n_hexes())));
}

LevelMarks wishes(const Forest& forest, std::span<const Index> hexes, int levels) {
  std::vector<std::int8_t> flags(forest.grown->pieces.cell.size(), 0);
  for (const Index h : hexes) flags[h] = static_cast<std::int8_t>(levels);
  return wishes(forest, flags);
}

}  // namespace hextwist
