// Lifting the worst hexes among few, by moving chosen nodes between them: what refinement does with its own children.
#pragma once

#include <span>

#include "hextwist/geom/model.h"
#include "hextwist/mesh/association/association.h"

namespace hextwist {

/// Moves nodes of hexes whose scaled Jacobian is below `threshold` so that the smallest corner around each rises, a few
/// sweeps over them. No node moves whose hexes are all good, and no corner ends below where it was and below the
/// threshold. Nodes on curves and surfaces slide on them. nodes: those that may move, ascending, with their owners (dim
/// 3: anywhere); hexes: all around them, ascending. Inverted hexes stay as they are (smooth.h untangles). The same bits
/// for any number of threads.
void lift_scaled_jacobians(Mesh& mesh, Association& association, const Model* model, std::span<const Index> nodes,
                           std::span<const Owner> owners, std::span<const Index> hexes, double threshold, int sweeps);

}  // namespace hextwist
