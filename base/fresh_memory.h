// Memory that was never written. The first touch of a page costs more than filling it, and so may filling it twice
// (docs/performance.md).
#pragma once

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <type_traits>
#include <vector>

namespace hextwist {

/// Asks the system for huge pages in memory that nothing has written yet. A wish: nothing depends on it.
inline void advise_huge_pages([[maybe_unused]] void* data, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
  constexpr std::size_t page = 4096, worthwhile = std::size_t{4} << 20;
  if (bytes < worthwhile) return;
  const std::size_t to_page = (page - reinterpret_cast<std::uintptr_t>(data) % page) % page;
  madvise(static_cast<char*>(data) + to_page, (bytes - to_page) / page * page, MADV_HUGEPAGE);
#endif
}

/// list.resize(n) for a caller that then writes every new item, best on all threads; until then they hold anything
/// (where asserts are on: rubbish). std::vector would have one thread write zeros first, which took a quarter of a pass
/// on two threads. (Inline, it makes g++ 12 warn of copies that cannot happen.)
template <class T>
[[gnu::noinline]] void resize_for_overwrite(std::vector<T>& list, std::size_t n) {
  const std::size_t n_old = list.size();
  constexpr std::size_t width = sizeof(T);  // NOLINT(bugprone-sizeof-expression): of pointers too
#ifdef NDEBUG
  constexpr std::size_t worthwhile = std::size_t{1} << 16;
#else
  constexpr std::size_t worthwhile = 1;
#endif
  if (n <= n_old || n * width < worthwhile) return list.resize(n);
  if (list.capacity() < n) {
    list.reserve(n);
    advise_huge_pages(list.data() + n_old, (n - n_old) * width);
  }
#if defined(__GLIBCXX__) && !defined(_GLIBCXX_DEBUG) && !defined(_GLIBCXX_SANITIZE_VECTOR)
  // A vector of libstdc++ is three pointers in a base class; for items that need no construction, growing within the
  // capacity is to move the second. The standard has nothing that does only this.
  if constexpr (std::is_trivially_copyable_v<T>) {
    auto& pointers = ((std::_Vector_base<T, std::allocator<T>>&)list)._M_impl;
    pointers._M_finish = pointers._M_start + n;
#ifndef NDEBUG
    std::memset(static_cast<void*>(list.data() + n_old), 0xC1, (n - n_old) * width);
#endif
    return;
  }
#endif
  list.resize(n);
}

}  // namespace hextwist
