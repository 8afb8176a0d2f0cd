// hextwist split, hextwist join and hextwist refine-in-parts.
#pragma once

#include "options.h"

namespace hextwist::app {

/// Returns the exit status; what went wrong has been printed.
int run_parts(const Options& options);

}  // namespace hextwist::app
