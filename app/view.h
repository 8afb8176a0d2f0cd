// hextwist view: a mesh as a page.
#pragma once

#include "hextwist/session/session.h"
#include "options.h"

namespace hextwist::app {

/// Writes the page that the options ask for; says so, and what was left out, by `say`. Throws Error.
void write_view(const Options& options, Session& session, const std::function<void(const std::string&)>& say);

}  // namespace hextwist::app
