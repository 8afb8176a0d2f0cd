#include "hextwist/sizing/adapt.h"

#include <algorithm>
#include <cmath>

#include "hextwist/mesh/parallel_internal.h"
#include "hextwist/sizing/size_field.h"

namespace hextwist {
namespace {

/// The mesh with its field of levels.
Mesh with_levels(const Mesh& mesh, std::span<const int> level) {
  Mesh result = mesh;
  const auto found = std::ranges::find_if(
      result.fields, [](const Field& field) { return field.name == level_field && field.on == Field::On::hex; });
  if (found == result.fields.end())
    result.fields.push_back({level_field, Field::On::hex, 1, {level.begin(), level.end()}});
  return result;
}

Field& level_values(Mesh& mesh) {
  return *std::ranges::find_if(
      mesh.fields, [](const Field& field) { return field.name == level_field && field.on == Field::On::hex; });
}

void check_length(const MeshedModel& input, std::size_t n, const char* what) {
  if (n != input.mesh.hexes.size())
    throw Error("there are " + std::to_string(n) + " " + what + " for " + std::to_string(input.mesh.n_hexes()) +
                " hexes");
}

AdaptResult unchanged(const MeshedModel& input, std::span<const int> level) {
  AdaptResult result;
  result.refined = {with_levels(input.mesh, level), input.model, input.association};
  for (Index h = 0; h < input.mesh.n_hexes(); ++h) result.origin.push_back(h);
  result.report.hexes_before = result.report.hexes_after = input.mesh.n_hexes();
  result.report.nodes_before = result.report.nodes_after = input.mesh.n_nodes();
  return result;
}

AdaptResult run(const MeshedModel& input, const Request& request, const Progress& progress) {
  RefineResult refined = refine(input, request, progress);
  return {std::move(refined.refined), std::move(refined.origin), std::move(refined.report)};
}

}  // namespace

std::vector<int> levels(const Mesh& mesh) {
  std::vector<int> result(mesh.hexes.size(), 0);
  const auto found = std::ranges::find_if(mesh.fields, [](const Field& field) {
    return field.name == level_field && field.on == Field::On::hex && field.components == 1;
  });
  if (found != mesh.fields.end())
    for (std::size_t h = 0; h < result.size(); ++h) result[h] = static_cast<int>(std::lround(found->values[h]));
  return result;
}

Index close_flags(const Mesh& mesh, std::span<const int> level, std::span<std::uint8_t> flags) {
  // From the finest down: the highest level of a flagged hex at each node flags all lower ones there.
  Index n_added = 0;
  std::vector<int> highest(mesh.points.size(), -1);
  std::vector<Index> fresh = where(mesh.n_hexes(), [&](Index h) { return flags[h] != 0; });
  while (!fresh.empty()) {
    for (const Index h : fresh)
      for (const Index n : mesh.hexes[h]) highest[n] = std::max(highest[n], level[h]);
    fresh = where(mesh.n_hexes(), [&](Index h) {
      return !flags[h] && std::ranges::any_of(mesh.hexes[h], [&](Index n) { return highest[n] > level[h]; });
    });
    for (const Index h : fresh) flags[h] = 1;
    n_added += static_cast<Index>(fresh.size());
  }
  return n_added;
}

AdaptResult adapt(const MeshedModel& input, std::span<const std::uint8_t> flags, const AdaptOptions& options,
                  const Progress& progress) {
  check_length(input, flags.size(), "flags");
  const std::vector<int> level = levels(input.mesh);
  std::vector<std::uint8_t> wanted(flags.begin(), flags.end());
  const Index n_added = options.keep_gradation ? close_flags(input.mesh, level, wanted) : 0;
  Request request{.kind = TargetKind::hex, .concave = options.concave, .smooth = options.smooth};
  request.targets = where(input.mesh.n_hexes(), [&](Index h) { return wanted[h] != 0; });
  if (request.targets.empty()) return unchanged(input, level);
  const MeshedModel leveled{with_levels(input.mesh, level), input.model, input.association};
  AdaptResult result = run(leveled, request, progress);
  std::vector<double>& values = level_values(result.refined.mesh).values;
  for (std::size_t h = 0; h < values.size(); ++h)
    if (wanted[result.origin[h]]) values[h] = level[result.origin[h]] + 1;
  if (n_added > 0)
    result.report.notices.push_back("cut " + std::to_string(n_added) +
                                    " hexes more than flagged, to keep neighbours within one level");
  return result;
}

AdaptResult adapt(const MeshedModel& input, std::span<const double> sizes, const AdaptOptions& options,
                  const Progress& progress) {
  check_length(input, sizes.size(), "sizes");
  auto background = std::make_shared<Mesh>();
  background->points = input.mesh.points;
  background->hexes = input.mesh.hexes;
  background->hex_ids = input.mesh.hex_ids;
  background->fields.push_back({"size", Field::On::hex, 1, {sizes.begin(), sizes.end()}});
  Request request{.kind = TargetKind::hex,
                  .bias = options.bias,
                  .size_field = field_size(background, "size"),
                  .concave = options.concave,
                  .smooth = options.smooth};
  request.targets = where(input.mesh.n_hexes(), [](Index) { return true; });
  const std::vector<int> level = levels(input.mesh);
  const MeshedModel leveled{with_levels(input.mesh, level), input.model, input.association};
  return run(leveled, request, progress);
}

}  // namespace hextwist
