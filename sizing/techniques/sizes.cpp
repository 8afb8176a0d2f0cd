// Size-driven refinement: cut, look again, until the elements are as small as wished.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "hextwist/base/memory.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/sizing/factors.h"
#include "hextwist/sizing/fields/growing.h"
#include "hextwist/sizing/levels.h"
#include "hextwist/sizing/size_report.h"
#include "hextwist/sizing/target_distance.h"
#include "hextwist/sizing/targets.h"
#include "hextwist/sizing/techniques/techniques_internal.h"

namespace hextwist {
namespace {

/// An edge is cut while it is longer than this times the wish, so that its pieces are no shorter than one over this.
constexpr double most_too_long = std::numbers::sqrt3;

const Sizes& sizes_of(const Request& request) {
  return std::get<Sizes>(request.how);
}
bool has_size(const Request& request) {
  return sizes_of(request).size.has_value();
}

/// Where a request's target is, as far as the sizes of its own edges and of the hexes at it are concerned.
class AtTarget {
 public:
  AtTarget(const MeshedModel& input, const Request& request)
      : is_point_(has_size(request) &&
                  (request.target.kind == EntityKind::node || request.target.kind == EntityKind::vertex)),
        close_(1e-6 * box(input.mesh).diagonal()) {
    if (has_size(request) && !is_solid(request.target.kind))
      distance_.emplace(input, request.target.kind, request.target.ids);
  }
  /// The target is nodes or vertices, for which a size was named: no edges lie on it, so the hexes that touch it are
  /// what is to have that size.
  bool is_point() const { return is_point_; }
  /// Per point: does it lie on the target? Nothing lies on hexes and volumes, nor where no size was named for it.
  std::vector<std::uint8_t> on_it(std::span<const Vec3> points) const {
    std::vector<std::uint8_t> result(points.size(), 0);
    if (!distance_) return result;
    std::vector<double> far(points.size());
    distance_->evaluate(points, far);
    for (std::size_t i = 0; i < far.size(); ++i) result[i] = far[i] <= close_;
    return result;
  }

 private:
  bool is_point_;
  double close_;
  std::optional<TargetDistance> distance_;
};

/// Eight for each hex.
std::vector<Vec3> corners_of(const Mesh& mesh, std::span<const Index> hexes) {
  std::vector<Vec3> corners;
  corners.reserve(hexes.size() * n_hex_corners);
  for (const Index h : hexes)
    for (const Index n : mesh.hexes[h]) corners.push_back(mesh.points[n]);
  return corners;
}

/// Hexes of the zone whose size is above the wish by more than that factor.
std::vector<Index> too_large_hexes(const Mesh& mesh, const SizeField& wish, std::span<const std::uint8_t> in_zone,
                                   const AtTarget& target) {
  const double least = wish.least();
  std::vector<Index> asked = indices_where(mesh.n_hexes(), [&](Index h) { return in_zone[h] != 0; });
  std::vector<double> size = actual_sizes(mesh, asked);
  std::size_t n = 0;
  for (std::size_t i = 0; i < asked.size(); ++i)
    if (size[i] > most_too_long * least) {
      asked[n] = asked[i];
      size[n++] = size[i];
    }
  asked.resize(n);
  std::vector<double> wished = wished_sizes(mesh, asked, wish);
  if (target.is_point()) {
    // A corner at the target wishes for all of the hex.
    const std::vector<Vec3> corners = corners_of(mesh, asked);
    const std::vector<std::uint8_t> on_it = target.on_it(corners);
    std::vector<double> there(corners.size());
    wish.evaluate(corners, there);
    for (std::size_t i = 0; i < there.size(); ++i)
      if (on_it[i]) wished[i / n_hex_corners] = std::min(wished[i / n_hex_corners], there[i]);
  }
  std::vector<Index> result;
  for (std::size_t i = 0; i < n; ++i)
    if (size[i] > most_too_long * wished[i]) result.push_back(asked[i]);
  return result;
}

/// Nodes of edges on the target that are longer than the wish by more than the factor: there it is to be met to the
/// edge, however the rest of their hexes may be.
std::vector<Index> target_nodes_too_far_apart(const Mesh& mesh, const SizeField& wish,
                                              std::span<const std::uint8_t> in_zone, const AtTarget& target) {
  const double least = wish.least();
  std::vector<Edge> longer;
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (int e = 0; in_zone[h] && e < n_hex_edges; ++e) {
      const Index a = mesh.hexes[h][edge_corner(e, 0)], b = mesh.hexes[h][edge_corner(e, 1)];
      if ((mesh.points[a] - mesh.points[b]).norm() > most_too_long * least) longer.push_back({a, b});
    }
  std::vector<Index> nodes;
  for (const Edge& edge : longer) nodes.insert(nodes.end(), edge.begin(), edge.end());
  sort_unique(nodes);
  std::vector<Vec3> points;
  for (const Index n : nodes) points.push_back(mesh.points[n]);
  const std::vector<std::uint8_t> on_it = target.on_it(points);
  std::vector<double> wished(nodes.size());
  wish.evaluate(points, wished);
  const auto place = [&](Index n) { return std::ranges::lower_bound(nodes, n) - nodes.begin(); };
  std::vector<Index> result;
  for (const Edge& edge : longer) {
    const auto a = place(edge[0]), b = place(edge[1]);
    const double length = (mesh.points[edge[0]] - mesh.points[edge[1]]).norm();
    if (on_it[a] && on_it[b] && length > most_too_long * std::max(wished[a], wished[b]))
      result.insert(result.end(), edge.begin(), edge.end());
  }
  return result;
}

/// Those of the hexes that have a corner at the target.
std::vector<Index> at_points(const Mesh& mesh, std::span<const Index> hexes, const AtTarget& target) {
  std::vector<Index> result;
  if (!target.is_point()) return result;
  const std::vector<std::uint8_t> on_it = target.on_it(corners_of(mesh, hexes));
  for (std::size_t i = 0; i < hexes.size(); ++i)
    if (std::ranges::count(std::span(on_it).subspan(i * n_hex_corners, n_hex_corners), 1) > 0)
      result.push_back(hexes[i]);
  return result;
}

/// Throws Error when the hexes that the wish takes at the very least cannot fit into memory: sooner than the pass that
/// would find out. A hex becomes at least as many as stand along (a curve), on (a surface) or in the target.
void check_wish_fits(const Mesh& mesh, std::span<const Index> too_large, const SizeField& wish,
                     const Request& request) {
  const int dim = dimension(request.target.kind);
  const std::vector<double> size = actual_sizes(mesh, too_large), wished = wished_sizes(mesh, too_large, wish);
  const double most = std::pow(3.0, sizes_of(request).max_passes);
  double n = mesh.n_hexes();
  for (std::size_t i = 0; i < size.size(); ++i)
    n += std::pow(std::clamp(size[i] / (most_too_long * wished[i]), 1.0, most), dim) - 1;
  check_memory(n, n, "at least ");
}

/// What one pass is to cut.
struct Step {
  std::shared_ptr<const SplitTable> table;
  std::vector<std::uint16_t> codes;
  std::vector<Index> too_large;  ///< hexes that ask for it, ascending
};

/// Marks the nodes of these hexes at which the wish is less than their size by more than the factor.
void mark_wishing_nodes(const Mesh& mesh, std::span<const Index> hexes, const SizeField& wish, double factor,
                        std::span<std::uint8_t> marked) {
  const std::vector<double> size = actual_sizes(mesh, hexes);
  const std::vector<Vec3> corners = corners_of(mesh, hexes);
  std::vector<double> wished(corners.size());
  wish.evaluate(corners, wished);
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (size[i / n_hex_corners] > factor * wished[i])
      marked[mesh.hexes[hexes[i / n_hex_corners]][i % n_hex_corners]] = 1;
}

/// An edge is cut in three when both its ends are marked: the nodes of too large hexes at which the wish is smaller
/// than the hex. Where the wish varies within a hex, only its fine side is cut then, and the children lie between fine
/// and coarse as the wish does; cutting all of it would put the transition into its neighbours, which are small enough
/// already. A hex in which nothing would be cut that way is cut whole, and so are all where the wish is constant or
/// jumps (size_field.h).
Step choose_step(const Mesh& mesh, const Request& request, const SizeField& wish, const AtTarget& target,
                 std::span<const std::uint8_t> in_zone, std::vector<Index> too_large, Report& report) {
  Step step{trisect_table(), {}, std::move(too_large)};
  const std::vector<Index> at_target = target_nodes_too_far_apart(mesh, wish, in_zone, target);
  if (step.too_large.empty() && at_target.empty()) return step;
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  for (const Index n : at_target) marked[n] = 1;
  const auto missed = [&] {
    std::vector<Index> hexes;
    for (const Index h : step.too_large)
      if (edge_mask_of_corners(corner_mask(mesh.hexes[h], marked)) == 0) hexes.push_back(h);
    return hexes;
  };
  mark_nodes(mesh.hexes, at_points(mesh, step.too_large, target), marked);
  const bool is_constant = sizes_of(request).bias == 1 && !sizes_of(request).field;
  if (is_constant || wish.jumps()) mark_nodes(mesh.hexes, step.too_large, marked);
  mark_wishing_nodes(mesh, missed(), wish, most_too_long, marked);
  mark_nodes(mesh.hexes, missed(), marked);
  if (request.concave == Concave::fill) report.filled_hexes += fill_concave(mesh, marked);
  if (request.levels == Levels::graded) say_graded(grade_marks(mesh, request.concave, marked), report.notices);
  step.codes = trisect_codes(mesh.hexes, marked);
  return step;
}

/// How far from the wish (as a logarithm of the ratio) twos and threes can bring a size that is so many times the wish.
double distance_left(double ratio) {
  for (const int step : plan_factors(ratio)) ratio /= step;
  return std::abs(std::log(ratio));
}

/// Regions of too large hexes that come nearer to the wish when they are halved now, and that can be one into eight.
std::vector<Index> hexes_to_halve(const Mesh& mesh, std::span<const Index> too_large, const SizeField& wish,
                                  EightPlan& plan) {
  std::vector<Index> wanted;
  for (const std::vector<Index>& region : connected_regions(mesh, too_large)) {
    const std::vector<double> size = actual_sizes(mesh, region), wished = wished_sizes(mesh, region, wish);
    double after_two = 0, after_three = 0;
    for (std::size_t i = 0; i < region.size(); ++i) {
      after_two += distance_left(size[i] / wished[i] / 2);
      after_three += distance_left(size[i] / wished[i] / 3);
    }
    if (after_two < after_three) wanted.insert(wanted.end(), region.begin(), region.end());
  }
  std::ranges::sort(wanted);
  if (wanted.empty()) return {};
  plan = plan_eight(mesh, wanted);
  std::vector<Index> halved = difference(wanted, plan.trisected);
  plan.trisected.clear();
  return halved;
}

/// Nodes, edges and faces of the target at these hexes.
CombinationTarget part_at(const CombinationTarget& target, const Mesh& mesh, std::span<const Index> hexes) {
  std::vector<std::uint8_t> chosen(mesh.points.size(), 0);
  mark_nodes(mesh.hexes, hexes, chosen);
  const auto is_chosen = [&](Index n) { return chosen[n] != 0; };
  CombinationTarget part;
  std::ranges::copy_if(target.nodes, std::back_inserter(part.nodes), is_chosen);
  std::ranges::copy_if(target.edges, std::back_inserter(part.edges),
                       [&](const Edge& edge) { return std::ranges::all_of(edge, is_chosen); });
  std::ranges::copy_if(target.faces, std::back_inserter(part.faces),
                       [&](const Quad& quad) { return std::ranges::all_of(quad, is_chosen); });
  return part;
}

/// Per hex: does it have a node of the target?
std::vector<std::uint8_t> touching(const CombinationTarget& target, const Mesh& mesh) {
  std::vector<std::uint8_t> on_it(mesh.points.size(), 0), result(mesh.hexes.size(), 0);
  for (const Index n : target.nodes) on_it[n] = 1;
  for (const Index h : touching_hexes(mesh.hexes, on_it)) result[h] = 1;
  return result;
}

SizeFieldPtr wish_of(const MeshedModel& input, const Request& request) {
  const Sizes& sizes = sizes_of(request);
  std::vector<SizeFieldPtr> fields;
  if (sizes.size)
    fields.push_back(growing_size(
        *sizes.size, sizes.bias,
        sizes.bias == 1 ? nullptr : std::make_shared<TargetDistance>(input, request.target.kind, request.target.ids)));
  if (sizes.field) {
    fields.push_back(sizes.field);
    if (sizes.bias > 1) fields.push_back(limited_growth(input.mesh, sizes.field, sizes.bias));
  }
  return smallest_of(std::move(fields));
}

/// Trisects what is too large; the other two do something else first.
class ByThrees : public SizeTechnique {
 public:
  explicit ByThrees(State& state)
      : wish_(wish_of(state.input, state.request)),
        everywhere_(sizes_of(state.request).bias > 1 && !state.request.target.depth && !state.request.target.radius),
        target_(state.input, state.request) {
    const std::vector<Index> targets = region_target(state.input, state.request.target, state.report.notices);
    in_zone_.assign(state.input.mesh.hexes.size(), everywhere_);
    in_report_.assign(state.input.mesh.hexes.size(), 0);
    for (const Index h : targets) in_zone_[h] = in_report_[h] = 1;
  }

  bool has_done() const override { return has_done_; }

  std::optional<Cut> next(State& state) override {
    const int max_passes = sizes_of(state.request).max_passes;
    for (;;) {
      if (auto cut = go_on(state)) return cut;
      state.begin("sizes");
      const Mesh& mesh = state.mesh();
      std::vector<Index> too_large = too_large_hexes(mesh, *wish_, in_zone_, target_);
      if (n_passes_ == 0) check_wish_fits(mesh, too_large, *wish_, state.request);
      if (n_passes_ < max_passes && begin_round(mesh, too_large)) {
        ++n_passes_;
        has_done_ = true;
        continue;
      }
      Step step = choose_step(mesh, state.request, *wish_, target_, in_zone_, std::move(too_large), state.report);
      if (step.codes.empty()) return std::nullopt;
      if (n_passes_ == max_passes) {
        unmet_ = std::move(step.too_large);
        return std::nullopt;
      }
      return Cut{step.table, std::move(step.codes), n_passes_++ > 0};
    }
  }

  void follow(const Lineage& lineage, const Mesh&, const Mesh&) override {
    const std::size_t n_kept = lineage.n_old_hexes - lineage.hexes.size();
    std::vector<std::uint8_t> zone(lineage.parent.size()), reported(lineage.parent.size());
    for (std::size_t h = 0; h < lineage.parent.size(); ++h) {
      zone[h] = in_zone_[lineage.parent[h]];
      reported[h] = in_report_[lineage.parent[h]] || (everywhere_ && h >= n_kept);
    }
    in_zone_ = std::move(zone);
    in_report_ = std::move(reported);
  }

  void finish(State& state) override {
    SizeReport report = size_report(
        state.mesh(), indices_where(state.mesh().n_hexes(), [&](Index h) { return in_report_[h] != 0; }), *wish_);
    report.n_passes = n_passes_;
    report.unmet = std::move(unmet_);
    state.report.sizes = std::move(report);
  }

 protected:
  /// The next cut of a round of something else that has begun.
  virtual std::optional<Cut> go_on(State&) { return std::nullopt; }
  /// Begins such a round for what is too large, where that comes nearer to the wish.
  virtual bool begin_round(const Mesh&, const std::vector<Index>&) { return false; }

  const SizeFieldPtr wish_;
  const bool everywhere_;
  std::vector<std::uint8_t> in_zone_, in_report_;
  int n_passes_ = 0;

 private:
  const AtTarget target_;
  bool has_done_ = false;
  std::vector<Index> unmet_;
};

/// One into eight in regions that come nearer to the wish by factors of two, where that can be.
class ByHalves : public ByThrees {
 public:
  using ByThrees::ByThrees;

  void follow(const Lineage& lineage, const Mesh& before, const Mesh& after) override {
    ByThrees::follow(lineage, before, after);
    if (round_) round_->follow(lineage, before, after);
  }

 protected:
  std::optional<Cut> go_on(State& state) override {
    if (!round_) return std::nullopt;
    auto cut = round_->next(state);
    if (!cut) round_.reset();
    return cut;
  }
  bool begin_round(const Mesh& mesh, const std::vector<Index>& too_large) override {
    EightPlan plan;
    std::vector<Index> halved = hexes_to_halve(mesh, too_large, *wish_, plan);
    if (halved.empty()) return false;
    round_.emplace(std::move(plan), std::move(halved));
    return true;
  }

 private:
  std::optional<EightRound> round_;
};

/// At the target, once all that are too large touch it: they are refined towards it only.
class ByCombination : public ByThrees {
 public:
  explicit ByCombination(State& state)
      : ByThrees(state), at_(sub_element_target(state.input, state.request.target, state.report.notices)) {}

  void follow(const Lineage& lineage, const Mesh& before, const Mesh& after) override {
    ByThrees::follow(lineage, before, after);
    at_ = carried_target(at_, lineage, after);
    // Depth 0: what touches the target now is all that is wished for.
    if (!everywhere_) in_zone_ = in_report_ = touching(at_, after);
    if (round_) round_->follow(lineage, after);
  }

 protected:
  std::optional<Cut> go_on(State& state) override {
    if (!round_) return std::nullopt;
    auto cut = round_->next(state, done_, n_passes_ > 1);
    if (!cut) {
      tell(done_, state);
      round_.reset();
    }
    return cut;
  }
  bool begin_round(const Mesh& mesh, const std::vector<Index>& too_large) override {
    if (too_large.empty()) return false;
    const std::vector<std::uint8_t> touches = touching(at_, mesh);
    if (!std::ranges::all_of(too_large, [&](Index h) { return touches[h] != 0; })) return false;
    round_.emplace(part_at(at_, mesh, too_large), EncloseAt::third);
    done_ = {};
    return true;
  }

 private:
  CombinationTarget at_;
  std::optional<EncloseRound> round_;
  Enclosed done_;
};

}  // namespace

std::unique_ptr<SizeTechnique> size_technique(State& state, Approach approach) {
  if (approach == Approach::size_by_halves) return std::make_unique<ByHalves>(state);
  if (approach == Approach::size_by_combination) return std::make_unique<ByCombination>(state);
  return std::make_unique<ByThrees>(state);
}

}  // namespace hextwist
