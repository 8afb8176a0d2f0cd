#include "hextwist/sizing/lift_new.h"

#include <algorithm>

#include "hextwist/base/parallel.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/quality/validity.h"
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

}  // namespace

std::vector<Index> lift_new_hexes(MeshedModel& refined, Index first_new_hex, Index first_new_node,
                                  const Finish& finish) {
  Mesh& mesh = refined.mesh;
  std::vector<Vec3> before;
  SmoothOptions options;
  options.fixed = finish.fixed;
  options.keep_jumps = finish.keep_jumps;
  for (const Freedom& freedom : freedoms) {
    std::vector<Index> low = hexes_below(mesh, freedom.wanted, first_new_hex);
    if (low.empty()) break;
    if (before.empty()) before = mesh.points;
    options.fix_boundary = !freedom.on_cad;
    options.nodes = nodes_of_hexes(mesh, with_layers(mesh, std::move(low), freedom.layers), first_new_node);
    lift_scaled_jacobians(mesh, refined.association, refined.model.get(), options, freedom.wanted, freedom.sweeps);
  }
  if (before.empty()) return {};
  return indices_where(mesh.n_nodes(), [&](Index n) { return before[n] != mesh.points[n]; });
}

}  // namespace hextwist
