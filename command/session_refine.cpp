#include <algorithm>

#include "hextwist/command/session_internal.h"
#include "hextwist/sizing/verify.h"

namespace hextwist {
namespace {

constexpr int max_local_numsplit = 8;

Request request_of(const Execution& run) {
  const Command& command = run.command;
  const Item& range = *command.find("range");
  Request request;
  request.kind = static_cast<TargetKind>(range.kind);  // the same order, as far as that goes
  static_assert(static_cast<int>(TargetKind::volume) == static_cast<int>(EntityKind::volume));
  request.targets = run.chosen(range);
  const bool whole =
      range.kind == EntityKind::volume && static_cast<int>(request.targets.size()) == run.state.meshed->model->count(3);
  if (is_cad(range.kind))
    for (Index& target : request.targets) ++target;
  if (const Item* splits = command.find("splits")) {
    request.numsplit = static_cast<int>(splits->number);
    if (request.numsplit > max_local_numsplit && !whole)
      throw error_at(
          command.statement, splits->token,
          "numsplit must be at most " + std::to_string(max_local_numsplit) + " unless all volumes are refined");
  }
  if (const Item* layers = command.find("layers")) request.depth = static_cast<int>(layers->number);
  if (const Item* growth = command.find("growth"); growth && growth->number != 1)
    throw error_at(command.statement, growth->token, "a bias other than 1 is not supported yet");
  request.concave = command.has("fill") ? Concave::fill : Concave::templates;
  request.smooth = command.has("smooth");
  for (const Method method : {Method::automatic, Method::single, Method::parallel, Method::combination})
    if (command.has(name(method))) request.method = method;
  if (run.state.fixed_nodes) request.fixed = *run.state.fixed_nodes;
  request.dry_run = command.has("dry_run");
  return request;
}

/// What the session knows of its mesh, so that it need not be measured again.
Measured known_of(const SessionState& state) {
  const auto summary = [&](const QualityRow& row) {
    const Mesh& mesh = state.meshed->mesh;
    return Summary{
        static_cast<Index>(row.count), row.average, row.std_dev, row.min, row.max, find_hex(mesh, row.min_hex),
        find_hex(mesh, row.max_hex)};
  };
  return {summary(state.mesh_state.shape), summary(state.mesh_state.scaled_jacobian), state.mesh_state.volume,
          state.off_cad};
}

std::string summary_of(const Report& report, bool has_cad, bool dry_run) {
  std::string line = std::to_string(report.hexes_before) + " -> " + counted(report.hexes_after, EntityKind::hex);
  if (report.filled_hexes > 0)
    line += " (" + std::to_string(report.filled_hexes) + " joined the region to make it convex)";
  if (dry_run) return line + ", " + counted(report.nodes_after, EntityKind::node) + "; nothing was changed";
  line += ", smallest shape " + short_number(report.shape_before.min) + " -> " + short_number(report.shape_after.min);
  if (report.off_cad.node >= 0)
    line += ", nodes at most " + short_number(report.off_cad.max) + " off " + (has_cad ? "the CAD" : "the skin");
  return line + ", " + short_number(report.total_seconds) + " s";
}

}  // namespace

void do_refine(Execution& run) {
  SessionState& state = run.state;
  if (state.meshed->mesh.n_hexes() == 0)
    throw error_at(run.command.statement, run.command.items.front().token, "there is no mesh to refine");
  run.stage("select");
  const Request request = request_of(run);
  run.close_stage();
  RefineResult result = refine(*state.meshed, known_of(state), request, run.core.callbacks.progress);
  const Report& report = result.report;
  run.record.filled_hexes = report.filled_hexes;
  run.record.seconds.insert(run.record.seconds.end(), report.seconds.begin(), report.seconds.end());
  for (const std::string& line : report.notices) run.note(line);
  const std::string line = text_of(run.command.statement) + ": " + summary_of(report, state.has_cad, request.dry_run);
  if (request.dry_run) {
    run.record.dry_run = true;
    run.record.after.hexes = report.hexes_after;
    run.record.after.nodes = report.nodes_after;
    return run.say(line);
  }

  const Mesh& mesh = result.refined.mesh;
  const std::string wrong = record_violations(run.record, mesh, report.violations);
  if (!wrong.empty()) throw Error("the result would be no good and is dropped: " + wrong);
  if (!report.off_nodes.empty()) {
    const auto worst = std::ranges::max_element(report.off_nodes, {}, &Disappointment::distance);
    run.note(counted(static_cast<std::int64_t>(report.off_nodes.size()), EntityKind::node) +
             " could not be put where they belong; the worst is node " + std::to_string(node_id(mesh, worst->node)) +
             ", " + short_number(worst->distance) + " from " + to_string(worst->owner));
  }
  // The engine measured the result already.
  state.mesh_state.hexes = mesh.n_hexes();
  state.mesh_state.nodes = mesh.n_nodes();
  state.mesh_state.shape = quality_row(mesh, report.shape_after);
  state.mesh_state.scaled_jacobian = quality_row(mesh, report.scaled_jacobian_after);
  state.mesh_state.volume = report.volume_after;
  state.off_cad = report.off_cad;
  state.tags = nullptr;
  state.meshed = std::make_shared<MeshedModel>(std::move(result.refined));
  run.say(line);
}

}  // namespace hextwist
