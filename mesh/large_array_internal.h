// Memory for large arrays. The first touch of a fresh page costs more than writing it; with pages of 2 MiB it happens
// 512 times less often (docs/performance.md).
#pragma once

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hextwist/mesh/parallel_internal.h"

namespace hextwist {

/// Asks the system for huge pages in memory that nothing has written yet. A wish: nothing depends on it.
inline void advise_huge_pages([[maybe_unused]] void* data, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
  constexpr std::size_t page = 4096, worthwhile = std::size_t{4} << 20;
  if (bytes < worthwhile) return;
  const auto begin = (reinterpret_cast<std::uintptr_t>(data) + page - 1) / page * page;
  const auto end = (reinterpret_cast<std::uintptr_t>(data) + bytes) / page * page;
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
}

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

/// list.reserve(n) for an array that is about to be filled: in huge pages where it is large.
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
/// list.resize(n) likewise.
template <class T>
void resize_large(std::vector<T>& list, std::size_t n) {
  reserve_large(list, n);
  list.resize(n);
}
template <class T>
void resize_large(std::vector<T>& list, std::size_t n, const T& value) {
  reserve_large(list, n);
  list.resize(n, value);
}

/// A copy of a list, with room for n items in all.
template <class T>
std::vector<T> copy_large(const std::vector<T>& list, std::size_t n) {
  std::vector<T> copy;
  reserve_large(copy, n);
  copy.assign(list.begin(), list.end());
  return copy;
}

}  // namespace hextwist
