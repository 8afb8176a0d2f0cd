// From entities to the hexes that are to be refined fully.
#pragma once

#include <vector>

#include "hextwist/sizing/request.h"

namespace hextwist {

/// Hexes that the request wants cut in three in all directions, ascending. Throws Error for entities that do not
/// exist, entities that own no part of the mesh, and depths that have no meaning (yet).
std::vector<Index> target_hexes(const MeshedModel& input, const Request& request);

/// True when the targets are all volumes of the model (or all blocks' worth of hexes of a mesh without one): the
/// request is then for uniform refinement.
bool is_whole_model(const MeshedModel& input, const Request& request);

}  // namespace hextwist
