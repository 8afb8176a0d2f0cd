// Commands that make a mesh where there is CAD alone, and one mesh of parts.
#pragma once

namespace hextwist {

struct Execution;
void do_mesh(Execution& run);
void do_merge(Execution& run);

}  // namespace hextwist
