// Marks grown so that no piece of a closure is ever cut again.
//
// Rule: if every hex at a marked node of pass k + 1 is a regular cell of level k, then that pass cuts regular cells of
// level k only, and quality does not depend on the number of levels. (Edges would do instead of nodes; nodes give
// convex corners, usually fewer hexes and better shapes.) So pass k must cut whatever lies around the marks of pass k
// + 1.
#pragma once

#include "hextwist/mesh/topology.h"
#include "hextwist/refine/levels/mirror.h"

namespace hextwist {

/// The wished marks and what they need. Guarantees:
///  1. a superset of `wished`; what is added are cells with all corners marked, the fewest that make the rule hold;
///  2. depends on `wished` and the connectivity of the base mesh alone;
///  3. monotone: more wishes never need less.
/// wished: normalized, within max_level(); corners of cells that lie in the base mesh.
/// Cost: O(cells * log), nothing that looks at all hexes; base_corners is node_corners(base) (loose_topology.h).
/// mirror: null, or then the marks are the same on both sides of its pairs.
LevelMarks graded(const LevelMarks& wished, std::span<const Hex> base_hexes, const CompressedRows& base_corners,
                  const Mirror* mirror = nullptr);

}  // namespace hextwist
