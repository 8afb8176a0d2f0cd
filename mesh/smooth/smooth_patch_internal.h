// The corner matrices around one node, as functions of that node's place x alone, four at a time.
//
// Let y = x - x0, A the matrix of the edge vectors at a corner. Then det A = d + g.y is affine, |A|^2 = n - 2 s.y +
// k|y|^2 is quadratic (k: how many columns contain x), and so the distortion h = (|A|^2 / 3)^(3/2) / det A, which is
// shape^(-3/2), has derivatives in closed form:
//   grad h = h u,  Hess h = h (u u' + 3k / N I - 3/2 m m' + c c'),  u = 3/2 m - c,  m = grad N / N,  c = g / D.
// h is convex where D > 0: |A(x)|^3 / D(x) is a power 3 >= 1 + 1 of a norm over an affine function. So is every
// increasing convex function of it, and every maximum or sum: one node's problem has one minimum.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "hextwist/mesh/smooth/problem_internal.h"

namespace hextwist {

using Four = Eigen::Array<double, 4, 1>;

/// One hex: the corner x itself, then the ends of its three edges at x.
struct CornerTerms {
  Four gx, gy, gz, d;
  Four sx, sy, sz, n;
};

/// k of the four corners.
inline Four columns_with_x() {
  return Four(3, 1, 1, 1);
}

[[gnu::always_inline]] inline CornerTerms corner_terms(const Vec3* points, const Vec3& x0, const Ring& ring) {
  const Vec3 a = points[ring.edge[0]] - x0, b = points[ring.edge[1]] - x0, c = points[ring.edge[2]] - x0;
  const Vec3 ab = points[ring.face[0]] - x0, ac = points[ring.face[1]] - x0, bc = points[ring.face[2]] - x0;
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), cc = c.squaredNorm();
  CornerTerms t;
  const auto put = [&t](int i, const Vec3& g, double d, const Vec3& s, double n) {
    t.gx[i] = g.x();
    t.gy[i] = g.y();
    t.gz[i] = g.z();
    t.d[i] = d;
    t.sx[i] = s.x();
    t.sy[i] = s.y();
    t.sz[i] = s.z();
    t.n[i] = n;
  };
  const Vec3 b_x_c = b.cross(c);
  put(0, -(b_x_c + c.cross(a) + a.cross(b)), a.dot(b_x_c), a + b + c, aa + bb + cc);
  // At the end a of an edge: columns a - y, ab - a, ac - a.
  const auto put_end = [&put](int i, const Vec3& end, double square, const Vec3& e, const Vec3& f) {
    const Vec3 w = e.cross(f);
    put(i, -w, end.dot(w), end, square + e.squaredNorm() + f.squaredNorm());
  };
  put_end(1, a, aa, ab - a, ac - a);
  put_end(2, b, bb, bc - b, ab - b);
  put_end(3, c, cc, ac - c, bc - c);
  return t;
}

/// Determinants and squared norms at y.
struct CornerValues {
  Four determinant, square;
};
[[gnu::always_inline]] inline CornerValues values(const CornerTerms& t, const Vec3& y, double y_squared) {
  return {t.d + t.gx * y.x() + t.gy * y.y() + t.gz * y.z(),
          t.n - 2 * (t.sx * y.x() + t.sy * y.y() + t.sz * y.z()) + columns_with_x() * y_squared};
}

inline constexpr double inverse_root_27 = 0.19245008972987526;  ///< 3^(-3/2)
inline constexpr double never = std::numeric_limits<double>::infinity();

/// Energy of one node's corners, with its derivatives.
struct Local {
  double energy = never;  ///< infinite where a determinant is not positive
  double worst = never;   ///< largest h
  Vec3 gradient = Vec3::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

/// Sums of derivatives of all corners, and how one set of four enters them. first = phi'(h) h, second = phi'(h) h +
/// phi''(h) h^2 for an energy phi(h).
struct DerivativeSums {
  Four x, y, z, xx, xy, xz, yy, yz, zz, identity;

  DerivativeSums() { x = y = z = xx = xy = xz = yy = yz = zz = identity = Four::Zero(); }

  [[gnu::always_inline]] inline void add(const CornerTerms& t, const Four& inverse_determinant,
                                         const Four& inverse_square, const Four& first, const Four& second) {
    const Four scale = -2 * inverse_square;
    const Four mx = t.sx * scale, my = t.sy * scale, mz = t.sz * scale;
    const Four cx = t.gx * inverse_determinant, cy = t.gy * inverse_determinant, cz = t.gz * inverse_determinant;
    x += first * (1.5 * mx - cx);
    y += first * (1.5 * my - cy);
    z += first * (1.5 * mz - cz);
    identity += (3 * first) * (columns_with_x() * inverse_square);
    const Four mm = 2.25 * second - 1.5 * first, mc = -1.5 * second, cc = second + first;
    const Four px = mm * mx + mc * cx, py = mm * my + mc * cy, pz = mm * mz + mc * cz;
    const Four qx = mc * mx + cc * cx, qy = mc * my + cc * cy, qz = mc * mz + cc * cz;
    xx += px * mx + qx * cx;
    xy += px * my + qx * cy;
    xz += px * mz + qx * cz;
    yy += py * my + qy * cy;
    yz += py * mz + qy * cz;
    zz += pz * mz + qz * cz;
  }
  void store(Local& local) const {
    local.gradient = Vec3(x.sum(), y.sum(), z.sum());
    const double i = identity.sum(), h01 = xy.sum(), h02 = xz.sum(), h12 = yz.sum();
    local.hessian << xx.sum() + i, h01, h02, h01, yy.sum() + i, h12, h02, h12, zz.sum() + i;
  }
};

/// The default energy: sum of h + weight * reference * (h / reference)^16.
template <bool with_power>
class ShapePatch {
 public:
  ShapePatch(const SmoothProblem& problem, const SweepRule& rule)
      : corners_(problem.max_rings), weight_(rule.weight * rule.reference), inverse_reference_(1 / rule.reference) {}

  void load(const Vec3* points, const Vec3& x0, std::span<const Ring> rings) {
    n_ = rings.size();
    for (std::size_t i = 0; i < n_; ++i) corners_[i] = corner_terms(points, x0, rings[i]);
  }
  /// Mean square of the edges at the node.
  double edge_squared() const {
    double sum = 0;
    for (std::size_t i = 0; i < n_; ++i) sum += corners_[i].n[0];
    return sum / (3 * static_cast<double>(n_));
  }
  /// At y = 0.
  Local derivatives() const {
    Four energy = Four::Zero(), worst = Four::Zero(), least = Four::Constant(never);
    DerivativeSums sums;
    for (std::size_t i = 0; i < n_; ++i) {
      const CornerTerms& t = corners_[i];
      const Four inverse_determinant = 1 / t.d, inverse_square = 1 / t.n;
      const Four h = (inverse_root_27 * t.n) * t.n.sqrt() * inverse_determinant;
      worst = worst.max(h);
      least = least.min(t.d);
      energy += h;
      if constexpr (with_power) {
        const Four power = weight_ * sixteenth(h * inverse_reference_);
        energy += power;
        sums.add(t, inverse_determinant, inverse_square, h + 16 * power, h + 256 * power);
      } else {
        sums.add(t, inverse_determinant, inverse_square, h, h);
      }
    }
    Local local;
    if (!(least.minCoeff() > 0)) return local;
    local.energy = energy.sum();
    local.worst = worst.maxCoeff();
    sums.store(local);
    return local;
  }
  /// Energy and worst only.
  Local at(const Vec3& y) const {
    Four energy = Four::Zero(), worst = Four::Zero(), least = Four::Constant(never);
    const double y_squared = y.squaredNorm();
    for (std::size_t i = 0; i < n_; ++i) {
      const auto [determinant, square] = values(corners_[i], y, y_squared);
      const Four h = (inverse_root_27 * square) * square.sqrt() / determinant;
      worst = worst.max(h);
      least = least.min(determinant);
      energy += h;
      if constexpr (with_power) energy += weight_ * sixteenth(h * inverse_reference_);
    }
    Local local;
    if (!(least.minCoeff() > 0)) return local;
    local.energy = energy.sum();
    local.worst = worst.maxCoeff();
    return local;
  }

 private:
  static Four sixteenth(const Four& q) {
    const Four q2 = q * q, q4 = q2 * q2, q8 = q4 * q4;
    return q8 * q8;
  }
  std::vector<CornerTerms> corners_;
  std::size_t n_ = 0;
  double weight_, inverse_reference_;
};

}  // namespace hextwist
