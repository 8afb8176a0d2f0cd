// What a session knows about its mesh, as rows of its records.

#include "hextwist/patch/verify.h"
#include "hextwist/session/session_internal.h"

namespace hextwist {
namespace {

std::string off_text(const OffModel& off, bool has_cad) {
  if (off.node < 0) return "";
  return "; nodes at most " + short_number(off.max) + " off " + (has_cad ? "the CAD" : "the skin");
}

}  // namespace

QualityRow quality_row(const Mesh& mesh, const Summary& summary) {
  if (summary.count == 0) return {};
  return {summary.count,
          summary.min,
          summary.max,
          summary.average,
          summary.std_dev,
          hex_id(mesh, summary.min_hex),
          hex_id(mesh, summary.max_hex)};
}

ViolationRow violation_row(const Mesh& mesh, const Violation& violation) {
  ViolationRow row{name(violation.kind), violation.text, {}, {}};
  for (const Index hex : violation.hexes) row.hexes.push_back(hex_id(mesh, hex));
  for (const Index node : violation.nodes) row.nodes.push_back(node_id(mesh, node));
  return row;
}

std::string record_violations(CommandRecord& record, const Mesh& mesh, const std::vector<Violation>& violations) {
  std::string first;
  for (const Violation& violation : violations) {
    const bool warning = is_warning(violation.kind);
    if (!warning && first.empty()) first = violation.text;
    if (!warning) ++record.n_violations;
    auto& rows = warning ? record.warnings : record.violations;
    if (rows.size() < max_violation_rows) rows.push_back(violation_row(mesh, violation));
  }
  if (record.n_violations <= 1) return first;
  return counted(record.n_violations, "violation") + ", the first: " + first;
}

void take_meshed(SessionState& state, MeshedModel meshed) {
  const Mesh& mesh = meshed.mesh;
  state.mesh_state = {};
  state.mesh_state.hexes = mesh.n_hexes();
  state.mesh_state.nodes = mesh.n_nodes();
  const Measured found = mesh.n_hexes() > 0 ? measured(meshed) : Measured();
  state.mesh_state.shape = quality_row(mesh, found.shape);
  state.mesh_state.scaled_jacobian = quality_row(mesh, found.scaled_jacobian);
  state.mesh_state.volume = found.volume;
  state.off_cad = found.off_cad;
  state.extremes = found.extremes;
  state.cad_volume = 0;
  if (meshed.model)
    for (int id = 1; id <= meshed.model->count(3); ++id) state.cad_volume += meshed.model->measure({3, id});
  state.meshed = std::make_shared<MeshedModel>(std::move(meshed));
}

void say_mesh(const Execution& run, const std::string& what) {
  const Mesh& mesh = run.state.meshed->mesh;
  std::string line =
      what + ": " + counted(mesh.n_hexes(), EntityKind::hex) + ", " + counted(mesh.n_nodes(), EntityKind::node);
  if (!mesh.blocks.empty()) line += ", " + counted(static_cast<std::int64_t>(mesh.blocks.size()), EntityKind::block);
  if (!mesh.node_sets.empty())
    line += ", " + counted(static_cast<std::int64_t>(mesh.node_sets.size()), EntityKind::nodeset);
  if (!mesh.side_sets.empty())
    line += ", " + counted(static_cast<std::int64_t>(mesh.side_sets.size()), EntityKind::sideset);
  const QualityRow& shape = run.state.mesh_state.shape;
  line += "; smallest shape " + short_number(shape.min) + " (hex " + std::to_string(shape.min_hex) + ")";
  run.say(line + off_text(run.state.off_cad, run.state.has_cad));
}

}  // namespace hextwist
