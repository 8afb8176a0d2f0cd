// Templates are made for cubes. Where they come out badly in the hexes of a mesh, flat or long or skewed as these are,
// new nodes go where the worst hex around them is best.
#pragma once

#include <functional>

#include "hextwist/mesh/meshed_model.h"
#include "hextwist/mesh/smooth/lift.h"
#include "hextwist/sizing/request.h"

namespace hextwist {

/// Scaled Jacobian below which a new hex is one that may be lifted.
inline constexpr double lift_below = 0.4;

/// What no hex may fall below, where these hexes are some of more. freedom: how far lifting has come, 0 .. n_freedoms -
/// 1, each at most once and in this order.
using BoundsOfAll = std::function<Bounds(int freedom, std::span<const Index> hexes, double wanted)>;
inline constexpr int n_freedoms = 8;

/// Lifts low hexes (mesh/smooth/lift.h) by the nodes (ascending) that are new, or not where they were. Fixed nodes,
/// nodes on curves and those of cubes stay. cell: per hex what it was cut out of; nodes of
/// one move together. of_boxes: hexes, ascending, that came of boxes, which are lifted further.
/// In the end, once: passes to come cut hexes as the templates made them. Returns the nodes that moved, ascending.
std::vector<Index> lift_new_hexes(MeshedModel& refined, std::vector<Index> new_nodes, const Finish& finish,
                                  std::span<const Index> cell, std::span<const Index> of_boxes = {},
                                  const BoundsOfAll& of_all = {});

}  // namespace hextwist
