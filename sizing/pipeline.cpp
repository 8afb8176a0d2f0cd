#include "hextwist/sizing/pipeline.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <ranges>
#include <utility>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/parallel.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/smooth/smooth.h"
#include "hextwist/refine/carry.h"
#include "hextwist/refine/place.h"
#include "hextwist/sizing/levels.h"

namespace hextwist {
namespace {

constexpr int smooth_layers = 2;  // around the new hexes
/// Between passes, new hexes below this shape are smoothed, even if smoothing is not asked for.
constexpr double least_shape_to_go_on = 0.1;

/// One more for the children of hexes all of whose edges were cut. The field is there (adapt.cpp).
void raise_levels(const Lineage& lineage, Mesh& refined) {
  const auto field = std::ranges::find_if(refined.fields, [](const Field& each) {
    return each.name == level_field && each.on == Field::On::hex && each.components == 1;
  });
  if (field == refined.fields.end()) return;
  for (const CutHex& cut : lineage.hexes) {
    const HexTemplate& pieces = lineage.table->hex(cut.code);
    if (std::ranges::count(pieces.edge_code, 0) > 0) continue;
    for (std::size_t i = 0; i < pieces.children.size(); ++i)
      ++field->values[static_cast<std::size_t>(cut.first_child) + i];
  }
}

}  // namespace

void Pipeline::pass(std::shared_ptr<const SplitTable> table, std::span<const std::uint16_t> codes) {
  ++n_passes_;
  const MeshedModel& from = *current_;
  stages_.begin("split", fraction());
  Split parts = split(from.mesh.hexes, from.mesh.n_nodes(), std::move(table), codes);
  stages_.begin("carry", fraction());
  Carried carried = carry(from.mesh, from.association, parts);
  MeshedModel next{std::move(carried.mesh), from.model, std::move(carried.association)};
  if (request_.levels != Levels::ignored) raise_levels(parts.lineage, next.mesh);
  if (!request_.dry_run) {
    stages_.begin("place", fraction());
    if (next.model && !next.association.empty()) {
      const Interruptible interruptible([&] {
        if (!stages_.report("place", fraction())) throw Cancelled();
      });
      place(from.mesh, from.association, parts, *next.model, next.mesh, next.association);
    }
    stages_.begin("improve", fraction());
    bool stopped = false;
    const auto keep_going = [&](const char* stage, double) {
      stopped |= !stages_.report(stage, fraction());
      return !stopped;
    };
    std::ranges::move(
        repair_children(from.mesh, parts, next.model.get(), next.mesh, next.association, request_.fixed, keep_going),
        std::back_inserter(report_.off_nodes));
    if (stopped) throw Cancelled();
  }
  const std::vector<Index>& parent = parts.lineage.parent;
  std::vector<Index> origin(parent.size());
  parallel_each(parent.size(),
                [&](std::size_t h) { origin[h] = result_.origin.empty() ? parent[h] : result_.origin[parent[h]]; });
  origin_before_ = std::exchange(result_.origin, std::move(origin));
  n_kept_before_ = n_kept(from.mesh);
  result_.lineage = std::move(parts.lineage);
  result_.refined = std::move(next);
  current_ = &result_.refined;
}

void Pipeline::keep() {
  result_.refined = input_;
  result_.lineage.n_old_nodes = input_.mesh.n_nodes();
  result_.lineage.n_old_hexes = input_.mesh.n_hexes();
  result_.lineage.parent.resize(input_.mesh.hexes.size());
  std::iota(result_.lineage.parent.begin(), result_.lineage.parent.end(), 0);
  result_.origin = result_.lineage.parent;
  current_ = &result_.refined;
}

void Pipeline::adopt(RefineResult result) {
  ++n_passes_;
  result_ = std::move(result);
  current_ = &result_.refined;
}

Index Pipeline::n_kept(const Mesh& mesh) const {
  // Hexes that were there before have their old ids and come first.
  const std::int64_t last_old = hex_id(input_.mesh, input_.mesh.n_hexes() - 1);
  const auto all = std::views::iota(Index{0}, mesh.n_hexes());
  return static_cast<Index>(std::ranges::partition_point(all, [&](Index h) { return hex_id(mesh, h) <= last_old; }) -
                            all.begin());
}

std::vector<Index> Pipeline::new_hexes() const {
  std::vector<Index> fresh;
  for (Index h = current_->mesh.n_hexes() - 1, first = n_kept(current_->mesh); h >= first; --h) fresh.push_back(h);
  return fresh;
}

void Pipeline::smooth_band(bool fix_boundary) {
  stages_.begin("smooth", fraction());
  Mesh& mesh = result_.refined.mesh;
  SmoothOptions options;
  options.nodes = nodes_inside(mesh, hex_band(mesh, new_hexes(), smooth_layers));
  options.fixed = request_.fixed;
  options.fix_boundary = fix_boundary;
  const SmoothReport smoothed = smooth(mesh, result_.refined.association, input_.model.get(), options,
                                       [&](const char* stage, double) { return stages_.report(stage, 0.9); });
  if (smoothed.stopped) throw Cancelled();
  report_.notices.push_back("smoothed " + std::to_string(smoothed.n_nodes) + " nodes in " +
                            std::to_string(smoothed.sweeps) + " sweeps");
}

void Pipeline::smooth_between_passes() {
  if (request_.dry_run) return;
  if (!request_.smooth) {
    const double smallest = summarize(quality(Metric::shape, current_->mesh, new_hexes())).min;
    if (smallest >= least_shape_to_go_on) return;
    if (!told_between_)
      report_.notices.push_back("smoothed between passes, as shapes had come down to " + std::to_string(smallest));
    told_between_ = true;
  }
  smooth_band(!request_.smooth);
}

}  // namespace hextwist
