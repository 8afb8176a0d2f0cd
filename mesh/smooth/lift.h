// Lifting the worst hexes among few, by moving chosen nodes between them.
#pragma once

#include "hextwist/mesh/smooth/smooth.h"

namespace hextwist {

/// Moves nodes of hexes whose scaled Jacobian is below `wanted` to where the worst corner around them is best: node by
/// node, at most `sweeps` times over those of such hexes. Guarantees:
///  1. neither the smallest scaled Jacobian of the hexes around the nodes nor their smallest shape falls, none is
///     inverted that was not, and where no hex is below `wanted`, nothing moves;
///  2. to 4. as in smooth.h. Of the options those that say which nodes may move count.
void lift_scaled_jacobians(Mesh& mesh, Association& association, const Model* model, const SmoothOptions& options,
                           double wanted, int sweeps);

}  // namespace hextwist
