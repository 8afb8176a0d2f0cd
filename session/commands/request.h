// What a command to refine asks for, for those who carry it out otherwise than on the mesh of the session.
#pragma once

#include "hextwist/session/commands/commands.h"

namespace hextwist {

/// Of `refine ...`, against the mesh of its session. Throws Error.
Request request_of(const Execution& run);

/// The fields after `sum`. Throws Error for one that no field of hexes is called.
std::vector<std::string> extensive_fields(const Execution& run);

}  // namespace hextwist
