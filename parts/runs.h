// Counts at keys of which many follow each other: as runs.
//
// What a pass brings comes at old nodes and hexes, most of which bring the same as the one before them. Where ids
// follow rows of hexes, as they do in most meshes, a part has a run for each row: their number goes with its surface.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace hextwist {

/// Counts of something at a key, of two kinds: (new nodes, 0), (new nodes in a hex, its children).
using Counts = std::array<std::int64_t, 2>;

/// The keys first .. first + n - 1 have these counts each.
struct Run {
  std::int64_t first = 0, n = 0;
  Counts each{};
  bool operator==(const Run&) const = default;
};

/// Adds a key above all keys so far.
inline void add_key(std::vector<Run>& runs, std::int64_t key, const Counts& counts) {
  if (!runs.empty() && runs.back().first + runs.back().n == key && runs.back().each == counts)
    ++runs.back().n;
  else
    runs.push_back({key, 1, counts});
}

struct RunStarts {
  std::vector<Counts> before;    ///< per run: the sum of the counts of all keys below its first one
  Counts total{};                ///< of all keys
  std::int64_t differs_at = -1;  ///< a key for which two runs have different counts, -1: there is none
};
/// Runs of several parts in any order; a key that several parts have counts once.
RunStarts starts_of(std::span<const Run> runs);

}  // namespace hextwist
