// What a command did as the rows of the JSON report and the dictionaries of Python: a field added here is in both.
// Whoever includes this links nlohmann_json; the library itself does not.
#pragma once

#include <nlohmann/json.hpp>

#include "hextwist/session/session.h"

namespace hextwist {

using Json = nlohmann::ordered_json;

inline Json quality_json(const QualityRow& row) {
  if (row.count == 0) return nullptr;
  return {{"min", row.min},         {"max", row.max},         {"average", row.average}, {"std_dev", row.std_dev},
          {"min_hex", row.min_hex}, {"max_hex", row.max_hex}, {"count", row.count}};
}

inline Json sizes_json(const SizesRow& row) {
  if (row.hexes == 0) return nullptr;
  return {{"hexes", row.hexes},
          {"passes", row.passes},
          {"met", row.met},
          {"met_in_the_end", row.met_in_the_end},
          {"coarser", row.coarser},
          {"finer", row.finer},
          {"much_finer", row.much_finer},
          {"smallest_ratio", row.smallest_ratio},
          {"largest_ratio", row.largest_ratio},
          {"n_unmet", row.n_unmet},
          {"unmet", row.unmet}};
}

inline Json violations_json(const std::vector<ViolationRow>& rows) {
  Json result = Json::array();
  for (const ViolationRow& row : rows)
    result.push_back({{"kind", row.kind}, {"text", row.text}, {"hexes", row.hexes}, {"nodes", row.nodes}});
  return result;
}

/// Fields in their order are described in docs/commands.md. Texts need not be UTF-8.
inline Json record_json(const CommandRecord& record) {
  Json seconds = {{"total", record.total_seconds}};
  for (const StageTime& stage : record.seconds) {
    const double before = seconds.value(stage.stage, 0.0);
    seconds[stage.stage] = before + stage.seconds;
  }
  const bool off = record.off_cad.node >= 0;
  Json row;
  row["command"] = record.command;
  row["ok"] = record.ok;
  row["error"] = record.ok ? Json() : Json(record.error);
  if (record.column > 0) row["error_place"] = {{"line", record.line}, {"column", record.column}};
  row["hexes_before"] = record.before.hexes;
  row["hexes_after"] = record.after.hexes;
  row["nodes_before"] = record.before.nodes;
  row["nodes_after"] = record.after.nodes;
  row["filled_hexes"] = record.filled_hexes;
  row["dry_run"] = record.dry_run;
  row["sizes"] = sizes_json(record.sizes);
  row["shape"] = {{"before", quality_json(record.before.shape)}, {"after", quality_json(record.after.shape)}};
  row["scaled_jacobian"] = {{"before", quality_json(record.before.scaled_jacobian)},
                            {"after", quality_json(record.after.scaled_jacobian)}};
  row["off_cad"] = {{"max", record.off_cad.max},
                    {"max_relative", record.off_cad.max_relative},
                    {"node", off ? Json(record.off_cad_node) : Json()},
                    {"owner", off ? Json(to_string(record.off_cad.owner)) : Json()},
                    {"model", record.has_cad ? "cad" : "skin"}};
  row["volume"] = {{"before", record.before.volume}, {"after", record.after.volume}, {"model", record.cad_volume}};
  row["n_violations"] = record.n_violations;
  row["violations"] = violations_json(record.violations);
  row["warnings"] = violations_json(record.warnings);
  row["notices"] = record.notices;
  row["seconds"] = seconds;
  row["peak_memory_bytes"] = record.peak_memory_bytes;
  return row;
}

}  // namespace hextwist
