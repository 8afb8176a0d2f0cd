#include "hextwist/mesh/smooth/sweep_internal.h"

namespace hextwist {
namespace {

/// Average of the edge neighbours, each counted once per hex around; a sliding node looks only at neighbours that
/// slide or stay on the boundary too, so that it is not pulled inwards.
Vec3 neighbour_average(const SmoothState& state, Index slot) {
  const SmoothProblem& problem = state.problem;
  const int dim = problem.owner[slot].dim;
  Vec3 sum = Vec3::Zero();
  int n = 0;
  for (Index r = problem.first_ring[slot]; r < problem.first_ring[slot + 1]; ++r)
    for (const Index node : problem.rings[r].edge)
      if (dim == 3 || state.association.node_owner[node].dim <= dim) {
        sum += state.mesh.points[node];
        ++n;
      }
  return n == 0 ? state.mesh.points[problem.nodes[slot]] : Vec3(sum / n);
}

bool average_node(SmoothState& state, const SweepRule& rule, Index slot, ShapePatch<false>& patch, bool& moved) {
  const SmoothProblem& problem = state.problem;
  const Index node = problem.nodes[slot], first = problem.first_ring[slot];
  const Vec3 x0 = state.mesh.points[node];
  patch.load(state.mesh.points.data(), x0,
             {problem.rings.data() + first, static_cast<std::size_t>(problem.first_ring[slot + 1] - first)});
  const double before = patch.at(Vec3::Zero()).worst;
  if (!std::isfinite(before)) return false;
  const bool slides = problem.slides(slot), on_model = problem.owner[slot].dim < 3;
  Vec3 step = neighbour_average(state, slot) - x0;
  if (slides) {
    const Tangents directions = tangents(state, slot);  // and the parameters
    if (problem.hold_of(slot)) step = within(directions, step);
  }
  Projection place;
  for (int halving = 0; halving < 3; ++halving, step /= 2) {
    Vec3 y = step;
    if (slides) {
      if (!slide(state, slot, step, place)) continue;
      y = place.point - x0;
    }
    if (!within_limit(rule, before, patch.at(y).worst)) continue;
    moved = y.squaredNorm() > rule.tolerance * rule.tolerance * patch.edge_squared();
    if (moved) {
      move_node(state, slot, slides ? place.point : x0 + y, true);
      if (on_model) state.association.node_parameters[node] = place.parameters;
    }
    return true;
  }
  return true;
}

}  // namespace

SweepCount sweep_laplacian(SmoothState& state, const SweepRule& rule) {
  return sweep(state, [&] {
    return [&, patch = ShapePatch<false>(state.problem, rule)](Index slot, bool& moved) mutable {
      return average_node(state, rule, slot, patch, moved);
    };
  });
}

}  // namespace hextwist
