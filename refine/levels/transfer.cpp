#include "hextwist/refine/levels/transfer.h"

#include <algorithm>

#include "hextwist/base/parallel.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/refine/origin.h"

namespace hextwist {
namespace {

/// Calls body(node, origin) for the nodes of a pass that were not there before.
template <class Body>
void for_each_fresh_node(const LevelPass& pass, std::span<const Index> old_node, const Body& body) {
  const Lineage& lineage = pass.lineage;
  const auto fresh = [&](Index node, const Origin& origin) {
    if (old_node[node] < 0) body(node, origin);
  };
  parallel_each(lineage.edges.size(), [&](std::size_t i) { for_each_node(lineage, lineage.edges[i], fresh); });
  parallel_each(lineage.faces.size(), [&](std::size_t i) { for_each_node(lineage, lineage.faces[i], fresh); });
  parallel_each(lineage.hexes.size(), [&](std::size_t i) {
    CutHex hex = lineage.hexes[i];
    hex.hex = static_cast<Index>(i);  // where its nodes are in pass.corners
    for_each_node(lineage, hex, pass.corners, fresh);
  });
}

std::vector<double> nodal_values(const LevelChange& change, const Field& field) {
  const auto width = static_cast<std::size_t>(field.components);
  std::vector<double> values;
  resize_for_overwrite(values, change.now.points.size() * width);
  parallel_each(change.now.points.size(), [&](std::size_t n) {
    if (change.old_node[n] < 0) return;
    for (std::size_t c = 0; c < width; ++c) values[n * width + c] = field.values[change.old_node[n] * width + c];
  });
  for (const auto& pass : change.stack)
    for_each_fresh_node(*pass, change.old_node, [&](Index node, const Origin& origin) {
      for (std::size_t c = 0; c < width; ++c) {
        double sum = 0;
        for (int i = 0; i < origin.n; ++i) sum += origin.weight[i] * values[origin.node[i] * width + c];
        values[node * width + c] = sum;
      }
    });
  return values;
}

/// Volumes that hex fields are averaged and shared out with; 0 where nobody asks.
struct Volumes {
  std::vector<double> before;  ///< per item of origin.several
  std::vector<double> of_row;  ///< per row: sum of the hexes now that share it
  std::vector<double> of_hex;  ///< per hex before: sum of those now that are finer
  std::vector<double> now;     ///< per hex now that is not the same
};

Volumes volumes(const LevelChange& change, bool extensive) {
  const LevelOrigin& origin = change.origin;
  Volumes result;
  result.before = quality(Metric::volume, change.before, origin.several.items);
  if (!extensive) return result;
  const auto n = static_cast<Index>(origin.kind.size());
  result.now.assign(origin.kind.size(), 0);
  result.of_row.assign(static_cast<std::size_t>(origin.several.size()), 0);
  result.of_hex.assign(change.before.hexes.size(), 0);
  for (Index h = 0; h < n; ++h) {
    if (origin.kind[h] == HexOrigin::same) continue;
    result.now[h] = volume(change.now, h);
    (origin.kind[h] == HexOrigin::finer ? result.of_hex : result.of_row)[origin.at[h]] += result.now[h];
  }
  return result;
}

std::vector<double> hex_values(const LevelChange& change, const Volumes& volume, const Field& field, bool extensive) {
  const LevelOrigin& origin = change.origin;
  const auto width = static_cast<std::size_t>(field.components);
  const auto value = [&](Index hex, std::size_t c) { return field.values[hex * width + c]; };
  std::vector<double> rows(static_cast<std::size_t>(origin.several.size()) * width);
  parallel_each(static_cast<std::size_t>(origin.several.size()), [&](std::size_t row) {
    const std::span<const Index> hexes = origin.several[static_cast<Index>(row)];
    for (std::size_t c = 0; c < width; ++c) {
      // From the first value, so that the average of equal ones is just that.
      double sum = 0, total = 0;
      for (std::size_t i = 0; i < hexes.size(); ++i) {
        const double weight = extensive ? 1 : volume.before[origin.several.first[row] + i];
        sum += weight * (extensive ? value(hexes[i], c) : value(hexes[i], c) - value(hexes[0], c));
        total += weight;
      }
      rows[row * width + c] = extensive ? sum : value(hexes[0], c) + (total > 0 ? sum / total : 0);
    }
  });
  std::vector<double> values;
  resize_for_overwrite(values, origin.kind.size() * width);
  parallel_each(origin.kind.size(), [&](std::size_t h) {
    const Index at = origin.at[h];
    const bool from_row = origin.kind[h] == HexOrigin::coarser;
    double share = 1;
    if (extensive && origin.kind[h] != HexOrigin::same)
      share = volume.now[h] / (from_row ? volume.of_row : volume.of_hex)[at];
    for (std::size_t c = 0; c < width; ++c)
      values[h * width + c] = share * (from_row ? rows[at * width + c] : value(at, c));
  });
  return values;
}

}  // namespace

std::vector<Field> transferred_fields(const LevelChange& change, std::span<const std::string> extensive) {
  std::vector<Field> fields;
  if (change.before.fields.empty()) return fields;
  const auto is_extensive = [&](const Field& field) {
    return std::ranges::find(extensive, field.name) != extensive.end();
  };
  const Volumes volume = volumes(change, std::ranges::any_of(change.before.fields, is_extensive));
  for (const Field& field : change.before.fields)
    fields.push_back({field.name, field.on, field.components,
                      field.on == Field::On::node ? nodal_values(change, field)
                                                  : hex_values(change, volume, field, is_extensive(field))});
  return fields;
}

}  // namespace hextwist
