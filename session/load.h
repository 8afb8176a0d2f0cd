// How a mesh gets into a session.
#pragma once

#include <memory>
#include <string>

#include "hextwist/base/fence.h"
#include "hextwist/base/interrupt.h"
#include "hextwist/session/transaction.h"

namespace hextwist {

/// Long loops ask whether the user wants to go on, while it lives.
Interruptible interruptible_as(const Transaction& run, const char* stage);

/// Where CAD and Exodus files are read.
Fence fence_of(const Transaction& run);

std::shared_ptr<const Model> read_model(Transaction& run, const std::filesystem::path& file, bool glue);

/// Repairs, checks and associates a mesh, and makes it that of the session. model: null, then its own skin. tags: what
/// is known of the association; may be null. what: what messages call the mesh. middles: the shape of its own skin,
/// where that is curved; may be null.
void load_mesh(Transaction& run, Mesh mesh, std::shared_ptr<const Model> model, const Association* tags,
               const std::string& what, const MiddleNodes* middles = nullptr);
/// The same for an association that is complete.
void load_meshed(Transaction& run, MeshedModel meshed);
/// Makes it the mesh of the session: checks nothing, measures everything that the records want.
void replace_and_measure(Transaction& run, MeshedModel meshed);

/// The result of a refinement becomes the mesh of the session, unless it is no good: then throws Error.
void accept_refined(Transaction& run, MeshedModel refined, const Report& report);
/// The same with the levelling of the result, and with fixed nodes where nodes are gone.
void accept_refined(Transaction& run, RefineResult result);
/// What the engine measured of a result that is the mesh of the session by now.
void take_measured(Transaction& run, const Report& report);

/// The levelling of the mesh that the command has made. Null: says so where there was one.
void take_levelling(Transaction& run, std::shared_ptr<const Levelling> levelling);

/// The fixed nodes that are left of those that there were, by their new numbers.
void take_fixed(Transaction& run, std::vector<Index> still);

/// Takes members out of all groups that mean nothing for a new mesh, or drops the groups where the CAD is new too.
void forget_members(ModelState& state, bool also_cad);

/// Notes that a mesh which is read or made takes the place of the one that is there, if one is.
void note_replaced(Transaction& run, Index n_before);
/// The line that tells of a mesh that came in.
void say_mesh(const Transaction& run, const std::string& what);

}  // namespace hextwist
