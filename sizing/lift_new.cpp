#include "hextwist/sizing/lift_new.h"

#include <algorithm>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/mesh/smooth/lift.h"
#include "hextwist/mesh/smooth/lift_together.h"

namespace hextwist {
namespace {

/// Which new nodes may move one by one, for hexes below which scaled Jacobian: the smallest freedom first, and the
/// worst hexes first, as nodes that went for the sake of fair ones are in their way. By trying on all shipped models
/// and on boxes (docs/design.md).
struct Freedom {
  double wanted;
  bool on_cad;
  int layers;  ///< of hexes around those
  int sweeps;
  bool of_boxes = false;  ///< alone: they come that far, others give up as much of their average for it
};
constexpr double lift_others_below = 0.3;  // those that did not come of boxes
constexpr Freedom freedoms[n_freedoms] = {{0.01, false, 1, 6},
                                          {0.02, false, 1, 6},
                                          {0.05, false, 1, 6},
                                          {0.1, false, 1, 6},
                                          {0.2, false, 0, 4},
                                          {lift_others_below, false, 0, 6},
                                          {lift_below, false, 0, 6, true},
                                          {lift_others_below, true, 0, 6}};

/// Shape of a cube, but for rounding.
constexpr double perfect = 0.9999;

}  // namespace

std::vector<Index> lift_new_hexes(MeshedModel& refined, std::vector<Index> new_nodes, const Finish& finish,
                                  std::span<const Index> cell, std::span<const Index> of_boxes,
                                  const BoundsOfAll& of_all) {
  Mesh& mesh = refined.mesh;
  std::vector<std::uint8_t> is_new(mesh.points.size(), 0);
  for (const Index n : new_nodes) is_new[n] = 1;
  const std::vector<Index> hexes = touching_hexes(mesh.hexes, is_new);
  // Few hexes are low, and only those around them change.
  const std::vector<Index> low_now = hexes_below(mesh, lift_below, hexes);
  if (low_now.empty()) return {};
  // Beyond what all are lifted to, there is something to do for boxes alone.
  if (intersection(low_now, of_boxes).empty() && hexes_below(mesh, lift_others_below, low_now).empty()) return {};
  const std::vector<Index> near = intersection(with_layers(mesh, low_now, 1), hexes);
  const std::vector<Index> near_of_boxes = intersection(near, of_boxes);
  if (!refined.association.empty())  // along curves they stay as even as they are
    std::erase_if(new_nodes, [&](Index n) { return refined.association.node_owner[n].dim == 1; });
  const std::vector<Index> around = intersection(with_layers(mesh, near, 1), hexes);
  const std::vector<double> shape = quality(Metric::shape, mesh, around);
  std::vector<Index> cubes;
  for (std::size_t i = 0; i < around.size(); ++i)
    if (shape[i] > perfect) cubes.push_back(around[i]);
  new_nodes = difference(new_nodes, nodes_of_hexes(mesh, cubes));
  SmoothOptions options;
  options.fixed = finish.fixed;
  options.keep_jumps = finish.keep_jumps;
  const std::vector<Vec3> before = mesh.points;
  const auto new_nodes_at = [&](std::vector<Index> low, int layers) {
    return intersection(new_nodes, nodes_of_hexes(mesh, with_layers(mesh, std::move(low), layers)));
  };
  for (int f = 0; f < n_freedoms; ++f) {
    const Freedom& freedom = freedoms[f];
    std::vector<Index> low = hexes_below(mesh, freedom.wanted, freedom.of_boxes ? near_of_boxes : near);
    if (low.empty()) continue;
    options.fix_boundary = !freedom.on_cad;
    options.nodes = new_nodes_at(std::move(low), freedom.layers);
    BoundsOf bounds;
    if (of_all) bounds = [&](std::span<const Index> of) { return of_all(f, of, freedom.wanted); };
    lift_scaled_jacobians(mesh, refined.association, refined.model.get(), options, freedom.wanted, freedom.sweeps,
                          bounds);
  }
  // What is low still is held by its neighbours.
  if (std::vector<Index> low = hexes_below(mesh, lift_others_below, near); !low.empty()) {
    options.fix_boundary = false;
    options.nodes = new_nodes_at(std::move(low), 1);
    lift_together(mesh, refined.association, refined.model.get(), options, cell, lift_others_below, before);
  }
  return indices_where(mesh.n_nodes(), [&](Index n) { return before[n] != mesh.points[n]; });
}

}  // namespace hextwist
