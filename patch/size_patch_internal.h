// Sizes in a patch.
#pragma once

#include <optional>

#include "hextwist/patch/patch_refine.h"
#include "hextwist/sizing/levelling.h"
#include "hextwist/sizing/sizes_of_all.h"

namespace hextwist {

/// Levels that sizes have come to wish for, in cells of the whole.
struct WishedBySizes {
  LevelMarks wished;
  const SizesOfAll& sizes;
  Report report;                   ///< what has been done to find out
  bool is_gradation_told = false;  ///< in that report
};

/// refine_patch() for sizes. Which hexes are to be cut is asked over the whole mesh, how is found out in a patch around
/// them: it decides as the whole would, for it knows of the rest what counts (SizesInPart).
std::optional<PatchResult> refine_sizes_patch(const MeshedModel& input, const Measured& known, const Request& request,
                                              Approach approach, const Progress& progress, const RingsOf& rings_of);

/// refine_levels_patch() for levels that are known.
std::optional<PatchResult> refine_wished_levels(const MeshedModel& input, const Measured& known, const Request& request,
                                                const WishedBySizes& wished, const Progress& progress,
                                                const RingsOf& rings_of);

/// The report on sizes in a patch and outside of it, in numbers of the whole.
SizeReport whole_sizes(const SizeReport& in_patch, const SizeReport& outside, const PatchNumbers& numbers);

/// Nodes and hexes in a report by their numbers in the changed whole.
void name_as_whole(Report& report, const PatchNumbers& numbers);
/// What comes of a plain patch by passes: numbers, verification, splice. The passes are done.
void finish_patch(PatchResult& made, const MeshedModel& input, const Measured& known, const Request& request,
                  const PatchNumbers& numbers, Report& report);
/// Counts before and after, memory. Throws Error where that many hexes are not allowed (limit_hexes()).
void count_patch(const PatchResult& made, const MeshedModel& input, Report& report);
/// Of a request that changes nothing: a patch without hexes.
PatchResult nothing_done(const MeshedModel& input, const Measured& known, const Request& request, Report report);

}  // namespace hextwist
