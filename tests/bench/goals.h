// The goals, and the table that says which of them are met.
#pragma once

#include <iosfwd>

#include "results.h"

namespace hextwist::bench {

/// Prints one row per goal: what was measured, its floor or peer, their ratio, what was wanted, whether it is met.
void print_goals(const Results& results, std::ostream& out);

}  // namespace hextwist::bench
