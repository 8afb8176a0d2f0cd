// merge: coincident nodes of touching parts become one; of CAD alone, surfaces of touching solids do.

#include "hextwist/mesh/merge.h"

#include <algorithm>

#include "hextwist/base/sorted.h"
#include "hextwist/command/select/selection.h"
#include "hextwist/geom/occ/model.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/session/commands/mesh.h"
#include "hextwist/session/load.h"

namespace hextwist {
namespace {

void glue_cad(Execution& run) {
  SessionState& state = run.state;
  if (run.command.find("range"))
    throw error_at(run.command.statement, run.command.find("range")->range.token,
                   "there is only CAD, whose touching solids are glued together: say 'merge all'");
  const Model& model = *run.meshed->model;
  const int n_surfaces = model.count(2);
  const Item* tolerance = run.command.find("tolerance");
  run.stage("glue CAD");
  CadImport joined = glued(model, tolerance ? tolerance->number : 0);
  for (const std::string& line : joined.notices) run.note(line);
  const std::string was = counted(n_surfaces, EntityKind::surface);
  state.glued = true;
  forget_members(state, true);
  replace_and_measure(run, {{}, std::move(joined.model), {}});
  run.say("touching solids are glued: " + was + " before, " + std::to_string(run.meshed->model->count(2)) + " now");
}

}  // namespace

void do_merge(Execution& run) {
  SessionState& state = run.state;
  const Mesh& mesh = run.meshed->mesh;
  if (mesh.n_hexes() == 0 && state.has_cad) return glue_cad(run);
  need_mesh(run, "to merge");
  constexpr double relative = 1e-6;  // files often keep six digits
  const Item* said = run.command.find("tolerance");
  const double tolerance = said ? said->number : relative * box(mesh).diagonal();
  std::vector<std::uint8_t> wanted;
  if (const Item* range = run.command.find("range")) {
    wanted.assign(mesh.points.size(), 0);
    for (const Index n : related(run.core.selector(), range->kind, run.chosen(*range), EntityKind::node)) wanted[n] = 1;
  }
  run.stage("merge");
  MergeResult merged = merge_nodes(mesh, tolerance, wanted);
  const std::string within = "within " + short_number(tolerance) + " of each other";
  if (merged.n_gone == 0) {
    run.leave_mesh();
    return run.say("no two nodes lie " + within + ": nothing is merged");
  }
  for (const std::string& line : merged.notices) run.note(line);
  if (state.periodic) run.note("surfaces are periodic no longer: that was said of the mesh before");
  if (state.levelling) run.note("levels end here: this mesh is the base of what is refined from now on");
  const auto is_curved = [](const auto& block) { return block.second > 8; };
  if (!state.has_cad && state.extras && std::ranges::any_of(state.extras->nodes_per_hex, is_curved))
    run.note("the skin is straight from node to node now: middle nodes, which bent it, are not merged");
  if (state.fixed_nodes) {
    std::vector<Index> fixed;
    for (const Index n : *state.fixed_nodes) fixed.push_back(merged.node_now[n]);
    state.fixed_nodes = std::make_shared<const std::vector<Index>>(sorted_unique(std::move(fixed)));
  }
  forget_members(state, !state.has_cad);
  state.tags = nullptr;
  const std::string done = counted(merged.n_gone, EntityKind::node) + " " + within + " became " +
                           (merged.n_gone == 1 ? "another" : "others") + ", " + counted(merged.n_faces, "pair") +
                           " of faces " + (merged.n_faces == 1 ? "is" : "are") + " one now";
  load_mesh(run, std::move(merged.mesh), state.has_cad ? run.meshed->model : nullptr, nullptr, "the merged mesh");
  run.say(done);
  say_mesh(run, "the merged mesh");
}

}  // namespace hextwist
