// Templates are made for cubes. Where they come out badly in the hexes of a mesh, flat or long or skewed as these are,
// new nodes go where the worst hex around them is best.
#pragma once

#include "hextwist/mesh/meshed_model.h"
#include "hextwist/sizing/request.h"

namespace hextwist {

/// Lifts the low hexes among those from first_new_hex on (mesh/smooth/lift.h) by their nodes from first_new_node on,
/// and those of the new hexes around; fixed ones stay. In the end, once: passes to come cut hexes as the templates made
/// them. Returns the nodes that moved, ascending.
std::vector<Index> lift_new_hexes(MeshedModel& refined, Index first_new_hex, Index first_new_node,
                                  const Finish& finish);

}  // namespace hextwist
