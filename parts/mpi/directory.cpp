#include "hextwist/parts/mpi/directory.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "hextwist/base/types.h"

namespace hextwist {
namespace {

__extension__ typedef unsigned __int128 Wide;

/// Which rank looks after an id: equal pieces of all that there are.
class Homes {
 public:
  Homes(Ranks& ranks, std::int64_t low, std::int64_t high)
      : n_ranks_(ranks.size()), low_(ranks.least(low)), high_(ranks.largest(high)) {}
  int operator()(std::int64_t id) const {
    const auto place = static_cast<Wide>(id - low_) * static_cast<unsigned>(n_ranks_);
    return static_cast<int>(place / n_ids());
  }
  /// The first id of the next home.
  std::int64_t end(int home) const {
    const auto n = static_cast<unsigned>(n_ranks_);
    return low_ + static_cast<std::int64_t>((n_ids() * static_cast<unsigned>(home + 1) + n - 1) / n);
  }

 private:
  Wide n_ids() const { return static_cast<Wide>(high_ - low_) + 1; }
  int n_ranks_;
  std::int64_t low_, high_;
};

constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();

struct ListedRun {
  Run run;
  std::int64_t list = 0;
};
const char* name_of(std::size_t list) {
  return list == 2 ? "hex " : "node ";
}

}  // namespace

PassSums sums_of(Ranks& ranks, const RunLists& mine) {
  const auto n_ranks = static_cast<std::size_t>(ranks.size());
  std::int64_t low = none, high = 0;
  for (const auto& runs : mine)
    if (!runs.empty()) {
      low = std::min(low, runs.front().first);
      high = std::max(high, runs.back().first + runs.back().n - 1);
    }
  const Homes home(ranks, low, high);
  // Runs are cut where homes meet; the first piece says where a run starts.
  std::vector<std::vector<ListedRun>> asked(n_ranks);
  std::array<std::vector<int>, n_bringers> home_of_run;
  for (std::size_t k = 0; k < n_bringers; ++k)
    for (Run run : mine[k]) {
      home_of_run[k].push_back(home(run.first));
      for (;;) {
        const int h = home(run.first);
        const std::int64_t n = std::min(run.n, home.end(h) - run.first);
        asked[h].push_back({{run.first, n, run.each}, static_cast<std::int64_t>(k)});
        if (n == run.n) break;
        run.first += n;
        run.n -= n;
      }
    }
  const std::vector<std::vector<ListedRun>> from = ranks.exchange(asked);

  std::array<RunStarts, n_bringers> starts;
  std::vector<std::int64_t> totals;
  ranks.together([&] {
    for (std::size_t k = 0; k < n_bringers; ++k) {
      std::vector<Run> runs;
      for (const auto& list : from)
        for (const ListedRun& each : list)
          if (each.list == static_cast<std::int64_t>(k)) runs.push_back(each.run);
      starts[k] = starts_of(runs);
      if (starts[k].differs_at >= 0)
        throw Error("parts disagree about what is new at " + std::string(name_of(k)) +
                    std::to_string(starts[k].differs_at));
      totals.insert(totals.end(), starts[k].total.begin(), starts[k].total.end());
    }
  });
  const std::vector<std::int64_t> before = ranks.sum_before(totals), in_all = ranks.sum(totals);
  PassSums sums;
  for (std::size_t k = 0; k < n_bringers; ++k) sums.total[k] = {in_all[2 * k], in_all[2 * k + 1]};

  std::vector<std::vector<Counts>> answers(n_ranks);
  std::array<std::size_t, n_bringers> at{};
  for (std::size_t r = 0; r < n_ranks; ++r)
    for (const ListedRun& each : from[r]) {
      const auto k = static_cast<std::size_t>(each.list);
      const Counts& start = starts[k].before[at[k]++];
      answers[r].push_back({before[2 * k] + start[0], before[2 * k + 1] + start[1]});
    }
  const std::vector<std::vector<Counts>> got = ranks.exchange(answers);
  // Pieces were sent list by list, in the order of runs.
  std::vector<std::size_t> next(n_ranks, 0);
  for (std::size_t k = 0; k < n_bringers; ++k)
    for (std::size_t i = 0; i < mine[k].size(); ++i) {
      const int first = home_of_run[k][i], last = home(mine[k][i].first + mine[k][i].n - 1);
      sums.before[k].push_back(got[first][next[first]]);
      for (int h = first; h <= last; ++h) ++next[h];
    }
  return sums;
}

std::vector<NodeAtOthers> at_others(Ranks& ranks, const Mesh& part, std::span<const std::int64_t> ids) {
  const auto n_ranks = static_cast<std::size_t>(ranks.size());
  const Homes home(ranks, ids.empty() ? none : ids.front(), ids.empty() ? 0 : ids.back());
  std::vector<std::vector<std::int64_t>> asked(n_ranks);
  for (const std::int64_t id : ids) asked[home(id)].push_back(id);
  const auto from = ranks.exchange(asked);
  std::vector<std::pair<std::int64_t, int>> all;
  for (std::size_t r = 0; r < n_ranks; ++r)
    for (const std::int64_t id : from[r]) all.emplace_back(id, static_cast<int>(r));
  std::ranges::sort(all);
  struct Answer {
    std::int64_t id, rank;
  };
  std::vector<std::vector<Answer>> answers(n_ranks);
  for (std::size_t i = 0, j = 0; i < all.size(); i = j) {
    for (j = i + 1; j < all.size() && all[j].first == all[i].first;) ++j;
    for (std::size_t a = i; a < j; ++a)
      for (std::size_t b = i; b < j; ++b)
        if (a != b) answers[all[a].second].push_back({all[a].first, all[b].second});
  }
  std::vector<NodeAtOthers> result;
  // Homes ascend with ids, and so do answers of each.
  for (const auto& list : ranks.exchange(answers))
    for (const Answer& answer : list) {
      const Index n = find_node(part, answer.id);
      if (result.empty() || result.back().node != n) result.push_back({n, {}});
      result.back().parts.push_back(static_cast<int>(answer.rank));
    }
  return result;
}

std::vector<SkinFace> skin_of_all(Ranks& ranks, std::vector<SkinFace> open, std::vector<SkinFace> walls) {
  std::int64_t low = none, high = 0;
  const auto lowest = [](const SkinFace& face) { return std::ranges::min(face.nodes); };
  for (const SkinFace& face : open) {
    low = std::min(low, lowest(face));
    high = std::max(high, lowest(face));
  }
  const Homes home(ranks, low, high);
  std::vector<std::vector<SkinFace>> to(static_cast<std::size_t>(ranks.size()));
  for (const SkinFace& face : open) to[home(lowest(face))].push_back(face);
  open.clear();
  for (const auto& list : ranks.exchange(to)) open.insert(open.end(), list.begin(), list.end());
  std::vector<SkinFace> mine = skin_among(std::move(open));
  mine.insert(mine.end(), walls.begin(), walls.end());
  return ranks.joined_everywhere(mine);
}

}  // namespace hextwist
