#include <algorithm>
#include <cmath>

#include "hextwist/mesh/smooth/lift_patch_internal.h"

namespace hextwist {
namespace {

/// h from the sum of the squared lengths and the determinant.
[[gnu::always_inline]] inline Four distortions(const Four& sum, const Four& determinant) {
  const Four third = sum / 3, ratio = third / determinant;
  return third * ratio * ratio;
}
/// Squared lengths of the three edges, for all lanes that they enter: their product and sum.
[[gnu::always_inline]] inline Four products(const Vec3& square, const Four& rest) {
  return rest * Four(square[0] * square[1] * square[2], square[0], square[1], square[2]);
}
[[gnu::always_inline]] inline Four sums(const Vec3& square, const Four& sum) {
  return sum + Four(square[0] + square[1] + square[2], square[0], square[1], square[2]);
}
/// A quantity per edge, for all lanes that it enters.
[[gnu::always_inline]] inline Four spread(double a, double b, double c) {
  return Four(a + b + c, a, b, c);
}

}  // namespace

LiftPatch::LiftPatch(const SmoothProblem& problem, const LiftRule& rule)
    : corners_(problem.max_rings),
      power_(rule.power),
      f_scale_(rule.wanted * rule.wanted),
      most_h_(rule.least_shape > 0 ? std::pow(rule.least_shape, -3) : never) {}

void LiftPatch::load(const Vec3* points, const Vec3& x0, std::span<const Ring> rings) {
  n_ = rings.size();
  Four h = Four::Constant(std::pow(fair_shape, -3));
  for (std::size_t i = 0; i < n_; ++i) {
    const Ring& ring = rings[i];
    Corners& t = corners_[i];
    const Vec3 a = points[ring.edge[0]] - x0, b = points[ring.edge[1]] - x0, c = points[ring.edge[2]] - x0;
    const Vec3 ab = points[ring.face[0]] - x0, ac = points[ring.face[1]] - x0, bc = points[ring.face[2]] - x0;
    t.end = {a, b, c};
    const auto put = [&t](int k, const Vec3& g, double d, double rest, double sum) {
      t.gx[k] = g.x();
      t.gy[k] = g.y();
      t.gz[k] = g.z();
      t.d[k] = d;
      t.rest[k] = rest;
      t.sum[k] = sum;
    };
    const Vec3 b_x_c = b.cross(c);
    put(0, -(b_x_c + c.cross(a) + a.cross(b)), a.dot(b_x_c), 1, 0);
    const auto put_end = [&put](int k, const Vec3& end, const Vec3& e, const Vec3& f) {
      const Vec3 w = e.cross(f);
      const double ee = e.squaredNorm(), ff = f.squaredNorm();
      put(k + 1, -w, end.dot(w), ee * ff, ee + ff);
    };
    put_end(0, a, ab - a, ac - a);
    put_end(1, b, bc - b, ab - b);
    put_end(2, c, ac - c, bc - c);
    h = h.max(distortions(sums(Vec3(a.squaredNorm(), b.squaredNorm(), c.squaredNorm()), t.sum), t.d));
  }
  h_scale_ = 1 / std::min(h.maxCoeff(), most_h_);
}

double LiftPatch::edge_squared() const {
  double sum = 0;
  for (std::size_t i = 0; i < n_; ++i)
    for (const Vec3& end : corners_[i].end) sum += end.squaredNorm();
  return sum / (3 * static_cast<double>(n_));
}

Four LiftPatch::powered(Four x) const {
  for (int m = 1; m < power_; m *= 2) x *= x;
  return x;
}

// Per corner, with c = grad D / D, v = grad log f = sum of n over its edges - 2 c, n = grad log |e|^2 = -2 e / |e|^2,
// s = grad log S, u = grad log h = 3 s - 2 c, k the number of its edges at the node:
//   Hess log f = 2 c c' + sum of (2 / |e|^2 I - n n'),  Hess log h = 2 c c' + 6 k / S I - 3 s s',
//   grad x^m = m x^m grad log x,  Hess x^m = x^m (m^2 (grad log x)(grad log x)' + m Hess log x).
Local LiftPatch::derivatives() const {
  Four energy = Four::Zero(), worst = Four::Zero(), least = Four::Constant(never);
  Four gx = Four::Zero(), gy = gx, gz = gx, xx = gx, xy = gx, xz = gx, yy = gx, yz = gx, zz = gx, identity = gx;
  Eigen::Matrix3d of_edges = Eigen::Matrix3d::Zero();
  const double m = power_;
  for (std::size_t i = 0; i < n_; ++i) {
    const Corners& t = corners_[i];
    const Vec3 square(t.end[0].squaredNorm(), t.end[1].squaredNorm(), t.end[2].squaredNorm());
    const Vec3 n[3] = {-2 / square[0] * t.end[0], -2 / square[1] * t.end[1], -2 / square[2] * t.end[2]};
    const Four sum = sums(square, t.sum), inverse_d = 1 / t.d, inverse_sum = 1 / sum;
    const Four f = products(square, t.rest) * inverse_d * inverse_d;
    const Four f_power = powered(f * f_scale_), h_power = powered(distortions(sum, t.d) * h_scale_);
    worst = worst.max(f);
    least = least.min(t.d);
    energy += f_power + h_power;
    const Four cx = t.gx * inverse_d, cy = t.gy * inverse_d, cz = t.gz * inverse_d;
    const Four vx = spread(n[0].x(), n[1].x(), n[2].x()) - 2 * cx, vy = spread(n[0].y(), n[1].y(), n[2].y()) - 2 * cy,
               vz = spread(n[0].z(), n[1].z(), n[2].z()) - 2 * cz;
    const Four scale = -2 * inverse_sum;
    const Four sx = scale * spread(t.end[0].x(), t.end[1].x(), t.end[2].x()),
               sy = scale * spread(t.end[0].y(), t.end[1].y(), t.end[2].y()),
               sz = scale * spread(t.end[0].z(), t.end[1].z(), t.end[2].z());
    const Four ux = 3 * sx - 2 * cx, uy = 3 * sy - 2 * cy, uz = 3 * sz - 2 * cz;
    const Four mf = m * f_power, mh = m * h_power;
    gx += mf * vx + mh * ux;
    gy += mf * vy + mh * uy;
    gz += mf * vz + mh * uz;
    const Four mmf = m * mf, mmh = m * mh, both = 2 * (mf + mh), shape = 3 * mh;
    const auto product = [&](const Four& v1, const Four& v2, const Four& u1, const Four& u2, const Four& c1,
                             const Four& c2, const Four& s1, const Four& s2) {
      return mmf * v1 * v2 + mmh * u1 * u2 + both * c1 * c2 - shape * s1 * s2;
    };
    xx += product(vx, vx, ux, ux, cx, cx, sx, sx);
    xy += product(vx, vy, ux, uy, cx, cy, sx, sy);
    xz += product(vx, vz, ux, uz, cx, cz, sx, sz);
    yy += product(vy, vy, uy, uy, cy, cy, sy, sy);
    yz += product(vy, vz, uy, uz, cy, cz, sy, sz);
    zz += product(vz, vz, uz, uz, cz, cz, sz, sz);
    identity += 6 * mh * columns_with_x() * inverse_sum;
    for (int k = 0; k < 3; ++k) {
      const double weight = mf[0] + mf[k + 1];
      of_edges.noalias() -= weight * n[k] * n[k].transpose();
      of_edges.diagonal().array() += 2 * weight / square[k];
    }
  }
  Local local;
  if (!(least.minCoeff() > 0)) return local;
  local.energy = energy.sum();
  local.worst = worst.maxCoeff();
  local.gradient = Vec3(gx.sum(), gy.sum(), gz.sum());
  const double i = identity.sum(), h01 = xy.sum(), h02 = xz.sum(), h12 = yz.sum();
  local.hessian << xx.sum() + i, h01, h02, h01, yy.sum() + i, h12, h02, h12, zz.sum() + i;
  local.hessian += of_edges;
  return local;
}

Local LiftPatch::at(const Vec3& y) const {
  Four energy = Four::Zero(), worst = Four::Zero(), worst_h = Four::Zero(), least = Four::Constant(never);
  for (std::size_t i = 0; i < n_; ++i) {
    const Corners& t = corners_[i];
    const Vec3 square((t.end[0] - y).squaredNorm(), (t.end[1] - y).squaredNorm(), (t.end[2] - y).squaredNorm());
    const Four d = t.d + t.gx * y.x() + t.gy * y.y() + t.gz * y.z();
    const Four f = products(square, t.rest) / (d * d), h = distortions(sums(square, t.sum), d);
    least = least.min(d);
    worst = worst.max(f);
    worst_h = worst_h.max(h);
    energy += powered(f * f_scale_) + powered(h * h_scale_);
  }
  Local local;
  if (!(least.minCoeff() > 0) || worst_h.maxCoeff() > most_h_) return local;
  local.energy = energy.sum();
  local.worst = worst.maxCoeff();
  return local;
}

}  // namespace hextwist
