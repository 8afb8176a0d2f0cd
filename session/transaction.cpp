#include "hextwist/session/transaction.h"

#include <new>

#include "hextwist/base/memory.h"
#include "hextwist/command/error_at.h"
#include "hextwist/mesh/periodic.h"
#include "hextwist/sizing/stages.h"

namespace hextwist {
namespace {

std::size_t new_record(Session::Core& core, std::string text) {
  core.records.emplace_back();
  core.records.back().command = std::move(text);
  core.records.back().before = mesh_state(core.meshed->mesh, core.state.measured);
  return core.records.size() - 1;
}

}  // namespace

Transaction::Transaction(Session::Core& session, std::string text, const Statement* statement)
    : core(session),
      state(session.state),
      meshed(session.meshed),
      place_(new_record(session, std::move(text))),
      statement_(statement),
      state_before_(session.state),
      variables_before_(session.variables) {}

void Transaction::note(const std::string& line) const {
  record().notices.push_back(line);
  if (core.callbacks.notice) core.callbacks.notice(line);
}

void Transaction::stage(const char* name) {
  close_stage();
  stage_ = name;
  since_ = Clock::now();
  if (core.callbacks.progress && !core.callbacks.progress(name, 0)) throw Cancelled();
}

void Transaction::close_stage() {
  if (stage_) record().seconds.push_back({stage_, std::chrono::duration<double>(Clock::now() - since_).count()});
  stage_ = nullptr;
}

void Transaction::replace(MeshedModel next) {
  MeshHolder holder(std::move(next));
  if (!mesh_before_) mesh_before_.emplace(std::move(core.meshed));
  core.exchange_mesh(std::move(holder));
}

void Transaction::replace_alike(MeshedModel next) {
  std::unique_ptr<Neighbours> neighbours = std::move(core.neighbours);
  replace(std::move(next));
  core.neighbours = std::move(neighbours);
}

void Transaction::change_sets(Mesh lists) {
  SetsChange change{sets_delta(lists, meshed->mesh)};
  if (meshed.is_lent()) replace_alike(*meshed);
  done_.reserve(done_.size() + 1);
  swap_sets(core.meshed.to_change().mesh, lists);
  if (!mesh_before_) done_.emplace_back(std::move(lists));
  back = std::move(change);
}

void Transaction::replace_fields(MeshedModel next) {
  replace_alike(std::move(next));
  levels_go_on_ = true;
}

void Transaction::splice(const SpliceChange& change) {
  const auto& [splice, forward] = change;
  core.topology = nullptr;
  done_.reserve(done_.size() + 1);
  if (meshed.is_lent()) {
    replace_alike(spliced(*meshed, *splice, forward));
  } else {
    splice->make_room(core.meshed.to_change(), forward);
    splice->apply(core.meshed.to_change(), forward);
    if (!mesh_before_) done_.emplace_back(change);
  }
  back = SpliceChange{splice, !forward};
  try {
    if (core.neighbours && !core.neighbours->apply(*splice, forward)) core.neighbours = nullptr;
  } catch (...) {
    core.neighbours = nullptr;
  }
}

void Transaction::leave_mesh() {
  if (!back && !mesh_before_) back = SameMesh();
}

void Transaction::end_levels() {
  if (is_playback || is_history || levels_go_on_ || !(back || mesh_before_)) return;
  if (back && std::holds_alternative<SameMesh>(*back)) return;
  if (!state.levelling || state.levelling != state_before_.levelling) return;
  // Changed by a command that knows nothing of levels.
  state.levelling = nullptr;
  note("levels end here: this mesh is the base of what is refined from now on");
}

void Transaction::check_pairs() const {
  if (is_playback || is_history || !state.periodic || !(back || mesh_before_)) return;
  check_periodic(*meshed, state.periodic->pairs);
}

std::optional<Step> Transaction::undo_step() {
  if (is_playback || is_history || !core.history.on) return std::nullopt;
  const ModelState &now = state, &then = state_before_;
  if (!back && !mesh_before_ && now.fixed_nodes == then.fixed_nodes && now.schemes == then.schemes &&
      now.groups == then.groups && now.extras == then.extras && now.periodic == then.periodic)
    return std::nullopt;
  if (!back) back = mesh_before_ ? difference(*meshed, **mesh_before_) : SameMesh();
  core.history.undo.reserve(core.history.undo.size() + 1);
  std::optional<Step> step(std::in_place, record().command, now, then, std::move(*back));
  if (auto* whole = std::get_if<WholeMesh>(&step->mesh)) whole->meshed = std::move(*mesh_before_);
  return step;
}

void Transaction::roll_back() noexcept {
  if (mesh_before_) core.exchange_mesh(std::move(*mesh_before_));
  for (; !done_.empty(); done_.pop_back()) {
    if (meshed.is_lent()) core.meshed = MeshHolder(*meshed);  // to whoever was told of the result
    core.topology = nullptr;
    core.neighbours = nullptr;
    MeshedModel& mesh = core.meshed.to_change();
    if (Mesh* lists = std::get_if<Mesh>(&done_.back())) {
      swap_sets(mesh.mesh, *lists);
    } else if (const auto* change = std::get_if<SpliceChange>(&done_.back())) {
      change->splice->make_room(mesh, !change->forward);  // which is there, but in a copy
      change->splice->apply(mesh, !change->forward);
    }
  }
  core.state = std::move(state_before_);
  core.variables = std::move(variables_before_);
}

void Transaction::close_record() {
  CommandRecord& row = record();
  const MeshState planned = row.after;
  row.after = mesh_state(meshed->mesh, state.measured);
  if (row.dry_run) {
    row.after.hexes = planned.hexes;
    row.after.nodes = planned.nodes;
  }
  row.off_cad = state.measured.off_cad;
  row.off_cad_node = row.off_cad.node < 0 ? 0 : node_id(meshed->mesh, row.off_cad.node);
  row.cad_volume = state.cad_volume;
  row.has_cad = state.has_cad;
  row.total_seconds = seconds();
  row.peak_memory_bytes = peak_memory();
}

void Transaction::fail(const CommandError& error) {
  if (!is_playback) roll_back();
  record().error = error.message();
  record().line = error.line();
  record().column = error.column();
  close_record();
}

void transact(Transaction& run, const std::function<void()>& f) {
  const auto failed = [&](const std::string& message) {
    CommandError error = run.statement_ ? error_in(*run.statement_, message) : CommandError(message, message, 0, 0);
    run.fail(error);
    return error;
  };
  std::optional<Step> step;
  try {
    f();
    run.close_stage();
    run.end_levels();
    run.check_pairs();
    step = run.undo_step();
  } catch (const CommandError& error) {
    run.fail(error);
    throw;
  } catch (const std::bad_alloc&) {
    throw failed("out of memory");
  } catch (const std::exception& error) {
    throw failed(error.what());
  } catch (...) {
    failed("stopped");
    throw;
  }
  // Nothing below throws, but for who is told of a journal that ends.
  Session::Core& core = run.core;
  if (step) core.history.add(std::move(*step));
  run.record().ok = true;
  run.close_record();
  if (!run.is_journaled || !core.recording || core.recording->write(run.record().command)) return;
  // What was done stays done.
  const std::string text = core.recording->file.string() + ": can't be written, recording has ended";
  core.recording = nullptr;
  if (core.callbacks.error)
    core.callbacks.error(CommandError(text, text, 0, 0));
  else if (core.callbacks.notice)
    core.callbacks.notice(text);
}

}  // namespace hextwist
