// Refinements by several ranks, each on its part of the mesh: the parts together are what one rank would have made.
//
// Each rank runs the passes on its own hexes and some rings of others' hexes around them, by the code that refines any
// mesh. What rank r makes of a hex of rank q in its halo is compared with what q makes of it: where the first two rings
// are the same on all ranks, nothing that lies beyond the halo had a say, since influence goes from hex to hex. Rings
// that differ are dropped before the next refinement; where the first two differ, all is done again with twice as many
// rings. So a closing of concave places that runs far makes halos wide, and in the end each rank has the whole mesh and
// is right for that reason.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "hextwist/parts/local_mesh.h"
#include "hextwist/parts/mpi/numbering.h"

namespace hextwist {

struct InRanks {
  LocalMesh local;
  GlobalIds ids;
  int n_rings = 0;  ///< that halos began with
  int n_restarts = 0;
};

/// Does the refinements one after another. n_rings: around each part, to begin with, and as many as the depth of a
/// target more. whole and part_of_hex are the same on all ranks. say: lines about what was done; called on all ranks.
/// Throws Error on all ranks: "rank 3: ...".
InRanks refine_in_ranks(Ranks& ranks, const MeshedModel& whole, std::span<const int> part_of_hex,
                        std::span<const Asked> asked, int n_rings, const std::function<void(const std::string&)>& say);

/// Writes each rank's part to name.n.rank: all of them, or none where one fails. Returns what the format could not
/// keep.
std::vector<std::string> write_in_ranks(Ranks& ranks, const InRanks& made, const std::filesystem::path& name);

}  // namespace hextwist
