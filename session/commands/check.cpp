#include <algorithm>

#include "hextwist/mesh/association/check.h"
#include "hextwist/mesh/others.h"
#include "hextwist/mesh/validate/validate.h"
#include "hextwist/session/commands/commands.h"

namespace hextwist {
namespace {

void add_violation(CommandRecord& record, const char* kind, const std::string& text) {
  ++record.n_violations;
  if (record.violations.size() < max_violation_rows) record.violations.push_back({kind, text, {}, {}});
}

std::string quality_text(const char* metric, const QualityRow& row) {
  return std::string(metric) + ": smallest " + short_number(row.min) + " (hex " + std::to_string(row.min_hex) +
         "), average " + short_number(row.average) + ", std. dev. " + short_number(row.std_dev);
}

}  // namespace

void do_check(Execution& run) {
  const SessionState& state = run.state;
  const auto& [mesh, model, association] = *run.meshed;
  need_mesh(run, "to check");
  run.stage("validate");
  record_violations(run.record(), mesh, validate(mesh));
  run.stage("check association");
  if (model) {
    for (const std::string& line :
         check_association(mesh, association, *model, std::max(state.tolerance, AssociateOptions().relative_tolerance)))
      add_violation(run.record(), "association", line);
    const OffModel off = off_model(mesh, association, *model);
    if (!(off.max_relative <= state.tolerance)) {  // NaN too
      add_violation(run.record(), "off cad",
                    "node " + std::to_string(node_id(mesh, off.node)) + " lies " + short_number(off.max) + " off " +
                        to_string(off.owner));
    }
    run.say("model: " + std::string(state.has_cad ? "CAD" : "skin of the mesh") + ", " +
            counted(model->count(3), EntityKind::volume) + ", " + counted(model->count(2), EntityKind::surface) + ", " +
            counted(model->count(1), EntityKind::curve) + ", " + counted(model->count(0), EntityKind::vertex));
    if (off.node >= 0)
      run.say("nodes at most " + short_number(off.max) + " off the model (" + short_number(off.max_relative) +
              " of its size), worst: node " + std::to_string(node_id(mesh, off.node)) + " on " + to_string(off.owner));
    run.say("volume: mesh " + short_number(state.measured.volume) + ", model " + short_number(state.cad_volume) + " (" +
            short_number(100 * (state.measured.volume - state.cad_volume) / state.cad_volume) + "%)");
  }
  run.say("mesh: " + counted(mesh.n_hexes(), EntityKind::hex) + ", " + counted(mesh.n_nodes(), EntityKind::node));
  if (mesh.others) run.say("other elements, which are not checked: " + others_text(mesh));
  run.say(quality_text("shape", quality_row(mesh, state.measured.shape)));
  run.say(quality_text("scaled Jacobian", quality_row(mesh, state.measured.scaled_jacobian)));
  for (const ViolationRow& row : run.record().warnings) run.note(row.text);
  if (run.record().n_violations > 0) {
    constexpr std::size_t max_lines = 20;
    const auto& rows = run.record().violations;
    for (std::size_t i = 0; i < std::min(rows.size(), max_lines); ++i) run.say("violation: " + rows[i].text);
    if (rows.size() > max_lines) run.say("... and " + std::to_string(run.record().n_violations - max_lines) + " more");
    throw Error(counted(run.record().n_violations, "violation") +
                ", the first: " + run.record().violations.front().text);
  }
  run.say("no violations");
}

}  // namespace hextwist
