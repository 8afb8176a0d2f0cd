// A patch of a base with all that has become of its hexes: a small forest of its own.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "hextwist/base/sorted.h"
#include "hextwist/patch/patch.h"
#include "hextwist/refine/levels/forest.h"
#include "hextwist/sizing/levelling.h"

namespace hextwist {

/// A base as it is, without what only steps over the whole need.
Forest bare_forest(Forest forest);

/// Roots of cells that are marked otherwise in one than in the other.
std::vector<Index> changed_roots(const LevelMarks& a, const LevelMarks& b);

/// Cells of some roots (ascending) by numbers in which these are 0, 1, ...
class LocalCells {
 public:
  explicit LocalCells(std::span<const Index> roots) : roots_(roots) {}

  /// -1: of another root.
  CellNumber local(LevelPieces::Leaf leaf) const {
    const Index root = root_of(leaf), at = position_in(roots_, root);
    return at < 0 ? -1 : moved(leaf, root, at);
  }
  CellNumber whole(LevelPieces::Leaf leaf) const {
    const Index at = root_of(leaf);
    return moved(leaf, at, roots_[at]);
  }
  LevelMarks local(const LevelMarks& marks) const {
    LevelMarks result(marks.size());
    for (std::size_t k = 0; k < marks.size(); ++k)
      for (std::size_t i = 0; i < marks[k].size(); ++i)
        if (const CellNumber cell = local({static_cast<int>(k), marks[k].cell[i]}); cell >= 0)
          result[k].add(cell, marks[k].corners[i]);
    trim(result);
    return result;
  }

  LevelMarks whole(const LevelMarks& marks) const {
    LevelMarks result(marks.size());
    for (std::size_t k = 0; k < marks.size(); ++k)
      for (std::size_t i = 0; i < marks[k].size(); ++i)
        result[k].add(whole({static_cast<int>(k), marks[k].cell[i]}), marks[k].corners[i]);
    return result;
  }

 private:
  static CellNumber moved(LevelPieces::Leaf leaf, Index from, Index to) {
    CellNumber shift = to - from;
    for (int level = 0; level < leaf.level; ++level) shift *= n_cell_children;
    return leaf.cell + shift;
  }
  std::span<const Index> roots_;
};

/// Sides on surfaces, in any order, with the ids of these.
void set_surface_faces(Association& association, std::vector<std::pair<Side, int>> faces);

/// Hexes of the mesh that lie in the roots; ascending.
std::vector<Index> hexes_in(const HandedHexes& hexes, std::span<const Index> roots);

/// Rings of hexes of the base, whose corners at each node the forest knows afterwards.
std::optional<Rings> rings_in_base(Forest& forest, std::span<const Index> nodes, int n_rings, std::size_t limit);

/// The patch with its part of the forest.
struct ForestPatch {
  Patch patch;
  LocalCells cells;
  Levelling levelling;

  /// Marks that cells outside of the patch make on cells of its outermost ring: all that are seen there.
  LevelMarks border;

  ForestPatch(const MeshedModel& input, const Levelling& whole, const Rings& rings, std::vector<Index> hexes);
  LevelMarks with_border(const LevelMarks& marks) const { return united(cells.local(marks), border); }
};

}  // namespace hextwist
