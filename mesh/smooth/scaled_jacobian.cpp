#include "hextwist/mesh/smooth/scaled_jacobian_internal.h"

#include "hextwist/mesh/smooth/problem_internal.h"

namespace hextwist {

void ScaledJacobianPatch::load(const Vec3* points, const Vec3& x0, std::span<const Ring> rings) {
  n_ = rings.size();
  for (std::size_t i = 0; i < n_; ++i) {
    const Ring& ring = rings[i];
    Corners& t = corners_[i];
    const Vec3 a = points[ring.edge[0]] - x0, b = points[ring.edge[1]] - x0, c = points[ring.edge[2]] - x0;
    const Vec3 ab = points[ring.face[0]] - x0, ac = points[ring.face[1]] - x0, bc = points[ring.face[2]] - x0;
    const Vec3 abc = points[ring.opposite] - x0;
    t.end = {a,
             b,
             c,
             a + (ab - b) + (ac - c) + (abc - bc),
             b + (ab - a) + (bc - c) + (abc - ac),
             c + (ac - a) + (bc - b) + (abc - ab)};
    for (const int k : {0, 4}) {
      const Vec3 &p = t.end[k ? 3 : 0], &q = t.end[k ? 4 : 1], &r = t.end[k ? 5 : 2];
      const Vec3 q_x_r = q.cross(r);
      t.g[k] = -(q_x_r + r.cross(p) + p.cross(q));
      t.d[k] = p.dot(q_x_r);
    }
    const auto put_end = [&t](int k, const Vec3& end, const Vec3& e, const Vec3& f) {
      const Vec3 w = e.cross(f);
      t.g[k + 1] = -w;
      t.d[k + 1] = end.dot(w);
      t.rest[k] = e.squaredNorm() * f.squaredNorm();
    };
    put_end(0, a, ab - a, ac - a);
    put_end(1, b, bc - b, ab - b);
    put_end(2, c, ac - c, bc - c);
  }
}

double ScaledJacobianPatch::edge_squared() const {
  double sum = 0;
  for (std::size_t i = 0; i < n_; ++i)
    for (int k = 0; k < 3; ++k) sum += corners_[i].end[k].squaredNorm();
  return sum / (3 * static_cast<double>(n_));
}

double ScaledJacobianPatch::powered(double f) const {
  double result = f;
  for (int m = 1; m < power_; m *= 2) result *= result;
  return result;
}

Local ScaledJacobianPatch::derivatives() const {
  Local local;
  local.energy = local.worst = 0;
  const double m = power_;
  for (std::size_t i = 0; i < n_; ++i) {
    const Corners& t = corners_[i];
    std::array<double, 6> square;
    std::array<Vec3, 6> n;  // gradient of the logarithm of the squared length
    for (int k = 0; k < 6; ++k) {
      square[k] = t.end[k].squaredNorm();
      n[k] = -2 / square[k] * t.end[k];
    }
    for (int c = 0; c < 5; ++c) {
      if (!(t.d[c] > 0)) return {};
      const Vec3 dd = t.g[c] / t.d[c];
      double product = 1;
      Vec3 v = -2 * dd;
      Eigen::Matrix3d curvature = 2 * dd * dd.transpose();
      for (int k = c == 0 ? 0 : c == 4 ? 3 : c - 1, end = c == 0 ? 3 : c == 4 ? 6 : c; k < end; ++k) {
        product *= square[k];
        v += n[k];
        curvature.diagonal().array() += 2 / square[k];
        curvature -= n[k] * n[k].transpose();
      }
      const double f = product * (c == 0 || c == 4 ? 1 : t.rest[c - 1]) / (t.d[c] * t.d[c]), power = powered(f);
      local.worst = std::max(local.worst, f);
      local.energy += power;
      local.gradient += m * power * v;
      local.hessian += power * (m * m * v * v.transpose() + m * curvature);
    }
  }
  return local;
}

Local ScaledJacobianPatch::at(const Vec3& y) const {
  Local local;
  double energy = 0, worst = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    const Corners& t = corners_[i];
    std::array<double, 5> product;
    product[0] = product[4] = 1;
    for (int k = 0; k < 3; ++k) {
      const double square = (t.end[k] - y).squaredNorm();
      product[0] *= square;
      product[k + 1] = square * t.rest[k];
      product[4] *= (t.end[k + 3] - y).squaredNorm();
    }
    for (int c = 0; c < 5; ++c) {
      const double d = t.d[c] + t.g[c].dot(y);
      if (!(d > 0)) return local;
      const double f = product[c] / (d * d);
      worst = std::max(worst, f);
      energy += powered(f);
    }
  }
  local.energy = energy;
  local.worst = worst;
  return local;
}

}  // namespace hextwist
