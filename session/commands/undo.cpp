// undo, redo, and `list undo`.

#include <algorithm>
#include <iterator>
#include <ranges>

#include "hextwist/session/commands/commands.h"

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

std::string mesh_text(const Mesh& mesh, const ModelState& state) {
  if (mesh.n_hexes() == 0) return "no mesh";
  return counted(mesh.n_hexes(), EntityKind::hex) + ", " + counted(mesh.n_nodes(), EntityKind::node) +
         ", smallest shape " + short_number(state.measured.shape.min);
}

bool is_splice(const Step& step) {
  return std::holds_alternative<SpliceChange>(step.mesh);
}
bool is_of_sets(const Step& step) {
  return std::holds_alternative<SetsChange>(step.mesh);
}

/// The way through n steps from the end of a list: those that lead back, and where it ends.
struct Way {
  std::vector<Step> back;
  std::vector<std::pair<std::size_t, MeshHolder*>> whole;  // of those that lead back; theirs when all is said
  MeshHolder* mesh;
  ModelState state;
};

/// Small refinements and changes of sets: each changes the mesh of the session.
void go_in_place(Execution& run, std::span<Step> steps, Way& way) {
  for (Step& step : steps | std::views::reverse) {
    if (const auto* splice = std::get_if<SpliceChange>(&step.mesh))
      run.splice(*splice);
    else
      run.change_sets(sets_after(std::get<SetsChange>(step.mesh).sets, run.meshed->mesh));
    way.back.emplace_back(step.command, step.state, way.state, std::move(*run.back));
    way.state = step.state;
  }
}

/// Any: through meshes that are made one from the other.
void go_by_copies(Execution& run, std::span<Step> steps, const char* verb, Way& way, MeshHolder& made) {
  for (Step& step : steps | std::views::reverse) {
    run.stage(verb);
    MeshHolder next_made, *next = &next_made;
    MeshChange back;
    if (auto* whole = std::get_if<WholeMesh>(&step.mesh))
      next = &whole->meshed;
    else if (std::holds_alternative<SameMesh>(step.mesh))
      next = way.mesh;
    else
      next_made = MeshHolder(changed(**way.mesh, step.mesh));
    if (const auto* splice = std::get_if<SpliceChange>(&step.mesh))
      back = SpliceChange{splice->splice, !splice->forward};
    else if (next != way.mesh)
      back = difference(**next, **way.mesh);
    if (auto* whole = std::get_if<WholeMesh>(&back); whole && way.mesh == &made)
      whole->meshed = std::move(made);
    else if (whole)
      way.whole.emplace_back(way.back.size(), way.mesh);
    way.back.emplace_back(step.command, step.state, way.state, std::move(back));
    if (next == &next_made) {
      made = std::move(next_made);
      next = &made;
    }
    way.mesh = next;
    way.state = step.state;
  }
}

/// Takes steps from the end of one list and puts those that lead back onto the other.
void travel(Execution& run, std::vector<Step>& from, std::vector<Step>& to, const char* verb, const char* done) {
  run.is_history = true;
  const std::size_t n = n_steps(run, from, verb);
  const std::span<Step> steps = std::span(from).last(n);
  MeshHolder made;
  Way way{.back = {}, .whole = {}, .mesh = &run.core.meshed, .state = run.state};
  way.back.reserve(n);
  const bool only_sets = n == 1 && is_of_sets(steps[0]);
  if (only_sets || std::ranges::all_of(steps, is_splice)) {
    if (!only_sets) run.stage("splice");
    go_in_place(run, steps, way);
  } else {
    go_by_copies(run, steps, verb, way, made);
  }
  to.reserve(to.size() + n);
  run.close_stage();
  for (std::size_t i = 0; i < n; ++i)
    run.say(std::string(done) + " '" + way.back[i].command + "'" +
            (i + 1 < n || only_sets ? "" : ": " + mesh_text((*way.mesh)->mesh, way.state)));
  // Nothing below throws.
  for (const auto& [i, mesh] : way.whole) std::get<WholeMesh>(way.back[i].mesh).meshed = std::move(*mesh);
  if (way.mesh != &run.core.meshed) run.core.exchange_mesh(std::move(*way.mesh));
  static_cast<ModelState&>(run.state) = std::move(way.state);
  std::ranges::move(way.back, std::back_inserter(to));
  from.erase(from.end() - static_cast<std::ptrdiff_t>(n), from.end());
}

std::string bytes_text(std::size_t bytes) {
  if (bytes < 1000) return std::to_string(bytes) + " bytes";
  const double value = static_cast<double>(bytes);
  return value < 1e6   ? short_number(value / 1e3) + " kB"
         : value < 1e9 ? short_number(value / 1e6) + " MB"
                       : short_number(value / 1e9) + " GB";
}

}  // namespace

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
      run.say(std::string(verb) + " " + std::to_string(i + 1) + ": " + step.command + " (" + bytes_text(step.bytes) +
              ")");
    }
  }
  run.say("together " + bytes_text(history.bytes()) + ", at most " + bytes_text(history.limit) + " are kept");
}

}  // namespace hextwist
