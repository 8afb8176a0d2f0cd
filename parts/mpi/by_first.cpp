#include "hextwist/parts/mpi/by_first.h"

#include <algorithm>
#include <cmath>

#include "hextwist/base/text.h"
#include "hextwist/parts/files.h"
#include "hextwist/parts/mpi/share_out.h"
#include "hextwist/session/core.h"
#include "hextwist/session/session.h"

namespace hextwist {
namespace {

/// A hex field that goes along through all commands: the rank that has the hex.
constexpr const char* rank_field = "rank of hextwist-mpi";

bool is_rank_field(const Field& field) {
  return field.on == Field::On::hex && field.name == rank_field;
}

/// Per hex the rank of what it came of; empty: not known. Takes the field away.
std::vector<int> take_ranks(Mesh& mesh, int n_ranks) {
  std::vector<int> rank;
  const auto field = std::ranges::find_if(mesh.fields, is_rank_field);
  if (field == mesh.fields.end()) return rank;
  if (field->values.size() == mesh.hexes.size())
    for (const double value : field->values)
      rank.push_back(std::isfinite(value) ? std::clamp(static_cast<int>(value), 0, n_ranks - 1) : 0);
  mesh.fields.erase(field);
  return rank;
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
    for (const std::string& text : commands.texts()) session.run(text);
  } catch (const CommandError& error) {
    throw Error(error.message());
  }
  if (core.meshed->model != model) throw Error("a command has put the mesh on another model: parts stay on theirs");
  if (core.meshed->mesh.hexes.empty()) throw Error("there are no hexes any more");
  return std::move(core.meshed.to_change());
}

}  // namespace

void refined_by_first(Ranks& ranks, RankPart& part, const PartCommands& commands, bool rebalance, const Say& say) {
  const std::shared_ptr<const Model> model = part.own.model;
  const std::int64_t n_before = part.n_hexes;
  part.own.mesh.fields.push_back({rank_field, Field::On::hex, 1, {}, true});
  part.own.mesh.fields.back().values.assign(part.own.mesh.hexes.size(), ranks.rank());
  part.own = moved(ranks, std::move(part.own), std::vector<int>(part.own.mesh.hexes.size(), 0));
  std::vector<int> rank_of_hex;
  ranks.together([&] {
    if (!ranks.is_first()) return;
    part.own = run_session(part, std::move(part.own), commands, say);
    rank_of_hex = take_ranks(part.own.mesh, ranks.size());
    need_ids(part.own.mesh);
  });
  share_heads(ranks, part.own.mesh);
  part.own.model = model;
  if (ranks.largest(!rank_of_hex.empty())) part.own = moved(ranks, std::move(part.own), rank_of_hex);
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
