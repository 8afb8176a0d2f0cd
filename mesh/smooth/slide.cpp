
#include "hextwist/mesh/smooth/sweep_internal.h"

namespace hextwist {

Tangents tangents(SmoothState& state, Index slot) {
  const Owner owner = state.problem.owner[slot];
  const Index node = state.problem.nodes[slot];
  Parameters& at = state.association.node_parameters[node];
  if (std::isnan(at.u)) at = state.model->project(owner, state.mesh.points[node]).parameters;
  Tangents result;
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
  return result;
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
  const Vec3 to = state.mesh.points[node] + step;
  const Parameters seed = state.association.node_parameters[node];
  state.model->project(state.problem.owner[slot], {&to, 1}, {&seed, 1}, {&result, 1});
  // The surface bends away from its tangent plane by less than the step, or the step is too long for it.
  return (result.point - to).squaredNorm() <= step.squaredNorm();
}

}  // namespace hextwist
