#include "hextwist/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace hextwist {

int n_threads() {
  const auto limit = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::max(1, std::min(tbb::this_task_arena::max_concurrency(), static_cast<int>(limit)));
}

namespace detail {

void run_ranges(std::size_t n, std::size_t grain, Cut cut, const void* context, RangeBody body) {
  if (n == 0) return;
  if (n <= grain) return body(context, 0, n);
  const tbb::blocked_range<std::size_t> all(0, n, grain);
  const auto run = [&](const auto& range) { body(context, range.begin(), range.end()); };
  cut == Cut::as_needed ? tbb::parallel_for(all, run) : tbb::parallel_for(all, run, tbb::static_partitioner());
}

}  // namespace detail
}  // namespace hextwist
