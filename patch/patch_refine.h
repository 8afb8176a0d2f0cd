// A request whose change is small, run in a patch.
#pragma once

#include <memory>

#include "hextwist/patch/patch.h"
#include "hextwist/patch/splice.h"
#include "hextwist/patch/verify.h"
#include "hextwist/refine/levels/level_origin.h"
#include "hextwist/sizing/plan.h"

namespace hextwist {

/// Where the rings around the target come from: by place, unless somebody knows the neighbours of all nodes.
using RingsOf = std::function<std::optional<Rings>(const Mesh& mesh, std::span<const Index> nodes,
                                                   std::span<const Index> at, int n_rings, std::size_t limit)>;

/// What came of it. The mesh and the origin of `result` are those of the patch; the report is that of the whole.
struct PatchResult {
  Patch patch;
  RefineResult result;
  std::unique_ptr<const Splice> splice;
  std::vector<Index> come;   ///< hexes of the changed patch that are new, in the order that they have in the whole
  bool is_verified = false;  ///< false (and not a dry run): only verifying everything will do
};

/// Rings that a patch must have beyond every hex that changes. The farthest that anything reaches is the repair of
/// inverted children (refine/repair.cpp): the nodes of three rings around them may move, and the hexes at these nodes
/// are looked at. Smoothing and filling reach less far; how far filling grows shows in the hexes that are cut.
inline constexpr int enough_rings = 4;

/// Do sizes or distances decide between passes what is cut? Then a dry run is a whole run whose mesh is thrown away.
bool is_by_places(const Request& request);

/// The request for a part of its mesh, with nodes and hexes, edges and faces by their numbers there; what is not there
/// is left out. nodes, hexes: those of the part, in the whole, ascending. target_edges, target_faces: what the target
/// names of these kinds, by nodes of the whole.
Request request_in_part(const Request& request, const Mesh& part, std::span<const Index> nodes,
                        std::span<const Index> hexes, std::span<const Edge> target_edges,
                        std::span<const Quad> target_faces);

/// Nothing where the request's plan has no reach or it asks for too much: then the passes over the whole mesh are to be
/// run. Throws what they throw.
std::optional<PatchResult> refine_patch(const MeshedModel& input, const Measured& known, const Request& request,
                                        const Progress& progress, const RingsOf& rings_of = rings_by_place);

/// refine_patch() where hexes become finer and coarser by levels: the patch is one of the base, with all that has
/// become of its hexes. Nothing also where inverted children had to be repaired.
std::optional<PatchResult> refine_levels_patch(const MeshedModel& input, const Measured& known, const Request& request,
                                               const Progress& progress, const RingsOf& rings_of);
/// Whether that is what a request asks for.
bool is_by_levels(const Request& request, const Plan& plan);

/// The levels of what a patch makes of a base, but for nodes that were moved (result.smoothed). Null: there are none.
std::shared_ptr<const Levelling> planted(const PatchResult& made, const Request& request, const MeshedModel& base);

/// The result of a patch put into a copy of the mesh.
RefineResult whole_result(PatchResult made, const MeshedModel& input, const Measured& known, const Request& request);

/// In numbers of the whole: the origin; and in detail, with levels.
std::vector<Index> whole_origin(const PatchResult& result, const MeshedModel& input);
LevelOrigin whole_came_from(const PatchResult& result, const MeshedModel& input);

}  // namespace hextwist
