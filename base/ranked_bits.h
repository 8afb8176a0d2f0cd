// Some of many numbers, and how many lower ones there are of them: a bit and a half for each of the many.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "hextwist/base/types.h"

namespace hextwist {

class RankedBits {
 public:
  static constexpr int width = 64;  ///< threads may set bits of different multiples of it at once

  /// Of 0 .. n - 1.
  explicit RankedBits(std::size_t n = 0) : bits_(word(n) + 1), before_(bits_.size()) {}

  void set(Index i) { bits_[word(i)] |= bit(i); }
  /// The same of any, of which there may be more than was said: but for finish(), which is for all.
  void set_more(Index i) {
    if (word(i) >= bits_.size()) bits_.resize(std::max(word(i) + 1, 2 * bits_.size()));
    set(i);
  }
  /// Of any that is not negative.
  bool has_any(Index i) const { return word(i) < bits_.size() && has(i); }
  bool has(Index i) const { return (bits_[word(i)] & bit(i)) != 0; }
  /// After the last set().
  void finish() {
    before_.resize(bits_.size());
    for (std::size_t w = 1; w < bits_.size(); ++w) before_[w] = before_[w - 1] + std::popcount(bits_[w - 1]);
  }
  /// Of one that is set: its place among them.
  Index operator[](Index i) const { return before_[word(i)] + std::popcount(bits_[word(i)] & (bit(i) - 1)); }
  /// The same of any; -1 where it is not set.
  Index find(Index i) const { return has(i) ? (*this)[i] : -1; }
  /// How many are set.
  std::size_t size() const {
    return static_cast<std::size_t>(before_.back()) + static_cast<std::size_t>(std::popcount(bits_.back()));
  }
  /// All that are set, ascending.
  std::vector<Index> list() const {
    std::vector<Index> list;
    list.reserve(size());
    for (std::size_t w = 0; w < bits_.size(); ++w)
      for (std::uint64_t rest = bits_[w]; rest; rest &= rest - 1)
        list.push_back(static_cast<Index>(w) * width + std::countr_zero(rest));
    return list;
  }

 private:
  static std::size_t word(std::size_t i) { return i / width; }
  static std::size_t word(Index i) { return word(static_cast<std::size_t>(i)); }
  static std::uint64_t bit(Index i) { return std::uint64_t{1} << (static_cast<std::size_t>(i) % width); }
  std::vector<std::uint64_t> bits_;
  std::vector<Index> before_;  // per word: how many are set in lower ones
};

}  // namespace hextwist
