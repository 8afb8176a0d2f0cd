// Loops over index ranges on all threads, and the fixed chunks that make sums independent of their number.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "hextwist/base/fresh_memory.h"
#include "hextwist/base/types.h"

namespace hextwist {

/// Threads available to a loop: for deciding how to divide work. Results must not depend on it.
int n_threads();

namespace detail {

/// One loop for all bodies: oneTBB and the body are compiled once, and not each for the other. n <= grain: one piece,
/// and no thread is asked.
enum class Cut { as_needed, one_stretch_each };
using RangeBody = void (*)(const void* context, std::size_t begin, std::size_t end);
void run_ranges(std::size_t n, std::size_t grain, Cut cut, const void* context, RangeBody body);

/// Calls f(begin, end), of type I.
template <class I, class F>
void run_ranges(std::size_t n, std::size_t grain, Cut cut, F& f) {
  run_ranges(n, grain, cut, std::addressof(f), [](const void* context, std::size_t begin, std::size_t end) {
    (*static_cast<F*>(const_cast<void*>(context)))(static_cast<I>(begin), static_cast<I>(end));
  });
}

}  // namespace detail

/// Calls f(begin, end) for pieces of 0..n, on all threads. What f writes must not depend on how the range is cut.
template <class F>
void parallel_ranges(Index n, F&& f, Index grain = 2048) {
  detail::run_ranges<Index>(static_cast<std::size_t>(n), static_cast<std::size_t>(grain), detail::Cut::as_needed, f);
}

/// Calls f(i) for every i in 0..n, on all threads. What f writes must not depend on the order.
template <class F>
void parallel_each(std::size_t n, F&& f, Index grain = 512) {
  parallel_ranges(
      static_cast<Index>(n),
      [&](Index begin, Index end) {
        for (Index i = begin; i < end; ++i) f(static_cast<std::size_t>(i));
      },
      grain);
}

/// Pieces of 0..n of a fixed size, whatever the threads: f(chunk, begin, end), for results kept per chunk and then
/// joined in order. n_chunks(n, size) of them.
inline Index n_chunks(Index n, Index size) {
  return n / size + (n % size != 0);
}
template <class F>
void parallel_chunks(Index n, Index size, F&& f) {
  parallel_ranges(
      n_chunks(n, size),
      [&](Index begin, Index end) {
        for (Index chunk = begin; chunk < end; ++chunk)
          f(chunk, chunk * size, std::min(n - chunk * size, size) + chunk * size);
      },
      1);
}

/// The i in 0..n for which wanted(i), ascending.
template <class Wanted>
std::vector<Index> indices_where(Index n, Wanted&& wanted) {
  constexpr Index size = 4096;
  const auto scratch = std::make_unique_for_overwrite<Index[]>(static_cast<std::size_t>(n));
  std::vector<Index> n_before(static_cast<std::size_t>(n_chunks(n, size)) + 1);
  parallel_chunks(n, size, [&](Index chunk, Index begin, Index end) {
    Index* at = &scratch[begin];
    for (Index i = begin; i < end; ++i)
      if (wanted(i)) *at++ = i;
    n_before[chunk + 1] = static_cast<Index>(at - &scratch[begin]);
  });
  std::partial_sum(n_before.begin(), n_before.end(), n_before.begin());
  std::vector<Index> found;
  resize_for_overwrite(found, static_cast<std::size_t>(n_before.back()));
  parallel_chunks(n, size, [&](Index chunk, Index begin, Index) {
    std::copy_n(&scratch[begin], n_before[chunk + 1] - n_before[chunk], found.data() + n_before[chunk]);
  });
  return found;
}

/// Prefix sums: calls place(i, start + count(0) + ... + count(i - 1)) for every i in 0..n and returns the sum of all.
/// count is called twice where there are several threads.
template <class Count, class Place>
std::int64_t running_sums(Index n, std::int64_t start, Count&& count, Place&& place) {
  const auto walk = [&](Index begin, Index end, std::int64_t sum) {
    for (Index i = begin; i < end; ++i) {
      const std::int64_t n_here = count(i);
      place(i, sum);
      sum += n_here;
    }
    return sum;
  };
  constexpr Index size = 1 << 14;
  if (n <= 2 * size || n_threads() == 1) return walk(0, n, start);
  std::vector<std::int64_t> of_chunk(n_chunks(n, size));
  parallel_chunks(n, size, [&](Index chunk, Index begin, Index end) {
    std::int64_t sum = 0;
    for (Index i = begin; i < end; ++i) sum += count(i);
    of_chunk[chunk] = sum;
  });
  for (std::int64_t& sum : of_chunk) sum = std::exchange(start, start + sum);
  parallel_chunks(n, size, [&](Index chunk, Index begin, Index end) { walk(begin, end, of_chunk[chunk]); });
  return start;
}

/// Lowers target to value if that is less; order of callers does not matter.
template <class T>
void atomic_min(T& target, T value) {
  std::atomic_ref<T> shared(target);
  T seen = shared.load(std::memory_order_relaxed);
  while (value < seen && !shared.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
  }
}

}  // namespace hextwist
