#include "hextwist/parts/runs.h"

#include <algorithm>

#include "hextwist/base/sorted.h"

namespace hextwist {

RunStarts starts_of(std::span<const Run> runs) {
  RunStarts result;
  // Between two bounds all keys have the same counts, or none is there.
  std::vector<std::int64_t> bound;
  bound.reserve(2 * runs.size());
  for (const Run& run : runs) bound.push_back(run.first), bound.push_back(run.first + run.n);
  sort_unique(bound);
  std::vector<Counts> at(bound.size(), Counts{});
  std::vector<std::uint8_t> is_there(bound.size(), 0);
  std::vector<Index> place;
  place.reserve(runs.size());
  for (const Run& run : runs) {
    auto b = static_cast<std::size_t>(std::ranges::lower_bound(bound, run.first) - bound.begin());
    place.push_back(static_cast<Index>(b));
    for (; b < bound.size() && bound[b] < run.first + run.n; ++b) {
      if (is_there[b] && at[b] != run.each) result.differs_at = bound[b];
      is_there[b] = 1;
      at[b] = run.each;
    }
  }
  for (std::size_t b = 0; b < bound.size(); ++b) {
    const Counts each = at[b];
    at[b] = result.total;
    if (is_there[b])
      for (std::size_t k = 0; k < each.size(); ++k) result.total[k] += each[k] * (bound[b + 1] - bound[b]);
  }
  result.before.reserve(runs.size());
  for (const Index b : place) result.before.push_back(at[b]);
  return result;
}

}  // namespace hextwist
