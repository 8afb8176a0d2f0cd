#include "hextwist/parts/mpi/refine.h"

#include <algorithm>
#include <numeric>

#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"

namespace hextwist {
namespace {

/// Rings that are compared with their owners and must be the same.
constexpr int least_rings = 2;

/// How many rings around this rank's own hexes are what their owners made of them.
int rings_alike(Ranks& ranks, const LocalMesh& local, std::span<const std::uint64_t> digest) {
  struct Question {
    Index hex;
    std::uint32_t low, high;
  };
  const auto n = static_cast<std::size_t>(ranks.size());
  std::vector<std::vector<Question>> questions(n);
  std::vector<std::vector<std::uint8_t>> ring(n);
  for (std::size_t i = 0; i < local.base.hex.size(); ++i) {
    const std::uint8_t r = local.base.ring[i];
    if (r == 0 || r > local.n_rings) continue;
    const auto owner = static_cast<std::size_t>(local.base.owner[i]);
    questions[owner].push_back(
        {local.base.hex[i], static_cast<std::uint32_t>(digest[i]), static_cast<std::uint32_t>(digest[i] >> 32)});
    ring[owner].push_back(r);
  }
  const auto asked = ranks.exchange(questions);
  std::vector<std::vector<std::uint8_t>> answers(n);
  for (std::size_t r = 0; r < n; ++r)
    for (const Question& question : asked[r]) {
      const std::uint64_t mine = digest[position_in(local.base.hex, question.hex)];
      answers[r].push_back(mine == (std::uint64_t{question.high} << 32 | question.low));
    }
  int alike = local.n_rings;
  const auto answered = ranks.exchange(answers);
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t i = 0; i < answered[r].size(); ++i)
      if (!answered[r][i]) alike = std::min(alike, ring[r][i] - 1);
  return alike;
}

GlobalIds ids_of(const MeshedModel& whole, const LocalMesh& local) {
  GlobalIds ids;
  for (const Index n : local.base.node) ids.node.push_back(node_id(whole.mesh, n));
  for (const Index h : local.base.hex) ids.hex.push_back(hex_id(whole.mesh, h));
  ids.highest_node = node_id(whole.mesh, whole.mesh.n_nodes() - 1);
  ids.highest_hex = hex_id(whole.mesh, whole.mesh.n_hexes() - 1);
  return ids;
}

std::int64_t n_own(const LocalMesh& local) {
  return std::ranges::count_if(local.base_of, [&](Index b) { return local.base.ring[b] == 0; });
}

}  // namespace

InRanks refine_in_ranks(Ranks& ranks, const MeshedModel& whole, std::span<const int> part_of_hex,
                        std::span<const Asked> asked, int n_rings, const std::function<void(const std::string&)>& say) {
  int deepest = 0;
  for (const Asked& each : asked) deepest = std::max(deepest, each.request.target.depth.value_or(0));
  n_rings += deepest;
  constexpr int most_rings = 250;
  for (int n_restarts = 0;; ++n_restarts, n_rings = std::min(2 * n_rings, most_rings)) {
    InRanks made;
    made.n_rings = n_rings;
    made.n_restarts = n_restarts;
    std::vector<std::string> lines;
    ranks.together([&] { made.local = local_mesh(whole, part_of_hex, ranks.rank(), n_rings); });
    made.ids = ids_of(whole, made.local);
    bool is_alike = true;
    for (const Asked& each : asked) {
      const std::int64_t n_before = ranks.sum(n_own(made.local));
      LocalRun run;
      ranks.together([&] { run = run_locally(made.local, each); });
      const auto alike = static_cast<int>(ranks.least(rings_alike(ranks, made.local, run.digest)));
      is_alike = alike >= std::min(least_rings, made.local.n_rings);
      if (!is_alike) break;
      number(ranks, run.records, run.by_levels, made.ids);
      std::vector<Index> nodes, hexes;
      ranks.together([&] { trim(made.local, alike, nodes, hexes); });
      made.ids.node = items_at(made.ids.node, nodes);
      made.ids.hex = items_at(made.ids.hex, hexes);
      const std::int64_t n_after = ranks.sum(n_own(made.local)), largest = ranks.largest(n_own(made.local));
      lines.push_back(std::to_string(n_before) + " -> " + std::to_string(n_after) + " hexes in " +
                      counted(ranks.size(), "part") + " of at most " + std::to_string(largest));
    }
    if (!is_alike) {
      if (n_rings == most_rings || ranks.least(made.local.is_all))
        throw Error("parts can't be brought to agree about hexes between them");
      continue;
    }
    for (const std::string& line : lines) say(line);
    if (n_restarts > 0)
      say("what is cut depends on places far away: halos of " + counted(n_rings, "ring") + " were needed");
    return made;
  }
}

}  // namespace hextwist
