// Refinements by several ranks, each on its part of the mesh: the parts together are what one rank would have made.
//
// Each rank runs the passes on its own hexes and some rings of others' hexes around them, by the code that refines any
// mesh. What it makes of these is compared with what their owners make of them (agree.h). Rings that differ are dropped
// before the next refinement; where too near ones do, all is done again with twice as many rings. So a closing of
// concave places that runs far makes halos wide, and where all of the mesh is looked at at once each rank has the whole
// mesh and is right for that reason.
#pragma once

#include <filesystem>
#include <functional>
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
  std::vector<std::int64_t> n_made;  ///< per hex of the rank's part before: what has become of it
};

struct RankOptions {
  int n_rings = 6;        ///< around each part, to begin with, and as many as the depth of a target more
  bool rebalance = true;  ///< share hexes out again where a rank ends with more than `fair` times the average
};
inline constexpr double fair = 1.2;

/// Does the refinements one after another. The part stays, but for where hexes are shared out again. say: lines about
/// what was done; called on all ranks. Throws Error on all ranks: "rank 3: ...".
InRanks refine_in_ranks(Ranks& ranks, RankPart& part, const PartCommands& commands, const RankOptions& options,
                        const std::function<void(const std::string&)>& say);

/// This rank's part of what was made, with counts of the whole.
OwnPart take_part(Ranks& ranks, InRanks made);

/// Writes each rank's part (PartOutput): all of them, or none where one fails. Returns what the format could not
/// keep.
std::vector<std::string> write_in_ranks(Ranks& ranks, InRanks made, const std::filesystem::path& name);

}  // namespace hextwist
