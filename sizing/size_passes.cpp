// Size-driven refinement: cut, look again, until the elements are as small as wished.
#include <cmath>
#include <numbers>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/parallel_internal.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/trisect.h"
#include "hextwist/sizing/factors.h"
#include "hextwist/sizing/pipeline_internal.h"
#include "hextwist/sizing/size_field.h"
#include "hextwist/sizing/size_report.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

/// An edge is cut while it is longer than this times the wish, so that its pieces are no shorter than one over this.
constexpr double most_too_long = std::numbers::sqrt3;

/// Hexes of the zone whose size is above the wish by more than that factor.
std::vector<Index> too_large_hexes(const Mesh& mesh, const SizeField& wish, std::span<const std::uint8_t> in_zone) {
  const double least = wish.least();
  std::vector<Index> asked = where(mesh.n_hexes(), [&](Index h) { return in_zone[h] != 0; });
  std::vector<double> size = actual_sizes(mesh, asked);
  std::size_t n = 0;
  for (std::size_t i = 0; i < asked.size(); ++i)
    if (size[i] > most_too_long * least) {
      asked[n] = asked[i];
      size[n++] = size[i];
    }
  asked.resize(n);
  const std::vector<double> wished = wished_sizes(mesh, asked, wish);
  std::vector<Index> result;
  for (std::size_t i = 0; i < n; ++i)
    if (size[i] > most_too_long * wished[i]) result.push_back(asked[i]);
  return result;
}

/// Nodes of edges that lie on the target (the wish is smallest at both ends) and are longer than it by more than the
/// factor: there the wish is to be met to the edge, however the rest of their hexes may be.
std::vector<Index> target_nodes_too_far_apart(const Mesh& mesh, const SizeField& wish,
                                              std::span<const std::uint8_t> in_zone) {
  const double least = wish.least();
  if (!(least > 0)) return {};
  std::vector<Edge> longer;
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (int e = 0; in_zone[h] && e < n_hex_edges; ++e) {
      const Index a = mesh.hexes[h][edge_corner(e, 0)], b = mesh.hexes[h][edge_corner(e, 1)];
      if ((mesh.points[a] - mesh.points[b]).norm() > most_too_long * least) longer.push_back({a, b});
    }
  std::vector<Index> nodes;
  for (const Edge& edge : longer) nodes.insert(nodes.end(), edge.begin(), edge.end());
  std::ranges::sort(nodes);
  nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  std::vector<Vec3> points;
  for (const Index n : nodes) points.push_back(mesh.points[n]);
  std::vector<double> wished(nodes.size());
  wish.evaluate(points, wished);
  std::vector<std::uint8_t> at_target(mesh.points.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i) at_target[nodes[i]] = wished[i] <= least * (1 + 1e-6);
  nodes.clear();
  for (const Edge& edge : longer)
    if (at_target[edge[0]] && at_target[edge[1]]) nodes.insert(nodes.end(), edge.begin(), edge.end());
  return nodes;
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
  std::vector<Vec3> corners;
  for (const Index h : hexes)
    for (const Index n : mesh.hexes[h]) corners.push_back(mesh.points[n]);
  std::vector<double> wished(corners.size());
  wish.evaluate(corners, wished);
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (size[i / n_hex_corners] > factor * wished[i])
      marked[mesh.hexes[hexes[i / n_hex_corners]][i % n_hex_corners]] = 1;
}

/// An edge is cut in three when both its ends are marked: the nodes of too large hexes at which the wish is smaller
/// than the hex. Where the wish varies within a hex, only its fine side is cut then, and the children lie between fine
/// and coarse as the wish does; cutting all of it would put the transition into its neighbours, which are small enough
/// already. A hex in which nothing would be cut that way is cut whole, and so are all where the wish jumps (size_field.h).
Step choose_step(const Mesh& mesh, const Request& request, const SizeField& wish, std::span<const std::uint8_t> in_zone,
                 std::vector<Index> too_large, Report& report) {
  Step step{trisect_table(), {}, std::move(too_large)};
  const std::vector<Index> at_target = target_nodes_too_far_apart(mesh, wish, in_zone);
  if (step.too_large.empty() && at_target.empty()) return step;
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  for (const Index n : at_target) marked[n] = 1;
  const auto missed = [&] {
    std::vector<Index> hexes;
    for (const Index h : step.too_large)
      if (edge_mask_of_corners(corner_mask(mesh.hexes[h], marked)) == 0) hexes.push_back(h);
    return hexes;
  };
  if (wish.jumps()) mark_nodes(mesh.hexes, step.too_large, marked);
  mark_wishing_nodes(mesh, missed(), wish, most_too_long, marked);
  mark_nodes(mesh.hexes, missed(), marked);
  if (request.concave == Concave::fill) report.filled_hexes += fill_concave(mesh, marked);
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
  std::vector<Index> halved;
  std::ranges::set_difference(wanted, plan.trisected, std::back_inserter(halved));
  plan.trisected.clear();
  return halved;
}

}  // namespace

SizeFieldPtr wish_of(const MeshedModel& input, const Request& request) {
  std::vector<SizeFieldPtr> fields;
  if (request.size)
    fields.push_back(growing_size(
        *request.size, request.bias,
        request.bias == 1 ? nullptr : std::make_shared<TargetDistance>(input, request.kind, request.targets)));
  if (request.size_field) {
    fields.push_back(request.size_field);
    if (request.bias > 1) fields.push_back(limited_growth(input.mesh, request.size_field, request.bias));
  }
  return smallest_of(std::move(fields));
}

bool size_passes(Pipeline& run, bool halves) {
  const Request& request = run.request();
  const SizeFieldPtr wish = wish_of(run.input(), request);
  const bool everywhere = request.bias > 1 && !request.depth && !request.radius;
  std::vector<Index> targets = region_target(run.input(), request, run.report().notices);
  std::vector<std::uint8_t> in_zone(run.input().mesh.hexes.size(), everywhere);
  for (const Index h : targets) in_zone[h] = 1;
  std::vector<std::uint8_t> in_report = in_zone;
  if (everywhere) {
    std::ranges::fill(in_report, 0);
    for (const Index h : targets) in_report[h] = 1;
  }
  const auto carry_zones = [&] {
    const Lineage& lineage = run.lineage();
    const std::size_t n_kept = lineage.n_old_hexes - lineage.hexes.size();
    std::vector<std::uint8_t> zone(lineage.parent.size()), reported(lineage.parent.size());
    for (std::size_t h = 0; h < lineage.parent.size(); ++h) {
      zone[h] = in_zone[lineage.parent[h]];
      reported[h] = in_report[lineage.parent[h]] || (everywhere && h >= n_kept);
    }
    in_zone = std::move(zone);
    in_report = std::move(reported);
  };
  int n_passes = 0;
  bool has_halved = false;
  std::vector<Index> unmet;
  while (true) {
    run.stages().begin("sizes", run.fraction());
    const Mesh& mesh = run.current().mesh;
    std::vector<Index> too_large = too_large_hexes(mesh, *wish, in_zone);
    if (halves && n_passes < request.max_passes) {
      EightPlan plan;
      if (std::vector<Index> halved = hexes_to_halve(mesh, too_large, *wish, plan); !halved.empty()) {
        eight_round(run, std::move(plan), std::move(halved), carry_zones);
        ++n_passes;
        has_halved = true;
        continue;
      }
    }
    Step step = choose_step(mesh, request, *wish, in_zone, std::move(too_large), run.report());
    if (step.codes.empty()) break;
    if (n_passes == request.max_passes) {
      unmet = std::move(step.too_large);
      break;
    }
    run.pass(step.table, step.codes);
    ++n_passes;
    carry_zones();
  }
  if (n_passes == 0) run.keep();
  SizeReport report = size_report(
      run.current().mesh, where(run.current().mesh.n_hexes(), [&](Index h) { return in_report[h] != 0; }), *wish);
  report.n_passes = n_passes;
  report.unmet = std::move(unmet);
  run.report().sizes = std::move(report);
  return has_halved;
}

}  // namespace hextwist
