// Lifting the worst hexes by all nodes around them at once.
#pragma once

#include "hextwist/mesh/smooth/smooth.h"

namespace hextwist {

/// Moves nodes inside volumes and on surfaces so that the worst scaled Jacobian of the hexes around them comes near
/// `wanted`: those of a block together, where node by node (lift_scaled_jacobians()) each is held by its neighbours. A
/// block are the nodes at the hexes of one cell, and those beside them. It has at most two turns with nodes inside
/// volumes alone and then, unless options.fix_boundary, two with those on surfaces as well; blocks that touch one after
/// the other. cell: per hex what it was cut out of. before: places of all nodes, from which shapes may come down a
/// little: to 0.85 of the smallest around the block. Guarantees, of each block: its smallest scaled Jacobian does not
/// fall, its volume stays within 0.4%, no hex is inverted that was not; and 2. to 4. of smooth.h. Of the options those
/// that say which nodes may move count.
void lift_together(Mesh& mesh, Association& association, const Model* model, const SmoothOptions& options,
                   std::span<const Index> cell, double wanted, std::span<const Vec3> before);

}  // namespace hextwist
