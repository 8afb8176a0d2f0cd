#include "hextwist/patch/adapt.h"

#include <algorithm>
#include <cmath>

#include "hextwist/base/parallel.h"
#include "hextwist/patch/refine.h"
#include "hextwist/refine/marks.h"
#include "hextwist/sizing/fields/size_field.h"
#include "hextwist/sizing/levels.h"

namespace hextwist {
namespace {

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

AdaptResult adapt(const MeshedModel& input, std::span<const std::uint8_t> flags, const AdaptOptions& options,
                  const Progress& progress) {
  check_length(input, flags.size(), "flags");
  const std::vector<int> level = levels(input.mesh);
  Request request{.kind = TargetKind::hex, .concave = options.concave, .smooth = options.smooth};
  request.levels = options.keep_gradation ? Levels::graded : Levels::counted;
  request.targets = indices_where(input.mesh.n_hexes(), [&](Index h) { return flags[h] != 0; });
  if (request.targets.empty()) return unchanged(input, level);
  return run({with_levels(input.mesh, level), input.model, input.association}, request, progress);
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
  request.levels = options.keep_gradation ? Levels::graded : Levels::counted;
  request.targets = indices_where(input.mesh.n_hexes(), [](Index) { return true; });
  return run({with_levels(input.mesh, levels(input.mesh)), input.model, input.association}, request, progress);
}

}  // namespace hextwist
