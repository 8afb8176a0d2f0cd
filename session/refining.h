// A request carried out on the mesh of a session: in a patch, changed in place, where that will do.
#pragma once

#include <optional>

#include "hextwist/patch/patch_refine.h"
#include "hextwist/patch/refine.h"
#include "hextwist/session/transaction.h"

namespace hextwist {

/// What would come of a request.
struct Refining {
  Request request;
  std::optional<PatchResult> patch;  ///< else `whole`
  RefineResult whole;

  const Report& report() const { return patch ? patch->result.report : whole.report; }
  /// No hex is another one.
  bool changes_nothing() const;
};

/// request.levelling is filled in. Throws what passes throw.
Refining prepare_refining(Transaction& run, Request request);
/// Where its hexes come from, in the mesh as it still is.
std::vector<Index> origin_of(const Refining& refining, const MeshedModel& before);
LevelOrigin came_from(const Refining& refining, const MeshedModel& before);
/// Makes the result the session's mesh. Throws Error when it is no good. Precondition: no dry run.
void accept_refining(Transaction& run, Refining refining);

}  // namespace hextwist
