// Condition number: kappa = |A| |adj A| / (3 det A). All three factors are simple in the place x of one node: det A is
// affine, |A|^2 and |adj A|^2 are quadratic, because cross products of two columns that both contain x lose their
// second power.
#include <algorithm>

#include "hextwist/mesh/smooth/condition_internal.h"
#include "hextwist/mesh/smooth/sweep_internal.h"

namespace hextwist {

void ConditionPatch::Cofactors::add(const Vec3& constant, const Vec3& e) {
  // |constant + e x y|^2 = |constant|^2 + 2 y.(constant x e) + y'(|e|^2 I - e e')y
  value += constant.squaredNorm();
  linear += constant.cross(e);
  quadratic += e.squaredNorm() * Eigen::Matrix3d::Identity() - e * e.transpose();
}

void ConditionPatch::load(const Vec3* points, const Vec3& x0, std::span<const Ring> rings) {
  n_ = rings.size();
  for (std::size_t i = 0; i < n_; ++i) {
    const Ring& ring = rings[i];
    corners_[i] = corner_terms(points, x0, ring);
    std::array<Cofactors, 4>& cofactors = cofactors_[i];
    cofactors.fill({});
    std::array<Vec3, 3> end, face;
    for (int k = 0; k < 3; ++k) {
      end[k] = points[ring.edge[k]] - x0;
      face[k] = points[ring.face[k]] - x0;
    }
    // At x: (a - y) x (b - y) = a x b + (b - a) x y.
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = end[k], &b = end[(k + 1) % 3];
      cofactors[0].add(a.cross(b), b - a);
    }
    // At an end a: columns a - y, e, f; e x (a - y) = e x a - e x y.
    constexpr int faces_at[3][2] = {{0, 1}, {2, 0}, {1, 2}};
    for (int k = 0; k < 3; ++k) {
      const Vec3 e = face[faces_at[k][0]] - end[k], f = face[faces_at[k][1]] - end[k];
      cofactors[k + 1].add(e.cross(f), Vec3::Zero());
      cofactors[k + 1].add(e.cross(end[k]), -e);
      cofactors[k + 1].add(f.cross(end[k]), -f);
    }
  }
}

double ConditionPatch::edge_squared() const {
  double sum = 0;
  for (std::size_t i = 0; i < n_; ++i) sum += corners_[i].n[0];
  return sum / (3 * static_cast<double>(n_));
}

Local ConditionPatch::evaluate(const Vec3& y, bool with_derivatives) const {
  Local local;
  double energy = 0, worst = 0;
  const double y_squared = y.squaredNorm();
  for (std::size_t i = 0; i < n_; ++i) {
    const CornerTerms& t = corners_[i];
    const auto [determinants, squares] = values(t, y, y_squared);
    for (int c = 0; c < 4; ++c) {
      const double d = determinants[c], n = squares[c];
      if (!(d > 0)) return {};
      const Cofactors& q = cofactors_[i][c];
      const Vec3 qy = q.quadratic * y;
      const double m = q.value + 2 * q.linear.dot(y) + y.dot(qy);
      const double kappa = std::sqrt(n * m) / (3 * d);
      const double power = weight_ * std::pow(kappa * inverse_reference_, 16);
      worst = std::max(worst, inverse_root_27 * n * std::sqrt(n) / d);
      energy += kappa + power;
      if (!with_derivatives) continue;
      const double first = kappa + 16 * power, second = kappa + 256 * power, k = c == 0 ? 3 : 1;
      const Vec3 dn = 2 / n * (k * y - Vec3(t.sx[c], t.sy[c], t.sz[c])), dm = 2 / m * (q.linear + qy);
      const Vec3 dd = Vec3(t.gx[c], t.gy[c], t.gz[c]) / d;
      const Vec3 u = (dn + dm) / 2 - dd;
      local.gradient += first * u;
      local.hessian +=
          second * u * u.transpose() + first * (k / n * Eigen::Matrix3d::Identity() + q.quadratic / m -
                                                (dn * dn.transpose() + dm * dm.transpose()) / 2 + dd * dd.transpose());
    }
  }
  local.energy = energy;
  local.worst = worst;
  return local;
}

SweepCount sweep_condition_number(SmoothState& state, const SweepRule& rule) {
  return sweep(state, [&] {
    return [&, patch = ConditionPatch(state.problem, rule)](Index slot, bool& moved) mutable {
      return improve_node(state, rule, slot, patch, moved);
    };
  });
}

}  // namespace hextwist
