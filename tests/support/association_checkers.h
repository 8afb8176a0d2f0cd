// Independent checkers of ownership: by maps and by one projection at a time, sharing no code with associate() or
// check_association().
#pragma once

#include <gtest/gtest.h>

#include "hextwist/mesh/association/association.h"

namespace hextwist::test {

/// Every node of a hex has an owner that exists; owners of dimension 0..2 are within relative_tolerance (of the model
/// size) of the node, found by projecting each from nowhere, and so is the place that its parameters name; nodes owned
/// by a volume lie in it, or `outside` of it at most (where coarse hexes bulge out of curved CAD, so may what they are
/// cut into).
testing::AssertionResult on_model(const Mesh& mesh, const Association& association, const Model& model,
                                  double relative_tolerance, double outside = 0);

/// The promises of a complete association that are about adjacency: which faces and edges have owners, and that
/// owners of nodes, edges, faces and hexes bound each other.
testing::AssertionResult complete(const Mesh& mesh, const Association& association, const Model& model);

/// Two associations of one mesh that say the same, parameters apart. Names the first difference.
testing::AssertionResult same_owners(const Association& a, const Association& b);

}  // namespace hextwist::test
