// Lifting the worst hexes among few, by moving chosen nodes between them.
#pragma once

#include <functional>
#include <span>

#include "hextwist/mesh/smooth/smooth.h"

namespace hextwist {

/// What no hex may fall below; 0: anything goes.
struct Bounds {
  double scaled_jacobian = 0, shape = 0;
};
/// The smallest of these hexes, inverted ones counting as 0; the scaled Jacobian at most `wanted`.
Bounds bounds_of(const Mesh& mesh, std::span<const Index> hexes, double wanted = 1);
/// The same of hexes of which these are some.
using BoundsOf = std::function<Bounds(std::span<const Index> hexes)>;

/// Moves nodes of hexes whose scaled Jacobian is below `wanted` to where the worst corner around them is best: node by
/// node, at most `sweeps` times over those of such hexes. Guarantees:
///  1. neither the smallest scaled Jacobian of the hexes around the nodes nor their smallest shape falls, none is
///     inverted that was not, and where no hex is below `wanted`, nothing moves;
///  2. to 4. as in smooth.h. Of the options those that say which nodes may move count.
/// bounds: where the mesh is a part of one whose hexes are lifted all at once; empty: bounds_of().
void lift_scaled_jacobians(Mesh& mesh, Association& association, const Model* model, const SmoothOptions& options,
                           double wanted, int sweeps, const BoundsOf& bounds = {});

}  // namespace hextwist
