#include "hextwist/sizing/techniques/level_sizes_internal.h"

#include <algorithm>

#include "hextwist/base/parallel.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/sizing/among_parts.h"
#include "hextwist/sizing/size_report.h"
#include "hextwist/sizing/sizes_of_all.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

/// Per node the level of the hexes around it; -1 where these are not all regular cells of one level.
std::vector<std::int8_t> regular_levels(const Mesh& mesh, const LevelPieces& pieces) {
  constexpr std::int8_t nothing_yet = -2;
  std::vector<std::int8_t> result(mesh.points.size(), nothing_yet);
  for (int block = 0; block < pieces.n_levels(); ++block)
    for (Index h = pieces.first[block]; h < pieces.first[block + 1]; ++h) {
      const auto level = static_cast<std::int8_t>(pieces.leaf(block, h).level == block ? block : -1);
      for (const Index n : mesh.hexes[h]) {
        std::int8_t& here = result[n];
        here = here == nothing_yet || here == level ? level : std::int8_t{-1};
      }
    }
  return result;
}

/// in_zone, in_report: per hex that the mesh came from.
SizeReport report_on(const RefineResult& made, const SizeWish& wish, std::span<const std::uint8_t> in_zone,
                     std::span<const std::uint8_t> in_report) {
  const Mesh& mesh = made.refined.mesh;
  const LevelOrigin& origin = made.came_from;
  std::vector<std::uint8_t> zone(mesh.hexes.size()), reported(mesh.hexes.size());
  parallel_each(zone.size(), [&](std::size_t i) {
    const auto h = static_cast<Index>(i);
    const auto any = [&](std::span<const std::uint8_t> of) {
      return std::ranges::any_of(origin.before(h), [&](Index b) { return of[b] != 0; });
    };
    zone[i] = any(in_zone);
    reported[i] = any(in_report) || (wish.is_everywhere() && origin.kind[h] != HexOrigin::same);
  });
  SizeReport report =
      size_report(mesh, indices_where(mesh.n_hexes(), [&](Index h) { return reported[h] != 0; }), wish.field());
  report.unmet = wish.too_large(mesh, zone);
  return report;
}

}  // namespace

LevelSizes::LevelSizes(const Forest& forest, State& state)
    : forest_(forest),
      state_(state),
      sizes_(std::get<Sizes>(state.request.how)),
      wish_(size_wish(state)),
      in_report_(state.input.mesh.hexes.size(), 0) {
  const std::vector<Index> region = size_region(state);
  in_zone_ = wish_->zone(state.input.mesh, region);
  for (const Index h : region) in_report_[h] = 1;
}

LevelMarks LevelSizes::more(const Mesh& mesh, const LevelPieces& pieces, std::span<const std::uint8_t> in_zone) const {
  const std::vector<Index> too_large = wish_->too_large(mesh, in_zone);
  wish_->check_fits(mesh, too_large, n_outside(state_), true);
  const std::vector<Index> too_far = wish_->nodes_too_far_apart(mesh, in_zone);
  std::vector<std::uint8_t> marked = wish_->marks(mesh, too_large, too_far);
  if (marked.empty()) return {};
  // Hexes that ask: for some of their edges or, when none of these can be had, for being cut.
  std::vector<std::uint8_t> asks(mesh.hexes.size(), 0), is_far(mesh.points.size(), 0);
  for (const Index h : too_large) asks[h] = 1;
  for (const Index n : too_far) is_far[n] = 1;
  const std::vector<std::int8_t> level_at = regular_levels(mesh, pieces);
  for (std::size_t n = 0; n < marked.size(); ++n) marked[n] &= static_cast<std::uint8_t>(level_at[n] >= 0);

  const Index n_base_outside = state_.part ? state_.part->n_base_outside : state_.among ? state_.among->n_outside : 0;
  const int most = std::min(sizes_.max_passes, max_level(forest_.base->mesh.n_hexes() + n_base_outside));
  LevelMarks marks(static_cast<std::size_t>(std::min(most, pieces.n_levels())));
  for (int block = 0; block < pieces.n_levels(); ++block)
    for (Index h = pieces.first[block]; h < pieces.first[block + 1]; ++h) {
      const LevelPieces::Leaf leaf = pieces.leaf(block, h);
      if (leaf.level >= most) continue;
      const int mask = corner_mask(mesh.hexes[h], marked);
      if (leaf.level == block && edge_mask_of_corners(mask) != 0)
        marks[leaf.level].add(leaf.cell, static_cast<std::uint8_t>(mask));
      else if (asks[h] || (in_zone[h] && edge_mask_of_corners(corner_mask(mesh.hexes[h], is_far)) != 0))
        marks[leaf.level].add(leaf.cell);
    }
  return closed(std::move(marks));
}

LevelMarks LevelSizes::wishes(LevelOptions& options) {
  const MeshedModel& base = *forest_.base;
  const std::vector<std::uint8_t> zone_before = by_level(forest_, std::span<const std::uint8_t>(in_zone_));
  Forest forest = forest_;  // with other wishes
  if (sizes_.coarsen) forest.wished = {};
  options.reuse = forest_.grown->stack;
  for (;;) {
    state_.begin("levels");
    LevelMarks marks = with_gradation(forest);
    if (state_.part) marks = united(marks, forest_.grown->marks);  // and what is wished for outside forces here
    LevelledMesh built = build_levels(base, marks, options.reuse,
                                      {.keep_meshes = true,
                                       .fixed = options.fixed,
                                       .progress = options.progress,
                                       .keep_jumps = options.keep_jumps,
                                       .repeated_surfaces = repeated_surfaces(forest_)});
    options.reuse = std::move(built.stack);
    if (state_.among && std::ranges::any_of(options.reuse, [](const auto& pass) { return pass->is_repaired; }))
      state_.among->by_whole = repaired_together;
    const LevelPieces pieces = level_pieces(options.reuse, base.mesh.n_hexes());
    const LevelOrigin origin = level_origin(pieces, forest_.grown->pieces);
    std::vector<std::uint8_t> zone(built.mesh.mesh.hexes.size());
    parallel_each(zone.size(), [&](std::size_t h) {
      zone[h] = std::ranges::any_of(origin.before(static_cast<Index>(h)), [&](Index b) { return zone_before[b] != 0; });
    });
    state_.begin("sizes");
    LevelMarks next = united(forest.wished, more(built.mesh.mesh, pieces, zone));
    trim(next);
    if (next == forest.wished) break;
    forest.wished = std::move(next);
    if (state_.among) state_.among->wished(forest.wished);
  }
  n_levels_ = static_cast<int>(forest.wished.size());
  return forest.wished;
}

SizeReport LevelSizes::report(const RefineResult& made) const {
  SizeReport result = report_on(made, *wish_, in_zone_, in_report_);
  result.n_passes = n_levels_;
  return result;
}

SizeReport level_size_report(const RefineResult& made, const State& state) {
  const std::shared_ptr<const SizeWish> wish = size_wish(state);
  const std::vector<std::uint8_t> in_zone = wish->zone(state.input.mesh, state.part->region);
  std::vector<std::uint8_t> in_report(in_zone.size(), 0);
  for (const Index h : state.part->region) in_report[h] = 1;
  return report_on(made, *wish, in_zone, in_report);
}

}  // namespace hextwist
