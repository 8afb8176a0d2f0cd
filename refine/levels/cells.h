// Regular cells by number, and marks on them: what a levelled refinement is made from.
//
// A regular cell of level 0 is a hex of the base mesh; one of level k is one of the 27 children of a regular cell of
// level k - 1. Its number is 27 * (number of that parent) + its place among the 27, in the order of the trisecting
// template: cells of a level are numbered as if all had been cut, in the order in which they stand in a mesh. (The
// scheme of forests of octrees: Burstedde, Wilcox and Ghattas, p4est, 2011; here with 27 children.)
//
// All other hexes of a refined mesh are closure: pieces of a regular cell that was cut along a part of its edges.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/base/types.h"

namespace hextwist {

using CellNumber = std::int64_t;

inline constexpr int n_cell_children = 27;
inline constexpr std::uint8_t all_corners = 0xff;

constexpr CellNumber cell_parent(CellNumber cell) {
  return cell / n_cell_children;
}
constexpr CellNumber first_cell_child(CellNumber cell) {
  return cell * n_cell_children;
}
/// Which of its parent's three layers along an axis the cell is in: 0, 1, 2.
constexpr int cell_layer(CellNumber cell, int axis) {
  const auto place = static_cast<int>(cell % n_cell_children);
  return axis == 0 ? place / 9 : axis == 1 ? place / 3 % 3 : place % 3;
}

/// A cell by the base hex that it lies in and its layers there, each 0 .. n - 1, of the n along an edge of the hex.
struct CellPlace {
  Index root;
  std::array<Index, 3> at;
};
CellPlace place_of(CellNumber cell, std::size_t level);
CellNumber number_of(const CellPlace& place, Index n);

/// Cells of a level are numbered in 62 bits: so many levels there can be at most (8 for a million hexes).
int max_level(Index n_base_hexes);
/// Throws Error when they are more.
void check_levels(int n_levels, Index n_base_hexes);

/// Marked corners of cells of one level. An edge is cut in three when both its ends are marked (a node is marked when
/// any cell that has it says so), so a cell with all corners marked becomes 27.
struct CellMarks {
  std::vector<CellNumber> cell;       ///< ascending, each once
  std::vector<std::uint8_t> corners;  ///< per cell: bit c for corner c, not 0

  bool empty() const { return cell.empty(); }
  std::size_t size() const { return cell.size(); }
  void add(CellNumber number, std::uint8_t corner_mask = all_corners) {
    cell.push_back(number);
    corners.push_back(corner_mask);
  }
  bool operator==(const CellMarks&) const = default;
};

/// [k]: marks on cells of level k, which pass k + 1 cuts. No empty level at the end.
using LevelMarks = std::vector<CellMarks>;

/// Sorts what was added in any order and joins marks of the same cell.
void normalize(CellMarks& marks);
/// Marks of both. Precondition: both normalized.
CellMarks united(const CellMarks& a, const CellMarks& b);
/// Level by level; levels at the end that are empty go.
LevelMarks united(const LevelMarks& a, const LevelMarks& b);
void trim(LevelMarks& marks);

/// How many cells of `marks` have all corners marked that do not in `wished`: they are cut for the sake of others.
Index n_forced(const CellMarks& marks, const CellMarks& wished);

}  // namespace hextwist
