#include "hextwist/mesh/smooth/lift.h"

#include <algorithm>

#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/smooth/scaled_jacobian_internal.h"
#include "hextwist/mesh/smooth/sweep_internal.h"

namespace hextwist {
namespace {

constexpr double at_rest = 0.01;  // of its edges: a shorter step of a node is none

}  // namespace

void lift_scaled_jacobians(Mesh& mesh, Association& association, const Model* model, std::span<const Index> nodes,
                           std::span<const Owner> owners, std::span<const Index> hexes, double threshold, int sweeps) {
  const SmoothProblem problem = make_smooth_problem(mesh, nodes, owners, hexes);
  SmoothState state{problem, mesh, association, model, std::vector<std::uint8_t>(problem.nodes.size(), 1)};
  SweepRule rule;
  rule.limit = 1 / (threshold * threshold);
  rule.tolerance = at_rest;
  std::vector<std::uint8_t> bad(problem.nodes.size());
  for (int i = 0; i < sweeps; ++i) {
    const std::vector<double> q = quality(Metric::scaled_jacobian, mesh, problem.hexes);
    std::ranges::fill(bad, 0);
    for (std::size_t k = 0; k < q.size(); ++k)
      if (q[k] < threshold)
        for (const Index node : mesh.hexes[problem.hexes[k]])
          if (const Index slot = problem.slot[node]; slot >= 0) bad[slot] = 1;
    bool any = false;
    for (std::size_t s = 0; s < bad.size(); ++s) any |= (state.awake[s] &= bad[s]);
    if (!any) return;
    sweep(state, [&] {
      return [&, patch = ScaledJacobianPatch(problem, i < 2 ? 4 : 8)](Index slot, bool& moved) mutable {
        return improve_node(state, rule, slot, patch, moved);
      };
    });
  }
}

}  // namespace hextwist
