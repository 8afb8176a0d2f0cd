#include "hextwist/session/record.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace hextwist {
namespace {

ViolationRow violation_row(const Mesh& mesh, const Violation& violation) {
  ViolationRow row{name(violation.kind), violation.text, {}, {}};
  for (const Index hex : violation.hexes) row.hexes.push_back(hex_id(mesh, hex));
  for (const Index node : violation.nodes) row.nodes.push_back(node_id(mesh, node));
  return row;
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

MeshState mesh_state(const Mesh& mesh, const Measured& measured) {
  return {mesh.n_hexes(), mesh.n_nodes(), quality_row(mesh, measured.shape),
          quality_row(mesh, measured.scaled_jacobian), measured.volume};
}

SizesRow sizes_row(const Mesh& mesh, const SizeReport& sizes) {
  SizesRow row;
  row.hexes = static_cast<std::int64_t>(sizes.hexes.size());
  row.coarser = sizes.n_coarser;
  row.finer = sizes.n_finer;
  row.much_finer = sizes.n_much_finer;
  row.passes = sizes.n_passes;
  row.met = sizes.met();
  row.met_in_the_end = sizes.moved ? sizes.moved->met() : row.met;
  if (!sizes.ratio.empty()) {
    const auto [least, most] = std::ranges::minmax(sizes.ratio);
    row.smallest_ratio = least;
    row.largest_ratio = most;
  }
  row.n_unmet = static_cast<std::int64_t>(sizes.unmet.size());
  for (std::size_t i = 0; i < std::min(sizes.unmet.size(), max_violation_rows); ++i)
    row.unmet.push_back(hex_id(mesh, sizes.unmet[i]));
  return row;
}

std::string record_violations(CommandRecord& record, const Mesh& mesh, const std::vector<Violation>& violations) {
  record.violations.clear();
  record.warnings.clear();
  record.n_violations = 0;
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

std::string off_text(const char* separator, const OffModel& off, bool has_cad) {
  // A mesh without CAD lies on its own skin but for rounding, which is nothing to say.
  constexpr double rounding = 1e-12;
  if (off.node < 0 || (!has_cad && off.max_relative < rounding)) return "";
  return std::string(separator) + "nodes at most " + short_number(off.max) + " off " +
         (has_cad ? "the CAD" : "the skin");
}

bool Recording::write(const std::string& command) {
  stream << command << std::endl;
  ++n_commands;
  return static_cast<bool>(stream);
}

}  // namespace hextwist
