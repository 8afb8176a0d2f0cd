#include "hextwist/sizing/loop.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <ranges>
#include <utility>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/nodal_fields.h"
#include "hextwist/mesh/periodic.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/mesh/smooth/smooth.h"
#include "hextwist/refine/carry.h"
#include "hextwist/refine/levels/transfer.h"
#include "hextwist/refine/others.h"
#include "hextwist/refine/place.h"
#include "hextwist/sizing/among_parts.h"
#include "hextwist/sizing/levelling.h"
#include "hextwist/sizing/lift_new.h"
#include "hextwist/sizing/outcome.h"
#include "hextwist/sizing/size_report.h"
#include "hextwist/sizing/sizes_of_all.h"
#include "hextwist/sizing/techniques/techniques_internal.h"
#include "hextwist/sizing/techniques/wish_internal.h"

namespace hextwist {
namespace {

constexpr int smooth_layers = 2;  // around the new hexes
/// Between passes, new hexes below this shape are smoothed, even if smoothing is not asked for.
constexpr double least_shape_to_go_on = 0.1;

}  // namespace

bool State::run(Technique& technique) {
  while (std::optional<Cut> cut = technique.next(*this)) {
    if (cut->cuts_again) smooth_between_passes();
    const bool is_first = current_ == &input;
    const std::optional<Passed> passed = pass(*cut);
    if (!passed) return false;
    technique.follow(passed->lineage, is_first ? input.mesh : passed->before.mesh, mesh());
  }
  if (current_ == &input) keep();
  technique.finish(*this);
  return true;
}

std::optional<State::Passed> State::pass(const Cut& cut) {
  ++n_passes_;
  const MeshedModel& from = *current_;
  check_others(from.mesh, *cut.table, cut.codes);
  begin("split");
  Split parts = split(from.mesh.hexes, from.mesh.n_nodes(), cut.table, cut.codes);
  if (std::ssize(parts.lineage.parent) > give_up_above) return std::nullopt;
  begin("carry");
  Carried carried = carry(from.mesh, from.association, parts);
  MeshedModel next{std::move(carried.mesh), from.model, std::move(carried.association)};
  raise_levels(parts.lineage, request.finish.level_field, next.mesh);
  if (!request.finish.dry_run && has_nodal_fields(input.mesh))
    straight_ = straight_.empty() ? next.mesh.points : carried_points(straight_, from.mesh, parts);
  if (!request.finish.dry_run) {
    begin("place");
    if (next.model && !next.association.empty()) {
      const Interruptible interruptible([&] {
        if (!stages.report("place", fraction())) throw Cancelled();
      });
      place(from.mesh, from.association, parts, *next.model, next.mesh, next.association);
    }
    begin("improve");
    if (is_second_try && cut.cuts_again && comes_out_inverted(next.mesh, parts)) return std::nullopt;
    bool stopped = false, had_to = false;
    const auto keep_going = [&](const char* stage, double) {
      stopped |= !stages.report(stage, fraction());
      return !stopped;
    };
    const std::vector<Index> fixed = with_inner_nodes(next.mesh, next.association, request.finish.fixed);
    std::vector<int> repeated;
    if (request.finish.periodic) repeated = periodic_surfaces(request.finish.periodic->pairs);
    std::ranges::move(repair_children(from.mesh, parts, next.model.get(), next.mesh, next.association,
                                      {fixed, request.finish.keep_jumps, repeated, keep_going}, &had_to),
                      std::back_inserter(report.off_nodes));
    if (had_to) report.by_whole = repaired_together;
    if (stopped) throw Cancelled();
  }
  const std::vector<Index>& parent = parts.lineage.parent;
  if (part)
    for (const CutHex& hex : parts.lineage.hexes)
      part->note_cut(result_.origin.empty() ? hex.hex : result_.origin[hex.hex]);
  std::vector<Index> origin(parent.size());
  parallel_each(parent.size(),
                [&](std::size_t h) { origin[h] = result_.origin.empty() ? parent[h] : result_.origin[parent[h]]; });
  result_.origin = std::move(origin);
  result_.levelling = nullptr;
  result_.came_from = {};
  result_.old_node = {};
  if (watch) watch(parts.lineage, from.mesh, cut);
  current_ = &result_.refined;
  return Passed{std::exchange(result_.refined, std::move(next)), std::move(parts.lineage)};
}

bool State::comes_out_inverted(const Mesh& mesh, const Split& parts) const {
  const std::vector<Index> inverted = inverted_hexes(mesh, parts.n_kept());
  if (!among || inverted.empty()) return !inverted.empty();
  std::vector<Index> parents;
  for (const Index h : inverted) parents.push_back(parts.lineage.parent[h]);
  return !among->own_among(parents, result_.origin).empty();
}

void State::keep() {
  result_.refined = input;
  raise_levels({}, request.finish.level_field, result_.refined.mesh);
  result_.origin.resize(input.mesh.hexes.size());
  std::iota(result_.origin.begin(), result_.origin.end(), 0);
  current_ = &result_.refined;
}

bool State::keep_if_met() {
  const Sizes* wished = std::get_if<Sizes>(&request.how);
  if (!wished || wished->coarsen || request.finish.level_field) return false;
  begin("sizes");
  const SizesOfAll sizes(input, request);
  if (!sizes.are_met()) return false;
  report.notices.insert(report.notices.end(), sizes.told.begin(), sizes.told.end());
  report.sizes = sizes.report(sizes.region);
  keep();
  result_.levelling = request.levelling;
  return true;
}

void State::adopt(RefineResult result, std::vector<Vec3> straight) {
  ++n_passes_;
  straight_ = std::move(straight);
  result_ = std::move(result);
  current_ = &result_.refined;
}

Index State::n_kept(const Mesh& mesh) const {
  // Hexes that were there before have their old ids and come first.
  const std::int64_t last_old = hex_id(input.mesh, input.mesh.n_hexes() - 1);
  const auto all = std::views::iota(Index{0}, mesh.n_hexes());
  return static_cast<Index>(std::ranges::partition_point(all, [&](Index h) { return hex_id(mesh, h) <= last_old; }) -
                            all.begin());
}

std::vector<Index> State::new_hexes() const {
  std::vector<Index> fresh;
  for (Index h = mesh().n_hexes() - 1, first = n_kept(mesh()); h >= first; --h) fresh.push_back(h);
  return fresh;
}

std::vector<Index> State::new_nodes() const {
  const std::int64_t last_old = node_id(input.mesh, input.mesh.n_nodes() - 1);
  const std::vector<Index>& old = result_.old_node;
  // By levels nodes that had been smoothed may be back where they were; those of the base, which come first, stay.
  const Index n_base = result_.levelling ? result_.levelling->forest.base->mesh.n_nodes() : 0;
  return indices_where(mesh().n_nodes(), [&](Index n) {
    if (old.empty()) return node_id(mesh(), n) > last_old;
    if (n < n_base) return false;
    return old[n] < 0 || mesh().points[n] != input.mesh.points[old[n]];
  });
}

std::vector<Index> State::with_moved_neighbours(std::vector<Index> nodes) const {
  if (!result_.levelling || result_.levelling->overlay.empty() || nodes.empty()) return nodes;
  const std::vector<Index> near = nodes_of_hexes(mesh(), layers_around(mesh(), nodes, 1));
  return union_of(nodes, intersection(near, result_.levelling->overlay.nodes));
}

Index State::node_before(Index node) const {
  if (!result_.old_node.empty()) return result_.old_node[node];
  return node < input.mesh.n_nodes() ? node : -1;
}

std::vector<Index> State::fixed_now() const {
  const std::vector<Index>& old = result_.old_node;
  if (old.empty()) return with_nodes_of_others(mesh(), request.finish.fixed);
  const std::vector<Index> fixed = sorted_unique(request.finish.fixed);
  return with_nodes_of_others(mesh(), indices_where(mesh().n_nodes(), [&](Index n) {
                                return old[n] >= 0 && std::ranges::binary_search(fixed, old[n]);
                              }));
}

void State::smooth_band(bool fix_boundary) {
  smooth_around(new_hexes(), fix_boundary);
}

void State::smooth_around(std::vector<Index> hexes, bool fix_boundary) {
  begin("smooth");
  report.has_smoothed = true;
  Mesh& mesh = result_.refined.mesh;
  const std::vector<Vec3> before = mesh.points;
  SmoothOptions options;
  options.nodes = nodes_inside(mesh, with_layers(mesh, std::move(hexes), smooth_layers));
  options.fixed = fixed_now();
  if (const auto& periodic = request.finish.periodic)  // smoothed by themselves, the two sides would not be alike
    options.fixed =
        union_of(sorted_unique(options.fixed), periodic_nodes(mesh, result_.refined.association, periodic->pairs));
  options.keep_jumps = request.finish.keep_jumps;
  options.fix_boundary = fix_boundary;
  const SmoothReport smoothed = smooth(mesh, result_.refined.association, input.model.get(), options,
                                       [&](const char* stage, double) { return stages.report(stage, 0.9); });
  if (smoothed.stopped) throw Cancelled();
  // In the end, and perhaps once more around hexes that came out flat.
  const auto moved = indices_where(mesh.n_nodes(), [&](Index n) { return before[n] != mesh.points[n]; });
  result_.smoothed = union_of(result_.smoothed, moved);
  if (smoothed.n_nodes == 0) return;
  note("smoothed " + std::to_string(smoothed.n_nodes) + " nodes in " + std::to_string(smoothed.sweeps) + " sweeps");
}

void State::evaluate_fields() {
  if (straight_.empty()) return;
  begin("carry");
  Mesh& mesh = result_.refined.mesh;
  std::vector<Index> elsewhere;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    if (mesh.points[n] == straight_[n]) continue;
    const Index before = node_before(n);
    if (before < 0 || mesh.points[n] != input.mesh.points[before])
      elsewhere.push_back(n);
    else  // where it was in the input
      copy_nodal_values(input.mesh, before, mesh, n);
  }
  evaluate_nodal_fields(input.mesh, mesh, elsewhere, result_.origin, mesh.fields);
}

void State::share_out_extensive() {
  if (result_.came_from.kind.empty())
    share_out(input.mesh, result_.origin, request.finish.extensive, result_.refined.mesh);
}

void State::smooth_between_passes() {
  if (request.finish.dry_run) return;
  if (!request.finish.smooth) {
    const double smallest = summarize(quality(Metric::shape, mesh(), new_hexes())).min;
    if (smallest >= least_shape_to_go_on) return;
    if (!told_between_) note("smoothed between passes, as shapes had come down to " + std::to_string(smallest));
    told_between_ = true;
  }
  smooth_band(!request.finish.smooth);
}

std::vector<Index> State::of_boxes(std::span<const Index> hexes) const {
  constexpr double right_angles = 0.999;  // scaled Jacobian, but for rounding
  const std::vector<Index> parents = items_at(result_.origin, hexes);
  const std::vector<double> angles = quality(Metric::scaled_jacobian, input.mesh, parents);
  std::vector<Index> result;
  for (std::size_t i = 0; i < hexes.size(); ++i)
    if (angles[i] > right_angles) result.push_back(hexes[i]);
  return result;
}

bool State::lift(std::span<const Index> low) {
  Finish finish = request.finish;
  finish.fixed = fixed_now();
  std::vector<Index> nodes = with_moved_neighbours(new_nodes());
  if (const auto& periodic = request.finish.periodic)
    nodes = difference(nodes, periodic_nodes(mesh(), result_.refined.association, periodic->pairs));
  BoundsOfAll of_all;
  if (bounds_of_all)
    of_all = [&](int freedom, std::span<const Index> hexes, double wanted) {
      return bounds_of_all(freedom, mesh(), hexes, result_.origin, wanted);
    };
  const std::vector<Index> moved =
      lift_new_hexes(result_.refined, std::move(nodes), finish, result_.origin, of_boxes(low), of_all);
  result_.smoothed = union_of(result_.smoothed, moved);
  return !moved.empty();
}

void State::smooth_and_close() {
  struct Shaped {
    std::vector<Vec3> points;
    std::vector<Parameters> parameters;
    std::vector<Index> smoothed;
    Report report;
  };
  if (bounds_of_all || std::holds_alternative<Layers>(request.how)) {
    smooth_band();
    return close();
  }
  MeshedModel& refined = result_.refined;
  const auto kept = [&] {
    stages.close();
    return Shaped{refined.mesh.points, refined.association.node_parameters, result_.smoothed, report};
  };
  const auto put_back = [&](Shaped shaped) {
    stages.close();
    refined.mesh.points = std::move(shaped.points);
    refined.association.node_parameters = std::move(shaped.parameters);
    result_.smoothed = std::move(shaped.smoothed);
    shaped.report.seconds = report.seconds;  // all that it took
    shaped.report.total_seconds = report.total_seconds;
    report = std::move(shaped.report);
  };
  Shaped before = kept();
  smooth_band();
  close();
  // Hexes beside the new ones give way too, and must not end with smaller corners than these would have.
  const std::vector<Index> changed = union_of(new_hexes(), layers_around(mesh(), result_.smoothed, 1));
  const auto least_corner = [&] { return summarize(quality(Metric::scaled_jacobian, mesh(), changed)).min; };
  const double least = least_corner();
  // Where corners stay low, from places as they would be without smoothing, and these themselves if it lowers any.
  constexpr double low_corner = 0.3;
  if (least >= low_corner) return;
  Shaped smoothed = kept();
  put_back(std::move(before));
  close();
  const double least_without = least_corner();
  if (!(least_without > least)) return put_back(std::move(smoothed));
  Shaped without = kept();
  smooth_band();
  close();
  if (least_corner() < std::min(least_without, low_corner)) put_back(std::move(without));
}

void State::close() {
  begin("improve");
  const Index first_new = n_kept(mesh());
  std::vector<Index> low, may_be_lifted;
  const auto look = [&] {
    may_be_lifted = hexes_below(mesh(), std::max(poor_quality, lift_below), first_new);
    low = hexes_below(mesh(), poor_quality, may_be_lifted);
    report.flat_hexes = flattened_hexes(input.mesh, mesh(), result_.origin, low);
  };
  look();
  for (const bool fix_boundary : {true, false}) {
    if (report.flat_hexes.empty()) break;
    if (fix_boundary)
      note("smoothed around " + std::to_string(report.flat_hexes.size()) +
           (report.flat_hexes.size() == 1 ? " hex that had come out flat" : " hexes that had come out flat"));
    smooth_around(report.flat_hexes, fix_boundary);
    look();
  }
  // Layers are as thin as they were asked for.
  const bool only_new_hexes = result_.old_node.empty();  // else nodes of others may lie elsewhere, too
  if (!std::holds_alternative<Layers>(request.how) && !(only_new_hexes && may_be_lifted.empty()))
    if (lift(may_be_lifted)) look();
  if (request.finish.periodic) repeat_periodic();
  report.poor = poor_hexes(input.mesh, report.scaled_jacobian_before, mesh(), low);
  report.off_nodes_allowed = request.finish.allow_off_cad;
  if (!report.off_nodes.empty()) report.off_nodes = still_off(result_.refined, report.off_nodes);
}

void State::tell_of_moved_nodes() {
  const Mesh& now = mesh();
  // What had been moved for better shapes goes back by levels, which is told; repeated surfaces are made exact.
  const bool goes_back = result_.levelling && request.levelling && !request.levelling->overlay.nodes.empty();
  if (request.finish.smooth || goes_back || request.finish.periodic) return;
  Index n_moved = 0;
  double farthest = 0;
  for (Index n = 0; n < now.n_nodes(); ++n) {
    const Index before = node_before(n);
    if (before < 0 || now.points[n] == input.mesh.points[before]) continue;
    ++n_moved;
    farthest = std::max(farthest, (now.points[n] - input.mesh.points[before]).norm());
  }
  if (n_moved > 0)
    note("moved " + counted(n_moved, "node") + " that had been there, by at most " + short_number(farthest) +
         ": hexes would be inverted or flat otherwise");
}

void State::measure_sizes() {
  if (!report.sizes || result_.smoothed.empty()) return;
  report.sizes->moved = size_report(mesh(), report.sizes->hexes, size_wish(*this)->field()).counts();
}

void State::repeat_periodic() {
  begin("periodic");
  try {
    const std::vector<Index> moved = repeat_places(result_.refined, request.finish.periodic->pairs);
    if (!moved.empty()) result_.smoothed = union_of(result_.smoothed, moved);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    throw Error(
        std::string(error.what()) +
        " after this refinement: whole hexes and layers of them ('method single', 'depth 1'), sizes by levels and all "
        "volumes at once keep periodic surfaces alike");
  }
}

RefineResult run_passes(State& state, Approach approach) {
  make_passes(state, approach);
  return finish_passes(state);
}

void make_passes(State& state, Approach approach) {
  state.begin("targets");
  if (approach == Approach::nearest_size)
    run_nearest_size(state);
  else if (approach == Approach::levels || approach == Approach::size_by_levels)
    run_levels(state);
  else if (approach == Approach::combination && is_regular(state.request) &&
           std::get<Cuts>(state.request.how).numsplit > 1 && run_combination_by_levels(state))
    ;
  else
    state.run(*make_technique(approach, state));
}

RefineResult finish_passes(State& state) {
  if (!state.request.finish.dry_run) {
    state.request.finish.smooth ? state.smooth_and_close() : state.close();
    state.measure_sizes();
    state.tell_of_moved_nodes();
    state.share_out_extensive();
  }
  state.evaluate_fields();
  state.stages.begin("verify", 0.9);
  return state.take_result();
}

}  // namespace hextwist
