#pragma once

#include <string>

namespace hextwist::bench {

/// Runs a task on cube(n) and returns the peak of memory over the bytes of its input and output arrays. Tasks:
/// pass_all8, pass_all27, pass_ball (split and carry); refine_uniform, refine_hex (all of refine()).
double run_task(const std::string& task, int n);

}  // namespace hextwist::bench
