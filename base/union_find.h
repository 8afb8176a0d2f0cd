// Union-find in which a root is always the lowest item of its set, so the order of joins does not matter and all
// threads can join at once: links go from higher to lower roots only, and a lost race is retried.
#pragma once

#include <utility>
#include <vector>

#include "hextwist/base/parallel.h"

namespace hextwist {

inline std::vector<Index> singletons(Index n) {
  std::vector<Index> parent;
  resize_for_overwrite(parent, static_cast<std::size_t>(n));
  parallel_each(parent.size(), [&](std::size_t i) { parent[i] = static_cast<Index>(i); });
  return parent;
}

inline Index find_root(std::vector<Index>& parent, Index i) {
  for (;;) {
    const Index up = std::atomic_ref(parent[i]).load(std::memory_order_relaxed);
    if (up == i) return i;
    const Index next = std::atomic_ref(parent[up]).load(std::memory_order_relaxed);
    // Path halving. If another thread has changed the link meanwhile, it still leads to an ancestor.
    if (next != up) std::atomic_ref(parent[i]).store(next, std::memory_order_relaxed);
    i = next;
  }
}

inline void join(std::vector<Index>& parent, Index a, Index b) {
  for (;;) {
    a = find_root(parent, a);
    b = find_root(parent, b);
    if (a == b) return;
    if (a < b) std::swap(a, b);
    Index expected = a;
    if (std::atomic_ref(parent[a]).compare_exchange_strong(expected, b, std::memory_order_relaxed)) return;
  }
}

}  // namespace hextwist
