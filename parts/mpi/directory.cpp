#include "hextwist/parts/mpi/directory.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "hextwist/base/types.h"

namespace hextwist {
namespace {

/// Which rank looks after a key: equal pieces of all that there are.
class Homes {
 public:
  template <class Items, class KeyOf>
  Homes(Ranks& ranks, const Items& items, const KeyOf& key_of) : n_ranks_(ranks.size()) {
    std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = 0;
    for (const auto& item : items) {
      low = std::min<std::int64_t>(low, key_of(item));
      high = std::max<std::int64_t>(high, key_of(item));
    }
    low_ = ranks.least(low);
    size_ = static_cast<double>(ranks.largest(high)) - static_cast<double>(low_) + 1;
  }
  std::size_t operator()(std::int64_t key) const {
    const double part = static_cast<double>(key - low_) / size_;
    return static_cast<std::size_t>(std::clamp(static_cast<int>(part * n_ranks_), 0, n_ranks_ - 1));
  }

 private:
  int n_ranks_;
  std::int64_t low_;
  double size_;
};

}  // namespace

Starts starts_by_key(Ranks& ranks, const std::vector<KeyCounts>& mine, const char* what) {
  const auto n_ranks = static_cast<std::size_t>(ranks.size());
  std::vector<std::vector<KeyCounts>> asked(n_ranks);
  const Homes home(ranks, mine, [](const KeyCounts& each) { return each.key; });
  for (const KeyCounts& each : mine) asked[home(each.key)].push_back(each);
  const std::vector<std::vector<KeyCounts>> from = ranks.exchange(asked);

  std::vector<KeyCounts> all;
  for (const auto& list : from) all.insert(all.end(), list.begin(), list.end());
  std::ranges::sort(all, {}, [](const KeyCounts& each) { return std::pair(each.key, each.n); });
  std::size_t n = 0;
  std::int64_t differs = -1;
  for (const KeyCounts& each : all) {
    if (n > 0 && all[n - 1].key == each.key) {
      if (all[n - 1].n != each.n) differs = each.key;
      continue;
    }
    all[n++] = each;
  }
  all.resize(n);
  ranks.together([&] {
    if (differs >= 0)
      throw Error("parts disagree about what is new at " + std::string(what) + " " + std::to_string(differs));
  });
  Counts sum{};
  for (KeyCounts& each : all)
    for (int k = 0; k < 2; ++k) each.n[k] = std::exchange(sum[k], sum[k] + each.n[k]);
  const Counts before = {ranks.sum_before(sum[0]), ranks.sum_before(sum[1])};
  Starts result;
  result.total = {ranks.sum(sum[0]), ranks.sum(sum[1])};

  std::vector<std::vector<Counts>> answers(n_ranks);
  for (std::size_t r = 0; r < n_ranks; ++r)
    for (const KeyCounts& each : from[r]) {
      const Counts& at = std::ranges::lower_bound(all, each.key, {}, &KeyCounts::key)->n;
      answers[r].push_back({before[0] + at[0], before[1] + at[1]});
    }
  // Homes ascend with keys, so answers come back in the order of what was asked.
  for (const auto& list : ranks.exchange(answers)) result.before.insert(result.before.end(), list.begin(), list.end());
  return result;
}

std::vector<std::vector<int>> others_with(Ranks& ranks, const std::vector<std::array<std::int64_t, 4>>& keys) {
  using Key = std::array<std::int64_t, 4>;
  const auto n_ranks = static_cast<std::size_t>(ranks.size());
  std::vector<std::vector<Key>> asked(n_ranks);
  const Homes home(ranks, keys, [](const Key& key) { return key[0]; });
  for (const Key& key : keys) asked[home(key[0])].push_back(key);
  const std::vector<std::vector<Key>> from = ranks.exchange(asked);
  std::vector<std::pair<Key, int>> all;
  for (std::size_t r = 0; r < n_ranks; ++r)
    for (const Key& key : from[r]) all.emplace_back(key, static_cast<int>(r));
  std::ranges::sort(all);
  // Per shared key its number among those that were asked, and each other rank.
  struct Answer {
    std::int64_t place;
    std::int64_t rank;
  };
  std::vector<std::vector<Answer>> answers(n_ranks);
  for (std::size_t r = 0; r < n_ranks; ++r)
    for (std::size_t i = 0; i < from[r].size(); ++i)
      for (auto at = std::ranges::lower_bound(all, std::pair(from[r][i], 0));
           at != all.end() && at->first == from[r][i]; ++at)
        if (at->second != static_cast<int>(r)) answers[r].push_back({static_cast<std::int64_t>(i), at->second});
  std::vector<std::vector<int>> result(keys.size());
  std::size_t first = 0;
  const auto got = ranks.exchange(answers);
  for (std::size_t r = 0; r < n_ranks; ++r) {
    for (const Answer& answer : got[r])
      result[first + static_cast<std::size_t>(answer.place)].push_back(static_cast<int>(answer.rank));
    first += asked[r].size();
  }
  return result;
}

}  // namespace hextwist
