// What refinements from disk to disk keep beside them: files, and what is known of all parts.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hextwist/parts/numbering.h"

namespace hextwist {

/// A folder of our own that goes with everything in it.
class Aside {
 public:
  /// Throws Error where it cannot be made.
  explicit Aside(const std::filesystem::path& where);
  ~Aside();
  Aside(const Aside&) = delete;
  Aside& operator=(const Aside&) = delete;
  std::filesystem::path file(const char* kind, int part) const {
    return folder_ / (kind + std::string(".") + std::to_string(part));
  }

 private:
  std::filesystem::path folder_;
};

/// Nodes that several parts have: (id, part), ascending.
class SharedNodes {
 public:
  void add(std::vector<std::int64_t> ids, int part) {
    for (const std::int64_t id : ids) all_.emplace_back(id, part);
  }
  /// Leaves only those of several parts. Returns how often nodes are there once too often.
  std::int64_t finish();
  /// Calls use(other part).
  template <class Use>
  void for_each_part(std::int64_t id, const Use& use) const {
    for (auto at = std::ranges::lower_bound(all_, std::pair(id, -1)); at != all_.end() && at->first == id; ++at)
      use(at->second);
  }
  /// Ascending, each once.
  std::vector<std::int64_t> ids() const {
    std::vector<std::int64_t> list;
    for (const auto& each : all_)
      if (list.empty() || list.back() != each.first) list.push_back(each.first);
    return list;
  }
  bool has(std::int64_t id) const {
    const auto at = std::ranges::lower_bound(all_, std::pair(id, -1));
    return at != all_.end() && at->first == id;
  }

 private:
  std::vector<std::pair<std::int64_t, int>> all_;
};

/// What numbering needs of a part between commands.
std::vector<std::byte> packed_state(const GlobalIds& ids, const std::vector<PassRecord>& records);
void unpack_state(std::span<const std::byte> bytes, GlobalIds& ids, std::vector<PassRecord>& records);

}  // namespace hextwist
