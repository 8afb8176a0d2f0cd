// Fields from the mesh before a step to the mesh after it.
#pragma once

#include <string>

#include "hextwist/refine/levels/match.h"

namespace hextwist {

/// What is known of a mesh that came out of a step.
struct LevelChange {
  const Mesh& before;
  const Mesh& now;                  ///< in the order of the levels
  const LevelStack& stack;          ///< of now
  std::span<const Index> old_node;  ///< per node now: the node before, -1
  const LevelOrigin& origin;        ///< per hex now: of before
};

/// The fields of `before` on `now`. Guarantees:
///  1. nodes: a node that was there, at the same place, keeps its values; others get those of `before` at their place
///     (mesh/nodal_fields.h), so what is linear stays so;
///  2. hexes: those of the same hex and of the hex that it lies in are copied; where there were several, the average by
///     volume, exact when all are equal; of whole numbers that of the largest;
///  3. hex fields named in `extensive` keep their sum instead: they are shared out by volume downwards (whole numbers
///     as whole numbers) and summed up.
std::vector<Field> transferred_fields(const LevelChange& change, std::span<const std::string> extensive);

}  // namespace hextwist
