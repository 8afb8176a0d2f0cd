#pragma once

#include "console.h"
#include "hextwist/session/session.h"

namespace hextwist::app {

/// Reads commands from the terminal, with line editing, history and completion, until quit or the end of input.
void run_interactive(Session& session, Console& console);

/// Reads commands line by line from standard input. Returns how many failed; throws as Session::run().
int run_standard_input(Session& session);

}  // namespace hextwist::app
