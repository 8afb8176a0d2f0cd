// Periodic surfaces of a session: how they come from commands and files, and go into files.
#pragma once

#include "hextwist/io/extras.h"
#include "hextwist/mesh/periodic.h"
#include "hextwist/session/transaction.h"

namespace hextwist {

/// Keeps a pair from now on. Throws Error where its sides are not alike, or one of the surfaces is in another pair in a
/// way that does not go with this.
void add_periodic(Transaction& run, const PeriodicPair& pair);

/// The pairs of surfaces that a file of the mesh names; notes say which of them can't be kept alike.
void take_periodic(Transaction& run, const FileExtras& extras);

/// What a file says beyond its mesh, with the pairs of now.
FileExtras with_periodic(const FileExtras* extras, const MeshedModel& meshed, const PeriodicBoundary& periodic);

}  // namespace hextwist
