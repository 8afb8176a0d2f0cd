#include "hextwist/sizing/lift_new.h"

#include <algorithm>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/smooth/lift.h"

namespace hextwist {
namespace {

/// Which new nodes may move, for hexes below which scaled Jacobian: the smallest freedom first. By trying on all
/// shipped models (docs/design.md).
struct Freedom {
  double wanted;
  bool on_cad;
  int layers;  ///< of hexes around those
  int sweeps;
};
constexpr Freedom freedoms[] = {{0.3, false, 0, 6}, {0.3, true, 0, 6}, {0.25, true, 1, 10}, {0.2, true, 2, 10}};

/// Shape of a cube, but for rounding.
constexpr double perfect = 0.9999;

/// Those of the hexes (ascending) of which `wanted` is true.
template <class Wanted>
std::vector<Index> hexes_where(Metric metric, const Mesh& mesh, std::span<const Index> hexes, const Wanted& wanted) {
  const std::vector<double> q = quality(metric, mesh, hexes);
  std::vector<Index> result;
  for (std::size_t i = 0; i < q.size(); ++i)
    if (wanted(q[i])) result.push_back(hexes[i]);
  return result;
}
std::vector<Index> low_among(const Mesh& mesh, std::span<const Index> hexes, double wanted) {
  return hexes_where(Metric::scaled_jacobian, mesh, hexes, [&](double q) { return q < wanted; });
}

}  // namespace

std::vector<Index> lift_new_hexes(MeshedModel& refined, std::vector<Index> new_nodes, const Finish& finish) {
  Mesh& mesh = refined.mesh;
  std::vector<std::uint8_t> is_new(mesh.points.size(), 0);
  for (const Index n : new_nodes) is_new[n] = 1;
  const std::vector<Index> hexes = touching_hexes(mesh.hexes, is_new);
  if (low_among(mesh, hexes, freedoms[0].wanted).empty()) return {};

  if (!refined.association.empty())  // along curves they stay as even as they are
    std::erase_if(new_nodes, [&](Index n) { return refined.association.node_owner[n].dim == 1; });
  const std::vector<Index> cubes =
      hexes_where(Metric::shape, mesh, hexes, [](double shape) { return shape > perfect; });
  new_nodes = difference(new_nodes, nodes_of_hexes(mesh, cubes));
  SmoothOptions options;
  options.fixed = finish.fixed;
  options.keep_jumps = finish.keep_jumps;
  const std::vector<Vec3> before = mesh.points;
  for (const Freedom& freedom : freedoms) {
    std::vector<Index> low = low_among(mesh, hexes, freedom.wanted);
    if (low.empty()) break;
    options.fix_boundary = !freedom.on_cad;
    options.nodes = intersection(new_nodes, nodes_of_hexes(mesh, with_layers(mesh, std::move(low), freedom.layers)));
    lift_scaled_jacobians(mesh, refined.association, refined.model.get(), options, freedom.wanted, freedom.sweeps);
  }
  return indices_where(mesh.n_nodes(), [&](Index n) { return before[n] != mesh.points[n]; });
}

}  // namespace hextwist
