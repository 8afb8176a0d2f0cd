#include "hextwist/mesh/smooth/lift.h"

#include <algorithm>

#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/mesh/smooth/lift_patch_internal.h"
#include "hextwist/mesh/smooth/sweep_internal.h"

namespace hextwist {
namespace {

/// Powers of the energy: gently first, so that all corners have their say and nodes don't jam, then for the worst.
/// Found by trying 1 to 16 and 2 to 8 sweeps on all shipped models.
constexpr int gentle = 2, hard = 8;
constexpr int gentle_sweeps = 4;

/// Leaves awake only nodes of hexes below `wanted`; false: there are none.
bool keep_low_awake(SmoothState& state, double wanted) {
  const SmoothProblem& problem = state.problem;
  const std::vector<double> q = quality(Metric::scaled_jacobian, state.mesh, problem.hexes);
  std::vector<std::uint8_t> low(problem.nodes.size());
  for (std::size_t k = 0; k < q.size(); ++k)
    if (q[k] < wanted)
      for (const Index node : state.mesh.hexes[problem.hexes[k]])
        if (const Index slot = problem.slot[node]; slot >= 0) low[slot] = 1;
  bool any = false;
  for (std::size_t s = 0; s < low.size(); ++s) any |= (state.awake[s] &= low[s]) != 0;
  return any;
}

}  // namespace

void lift_low(SmoothState& state, const Bounds& bounds, int max_sweeps,
              const std::function<bool(const SweepCount&)>& after_sweep) {
  SweepRule rule;
  const double wanted = bounds.scaled_jacobian;
  if (!(wanted > 0)) return;
  rule.limit = 1 / (wanted * wanted);
  LiftRule lift{wanted, bounds.shape};
  std::ranges::fill(state.awake, 1);
  for (int i = 0; i < max_sweeps && keep_low_awake(state, wanted); ++i) {
    lift.power = i < gentle_sweeps ? gentle : hard;
    if (i == gentle_sweeps) {  // what rests by the one energy may not by the other
      std::ranges::fill(state.awake, 1);
      keep_low_awake(state, wanted);
    }
    const SweepCount count = sweep(state, [&] {
      return [&, patch = LiftPatch(state.problem, lift)](Index slot, bool& moved) mutable {
        return improve_node(state, rule, slot, patch, moved);
      };
    });
    if (!after_sweep(count)) return;
  }
}

void lift_scaled_jacobians(Mesh& mesh, Association& association, const Model* model, const SmoothOptions& options,
                           double wanted, int sweeps, const BoundsOf& bounds) {
  if (!association.empty()) association.node_parameters.resize(mesh.points.size());
  const SmoothProblem problem = make_smooth_problem(mesh, association, model, options);
  if (problem.n_nodes() == 0) return;
  SmoothState state{problem, mesh, association, model, std::vector<std::uint8_t>(problem.nodes.size(), 1)};
  const std::vector<Vec3> points = mesh.points;
  const std::vector<Parameters> parameters = association.node_parameters;
  const std::vector<Index> inverted_before = inverted_hexes(mesh, problem.hexes);
  const Bounds before = bounds ? bounds(problem.hexes) : bounds_of(mesh, problem.hexes, wanted);
  lift_low(state, {wanted, before.shape}, sweeps, [](const SweepCount&) { return true; });
  take_back(state, points, parameters, inverted_before, before);
}

}  // namespace hextwist
