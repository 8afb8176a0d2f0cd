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

/// list.reserve(n) for an array that is about to be filled: in huge pages where it is large.
template <class T>
void reserve_large(std::vector<T>& list, std::size_t n) {
  if (list.capacity() >= n) return;
  list.reserve(n);
  advise_huge_pages(list.data() + list.size(), (n - list.size()) * sizeof(T));
}
/// Room for n items more, at least doubled where there is too little.
template <class T>
void grow_large(std::vector<T>& list, std::size_t n) {
  if (list.capacity() < list.size() + n) reserve_large(list, std::max(list.size() + n, 2 * list.capacity()));
}
/// list.resize(n) likewise.
template <class T>
void resize_large(std::vector<T>& list, std::size_t n) {
  reserve_large(list, n);
  list.resize(n);
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
