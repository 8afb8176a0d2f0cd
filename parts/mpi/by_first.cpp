#include "hextwist/parts/mpi/by_first.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "hextwist/base/text.h"
#include "hextwist/geom/renumbered_model.h"
#include "hextwist/io/results.h"
#include "hextwist/parts/files.h"
#include "hextwist/parts/mpi/share_out.h"
#include "hextwist/session/core.h"
#include "hextwist/session/session.h"

namespace hextwist {
namespace {

/// Hexes know which they come of as those of a file do, so no command sees it. Per hex the rank of what it came of; the
/// first where that is not known.
std::vector<int> take_ranks(Mesh& mesh, std::span<const int> rank_before) {
  std::vector<int> rank(mesh.hexes.size(), 0);
  const std::vector<Index> before = std::exchange(mesh.file_hexes, {});
  for (std::size_t h = 0; h < before.size() && before.size() == rank.size(); ++h) rank[h] = rank_before[before[h]];
  return rank;
}

bool is_other_only_by_names(const Model& now, const Model& before) {
  const std::optional<RenumberingOf> of = renumbering_of(now), was = renumbering_of(before);
  if (!of) return false;
  if (was) return of->model == was->model && of->renumbering.id == was->renumbering.id;
  return of->model.get() == &before && std::ranges::all_of(of->renumbering.id, [](const std::vector<int>& ids) {
           return std::ranges::is_sorted(ids);
         });
}

/// What parts would lose of what commands have made.
void refuse_more(const Session::Core& core) {
  if (core.state.order == 2) throw Error("'set order 2': hexes of 20 nodes are not done in parts");
  refuse_more(core.meshed->mesh, core.state.extras.get(), "the mesh after the commands");
  if (core.state.periodic)
    throw Error("'periodic': surfaces that repeat others are not kept alike in parts; run it with hextwist");
  if (core.meshed->mesh.results)
    if (const std::string lost = extras_text(*core.meshed->mesh.results); !lost.empty())
      throw Error("what commands have put beside the mesh is not kept in parts: " + lost);
}

/// Only these are known not to ask for what was there before.
bool goes_forward(const PartCommands& commands) {
  return std::ranges::all_of(commands.names(), [](const std::string& name) {
    return name == "refine" || name == "coarsen" || name == "smooth" || name == "sizing";
  });
}

MeshedModel run_session(const RankPart& part, MeshedModel whole, const PartCommands& commands, const Say& say) {
  const std::shared_ptr<const Model> model = whole.model;
  Session session;
  Session::Core& core = session.core();
  core.history.on = false;
  session.take(std::move(whole), part.has_cad);
  core.history.on = !goes_forward(commands);
  session.set_callbacks({.output = say, .notice = say, .error = {}, .progress = {}});
  try {
    for (const std::string& text : commands.texts()) {
      session.run(text);
      if (core.meshed->model != model && !is_other_only_by_names(*core.meshed->model, *model))
        throw Error("a command has put the mesh on another model: parts stay on theirs; it is among '" + text + "'");
    }
  } catch (const CommandError& error) {
    throw Error(error.message());
  }
  if (core.meshed->mesh.hexes.empty()) throw Error("there are no hexes any more");
  refuse_more(core);
  return std::move(core.meshed.to_change());
}

}  // namespace

void refined_by_first(Ranks& ranks, RankPart& part, const PartCommands& commands, bool rebalance, const Say& say) {
  const std::shared_ptr<const Model> model = part.own.model;
  const std::int64_t n_before = part.n_hexes;
  std::vector<int> rank_before, rank_of_hex;
  part.own = at_first(ranks, std::move(part.own), rank_before, part.highest_node);
  ranks.together([&] {
    if (!ranks.is_first()) return;
    part.own.mesh.file_hexes.resize(part.own.mesh.hexes.size());
    std::iota(part.own.mesh.file_hexes.begin(), part.own.mesh.file_hexes.end(), 0);
    part.own = run_session(part, std::move(part.own), commands, say);
    rank_of_hex = take_ranks(part.own.mesh, rank_before);
    need_ids(part.own.mesh);
  });
  share_heads(ranks, part.own.mesh);
  part.own.model = model;
  part.highest_node = ranks.largest(part.own.mesh.node_ids.empty() ? 0 : part.own.mesh.node_ids.back());
  part.own = moved(ranks, std::move(part.own), rank_of_hex);  // without nodes of no hex
  count_whole(ranks, part);
  say(std::to_string(n_before) + " -> " + std::to_string(part.n_hexes) + " hexes in " + counted(ranks.size(), "part"));
  const bool is_any_empty = ranks.least(part.own.mesh.n_hexes()) == 0;
  if (load_of(ranks, part.own.mesh.n_hexes(), say) <= fair && !is_any_empty) return;
  if (!rebalance && !is_any_empty) return;
  const std::vector<int> shared = share_out(ranks, part.own.mesh, PartitionBy::boxes);
  part.own = moved(ranks, std::move(part.own), shared);
  say("hexes are shared out again");
}

}  // namespace hextwist
