// How a mesh came out of a base mesh by levels (refine/levels/forest.h), so that it can be refined and coarsened
// further without its quality coming down.
#pragma once

#include <functional>

#include "hextwist/refine/levels/overlay.h"
#include "hextwist/sizing/loop.h"

namespace hextwist {

struct Levelling {
  Forest forest;
  Overlay overlay = {};  ///< what smoothing did to the mesh that was handed out
};
using LevellingPtr = std::shared_ptr<const Levelling>;

/// How the mesh that is to be cut came about counts.
inline bool has_levels(const Request& request) {
  return request.levelling && !request.levelling->forest.is_bare();
}

/// After a request: that of its result. result.levelling: what run_levels() made, or null; refined: the whole mesh.
/// Null: `refined` is a base.
LevellingPtr levelling_after(const Request& request, const RefineResult& result, const MeshedModel& refined);
/// After these nodes (ascending) have moved. before: null or bare, then the mesh as it is now is a base: null.
LevellingPtr levelling_after_move(const LevellingPtr& before, std::span<const Index> moved, const MeshedModel& meshed);

/// With a base that this has been done to, which changes nothing but what things are called. Null stays null.
LevellingPtr with_base(const LevellingPtr& levelling, const std::function<void(MeshedModel& base)>& change);

/// Approach::levels and size_by_levels: makes the mesh of the request's levelling (of the input, where it has none)
/// with other wishes the current one. Tells what was cut for the sake of gradation, and what came off of earlier
/// smoothing.
void run_levels(State& state);

/// The levels that a request asks for, of what its levelling has: no sizes. What is said about it goes to `notices`.
LevelMarks wishes_of(const Forest& forest, const MeshedModel& input, const Request& request,
                     std::vector<std::string>& notices);

/// Says how many cells are cut for the sake of gradation.
void tell_forced(Index n_forced, Report& report);

/// run_levels() in a part of a mesh, where the cells are known: the part does not show all that gradation needs. With
/// a report on sizes where the state has them.
struct KnownLevels {
  LevelMarks wished, graded;
  Index n_forced = 0;        ///< in the whole
  bool is_bare = false;      ///< nothing is wished for in the whole
  bool is_repaired = false;  ///< set: inverted children were repaired
};
void run_levels(State& state, KnownLevels& known);
/// What Approach::size_by_levels would have of the levelling of a request, without making it.
LevelMarks size_wishes(State& state);

/// Approach::combination with numsplit n above 1: the hexes that touch the target are cut by n - 1 levels, those that
/// touch it then by the combination, so that no piece of a transition is cut either. Returns false where that can't be
/// had: of nodes, edges and faces of a mesh that was cut by levels already.
bool run_combination_by_levels(State& state);

/// The same without what can be made again, for keeping; bytes that it takes beside its base.
LevellingPtr without_stack(const LevellingPtr& levelling);
std::size_t bytes_of(const Levelling& levelling);

/// The hex field of levels; null: there is none.
const Field* level_field(const Mesh& mesh);

/// After a pass that knows nothing of levels: adds one in the hex field of levels (Finish::level_field) to the children
/// of hexes all of whose edges were cut. make: the field where there is none.
void raise_levels(const Lineage& lineage, bool make, Mesh& refined);

}  // namespace hextwist
