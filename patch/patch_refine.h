// A request whose change is small, run in a patch.
#pragma once

#include <memory>

#include "hextwist/patch/patch.h"
#include "hextwist/patch/splice.h"
#include "hextwist/patch/verify.h"
#include "hextwist/sizing/request.h"

namespace hextwist {

/// Where the rings around the target come from: by place, unless somebody knows the neighbours of all nodes.
using RingsOf = std::function<std::optional<Rings>(const Mesh& mesh, std::span<const Index> nodes,
                                                   std::span<const Index> at, int n_rings, std::size_t limit)>;

/// What came of it. The mesh and the origin of `result` are those of the patch; the report is that of the whole.
struct PatchResult {
  Patch patch;
  RefineResult result;
  std::unique_ptr<const Splice> splice;
  bool is_verified = false;  ///< false (and not a dry run): only verifying everything will do
};

/// Do sizes or distances decide between passes what is cut? Then a dry run is a whole run whose mesh is thrown away.
bool is_by_places(const Request& request);

/// Nothing where the request's plan has no reach or it asks for too much: then the passes over the whole mesh are to be
/// run. Throws what they throw.
std::optional<PatchResult> refine_patch(const MeshedModel& input, const Measured& known, const Request& request,
                                        const Progress& progress, const RingsOf& rings_of = rings_by_place);

/// The result of a patch put into a copy of the mesh.
RefineResult whole_result(PatchResult made, const MeshedModel& input, const Measured& known, const Request& request);

/// The origin in numbers of the whole.
std::vector<Index> whole_origin(const PatchResult& result, const MeshedModel& input);

}  // namespace hextwist
