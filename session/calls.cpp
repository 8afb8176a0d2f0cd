// What a session is asked by programs instead of by commands.

#include <algorithm>
#include <new>

#include "hextwist/base/memory.h"
#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/validate/validate.h"
#include "hextwist/patch/adapt.h"
#include "hextwist/session/session_internal.h"
#include "hextwist/sizing/stages.h"

namespace hextwist {
namespace {

/// Runs f like a command of that name: recorded, to be undone, and without a trace when it fails.
template <class F>
void run_step(Session::Core& core, const std::string& name, F f) {
  const SessionState before = core.state;
  const auto start = std::chrono::steady_clock::now();
  const Command command = made_command("import", "mesh", "");  // for messages that point at words: there are none
  CommandRecord record;
  record.command = name;
  record.before = before.mesh_state;
  const auto finish = [&] {
    record.after = core.state.mesh_state;
    record.off_cad = core.state.off_cad;
    if (record.off_cad.node >= 0) record.off_cad_node = node_id(core.state.meshed->mesh, record.off_cad.node);
    record.cad_volume = core.state.cad_volume;
    record.has_cad = core.state.has_cad;
    record.total_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    record.peak_memory_bytes = peak_memory();
    core.records.push_back(std::move(record));
  };
  std::string problem;
  try {
    Execution run(core, command, record);
    f(run);
    run.close_stage();
    remember(core, name, before);
    record.ok = true;
    return finish();
  } catch (const std::bad_alloc&) {
    problem = "out of memory";
  } catch (const std::exception& error) {
    problem = error.what();
  } catch (...) {
    core.state = before;
    throw;
  }
  core.state = before;
  record.error = problem;
  finish();
  throw CommandError(problem, problem, 0, 0);
}

template <class T>
AdaptOutcome adapt_session(Session::Core& core, const char* by, std::span<const T> values, AdaptOptions options) {
  AdaptOutcome outcome;
  run_step(core, std::string("adapt by ") + by, [&](Execution& run) {
    const MeshedModel& meshed = *core.state.meshed;
    if (meshed.mesh.n_hexes() == 0) throw Error("there is no mesh to adapt");
    if (core.state.fixed_nodes)
      options.fixed.insert(options.fixed.end(), core.state.fixed_nodes->begin(), core.state.fixed_nodes->end());
    AdaptResult result = hextwist::adapt(meshed, values, options, core.callbacks.progress);
    for (const std::string& line : result.report.notices) run.note(line);
    run.record.seconds = result.report.seconds;
    run.record.filled_hexes = result.report.filled_hexes;
    outcome = {std::move(result.origin), std::move(result.report)};
    // Nothing was cut, and then nothing was measured: the mesh stays, without a field of zeros.
    if (outcome.report.hexes_after > outcome.report.hexes_before)
      accept_refined(run, std::move(result.refined), outcome.report);
  });
  return outcome;
}

}  // namespace

void Session::take(Mesh mesh, std::shared_ptr<const Model> model, const Association* tags) {
  run_step(*core_, "take mesh", [&](Execution& run) {
    SessionState& state = core_->state;
    forget_members(state, true);
    state.has_cad = model != nullptr;
    state.cad_file.clear();
    state.meshed = std::make_shared<MeshedModel>(MeshedModel{{}, std::move(model), {}});
    load_mesh(run, std::move(mesh), tags, "mesh");
    state.tags = tags ? std::make_shared<const Association>(*tags) : nullptr;
  });
}

void Session::take(MeshedModel meshed, bool has_cad, const std::vector<std::string>& notices) {
  run_step(*core_, "take mesh", [&](Execution& run) {
    SessionState& state = core_->state;
    run.stage("check mesh");
    for (const std::string& line : notices) run.note(line);
    const std::vector<Violation> violations = validate(meshed.mesh);
    std::string wrong = record_violations(run.record, meshed.mesh, violations);
    if (const auto inverted = inverted_among(violations); !inverted.empty() && state.untangle) {
      run.stage("untangle");
      const std::vector<Vec3> before = meshed.mesh.points;
      run.record.violations.clear();
      run.record.warnings.clear();
      run.record.n_violations = 0;
      if (untangle_mesh(run, meshed.mesh, meshed.association, meshed.model.get(), inverted, true)) {
        wrong = record_violations(run.record, meshed.mesh, validate(meshed.mesh));
        run.note(untangled_text(meshed.mesh, before, inverted));
      } else {
        wrong += "; untangling did not help";
      }
    }
    if (!wrong.empty()) throw Error(wrong);
    if (const auto broken = check_association(meshed.mesh, meshed.association, *meshed.model); !broken.empty())
      throw Error(broken.front());
    forget_members(state, true);
    state.has_cad = has_cad;
    state.cad_file.clear();
    state.tags = nullptr;
    take_meshed(state, std::move(meshed));
  });
}

void Session::take_mesh(Mesh mesh, const Association* tags) {
  run_step(*core_, "take mesh", [&](Execution& run) {
    SessionState& state = core_->state;
    forget_members(state, !state.has_cad);
    load_mesh(run, std::move(mesh), tags, "mesh");
    state.tags = tags ? std::make_shared<const Association>(*tags) : nullptr;
  });
}

AdaptOutcome Session::adapt(std::span<const std::uint8_t> flags, const AdaptOptions& options) {
  return adapt_session(*core_, "flags", flags, options);
}
AdaptOutcome Session::adapt(std::span<const double> sizes, const AdaptOptions& options) {
  return adapt_session(*core_, "sizes", sizes, options);
}

std::vector<std::int64_t> Session::ids(std::string_view kind, std::string_view range) const {
  // The reader of commands reads it, as part of the command that is about entities of all kinds.
  const std::vector<Statement> statements = split_statements("list " + std::string(kind) + " " + std::string(range));
  if (statements.size() != 1) throw CommandError("this is no range", "this is no range", 0, 0);
  const Command command = parse(statements.front());
  const Item* said = command.find("range");
  if (!said) throw error_in(statements.front(), "'" + printable(kind) + "' is no kind of entity");
  const Selector selector = core_->selector();
  std::vector<std::string> notices;
  std::vector<std::int64_t> result;
  for (const Index i : select(selector, command.statement, said->kind, said->range, notices))
    result.push_back(id_of(selector, said->kind, i));
  std::ranges::sort(result);
  return result;
}

std::shared_ptr<const MeshedModel> Session::Core::lent_mesh() const {
  for (const auto& weak : lent)
    if (auto held = weak.lock(); held == state.meshed) return held;
  return nullptr;
}

std::shared_ptr<const MeshedModel> Session::share() const {
  if (auto lent = core_->lent_mesh()) return lent;
  // A count of its own tells what was lent from what the session holds several times itself.
  const auto& meshed = core_->state.meshed;
  const auto holder = std::make_shared<const std::shared_ptr<const MeshedModel>>(meshed);
  std::shared_ptr<const MeshedModel> result(holder, meshed.get());
  std::erase_if(core_->lent, [](const auto& weak) { return weak.expired(); });
  core_->lent.push_back(result);
  return result;
}

bool Session::has_cad() const {
  return core_->state.has_cad;
}

}  // namespace hextwist
