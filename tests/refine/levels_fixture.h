// A forest with its mesh, as a program that refines and coarsens keeps them.
#pragma once

#include <gtest/gtest.h>

#include <functional>

#include "hextwist/refine/levels/forest.h"
#include "support/meshed.h"

namespace hextwist::test {

struct Grown {
  Forest forest;
  MeshedModel mesh;

  explicit Grown(MeshedModel base)
      : forest(plant(std::make_shared<const MeshedModel>(std::move(base)))), mesh(*forest.base) {}

  /// By how many levels each hex becomes finer or coarser.
  LevelStep adapt(const std::function<int(Index)>& levels, const LevelOptions& options = {}) {
    std::vector<std::int8_t> flags(mesh.mesh.hexes.size());
    for (Index h = 0; h < mesh.mesh.n_hexes(); ++h) flags[h] = static_cast<std::int8_t>(levels(h));
    return take(change(forest, mesh.mesh, wishes(forest, flags), options));
  }
  LevelStep refine(const std::vector<Index>& hexes, int levels = 1, const LevelOptions& options = {}) {
    return take(change(forest, mesh.mesh, wishes(forest, hexes, levels), options));
  }
  LevelStep set(const std::vector<std::uint8_t>& levels) {
    return take(change(forest, mesh.mesh, wishes_of_levels(forest, levels)));
  }
  /// The leaf that each hex is or is a piece of; its level; the hex of the base that it lies in.
  std::vector<LevelPieces::Leaf> leaves() const {
    std::vector<LevelPieces::Leaf> result;
    for (Index h = 0; h < mesh.mesh.n_hexes(); ++h) result.push_back(forest.grown->hexes.leaf(h));
    return result;
  }
  std::vector<int> levels() const {
    std::vector<int> result;
    for (const auto& leaf : leaves()) result.push_back(leaf.level);
    return result;
  }
  std::vector<Index> roots() const {
    std::vector<Index> result;
    for (auto leaf : leaves()) {
      for (; leaf.level > 0; --leaf.level) leaf.cell = cell_parent(leaf.cell);
      result.push_back(static_cast<Index>(leaf.cell));
    }
    return result;
  }

 private:
  LevelStep take(LevelStep step) {
    forest = step.forest;
    mesh = step.mesh;
    return step;
  }
};

}  // namespace hextwist::test
