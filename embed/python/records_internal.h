// Records of commands as dictionaries.
#pragma once

#include "hextwist/embed/python/convert_internal.h"

namespace hextwist::python {

inline py::object quality_dict(const QualityRow& row) {
  if (row.count == 0) return py::none();
  using namespace py::literals;
  return py::dict("min"_a = row.min, "max"_a = row.max, "average"_a = row.average, "std_dev"_a = row.std_dev,
                  "min_hex"_a = row.min_hex, "max_hex"_a = row.max_hex, "count"_a = row.count);
}

inline py::object sizes_dict(const SizesRow& row) {
  if (row.hexes == 0) return py::none();
  using namespace py::literals;
  return py::dict("hexes"_a = row.hexes, "passes"_a = row.passes, "met"_a = row.met, "coarser"_a = row.coarser,
                  "finer"_a = row.finer, "much_finer"_a = row.much_finer, "smallest_ratio"_a = row.smallest_ratio,
                  "largest_ratio"_a = row.largest_ratio, "n_unmet"_a = row.n_unmet, "unmet"_a = row.unmet);
}

inline py::list violation_list(const std::vector<ViolationRow>& rows) {
  using namespace py::literals;
  py::list result;
  for (const ViolationRow& row : rows)
    result.append(
        py::dict("kind"_a = row.kind, "text"_a = text(row.text), "hexes"_a = row.hexes, "nodes"_a = row.nodes));
  return result;
}

inline py::list text_list(const std::vector<std::string>& lines) {
  py::list result;
  for (const std::string& line : lines) result.append(text(line));
  return result;
}

inline py::dict record_dict(const CommandRecord& record) {
  using namespace py::literals;
  py::dict seconds("total"_a = record.total_seconds);
  for (const StageTime& stage : record.seconds) {
    const py::str name(stage.stage);
    seconds[name] = stage.seconds + (seconds.contains(name) ? seconds[name].cast<double>() : 0.0);
  }
  const auto both = [](const py::object& before, const py::object& after) {
    return py::dict("before"_a = before, "after"_a = after);
  };
  const bool off = record.off_cad.node >= 0;
  py::dict row("command"_a = text(record.command), "ok"_a = record.ok);
  row["error"] = record.ok ? py::object(py::none()) : py::object(text(record.error));
  if (record.column > 0) row["error_place"] = py::dict("line"_a = record.line, "column"_a = record.column);
  row["hexes_before"] = record.before.hexes;
  row["hexes_after"] = record.after.hexes;
  row["nodes_before"] = record.before.nodes;
  row["nodes_after"] = record.after.nodes;
  row["filled_hexes"] = record.filled_hexes;
  row["dry_run"] = record.dry_run;
  row["sizes"] = sizes_dict(record.sizes);
  row["shape"] = both(quality_dict(record.before.shape), quality_dict(record.after.shape));
  row["scaled_jacobian"] =
      both(quality_dict(record.before.scaled_jacobian), quality_dict(record.after.scaled_jacobian));
  row["off_cad"] = py::dict("max"_a = record.off_cad.max, "max_relative"_a = record.off_cad.max_relative,
                            "node"_a = off ? py::object(py::int_(record.off_cad_node)) : py::object(py::none()),
                            "owner"_a = off ? py::object(py::str(to_string(record.off_cad.owner))) : py::none(),
                            "model"_a = record.has_cad ? "cad" : "skin");
  row["volume"] =
      py::dict("before"_a = record.before.volume, "after"_a = record.after.volume, "model"_a = record.cad_volume);
  row["n_violations"] = record.n_violations;
  row["violations"] = violation_list(record.violations);
  row["warnings"] = violation_list(record.warnings);
  row["notices"] = text_list(record.notices);
  row["seconds"] = seconds;
  row["peak_memory_bytes"] = record.peak_memory_bytes;
  return row;
}

}  // namespace hextwist::python
