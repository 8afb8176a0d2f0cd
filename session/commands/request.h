// What a command to refine asks for, for those who carry it out otherwise than on the mesh of the session.
#pragma once

#include "hextwist/session/commands/commands.h"

namespace hextwist {

/// Of `refine ...`, against the mesh of its session. Throws Error.
Request request_of(const Execution& run);

}  // namespace hextwist
