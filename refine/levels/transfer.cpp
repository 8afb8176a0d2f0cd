#include "hextwist/refine/levels/transfer.h"

#include <algorithm>
#include <cmath>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/io/results.h"
#include "hextwist/mesh/nodal_fields.h"
#include "hextwist/mesh/quality/quality.h"

namespace hextwist {
namespace {

/// Per hex now a hex before that it is, lies in or is made of.
std::vector<Index> hexes_before(const LevelOrigin& origin) {
  std::vector<Index> result(origin.kind.size());
  parallel_each(result.size(), [&](std::size_t h) { result[h] = origin.before(static_cast<Index>(h)).front(); });
  return result;
}

/// Volumes that hex fields are averaged and shared out with; 0 where nobody asks.
struct Volumes {
  std::vector<double> before;     ///< per item of origin.several
  std::vector<double> of_row;     ///< per row: sum of the hexes now that share it
  std::vector<double> of_hex;     ///< per hex before: sum of those now that are finer
  std::vector<double> now;        ///< per hex now that is not the same
  std::vector<double> before_it;  ///< per hex now: of those that share with it and come first
};

Volumes volumes(const Mesh& before, const Mesh& now, const LevelOrigin& origin, bool extensive) {
  Volumes result;
  result.before = quality(Metric::volume, before, origin.several.items);
  if (!extensive) return result;
  const auto n = static_cast<Index>(origin.kind.size());
  result.now.assign(origin.kind.size(), 0);
  result.before_it.assign(origin.kind.size(), 0);
  result.of_row.assign(static_cast<std::size_t>(origin.several.size()), 0);
  result.of_hex.assign(before.hexes.size(), 0);
  for (Index h = 0; h < n; ++h) {
    if (origin.kind[h] == HexOrigin::same) continue;
    result.now[h] = volume(now, h);
    double& sum = (origin.kind[h] == HexOrigin::finer ? result.of_hex : result.of_row)[origin.at[h]];
    result.before_it[h] = sum;
    sum += result.now[h];
  }
  return result;
}

std::vector<double> hex_values(const LevelOrigin& origin, const Volumes& volume, const Field& field, bool extensive) {
  const auto width = static_cast<std::size_t>(field.components);
  const auto value = [&](Index hex, std::size_t c) { return field.values[hex * width + c]; };
  std::vector<double> rows(static_cast<std::size_t>(origin.several.size()) * width);
  parallel_each(static_cast<std::size_t>(origin.several.size()), [&](std::size_t row) {
    const std::span<const Index> hexes = origin.several[static_cast<Index>(row)];
    if (field.integer && !extensive) {
      const double* const volumes = &volume.before[origin.several.first[row]];
      const auto largest = static_cast<std::size_t>(std::max_element(volumes, volumes + hexes.size()) - volumes);
      for (std::size_t c = 0; c < width; ++c) rows[row * width + c] = value(hexes[largest], c);
      return;
    }
    for (std::size_t c = 0; c < width; ++c) {
      // From the first value, so that the average of equal ones is just that.
      double sum = 0, total = 0;
      for (std::size_t i = 0; i < hexes.size(); ++i) {
        const double weight = extensive ? 1 : volume.before[origin.several.first[row] + i];
        if (extensive)
          sum += value(hexes[i], c);
        else if (value(hexes[i], c) != value(hexes[0], c))
          sum += weight * (value(hexes[i], c) - value(hexes[0], c));
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
    const bool is_shared = extensive && origin.kind[h] != HexOrigin::same;
    const double all = is_shared ? (from_row ? volume.of_row : volume.of_hex)[at] : 1;
    for (std::size_t c = 0; c < width; ++c) {
      const double whole = from_row ? rows[at * width + c] : value(at, c);
      double& to = values[h * width + c];
      if (!is_shared)
        to = whole;
      else if (!field.integer)
        to = volume.now[h] / all * whole;
      else  // what is counted stays whole, and all that share have all of it
        to = std::round((volume.before_it[h] + volume.now[h]) / all * whole) -
             std::round(volume.before_it[h] / all * whole);
    }
  });
  return values;
}

bool is_one_of(std::span<const std::string> names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// Does the file have values of fields called so, other than those of the moment?
bool has_more_of(const FileResults& results, std::span<const std::string> extensive) {
  return results.times.size() > 1 && std::ranges::any_of(results.on_hexes, [&](const TimedValues& values) {
           return is_one_of(extensive, values.name);
         });
}

/// Is a hex made of hexes that lie in several of the file?
bool joins_hexes_of_file(const LevelOrigin& origin, const Mesh& before) {
  for (Index row = 0; row < origin.several.size(); ++row) {
    const std::span<const Index> hexes = origin.several[row];
    if (std::ranges::any_of(hexes, [&](Index h) { return before.file_hexes[h] != before.file_hexes[hexes[0]]; }))
      return true;
  }
  return false;
}

}  // namespace

std::vector<Field> transferred_fields(const LevelChange& change, std::span<const std::string> extensive) {
  std::vector<Field> fields;
  if (change.before.fields.empty()) return fields;
  const auto is_extensive = [&](const Field& field) { return is_one_of(extensive, field.name); };
  const Volumes volume =
      volumes(change.before, change.now, change.origin, std::ranges::any_of(change.before.fields, is_extensive));
  for (const Field& field : change.before.fields) {
    fields.push_back({field.name, field.on, field.components, {}, field.integer});
    if (field.on == Field::On::hex) {
      fields.back().values = hex_values(change.origin, volume, field, is_extensive(field));
      continue;
    }
    const auto width = static_cast<std::size_t>(field.components);
    fields.back().values.resize(change.now.points.size() * width);
    parallel_each(change.now.points.size(), [&](std::size_t n) {
      if (const Index old = change.old_node[n]; old >= 0)
        std::copy_n(&field.values[static_cast<std::size_t>(old) * width], width, &fields.back().values[n * width]);
    });
  }
  const auto is_elsewhere = [&](Index n) {
    return change.old_node[n] < 0 || change.before.points[change.old_node[n]] != change.now.points[n];
  };
  if (has_nodal_fields(change.before))
    evaluate_nodal_fields(change.before, change.now, indices_where(change.now.n_nodes(), is_elsewhere),
                          hexes_before(change.origin), fields);
  return fields;
}

bool results_take_all(const Mesh& mesh, const Mesh* base, std::span<const std::string> extensive) {
  if (!mesh.results || mesh.file_hexes.empty() || !mesh.results->has_places()) return false;
  return (base && base->file_hexes.empty()) || has_more_of(*mesh.results, extensive);
}

void carry_results(const Mesh& before, const LevelOrigin& origin, std::span<const std::string> extensive, Mesh& now) {
  now.results = before.results;  // which know the time that the fields are of
  if (before.file_hexes.empty()) return;
  now.file_hexes = items_at(before.file_hexes, hexes_before(origin));
  if (!now.results || !now.results->has_places()) return;
  if (!joins_hexes_of_file(origin, before) && !has_more_of(*now.results, extensive)) return;
  const Volumes volume = volumes(before, now, origin, true);
  const std::span<const std::string> shared =
      has_more_of(*now.results, extensive) ? extensive : std::span<const std::string>();
  const std::shared_ptr<FileResults> results =
      results_on({before, now, [&](Index hex) { return origin.before(hex); },
                  [&](const std::string& name, std::vector<double> values) {
                    const Field field{"", Field::On::hex, 1, std::move(values)};
                    return hex_values(origin, volume, field, is_one_of(shared, name));
                  }});
  place_in_itself(now, *results);
  now.results = results;
}

void share_out(const Mesh& before, std::span<const Index> origin, std::span<const std::string> extensive, Mesh& now) {
  if (extensive.empty()) return;
  std::vector<Index> n_now(before.hexes.size(), 0);
  for (const Index h : origin) ++n_now[h];
  LevelOrigin cut{std::vector(origin.size(), HexOrigin::same), {origin.begin(), origin.end()}, {{0}, {}}};
  for (std::size_t h = 0; h < origin.size(); ++h)
    if (n_now[origin[h]] > 1) cut.kind[h] = HexOrigin::finer;
  const Volumes volume = volumes(before, now, cut, true);
  for (Field& field : now.fields) {
    if (field.on != Field::On::hex || !is_one_of(extensive, field.name)) continue;
    const auto was = std::ranges::find_if(
        before.fields, [&](const Field& other) { return other.on == field.on && other.name == field.name; });
    if (was != before.fields.end()) field.values = hex_values(cut, volume, *was, true);
  }
  if (results_take_all(before, nullptr, extensive)) carry_results(before, cut, extensive, now);
}

}  // namespace hextwist
