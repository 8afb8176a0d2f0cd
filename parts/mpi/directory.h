// Numbers that are handed out over all ranks, by keys that several ranks may have.
//
// Keys are ids of the whole mesh. The rank that looks after a key (its home) follows from the key alone, in ascending
// order; so sums of counts over all lower keys are sums over the ranks before and the keys at home.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hextwist/parts/mpi/ranks.h"

namespace hextwist {

/// Counts of something at a key, of two kinds: (new nodes, 0), (new nodes in a hex, its children).
using Counts = std::array<std::int64_t, 2>;

struct KeyCounts {
  std::int64_t key;
  Counts n;
};

struct Starts {
  std::vector<Counts> before;  ///< per key that was asked: the sum of the counts of all lower keys of any rank
  Counts total{};
};

/// mine: ascending by key, each once. Several ranks may have a key; then they have the same counts for it, and it
/// counts once. what: what a key is in messages ("node"). Throws Error on all ranks where
/// counts for a key differ.
Starts starts_by_key(Ranks& ranks, const std::vector<KeyCounts>& mine, const char* what);

/// For each key (ascending, each once) the other ranks that have it too, ascending. Rows in the order of keys.
std::vector<std::vector<int>> others_with(Ranks& ranks, const std::vector<std::array<std::int64_t, 4>>& keys);

}  // namespace hextwist
