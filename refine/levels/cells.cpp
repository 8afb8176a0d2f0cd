#include "hextwist/refine/levels/cells.h"

#include <algorithm>
#include <numeric>

#include "hextwist/base/parallel.h"

namespace hextwist {
namespace {

/// Walks along two sorted lists: only_a(i), only_b(j), both(i, j), in ascending order of cells.
template <class OnlyA, class OnlyB, class Both>
void walk_along(const CellMarks& a, const CellMarks& b, const OnlyA& only_a, const OnlyB& only_b, const Both& both) {
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    if (j == b.size() || (i < a.size() && a.cell[i] < b.cell[j]))
      only_a(i++);
    else if (i == a.size() || b.cell[j] < a.cell[i])
      only_b(j++);
    else
      both(i++, j++);
  }
}

}  // namespace

CellPlace place_of(CellNumber cell, std::size_t level) {
  CellPlace place{0, {0, 0, 0}};
  Index weight = 1;
  for (std::size_t k = 0; k < level; ++k, cell = cell_parent(cell), weight *= 3)
    for (int axis = 0; axis < 3; ++axis) place.at[axis] += weight * cell_layer(cell, axis);
  place.root = static_cast<Index>(cell);
  return place;
}

CellNumber number_of(const CellPlace& place, Index n) {
  CellNumber number = place.root;
  for (Index weight = n / 3; weight > 0; weight /= 3)
    number = first_cell_child(number) + 9 * (place.at[0] / weight % 3) + 3 * (place.at[1] / weight % 3) +
             place.at[2] / weight % 3;
  return number;
}

int max_level(Index n_base_hexes) {
  int level = 0;
  for (CellNumber n = std::max<Index>(n_base_hexes, 1); n <= (CellNumber{1} << 62) / n_cell_children;
       n *= n_cell_children)
    ++level;
  return level;
}

void check_levels(int n_levels, Index n_base_hexes) {
  if (const int most = max_level(n_base_hexes); n_levels > most)
    throw Error("cells of this mesh cannot be cut more than " + std::to_string(most) + " times");
}

void normalize(CellMarks& marks) {
  if (std::ranges::is_sorted(marks.cell, std::less_equal{})) return;
  std::vector<Index> order(marks.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](Index i) { return marks.cell[i]; });
  CellMarks sorted;
  for (const Index i : order)
    if (!sorted.empty() && sorted.cell.back() == marks.cell[i])
      sorted.corners.back() |= marks.corners[i];
    else
      sorted.add(marks.cell[i], marks.corners[i]);
  marks = std::move(sorted);
}

CellMarks united(const CellMarks& a, const CellMarks& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  CellMarks both;
  walk_along(
      a, b, [&](std::size_t i) { both.add(a.cell[i], a.corners[i]); },
      [&](std::size_t j) { both.add(b.cell[j], b.corners[j]); },
      [&](std::size_t i, std::size_t j) {
        both.add(a.cell[i], static_cast<std::uint8_t>(a.corners[i] | b.corners[j]));
      });
  return both;
}

LevelMarks united(const LevelMarks& a, const LevelMarks& b) {
  LevelMarks both = a;
  both.resize(std::max(a.size(), b.size()));
  for (std::size_t k = 0; k < b.size(); ++k) both[k] = united(both[k], b[k]);
  trim(both);
  return both;
}

void trim(LevelMarks& marks) {
  while (!marks.empty() && marks.back().empty()) marks.pop_back();
}

Index n_forced(const CellMarks& marks, const CellMarks& wished) {
  Index n = 0;
  const auto nothing = [](std::size_t) {};
  walk_along(
      marks, wished, [&](std::size_t i) { n += marks.corners[i] == all_corners; }, nothing,
      [&](std::size_t i, std::size_t j) { n += marks.corners[i] == all_corners && wished.corners[j] != all_corners; });
  return n;
}

}  // namespace hextwist
