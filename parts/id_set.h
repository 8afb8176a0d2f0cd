// Ids of a whole mesh, of which parts bring some each.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "hextwist/base/types.h"

namespace hextwist {

/// A bit for each id, on pages that are there where ids are.
class IdSet {
 public:
  /// False: it was there already. Ids are not negative.
  bool add(std::int64_t id);
  bool has(std::int64_t id) const;
  std::int64_t size() const { return size_; }
  std::int64_t highest() const { return highest_; }
  /// Would an array of the ids be smaller, by more than 64 MiB?
  bool is_sparse() const;
  /// Per id (ascending) how many lower ones there are; -1 where it is none of them.
  std::vector<Index> places(std::span<const std::int64_t> ids) const;
  /// All of them, ascending.
  class Walk {
   public:
    explicit Walk(const IdSet& set) : set_(&set) {}
    /// -1 at the end.
    std::int64_t next();

   private:
    const IdSet* set_;
    std::size_t page_ = 0, word_ = 0;
    std::uint64_t rest_ = 0;
    bool is_begun_ = false;
  };

 private:
  static constexpr std::size_t words = 1 << 10, ids_on_page = words * 64;
  struct Page {
    std::array<std::uint64_t, words> bits{};
    std::int64_t n = 0;
  };
  std::vector<std::unique_ptr<Page>> pages_;
  std::int64_t size_ = 0, highest_ = -1, n_pages_ = 0;
};

}  // namespace hextwist
