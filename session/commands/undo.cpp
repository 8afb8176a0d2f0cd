// undo, redo, and what they stand on. What a step holds is decided in undo.cpp.

#include <algorithm>
#include <iterator>

#include "hextwist/session/session_internal.h"

namespace hextwist {
namespace {

/// n as said, 1 by default.
std::size_t n_steps(const Execution& run, const std::vector<Step>& steps, const char* verb) {
  if (!run.core.history.on && steps.empty())
    throw error_in(run.command.statement, "undo is switched off: 'set undo on' keeps what later commands change");
  if (steps.empty()) throw error_in(run.command.statement, std::string("there is nothing to ") + verb);
  const Item* said = run.command.find("steps");
  if (!said) return 1;
  if (said->number > static_cast<double>(steps.size()))
    throw error_at(run.command.statement, said->token,
                   "only " + counted(static_cast<std::int64_t>(steps.size()), "command") + " can be " + verb + "ne");
  return static_cast<std::size_t>(said->number);
}

std::string mesh_text(const ModelState& state) {
  const MeshState& mesh = state.mesh_state;
  if (mesh.hexes == 0) return "no mesh";
  return counted(mesh.hexes, EntityKind::hex) + ", " + counted(mesh.nodes, EntityKind::node) + ", smallest shape " +
         short_number(state.mesh_state.shape.min);
}

/// travel() through small refinements alone, in place.
void travel_splices(Execution& run, std::vector<Step>& from, std::vector<Step>& to, std::size_t n, const char* done) {
  ModelState state = run.state;
  std::vector<SpliceStep> splices;
  std::vector<Step> back;
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < n; ++i) {
    const Step& step = from[from.size() - 1 - i];
    splices.push_back({step.splice(), step.forward()});
    back.emplace_back(step.command(), state, step.splice(), !step.forward());
    lines.push_back(std::string(done) + " '" + step.command() + "'");
    state = step.state();
  }
  lines.back() += ": " + mesh_text(state);
  to.reserve(to.size() + n);
  run.splice(splices, std::move(state), lines);
  // Nothing below throws.
  std::ranges::move(back, std::back_inserter(to));
  from.resize(from.size() - n);
}

/// Takes steps from the end of one list and puts those that lead back onto the other.
void travel(Execution& run, std::vector<Step>& from, std::vector<Step>& to, const char* verb, const char* done) {
  run.is_history = true;
  const std::size_t n = n_steps(run, from, verb);
  if (n == 1 && from.back().only_sets()) {
    // Blocks and sets alone are exchanged in place, as they were changed.
    to.reserve(to.size() + 1);
    const std::string line = std::string(done) + " '" + from.back().command() + "'";
    run.change_sets(sets_after(from.back().sets(), run.state.meshed->mesh));
    run.step->swap_command(from.back());
    to.push_back(std::move(*run.step));
    run.step.reset();
    from.pop_back();
    return run.say(line);
  }
  const std::span<const Step> taken = std::span(from).last(n);
  if (std::ranges::all_of(taken, [](const Step& step) { return step.splice() != nullptr; }))
    return travel_splices(run, from, to, n, done);
  ModelState state = run.state;
  std::vector<Step> back;
  for (std::size_t i = 0; i < n; ++i) {
    run.stage(verb);
    const Step& step = from[from.size() - 1 - i];
    ModelState next = step.apply(state);
    if (step.splice())
      back.emplace_back(step.command(), state, step.splice(), !step.forward());
    else
      back.emplace_back(step.command(), next, state);
    state = std::move(next);
  }
  to.reserve(to.size() + n);
  std::vector<std::string> lines;
  for (const Step& step : back) lines.push_back(std::string(done) + " '" + step.command() + "'");
  // Nothing below throws.
  std::ranges::move(back, std::back_inserter(to));
  from.resize(from.size() - n);
  static_cast<ModelState&>(run.state) = std::move(state);
  lines.back() += ": " + mesh_text(run.state);
  for (const std::string& line : lines) run.say(line);
}

}  // namespace

std::string bytes_text(std::size_t bytes) {
  if (bytes < 1000) return std::to_string(bytes) + " bytes";
  const double value = static_cast<double>(bytes);
  return value < 1e6   ? short_number(value / 1e3) + " kB"
         : value < 1e9 ? short_number(value / 1e6) + " MB"
                       : short_number(value / 1e9) + " GB";
}

void add_step(Session::Core& core, Step step) noexcept {
  if (core.history.on) core.history.add(std::move(step));
}

void remember(Session::Core& core, const std::string& command, const ModelState& before) {
  const ModelState& now = core.state;
  if (!core.history.on) return;
  if (now.meshed == before.meshed && now.fixed_nodes == before.fixed_nodes && now.schemes == before.schemes &&
      now.groups == before.groups)
    return;
  core.history.undo.reserve(core.history.undo.size() + 1);
  add_step(core, Step(command, now, before));
}

void Execution::change_sets(Mesh lists) {
  // Somebody outside may look at the mesh: then a copy changes.
  if (core.lent_mesh()) state.meshed = std::make_shared<MeshedModel>(*state.meshed);
  // Built as const by nobody: see take_meshed() and accept_refined().
  Mesh& mesh = const_cast<Mesh&>(state.meshed->mesh);
  step.emplace(text_of(command.statement), state, sets_delta(lists, mesh));
  mesh.blocks.swap(lists.blocks);
  mesh.node_sets.swap(lists.node_sets);
  mesh.side_sets.swap(lists.side_sets);
}

void switch_undo(Execution& run, bool on) {
  History& history = run.core.history;
  history.on = on;
  // Steps can be taken only from the state that they were kept beside.
  if (!on) history.undo.clear(), history.redo.clear();
}

void do_undo(Execution& run) {
  History& history = run.core.history;
  if (run.command.has("on") || run.command.has("off")) return switch_undo(run, run.command.has("on"));
  travel(run, history.undo, history.redo, "undo", "undone:");
}

void do_redo(Execution& run) {
  History& history = run.core.history;
  travel(run, history.redo, history.undo, "redo", "done again:");
}

void list_undo(Execution& run) {
  const History& history = run.core.history;
  if (!history.on) run.say("undo is switched off");
  for (const auto* steps : {&history.undo, &history.redo}) {
    const char* verb = steps == &history.undo ? "undo" : "redo";
    if (steps->empty()) run.say(std::string("nothing to ") + verb);
    // The one that comes next first.
    for (std::size_t i = 0; i < steps->size(); ++i) {
      const Step& step = (*steps)[steps->size() - 1 - i];
      run.say(std::string(verb) + " " + std::to_string(i + 1) + ": " + step.command() + " (" +
              bytes_text(step.bytes()) + ")");
    }
  }
  run.say("together " + bytes_text(history.bytes()) + ", at most " + bytes_text(history.limit) + " are kept");
}

}  // namespace hextwist
