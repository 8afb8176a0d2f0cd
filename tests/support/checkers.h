// Independent checkers: the specification of a good mesh. They share no code with the library beyond mesh.h and
// corners.h, are simple instead of fast, and report the first offence by id.
#pragma once

#include <gtest/gtest.h>

#include "hextwist/mesh/mesh.h"

namespace hextwist::test {

/// Every node used, none repeated in a hex; every quad shared by at most two hexes, in opposite sense; no node of the
/// skin lies inside an edge or quad of the skin of a hex that does not have it (within 1e-7 of the quad's size).
enum class UnusedNodes { refused, allowed };
/// allowed: of meshes with nodes twice at one place (cracks, contact), whose two sides may be cut differently.
enum class HangingNodes { refused, allowed };
testing::AssertionResult conformal(const Mesh& mesh, UnusedNodes unused = UnusedNodes::refused,
                                   HangingNodes hanging = HangingNodes::refused);

/// The Jacobian of every hex positive at 5 x 5 x 5 places of it, corners among them.
testing::AssertionResult uninverted(const Mesh& mesh);

/// Sets, blocks and fields have members that exist, ascending and once each; fields the right length.
testing::AssertionResult sets_valid(const Mesh& mesh);

}  // namespace hextwist::test
