// Fields from the mesh before a step to the mesh after it.
#pragma once

#include <string>

#include "hextwist/refine/levels/match.h"

namespace hextwist {

/// What is known of a mesh that came out of a step.
struct LevelChange {
  const Mesh& before;
  const Mesh& now;                  ///< in the order of the levels
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

/// What the file of `before` has at other times and on sets (Mesh::results, Mesh::file_hexes), for `now`. As long as
/// each hex lies in one of the file, that says all; where one is made of several, or fields in `extensive` have other
/// times, all values are carried at once, as transferred_fields() does it, as if `now` had been written and read again.
void carry_results(const Mesh& before, const LevelOrigin& origin, std::span<const std::string> extensive, Mesh& now);

/// Is carry_results() to make values anew in a mesh of which this one is a part, by levels of `base` (null: not by
/// levels)? That takes all of it.
bool results_take_all(const Mesh& mesh, const Mesh* base, std::span<const std::string> extensive);

/// After passes, of which each copies the values of hexes: those of fields in `extensive` are shared out. origin: per
/// hex now the hex before that it lies in.
void share_out(const Mesh& before, std::span<const Index> origin, std::span<const std::string> extensive, Mesh& now);

}  // namespace hextwist
