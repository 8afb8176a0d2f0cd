// What two levelled meshes of one base have in common, and where the hexes of one are in the other.
#pragma once

#include "hextwist/refine/levels/level_origin.h"
#include "hextwist/refine/levels/stack.h"

namespace hextwist {

/// Per node of the mesh of `now`: the same node in that of `before`, -1 where it was not there. A node is the same when
/// it lies at the same place of the same edge, of the same face with the same cuts, or of the same cell with the same
/// cuts.
std::vector<Index> matching_nodes(const LevelStack& now, const LevelStack& before, Index n_base_nodes);

/// What every hex came from.
LevelOrigin level_origin(const LevelPieces& now, const LevelPieces& before);

}  // namespace hextwist
