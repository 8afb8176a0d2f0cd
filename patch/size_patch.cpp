#include "hextwist/patch/size_patch_internal.h"

#include <algorithm>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/patch/extremes.h"
#include "hextwist/patch/forest_patch_internal.h"
#include "hextwist/sizing/stages.h"

namespace hextwist {
namespace {

/// What asks for more touches it, and levels and transitions lie around.
constexpr int rings_cut_at_first = 2, most_rings = 60;

/// Hexes that are too large, and those with two nodes of edges that are too long.
std::vector<Index> asking_hexes(const SizesOfAll& sizes) {
  const Mesh& mesh = sizes.input.mesh;
  if (sizes.too_far.empty()) return sizes.too_large;
  std::vector<std::uint8_t> is_far(mesh.points.size(), 0);
  for (const Index n : sizes.too_far) is_far[n] = 1;
  return union_of(sizes.too_large, indices_where(mesh.n_hexes(), [&](Index h) {
                    return sizes.in_zone[h] &&
                           std::ranges::count_if(mesh.hexes[h], [&](Index n) { return is_far[n] != 0; }) > 1;
                  }));
}

/// The worst shape of the hexes outside of a patch. Nothing: it is not known.
std::optional<double> worst_outside(const MeshedModel& input, const Measured& known, std::span<const Index> hexes) {
  if (!known.extremes) return std::nullopt;
  const auto outside = [&](std::int64_t id) { return !std::ranges::binary_search(hexes, find_hex(input.mesh, id)); };
  const ExtremeList& least = known.extremes->shape[0];
  const auto found = std::ranges::find_if(least, [&](const auto& item) { return outside(item.second); });
  if (found == least.end()) return std::nullopt;
  return found->first;
}

/// A mesh that is the base of nothing yet.
std::optional<PatchResult> in_plain_patch(const SizesOfAll& sizes, const Measured& known, const Report& before,
                                          Approach approach, const Progress& progress, const RingsOf& rings_of,
                                          std::size_t limit) {
  const MeshedModel& input = sizes.input;
  const Request& request = sizes.request;
  const std::vector<Index> asking = asking_hexes(sizes), nodes = nodes_of_hexes(input.mesh, asking);
  for (int n_rings = rings_cut_at_first + enough_rings; n_rings <= most_rings; n_rings *= 2) {
    Report report = before;
    Stages stages(report, progress);
    stages.begin("patch", 0);
    std::optional<Rings> rings = rings_of(input.mesh, nodes, asking, n_rings, limit);
    if (!rings || touch_others(input.mesh, rings->hexes)) return std::nullopt;
    PatchResult made;
    made.patch = make_patch(input, std::move(rings->hexes));
    SizesInPart part(sizes, made.patch.nodes, made.patch.hexes);
    part.ring = rings->ring;
    if (part.n_outside > 0) {
      const std::optional<double> worst = worst_outside(input, known, made.patch.hexes);
      if (!worst) return std::nullopt;
      part.worst_shape_outside = *worst;
    }
    const Request local = request_in_part(request, made.patch.meshed.mesh, made.patch.nodes, made.patch.hexes, {}, {});
    stages.close();
    State run(made.patch.meshed, local, report, progress);
    run.part = &part;
    make_passes(run, approach);
    run.stages.close();
    if (part.is_too_small) return std::nullopt;
    if (!rings->is_all && part.farthest + enough_rings > n_rings) continue;
    if (const LevellingPtr& levelling = run.result().levelling; levelling && !levelling->forest.is_bare()) {
      report.off_nodes.clear();  // they come again
      report.by_whole.clear();
      return refine_wished_levels(input, known, request,
                                  {LocalCells(made.patch.hexes).whole(levelling->forest.wished), sizes, report, true},
                                  progress, rings_of);
    }
    made.result = finish_passes(run);
    made.result.levelling = nullptr;
    made.result.came_from = {};
    made.result.old_node = {};
    const PatchNumbers numbers(made.patch, input, made.result.refined.mesh);
    if (report.sizes->directions) part.outside.directions = sizes.directions(part.outside.hexes);
    report.sizes = whole_sizes(*report.sizes, part.outside, numbers);
    finish_patch(made, input, known, request, numbers, report);
    count_patch(made, input, report);
    made.result.report = std::move(report);
    return made;
  }
  return std::nullopt;
}

/// A mesh that has come out of its base by levels.
std::optional<PatchResult> in_forest_patch(const SizesOfAll& sizes, const Measured& known, const Report& before,
                                           const Progress& progress, const RingsOf& rings_of, std::size_t limit) {
  const MeshedModel& input = sizes.input;
  if (!sizes.request.levelling->forest.grown) return std::nullopt;
  Levelling whole = *sizes.request.levelling;
  const HandedHexes& handed = whole.forest.grown->hexes;
  const Mesh& base = whole.forest.base->mesh;
  // Sizes are asked of the mesh as the levels make it: where nodes were moved since, other hexes may ask.
  std::vector<std::uint8_t> has_moved(input.mesh.points.size(), 0);
  for (const Index n : whole.overlay.nodes) has_moved[n] = 1;
  std::vector<Index> roots;
  for (const Index h : asking_hexes(sizes)) roots.push_back(handed.root(h));
  if (!whole.overlay.nodes.empty())
    for (const Index h : touching_hexes(input.mesh.hexes, has_moved))
      if (sizes.in_zone[h]) roots.push_back(handed.root(h));
  sort_unique(roots);
  const std::vector<Index> nodes = nodes_of_hexes(base, roots);
  Request request = sizes.request;
  for (int n_rings = rings_cut_at_first + enough_rings; n_rings <= most_rings; n_rings *= 2) {
    Report report = before;
    Stages stages(report, progress);
    stages.begin("patch", 0);
    const std::optional<Rings> rings = rings_in_base(whole.forest, nodes, n_rings, limit);
    if (!rings) return std::nullopt;
    std::vector<Index> hexes = hexes_in(handed, rings->hexes);
    if (hexes.size() > limit || touch_others(input.mesh, hexes)) return std::nullopt;
    ForestPatch patch(input, whole, *rings, std::move(hexes));
    SizesInPart part(sizes, patch.patch.nodes, patch.patch.hexes);
    part.n_base_outside = base.n_hexes() - static_cast<Index>(rings->hexes.size());
    Request local = request_in_part(request, patch.patch.meshed.mesh, patch.patch.nodes, patch.patch.hexes, {}, {});
    local.levelling = std::make_shared<const Levelling>(patch.levelling);
    stages.close();
    State run(patch.patch.meshed, local, report, progress);
    run.part = &part;
    const LevelMarks wished = size_wishes(run);
    run.stages.close();
    const bool is_enough =
        rings->is_all || std::ranges::all_of(changed_roots(local.levelling->forest.wished, wished),
                                             [&](Index root) { return rings->ring[root] + enough_rings <= n_rings; });
    if (!is_enough) continue;
    request.levelling = std::make_shared<const Levelling>(whole);  // which knows corners of the base by now
    return refine_wished_levels(input, known, request,
                                {united(whole.forest.wished, patch.cells.whole(wished)), sizes, report, false},
                                progress, rings_of);
  }
  return std::nullopt;
}

}  // namespace

SizeReport whole_sizes(const SizeReport& in_patch, const SizeReport& outside, const PatchNumbers& numbers) {
  std::vector<std::pair<Index, double>> rows;
  for (std::size_t i = 0; i < in_patch.hexes.size(); ++i)
    rows.emplace_back(numbers.hex[in_patch.hexes[i]], in_patch.ratio[i]);
  for (std::size_t i = 0; i < outside.hexes.size(); ++i)
    rows.emplace_back(numbers.hexes.after(outside.hexes[i]), outside.ratio[i]);
  std::ranges::sort(rows);
  SizeReport whole = in_patch;
  whole.hexes.clear();
  whole.ratio.clear();
  for (const auto& [hex, ratio] : rows) {
    whole.hexes.push_back(hex);
    whole.ratio.push_back(ratio);
  }
  whole.n_coarser += outside.n_coarser;
  whole.n_finer += outside.n_finer;
  whole.n_much_finer += outside.n_much_finer;
  if (whole.moved) whole.moved->add(outside.counts());
  for (Index& h : whole.unmet) h = numbers.hex[h];
  std::ranges::sort(whole.unmet);
  if (whole.directions && outside.directions) {
    whole.directions->n_longer += outside.directions->n_longer;
    whole.directions->n_shorter += outside.directions->n_shorter;
  }
  return whole;
}

std::optional<PatchResult> refine_sizes_patch(const MeshedModel& input, const Measured& known, const Request& request,
                                              Approach approach, const Progress& progress, const RingsOf& rings_of) {
  if (std::get<Sizes>(request.how).coarsen || request.finish.level_field) return std::nullopt;
  Report report;
  report.scaled_jacobian_before = known.scaled_jacobian;
  Stages stages(report, progress);
  stages.begin("sizes", 0);
  const SizesOfAll sizes(input, request);
  if (sizes.are_met()) {
    report.notices = sizes.told;
    report.sizes = sizes.report(sizes.region);
    stages.close();
    return nothing_done(input, known, request, std::move(report));
  }
  stages.close();
  const std::size_t limit = input.mesh.hexes.size() / static_cast<std::size_t>(patch_rule.part);
  // A mesh that becomes much larger is made as a whole, and seen to be large before anything is tried.
  if (sizes.too_large.size() > limit || sizes.least_more() > static_cast<double>(limit)) return std::nullopt;
  if (known.scaled_jacobian.min <= 0) return std::nullopt;
  if (has_levels(request) && approach != Approach::size_by_levels) return std::nullopt;  // levels end
  if (has_levels(request)) return in_forest_patch(sizes, known, report, progress, rings_of, limit);
  return in_plain_patch(sizes, known, report, approach, progress, rings_of, limit);
}

}  // namespace hextwist
