
#include "hextwist/mesh/smooth/sweep_internal.h"

namespace hextwist {

double worst_corner(const Vec3* points, std::span<const Ring> rings, const Vec3& x) {
  double worst = 1;
  const auto look = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    worst = std::min(worst, a.dot(b.cross(c)) / std::sqrt(a.squaredNorm() * b.squaredNorm() * c.squaredNorm()));
  };
  for (const Ring& ring : rings) {
    const Vec3 &a = points[ring.edge[0]], &b = points[ring.edge[1]], &c = points[ring.edge[2]];
    const Vec3 &ab = points[ring.face[0]], &ac = points[ring.face[1]], &bc = points[ring.face[2]];
    look(a - x, b - x, c - x);
    // At the ends of the edges, seen so that the determinant is positive too.
    look(x - a, ac - a, ab - a);
    look(x - b, ab - b, bc - b);
    look(x - c, bc - c, ac - c);
  }
  return worst;
}

namespace {

constexpr double parallel_sine = 1e-6;

/// What a hold leaves of these directions (of all, where there are none).
Tangents held(const Tangents& free, const Hold& hold) {
  Tangents result;
  if (free.n == 1) {
    for (int i = 0; i < hold.n; ++i)
      if (std::abs(free.direction[0].dot(hold.normal[i])) > parallel_sine) return result;
    return free;
  }
  Hold taken;
  if (free.n == 2) taken.add(free.direction[0].cross(free.direction[1]));
  for (int i = 0; i < hold.n; ++i) taken.add(hold.normal[i]);
  result.n = 3 - taken.n;
  if (result.n == 1) result.direction[0] = taken.normal[0].cross(taken.normal[1]);
  if (result.n == 2) {
    result.direction[0] = taken.normal[0].unitOrthogonal();
    result.direction[1] = taken.normal[0].cross(result.direction[0]);
  }
  return result;
}

}  // namespace

Tangents tangents(SmoothState& state, Index slot) {
  const Owner owner = state.problem.owner[slot];
  const Index node = state.problem.nodes[slot];
  const Hold* hold = state.problem.hold_of(slot);
  Tangents result;
  if (owner.dim == 3) return held({}, *hold);
  Parameters& at = state.association.node_parameters[node];
  if (std::isnan(at.u)) at = state.model->project(owner, state.mesh.points[node]).parameters;
  if (owner.dim == 1) {
    result.direction[0] = state.model->tangent(owner.id, at.u);
    result.n = result.direction[0].squaredNorm() > 0.5;
  } else {
    const Vec3 normal = state.model->normal(owner.id, at);
    if (!(normal.squaredNorm() > 0.5)) return result;
    result.direction[0] = normal.unitOrthogonal();
    result.direction[1] = normal.cross(result.direction[0]);
    result.n = 2;
  }
  return hold && result.n > 0 ? held(result, *hold) : result;
}

Vec3 within(const Tangents& tangents, const Vec3& step) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < tangents.n; ++i) sum += tangents.direction[i].dot(step) * tangents.direction[i];
  return sum;
}

Vec3 tangent_step(const Tangents& tangents, const Local& local) {
  const Vec3 &a = tangents.direction[0], &b = tangents.direction[1];
  if (tangents.n == 0) return Vec3::Zero();
  const Vec3 ha = local.hessian * a;
  const double aa = a.dot(ha), ga = a.dot(local.gradient);
  if (tangents.n == 1) return -ga / aa * a;
  const double shift = 1e-12 * local.hessian.trace();
  const double ab = b.dot(ha), bb = b.dot(local.hessian * b) + shift, gb = b.dot(local.gradient);
  const double determinant = (aa + shift) * bb - ab * ab;
  return ((ab * gb - bb * ga) * a + (ab * ga - (aa + shift) * gb) * b) / determinant;
}

bool slide(const SmoothState& state, Index slot, const Vec3& step, Projection& result) {
  const Index node = state.problem.nodes[slot];
  const Vec3 from = state.mesh.points[node], to = from + step;
  const Owner owner = state.problem.owner[slot];
  const Hold* hold = state.problem.hold_of(slot);
  if (owner.dim == 3) {
    result.point = to;
    return true;
  }
  const Parameters seed = state.association.node_parameters[node];
  state.model->project(owner, {&to, 1}, {&seed, 1}, {&result, 1});
  if (hold) {
    // Where the surface bends away from what holds the node, back and forth between the two.
    constexpr int max_rounds = 8;
    constexpr double held_well = 1e-10;  // of the step
    for (int round = 0;; ++round) {
      Vec3 off = Vec3::Zero();
      for (int i = 0; i < hold->n; ++i) off += hold->normal[i].dot(result.point - from) * hold->normal[i];
      if (off.squaredNorm() <= held_well * held_well * step.squaredNorm()) break;
      if (round == max_rounds) return false;
      const Vec3 back = result.point - off;
      const Parameters near = result.parameters;
      state.model->project(owner, {&back, 1}, {&near, 1}, {&result, 1});
    }
  }
  // The surface bends away from its tangent plane by less than the step, or the step is too long for it.
  return (result.point - to).squaredNorm() <= step.squaredNorm();
}

}  // namespace hextwist
