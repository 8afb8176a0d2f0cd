// Refinements by several ranks, each on its part of the mesh: the parts together are what one rank would have made.
//
// Each rank runs the passes on its own hexes and some rings of others' hexes around them, by the code that refines any
// mesh. What it makes of these is compared with what their owners make of them (agree.h). Rings that differ are dropped
// before the next refinement; where too near ones do, all is done again with twice as many rings. So a closing of
// concave places that runs far makes halos wide, and what looks at all of the mesh at once is done by the first rank.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "hextwist/parts/asked.h"
#include "hextwist/parts/mpi/input.h"
#include "hextwist/parts/own_part.h"

namespace hextwist {

struct InRanks {
  LocalMesh local;
  GlobalIds ids;
  int n_rings = 0;  ///< that halos began with
  int n_restarts = 0;
  std::vector<std::int64_t> n_made;            ///< per hex of the rank's part before: what has become of it
  std::shared_ptr<const FileResults> results;  ///< RankPart::results
  std::size_t array_bytes = 0;                 ///< of the part before and after, each with its halo
};

struct RankOptions {
  int n_rings = 6;        ///< around each part, to begin with, and as many as the depth of a target more
  bool rebalance = true;  ///< share hexes out again where a rank ends with more than `fair` times the average
};

/// Does the refinements one after another; what can't be done in parts is done by the first rank (by_first.h). The part
/// stays, but for that, and where hexes are shared out again. say: lines about what was done. Throws Error on all
/// ranks: "rank 3: ...".
InRanks refine_in_ranks(Ranks& ranks, RankPart& part, const PartCommands& commands, const RankOptions& options,
                        const Say& say);

/// This rank's part of what was made, with counts of the whole.
OwnPart take_part(Ranks& ranks, InRanks made);

/// Writes each rank's part (PartOutput): all of them, or none where one fails. Returns what the format could not
/// keep.
std::vector<std::string> write_in_ranks(Ranks& ranks, InRanks made, const std::filesystem::path& name);

}  // namespace hextwist
