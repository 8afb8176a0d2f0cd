#include "hextwist/refine/levels/gradation.h"

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

/// A part of a cell's surface: along each axis at its low end (0), between (1), or at its high end (2). 1, 1, 1 is the
/// cell itself, one end makes a face, two an edge, three a corner.
using Feature = std::array<std::int8_t, 3>;
constexpr int n_features = 27;

constexpr Feature feature(int number) {
  return {static_cast<std::int8_t>(number % 3), static_cast<std::int8_t>(number / 3 % 3),
          static_cast<std::int8_t>(number / 9)};
}

struct Tables {
  /// Per child of a cell and corner of that child: the feature of the cell on which the corner lies.
  std::array<std::array<std::uint8_t, 8>, n_cell_children> of_corner;
  /// Per feature, as bits: those that lie on it. What is around a corner is around its edges and faces too, and more.
  std::array<std::uint32_t, n_features> on;
};

const Tables& tables() {
  static const Tables made = [] {
    Tables t{};
    for (int child = 0; child < n_cell_children; ++child)
      for (int c = 0; c < 8; ++c) {
        int number = 0, weight = 1;
        for (int axis = 0; axis < 3; ++axis, weight *= 3) {
          const int at = cell_layer(child, axis) + (c >> axis & 1);
          number += weight * (at == 0 ? 0 : at == 3 ? 2 : 1);
        }
        t.of_corner[child][c] = static_cast<std::uint8_t>(number);
      }
    for (int f = 0; f < n_features; ++f)
      for (int g = 0; g < n_features; ++g) {
        const Feature whole = feature(f), part = feature(g);
        bool on = f != g;
        for (int axis = 0; axis < 3; ++axis) on &= whole[axis] == 1 || whole[axis] == part[axis];
        if (on) t.on[f] |= 1u << g;
      }
    return t;
  }();
  return made;
}

/// Finds the cells of one level around features of a cell, beyond the base hex that it lies in.
class Around {
 public:
  Around(std::span<const Hex> hexes, const CompressedRows& corners, std::size_t level)
      : hexes_(hexes), corners_(corners), level_(level) {
    for (std::size_t k = 0; k < level; ++k) n_ *= 3;
  }

  /// Appends all cells that share this feature of the cell, itself among them.
  void collect(CellNumber cell, const Feature& of, std::vector<CellNumber>& found) const {
    const CellPlace place = place_of(cell, level_);
    // Along each axis within the base hex: one or two layers, or the skin of the hex.
    std::array<Index, 3> low = place.at, high = place.at;
    std::array<bool, 3> skin{};
    for (int axis = 0; axis < 3; ++axis) {
      if (of[axis] == 0) skin[axis] = low[axis]-- == 0;
      if (of[axis] == 2) skin[axis] = ++high[axis] == n_;
    }
    const int n_skin = skin[0] + skin[1] + skin[2];
    if (n_skin == 0) {
      for_each_layer(low, high, [&](const std::array<Index, 3>& at) {
        found.push_back(number_of({place.root, at}, n_));
      });
      return;
    }
    // The corner of the base hex from which its edge or face on the skin is measured, and the axes along that.
    const Hex& hex = hexes_[place.root];
    int corner = 0;
    std::array<int, 3> along{};
    int n_along = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (skin[axis])
        corner |= (of[axis] == 2) << axis;
      else
        along[n_along++] = axis;
    for (const Index other : corners_[hex[corner]]) {
      const Hex& theirs = hexes_[other >> 3];
      std::array<int, 3> their_axis{};  // of `along`
      if (!same_part(hex, corner, along, n_along, theirs, other & 7, their_axis)) continue;
      CellPlace there{other >> 3, {}};
      for (int axis = 0; axis < 3; ++axis) there.at[axis] = (other >> axis & 1) ? n_ - 1 : 0;
      std::array<Index, 3> from{}, to{};
      for (int i = 0; i < n_along; ++i) from[i] = low[along[i]], to[i] = high[along[i]];
      for_each_layer(from, to, [&](const std::array<Index, 3>& at) {
        for (int i = 0; i < n_along; ++i)
          there.at[their_axis[i]] = (other >> their_axis[i] & 1) ? n_ - 1 - at[i] : at[i];
        found.push_back(number_of(there, n_));
      });
    }
  }

 private:
  template <class Body>
  static void for_each_layer(const std::array<Index, 3>& low, const std::array<Index, 3>& high, const Body& body) {
    for (Index x = low[0]; x <= high[0]; ++x)
      for (Index y = low[1]; y <= high[1]; ++y)
        for (Index z = low[2]; z <= high[2]; ++z) body({x, y, z});
  }

  /// Is the part of a hex that runs from a corner along these axes one of the other hex too, from that corner of it?
  /// Finds the axes along which it runs there.
  static bool same_part(const Hex& hex, int corner, const std::array<int, 3>& along, int n_along, const Hex& theirs,
                        int their_corner, std::array<int, 3>& their_axis) {
    for (int i = 0; i < n_along; ++i) {
      int axis = 0;
      while (axis < 3 && theirs[their_corner ^ 1 << axis] != hex[corner ^ 1 << along[i]]) ++axis;
      if (axis == 3) return false;
      their_axis[i] = axis;
    }
    return n_along < 2 || theirs[their_corner ^ 1 << their_axis[0] ^ 1 << their_axis[1]] ==
                              hex[corner ^ 1 << along[0] ^ 1 << along[1]];
  }

  std::span<const Hex> hexes_;
  const CompressedRows& corners_;
  std::size_t level_;
  Index n_ = 1;  // cells of the level along an edge of a base hex
};

/// The cells of level - 1 that marks on cells of `level` need cut. Ascending.
CellMarks needed(const CellMarks& marks, std::size_t level, std::span<const Hex> hexes, const CompressedRows& corners) {
  const Tables& table = tables();
  const Around around(hexes, corners, level - 1);
  constexpr Index size = 4096;
  const auto n = static_cast<Index>(marks.size());
  std::vector<std::vector<CellNumber>> of_chunk(static_cast<std::size_t>(n_chunks(n, size)));
  parallel_chunks(n, size, [&](Index chunk, Index begin, Index end) {
    std::vector<CellNumber>& found = of_chunk[chunk];
    for (Index i = begin; i < end;) {
      const CellNumber parent = cell_parent(marks.cell[i]);
      std::uint32_t features = 0;
      for (; i < end && cell_parent(marks.cell[i]) == parent; ++i)
        for (int c = 0; c < 8; ++c)
          if (marks.corners[i] >> c & 1) features |= 1u << table.of_corner[marks.cell[i] % n_cell_children][c];
      for (int f = 0; f < n_features; ++f)
        if ((features >> f & 1) && !(features & table.on[f])) around.collect(parent, feature(f), found);
    }
    sort_unique(found);
  });
  CellMarks result;
  for (const auto& found : of_chunk) result.cell.insert(result.cell.end(), found.begin(), found.end());
  sort_unique(result.cell);
  result.corners.assign(result.cell.size(), all_corners);
  return result;
}

}  // namespace

LevelMarks graded(const LevelMarks& wished, std::span<const Hex> base_hexes, const CompressedRows& base_corners,
                  const Mirror* mirror) {
  LevelMarks marks = wished;
  trim(marks);
  for (std::size_t level = marks.size(); level-- > 0;) {
    if (mirror) mark_images(marks[level], level, base_hexes, base_corners, *mirror);
    if (level > 0) marks[level - 1] = united(marks[level - 1], needed(marks[level], level, base_hexes, base_corners));
  }
  return marks;
}

}  // namespace hextwist
