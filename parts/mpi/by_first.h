// What can't be done in parts, done by the first rank: it is sent the whole mesh, runs the commands in a session as
// hextwist does, and sends parts of what has become of it to all.
#pragma once

#include "hextwist/parts/asked.h"
#include "hextwist/parts/mpi/input.h"

namespace hextwist {

/// Hexes go to the ranks that had what they come of; where these are gone or not shared out fairly (rebalance), in
/// boxes. Throws Error on all ranks: "rank 0: ...".
void refined_by_first(Ranks& ranks, RankPart& part, const PartCommands& commands, bool rebalance, const Say& say);

}  // namespace hextwist
