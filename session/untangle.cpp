#include <algorithm>
#include <cmath>
#include <numeric>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/others.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/mesh/smooth/smooth.h"
#include "hextwist/mesh/validate/validate.h"
#include "hextwist/session/untangle.h"

namespace hextwist {
namespace {

/// Layers of hexes around the inverted ones whose nodes may move: as few as it takes.
constexpr int near_layers[] = {1, 2, 3, 4};
constexpr int far_layers[] = {6, 9, 13};
constexpr int free_layers[] = {0, 1, 2};
constexpr int sweeps_after = 10;  // so that hexes are not only just right
constexpr int max_sweeps = 300;

enum class Boundary { stays, slides, is_free };

SmoothReport run_smooth(const Transaction& run, Mesh& mesh, Association& association, const Model* model,
                        const SmoothOptions& options) {
  SmoothReport report = smooth(mesh, association, model, options, [&](const char* stage, double fraction) {
    return !run.core.callbacks.progress || run.core.callbacks.progress(stage, fraction);
  });
  if (report.stopped) throw Cancelled();
  return report;
}

/// Untangles by moving the nodes of these hexes (ascending), and returns the hexes that are inverted still. A region
/// that is not mended altogether is left as it was: what a failed try heaps up is no good start for the next.
std::vector<Index> untangle_in(const Transaction& run, Mesh& mesh, Association& association, const Model* model,
                               const std::vector<Index>& hexes, Boundary boundary) {
  SmoothOptions options;
  options.scheme = SmoothScheme::untangle;
  options.fix_boundary = boundary == Boundary::stays;
  options.free_boundary = boundary == Boundary::is_free;
  options.iterations = max_sweeps;
  options.nodes = nodes_of_hexes(mesh, hexes);
  options.fixed = with_nodes_of_others(mesh, {});
  const std::vector<Index> nodes = *options.nodes;
  const std::vector<Vec3> points = items_at(mesh.points, nodes);
  const bool has_parameters = !association.node_parameters.empty();
  const std::vector<Parameters> parameters =
      has_parameters ? items_at(association.node_parameters, nodes) : std::vector<Parameters>();
  const std::vector<Index> bad = run_smooth(run, mesh, association, model, options).not_repaired;
  std::vector<Index> mended;
  for (const std::vector<Index>& region : connected_regions(mesh, hexes)) {
    if (intersection(region, bad).empty()) {
      mended.insert(mended.end(), region.begin(), region.end());
      continue;
    }
    for (const Index n : nodes_of_hexes(mesh, region)) {
      const Index at = position_in(nodes, n);
      mesh.points[n] = points[at];
      if (has_parameters) association.node_parameters[n] = parameters[at];
    }
  }
  if (!mended.empty()) {
    options.scheme = SmoothScheme::mean_ratio;
    options.iterations = sweeps_after;
    options.nodes = nodes_of_hexes(mesh, sorted_unique(std::move(mended)));
    run_smooth(run, mesh, association, model, options);
  }
  std::vector<Index> around = with_layers(mesh, hexes, 1);
  return inverted_hexes(mesh, sorted_unique(std::move(around)));
}

/// With so many layers around the inverted hexes.
std::vector<Index> untangle_around(const Transaction& run, Mesh& mesh, Association& association, const Model* model,
                                   const std::vector<Index>& inverted, int layers, Boundary boundary) {
  return untangle_in(run, mesh, association, model, sorted_unique(with_layers(mesh, inverted, layers)), boundary);
}

}  // namespace

std::vector<Index> inverted_among(const std::vector<Violation>& violations) {
  std::vector<Index> result;
  for (const Violation& violation : violations) {
    if (is_warning(violation.kind)) continue;
    // A node of a tangled skin lies inside faces that it does not belong to.
    if (violation.kind == ViolationKind::hanging_node) continue;
    if (violation.kind != ViolationKind::inverted) return {};
    result.insert(result.end(), violation.hexes.begin(), violation.hexes.end());
  }
  sort_unique(result);
  return result;
}

std::vector<Index> untangle_near(const Transaction& run, Mesh& mesh, Association& association, const Model* model,
                                 std::vector<Index> inverted, bool slide) {
  for (const int layers : near_layers)
    if (!inverted.empty())
      inverted =
          untangle_around(run, mesh, association, model, inverted, layers, slide ? Boundary::slides : Boundary::stays);
  return inverted;
}

std::vector<Index> untangle_freely(const Transaction& run, Mesh& mesh, std::vector<Index> inverted) {
  // A fold is undone by less than the size of a hex; what takes more would be another shape.
  const double farthest = std::cbrt(volume(mesh) / static_cast<double>(mesh.hexes.size()));
  const std::vector<Index> before = inverted;
  const std::vector<Vec3> points = mesh.points;
  Association nobody;
  for (const int layers : free_layers)
    if (!inverted.empty()) inverted = untangle_around(run, mesh, nobody, nullptr, inverted, layers, Boundary::is_free);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if ((mesh.points[n] - points[n]).norm() > farthest) {
      mesh.points = points;
      return before;
    }
  return inverted;
}

std::vector<Index> untangle_far(const Transaction& run, Mesh& mesh, Association& association, const Model* model,
                                std::vector<Index> inverted) {
  for (const int layers : far_layers)
    for (const Boundary boundary : {Boundary::stays, Boundary::slides})
      if (!inverted.empty()) inverted = untangle_around(run, mesh, association, model, inverted, layers, boundary);
  std::vector<Index> all(mesh.hexes.size());
  std::iota(all.begin(), all.end(), 0);
  for (const Boundary boundary : {Boundary::stays, Boundary::slides})
    if (!inverted.empty()) inverted = untangle_in(run, mesh, association, model, all, boundary);
  return inverted;
}

std::string untangled_text(const Mesh& mesh, const std::vector<Vec3>& before, const std::vector<Index>& inverted) {
  constexpr std::size_t max_ids = 5;
  std::string line = counted(static_cast<std::int64_t>(inverted.size()), EntityKind::hex) +
                     (inverted.size() == 1 ? " was" : " were") + " inverted (hex";
  for (std::size_t i = 0; i < std::min(inverted.size(), max_ids); ++i)
    line += " " + std::to_string(hex_id(mesh, inverted[i]));
  if (inverted.size() > max_ids) line += " ...";
  std::int64_t n_moved = 0;
  double farthest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double way = (mesh.points[i] - before[i]).norm();
    if (way > 0) ++n_moved;
    farthest = std::max(farthest, way);
  }
  return line + "): untangled, " + counted(n_moved, EntityKind::node) + " moved by at most " + short_number(farthest);
}

}  // namespace hextwist
