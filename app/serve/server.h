// hextwist serve: sessions for pages in browsers on this machine.
//
// Who may talk to it: requests to the address that was printed (no other name of it), from the page itself (no other
// origin), with the token that stands in that address. Bodies, numbers of sessions and times of commands are limited,
// and every session is safe ('set safe on'): commands touch files below the folder where it was started alone.
#pragma once

#include <filesystem>
#include <string>

#include "options.h"

namespace hextwist::app {

/// Serves until a signal. Returns the exit status; prints the address first.
int serve(const Options& options);

}  // namespace hextwist::app
