// Large arrays made on all threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "hextwist/base/fresh_memory.h"
#include "hextwist/base/parallel.h"

namespace hextwist {

/// Touches fresh memory first, on all threads: the system clears pages where they are touched, which for one thread
/// takes longer than filling them.
inline void touch_pages([[maybe_unused]] void* data, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
  constexpr std::size_t page = 4096, worthwhile = std::size_t{4} << 20;
  if (bytes < worthwhile || n_threads() == 1) return;
  constexpr Index pages_of_piece = 512;
  const auto n_pages = static_cast<Index>((bytes - 1) / page + 1);
  parallel_ranges(
      n_pages,
      [&](Index begin, Index end) {
        for (Index p = begin; p < end; ++p) static_cast<volatile char*>(data)[static_cast<std::size_t>(p) * page] = 0;
      },
      pages_of_piece);
#endif
}

/// list.reserve(n) for an array that one thread is about to fill: in huge pages where it is large.
template <class T>
void reserve_large(std::vector<T>& list, std::size_t n) {
  if (list.capacity() >= n) return;
  list.reserve(n);
  advise_huge_pages(list.data() + list.size(), (n - list.size()) * sizeof(T));
  touch_pages(list.data() + list.size(), (n - list.size()) * sizeof(T));
}
/// Room for n items more, at least doubled where there is too little; it may stay unused.
template <class T>
void grow_large(std::vector<T>& list, std::size_t n) {
  if (list.capacity() >= list.size() + n) return;
  list.reserve(std::max(list.size() + n, 2 * list.capacity()));
  advise_huge_pages(list.data() + list.size(), (list.capacity() - list.size()) * sizeof(T));
}

/// Has every item of a large array written by f(begin, end), on all threads: one stretch each, for two threads that
/// touch the same fresh huge page first both clear all of it.
template <class F>
void fill_ranges(std::size_t n, F&& f) {
  constexpr std::size_t grain = 1 << 15;
  detail::run_ranges<std::size_t>(n, grain, detail::Cut::one_stretch_each, f);
}

/// list.resize(n, value), written on all threads.
template <class T>
void resize_large(std::vector<T>& list, std::size_t n, const T& value = T{}) {
  const std::size_t n_old = list.size();
  resize_for_overwrite(list, n);
  if (n > n_old)
    fill_ranges(n - n_old, [&](std::size_t begin, std::size_t end) {
      std::fill(list.data() + n_old + begin, list.data() + n_old + end, value);
    });
}

/// A copy of a list, with room for n items in all.
template <class T>
std::vector<T> copy_large(const std::vector<T>& list, std::size_t n) {
  std::vector<T> copy;
  copy.reserve(n);
  advise_huge_pages(copy.data(), n * sizeof(T));
  resize_for_overwrite(copy, list.size());
  fill_ranges(list.size(), [&](std::size_t begin, std::size_t end) {
    std::copy(list.data() + begin, list.data() + end, copy.data() + begin);
  });
  return copy;
}

}  // namespace hextwist
