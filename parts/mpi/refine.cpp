#include "hextwist/parts/mpi/refine.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/parts/agree.h"
#include "hextwist/parts/halo.h"
#include "hextwist/parts/mpi/by_first.h"
#include "hextwist/parts/mpi/directory.h"
#include "hextwist/parts/mpi/share_out.h"
#include "hextwist/parts/pack.h"
#include "hextwist/patch/patch.h"

namespace hextwist {
namespace {

/// The part with its halo.
LocalMesh with_halo(Ranks& ranks, const RankPart& part, int n_rings) {
  const Mesh& mesh = part.own.mesh;
  std::vector<std::int64_t> skin;
  ranks.together([&] { skin = skin_nodes(mesh); });
  std::vector<std::vector<std::byte>> to(static_cast<std::size_t>(ranks.size()));
  {
    HaloSearch search(mesh, ranks.rank(), ranks.size(), at_others(ranks, mesh, skin));
    std::vector<HaloSearch::Reached> told;
    for (int ring = 1; ring <= n_rings; ++ring) {
      const auto from = ranks.exchange(search.next_ring(told));
      told.clear();
      for (const auto& list : from) told.insert(told.end(), list.begin(), list.end());
      if (ranks.largest(!told.empty() || search.goes_on()) == 0) break;
    }
    ranks.together([&] {
      for (int other = 0; other < ranks.size(); ++other) {
        std::vector<Index> hexes = search.hexes_around(other);
        if (hexes.empty()) continue;
        Patch patch = make_patch(part.own, std::move(hexes));
        set_ids(mesh, patch, patch.meshed.mesh);
        to[other] = packed(patch.meshed);
      }
    });
  }
  auto from = ranks.exchange(to);
  to.clear();
  LocalMesh local;
  ranks.together([&] {
    std::vector<HaloPiece> pieces;
    for (int other = 0; other < ranks.size(); ++other) {
      if (from[other].empty()) continue;
      pieces.push_back({unpacked(from[other]), other});
      from[other] = {};
    }
    local = local_mesh(part.own, ranks.rank(), pieces, n_rings, part.n_hexes,
                       [](int rank) { return "the part of rank " + std::to_string(rank); });
  });
  return local;
}

/// How many rings around this rank's own hexes are what their owners made of them.
int rings_alike(Ranks& ranks, const LocalMesh& local, std::span<const std::uint64_t> digest) {
  const HaloMade made = made_of_halo(local, digest, ranks.size());
  const auto asked = ranks.exchange(made.of);
  std::vector<std::vector<std::uint8_t>> answers;
  for (const auto& theirs : asked) answers.push_back(is_same(theirs, local.base, digest));
  int alike = local.n_rings;
  const auto answered = ranks.exchange(answers);
  for (std::size_t r = 0; r < answered.size(); ++r)
    for (std::size_t i = 0; i < answered[r].size(); ++i)
      if (!answered[r][i]) alike = std::min(alike, made.ring[r][i] - 1);
  return alike;
}

/// The text of the first rank that has one.
std::string first_text(Ranks& ranks, const std::string& text) {
  const auto first = static_cast<int>(ranks.least(text.empty() ? ranks.size() : ranks.rank()));
  return first == ranks.size() ? std::string() : ranks.text_of(first, text);
}

Box whole_box(Ranks& ranks, const LocalMesh& local) {
  const Box mine = own_box(local);
  std::vector<double> most;
  for (int k = 0; k < 3; ++k) most.insert(most.end(), {mine.max[k], -mine.min[k]});
  most = ranks.largest(std::move(most));
  Box all;
  for (int k = 0; k < 3; ++k) {
    all.max[k] = most[2 * k];
    all.min[k] = -most[2 * k + 1];
  }
  return all;
}

SizeCounts sum_of(Ranks& ranks, const SizeCounts& mine) {
  const std::vector<std::int64_t> sum =
      ranks.sum(std::vector{mine.met.n_hexes, mine.met.n_coarser, mine.met.n_finer, mine.met.n_much_finer, mine.unmet});
  return {{sum[0], sum[1], sum[2], sum[3]}, sum[4]};
}

/// What all ranks make of a command together.
Asked agreed(Ranks& ranks, const PartCommands& commands, std::size_t i, LocalMesh& local, const GlobalIds& ids,
             bool has_cad, std::vector<Approach>& before) {
  PartAsked mine;
  ranks.together([&] { mine = commands.asked(i, local, ids, has_cad); });
  const bool is_here = mine.has_target;
  for (std::string* said : {&mine.wrong, &mine.by_whole, &mine.nothing}) *said = first_text(ranks, *said);
  const auto approach =
      static_cast<Approach>(ranks.largest(is_here ? static_cast<std::int64_t>(mine.asked.approach) : 0));
  const bool is_anywhere = ranks.largest(is_here) != 0;
  commands.check(i, is_anywhere, mine, ranks.sum(std::move(mine.has_id)), approach, before);
  before.push_back(approach);
  mine.asked.approach = approach;
  return std::move(mine.asked);
}

/// The turns of all ranks, in their order.
std::vector<Turn> all_turns(Ranks& ranks, std::span<const PassRecord> records) {
  std::vector<Turn> mine;
  for (const PassRecord& record : records) mine.push_back(record.turn);
  return sorted_unique(ranks.joined_everywhere(mine));
}

void number(Ranks& ranks, const LocalRun& run, GlobalIds& ids) {
  const std::int64_t before = ids.highest_hex;
  for (const Turn& turn : all_turns(ranks, run.records)) {
    const PassRecord* record = pass_at(run.records, turn);
    RunLists runs;
    if (record) runs = brought_by(*record, ids);
    const PassSums sums = sums_of(ranks, runs);
    number_pass(record, runs, sums, ids);
  }
  if (ranks.largest(run.by_levels) == 0) return;
  const RunLists runs = {std::vector<Run>(), std::vector<Run>(), survivors(before, ids)};
  const PassSums sums = sums_of(ranks, runs);
  number_survivors(before, runs[2], sums.before[2], sums.total[2][0], ids);
}

/// Nothing where halos were not wide enough. Throws NeedsWhole on all ranks.
std::optional<InRanks> try_to_refine(Ranks& ranks, const RankPart& part, const PartCommands& commands, int n_rings,
                                     std::vector<std::string>& lines) {
  InRanks made;
  made.n_rings = n_rings;
  made.local = with_halo(ranks, part, n_rings);
  made.array_bytes = array_bytes(made.local);
  made.ids = {made.local.base.node, made.local.base.hex, part.highest_node, part.highest_hex};
  std::vector<Approach> approaches;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const std::int64_t n_before = ranks.sum(n_own_hexes(made.local));
    const Asked asked = agreed(ranks, commands, i, made.local, made.ids, part.has_cad, approaches);
    LocalRun run;
    const OfWhole whole = {whole_box(ranks, made.local), n_before};
    // What is asked of all ranks in between, each asks as often.
    const LeastOfAll least = [&](int, const Bounds& mine) {
      const std::vector<double> most = ranks.largest(std::vector{-mine.scaled_jacobian, -mine.shape});
      return Bounds{-most[0], -most[1]};
    };
    const NumbersOfAll numbers = [&](const PartNumbers& mine, bool& has_failed) {
      std::vector<std::int64_t> sums(mine.sum.begin(), mine.sum.end());
      sums.push_back(has_failed);
      sums = ranks.sum(std::move(sums));
      has_failed = sums.back() > 0;
      PartNumbers all;
      std::copy_n(sums.begin(), all.sum.size(), all.sum.begin());
      all.least = -ranks.largest(std::vector{-mine.least})[0];
      return all;
    };
    ranks.together([&] { run = run_locally(made.local, asked, whole, {least, numbers}); });
    const int n_rings_now = made.local.n_rings;
    const auto alike = static_cast<int>(ranks.least(rings_alike(ranks, made.local, run.digest)));
    const bool have_all = ranks.least(made.local.is_all) != 0;
    const std::string by_whole = first_text(ranks, run.by_whole);
    const Verdict verdict = verdict_of(alike, n_rings_now, by_whole, have_all);
    if (verdict == Verdict::needs_all) throw NeedsWhole(by_whole);
    if (verdict == Verdict::too_narrow) return std::nullopt;
    ranks.together([&] {
      if (!run.wrong.empty()) throw Error(run.wrong);
    });
    const int keep = rings_to_keep(alike, have_all);
    for (PassRecord& record : run.records) keep_rings(record, keep);
    number(ranks, run, made.ids);
    ranks.together([&] { trim(made.local, keep, made.ids); });
    const std::int64_t n_after = ranks.sum(n_own_hexes(made.local)), largest = ranks.largest(n_own_hexes(made.local));
    if (const std::string met = text_of(sum_of(ranks, run.sizes)); !met.empty()) lines.push_back(met);
    lines.push_back(std::to_string(n_before) + " -> " + std::to_string(n_after) + " hexes in " +
                    counted(ranks.size(), "part") + " of at most " + std::to_string(largest));
  }
  made.array_bytes += array_bytes(made.local);
  std::vector<std::int64_t> n_of_base(made.local.base.hex.size(), 0);
  for (const Index b : made.local.base_of) ++n_of_base[b];
  for (std::size_t b = 0; b < n_of_base.size(); ++b)
    if (made.local.base.ring[b] == 0) made.n_made.push_back(n_of_base[b]);
  return made;
}

/// The mesh as it is, in parts that the first rank has made.
InRanks refine_by_first(Ranks& ranks, RankPart& part, const PartCommands& commands, const RankOptions& options,
                        const std::string& why, const Say& say) {
  say(why + ": the first process does it, with the whole mesh");
  refined_by_first(ranks, part, commands, options.rebalance, say);
  InRanks made;
  made.n_rings = 1;
  made.local = with_halo(ranks, part, made.n_rings);
  made.ids = {made.local.base.node, made.local.base.hex, part.highest_node, part.highest_hex};
  return made;
}

InRanks refine_by_all(Ranks& ranks, RankPart& part, const PartCommands& commands, const RankOptions& options,
                      const Say& say) {
  if (!commands.by_whole().empty()) return refine_by_first(ranks, part, commands, options, commands.by_whole(), say);
  for (const std::string& line : commands.notices()) say(line);  // the first says so by itself
  int n_rings = first_rings(options.n_rings, commands.depth(), commands.size()), n_restarts = 0;
  bool may_rebalance = options.rebalance && ranks.size() > 1;
  for (;;) {
    std::vector<std::string> lines;
    std::optional<InRanks> made;
    try {
      made = try_to_refine(ranks, part, commands, n_rings, lines);
      if (!made && 2 * n_rings > most_rings) throw NeedsWhole(depends_on_far(n_rings));
    } catch (const NeedsWhole& needs) {
      return refine_by_first(ranks, part, commands, options, needs.why, say);
    }
    if (!made) {
      ++n_restarts;
      n_rings *= 2;
      continue;
    }
    made->n_restarts = n_restarts;
    for (const std::string& line : lines) say(line);
    if (n_restarts > 0)
      say("what is made depends on places far away: halos of " + counted(n_rings, "ring") + " were needed");
    const double load = load_of(ranks, n_own_hexes(made->local), say);
    if (!may_rebalance || load <= fair) return std::move(*made);
    // What comes out does not depend on who does it: the same again, by others.
    may_rebalance = false;
    const std::vector<std::int64_t> weights = std::move(made->n_made);
    made.reset();
    const std::vector<int> rank_of_hex = share_out(ranks, part.own.mesh, PartitionBy::boxes, weights);
    part.own = moved(ranks, std::move(part.own), rank_of_hex);
    say("hexes are shared out again by what becomes of them");
  }
}

}  // namespace

InRanks refine_in_ranks(Ranks& ranks, RankPart& part, const PartCommands& commands, const RankOptions& options,
                        const Say& say) {
  InRanks made = refine_by_all(ranks, part, commands, options, say);
  made.results = part.results;
  return made;
}

OwnPart take_part(Ranks& ranks, InRanks made) {
  const std::shared_ptr<const FileResults> results = std::move(made.results);
  const std::int64_t highest = std::max(made.ids.highest_node, made.ids.highest_hex);
  OwnPart part;
  ranks.together([&] { part = take_own(std::move(made.local), std::move(made.ids), ranks.rank(), ranks.size()); });
  const std::vector<std::int64_t> counts = ranks.sum(part.counts);
  const std::vector<std::int64_t> shares = ranks.sum(block_shares(part, counts));
  fill_in_whole(part, counts, shares, highest);
  part.mesh.results = results;
  return part;
}

std::vector<std::string> write_in_ranks(Ranks& ranks, InRanks made, const std::filesystem::path& name) {
  const OwnPart part = take_part(ranks, std::move(made));
  std::vector<std::string> notices;
  PartOutput output(name, ranks.size());
  ranks.together([&] { output.write(part, notices); });
  ranks.together([&] { output.commit(); });
  return ranks.lines_of_all(notices);
}

}  // namespace hextwist
