// One sweep over the nodes: Newton's method on each node's own energy, with a line search, colour after colour.
//
// A patch offers load(points, x0, rings), edge_squared(), derivatives() at the node's place and at(y) beside it.
#pragma once

#include <atomic>
#include <cmath>

#include "hextwist/base/parallel.h"
#include "hextwist/mesh/smooth/smooth_patch_internal.h"

namespace hextwist {

/// Newton's step -H^-1 g by Cholesky, with as much of the identity added to H as it takes to make it positive definite.
inline Vec3 newton_step(const Eigen::Matrix3d& h, const Vec3& g) {
  const double size = std::abs(h(0, 0)) + std::abs(h(1, 1)) + std::abs(h(2, 2));
  Vec3 step = Vec3::Zero();
  for (double shift = 1e-12 * size; shift <= 10 * size; shift = std::max(10 * shift, 1e-3 * size)) {
    const double p0 = h(0, 0) + shift, d0 = 1 / p0, l10 = h(0, 1) * d0, l20 = h(0, 2) * d0;
    const double p1 = h(1, 1) + shift - l10 * h(0, 1), d1 = 1 / p1, t = h(1, 2) - l10 * h(0, 2), l21 = t * d1;
    const double p2 = h(2, 2) + shift - l20 * h(0, 2) - l21 * t, d2 = 1 / p2;
    if (!(p0 > 0 && p1 > 0 && p2 > 0)) continue;
    const double y0 = -g[0], y1 = -g[1] - l10 * y0, y2 = -g[2] - l20 * y0 - l21 * y1;
    step[2] = y2 * d2;
    step[1] = y1 * d1 - l21 * step[2];
    step[0] = y0 * d0 - l10 * step[1] - l20 * step[2];
    break;
  }
  return step;
}

/// The directions that a node may take that slides: 1 or 2 orthonormal columns; 0 where it can't be told or there is
/// none.
struct Tangents {
  int n = 0;
  std::array<Vec3, 2> direction = {Vec3::Zero(), Vec3::Zero()};
};
/// Makes the node's parameters known where they are not.
Tangents tangents(SmoothState& state, Index slot);

/// Newton's step within them; the part of any step within them.
Vec3 tangent_step(const Tangents& tangents, const Local& local);
Vec3 within(const Tangents& tangents, const Vec3& step);

/// Where a sliding node arrives after `step`; false when the projection leads elsewhere.
bool slide(const SmoothState& state, Index slot, const Vec3& step, Projection& result);

/// Moves the node and wakes it and its neighbours.
inline void move_node(SmoothState& state, Index slot, const Vec3& to, bool wake) {
  state.mesh.points[state.problem.nodes[slot]] = to;
  if (!wake) return;
  const auto set = [&](Index node) {
    if (const Index s = state.problem.slot[node]; s >= 0)
      std::atomic_ref(state.awake[s]).store(1, std::memory_order_relaxed);
  };
  set(state.problem.nodes[slot]);
  for (Index r = state.problem.first_ring[slot]; r < state.problem.first_ring[slot + 1]; ++r) {
    for (const Index node : state.problem.rings[r].edge) set(node);
    for (const Index node : state.problem.rings[r].face) set(node);
  }
}

/// Relative slack of the limit: distortions are computed in another order by quality(), so a corner that comes near
/// to the limit must stay clear of it by more than rounding.
inline constexpr double limit_slack = 1e-9;

/// May corners whose worst was `before` get `after`?
inline bool within_limit(const SweepRule& rule, double before, double after) {
  return after <= (before < rule.limit * (1 - limit_slack) ? rule.limit : before) * (1 - limit_slack);
}

/// The smallest scaled Jacobian of the corners that a node at x is part of.
double worst_corner(const Vec3* points, std::span<const Ring> rings, const Vec3& x);

/// May the node go to `to`, where the largest distortion is `worst`? By the inequality of the means no scaled Jacobian
/// is below one over its corner's distortion, so that few need a look.
inline bool keeps_corners(const SmoothState& state, const SweepRule& rule, std::span<const Ring> rings,
                          const Vec3& from, const Vec3& to, double worst) {
  if (!(worst * rule.least_corner > 1 - limit_slack)) return true;
  const double after = worst_corner(state.mesh.points.data(), rings, to);
  return after > rule.least_corner * (1 + limit_slack) || after > worst_corner(state.mesh.points.data(), rings, from);
}

template <class Patch>
bool improve_node(SmoothState& state, const SweepRule& rule, Index slot, Patch& patch, bool& moved) {
  const SmoothProblem& problem = state.problem;
  const Index node = problem.nodes[slot];
  const Vec3 x0 = state.mesh.points[node];
  const Index first = problem.first_ring[slot];
  const std::span<const Ring> rings(problem.rings.data() + first,
                                    static_cast<std::size_t>(problem.first_ring[slot + 1] - first));
  patch.load(state.mesh.points.data(), x0, rings);
  const Local local = patch.derivatives();
  if (!std::isfinite(local.energy)) return false;
  const bool slides = problem.slides(slot), on_model = problem.owner[slot].dim < 3;
  Vec3 step = slides ? tangent_step(tangents(state, slot), local) : newton_step(local.hessian, local.gradient);
  double slope = step.dot(local.gradient);
  // Written so that NaN ends it too. Below this, the energy's own rounding decides.
  if (!(slope < -1e-14 * local.energy)) return true;
  Projection place;
  for (int halving = 0; halving < 12; ++halving, step /= 2, slope /= 2) {
    Vec3 y = step;
    if (slides) {
      if (!slide(state, slot, step, place)) continue;
      y = place.point - x0;
    }
    const Local there = patch.at(y);
    if (!(there.energy <= local.energy + 1e-4 * slope) || !within_limit(rule, local.worst, there.worst)) continue;
    if (!keeps_corners(state, rule, rings, x0, x0 + y, there.worst)) continue;
    moved = y.squaredNorm() > rule.tolerance * rule.tolerance * patch.edge_squared();
    move_node(state, slot, slides ? place.point : x0 + y, moved);
    if (on_model) state.association.node_parameters[node] = place.parameters;
    return true;
  }
  return true;
}

/// Visits the nodes that are awake, colour by colour; visit(slot, moved) returns whether the node counts as updated.
/// make_visit() is called once per piece of work, so that what it holds belongs to one thread.
template <class MakeVisit>
SweepCount sweep(SmoothState& state, const MakeVisit& make_visit) {
  std::atomic<std::int64_t> updates = 0, n_moved = 0;
  for (Index colour = 0; colour < state.problem.n_colours(); ++colour) {
    const Index first = state.problem.first_colour[colour];
    parallel_ranges(
        state.problem.first_colour[colour + 1] - first,
        [&](Index begin, Index end) {
          auto visit = make_visit();
          std::int64_t count = 0, count_moved = 0;
          for (Index slot = first + begin; slot < first + end; ++slot) {
            std::atomic_ref awake(state.awake[slot]);
            if (!awake.load(std::memory_order_relaxed)) continue;
            awake.store(0, std::memory_order_relaxed);
            bool moved = false;
            count += visit(slot, moved);
            count_moved += moved;
          }
          updates.fetch_add(count, std::memory_order_relaxed);
          n_moved.fetch_add(count_moved, std::memory_order_relaxed);
        },
        512);
  }
  return {updates, n_moved};
}

}  // namespace hextwist
