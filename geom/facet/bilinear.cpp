#include "hextwist/geom/facet/bilinear.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "hextwist/geom/facet/newton_internal.h"
#include "hextwist/geom/segment.h"

namespace hextwist {
namespace {

// Roots and weights of the Legendre polynomials of degree 4 and 2, on [0, 1].
constexpr std::array<double, 4> gauss4 = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                          0.93056815579702629};
constexpr std::array<double, 4> weight4 = {0.17392742256872692, 0.32607257743127307, 0.32607257743127307,
                                           0.17392742256872692};
constexpr std::array<double, 2> gauss2 = {0.21132486540518712, 0.78867513459481288};

double cross2(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

Vec3 point(const BilinearPatch& x, double s, double t) {
  // This form gives the corners and edges bit for bit.
  return (1 - t) * ((1 - s) * x[0] + s * x[1]) + t * ((1 - s) * x[3] + s * x[2]);
}

Vec3 area_vector(const BilinearPatch& x, double s, double t) {
  const Vec3 ds = (1 - t) * (x[1] - x[0]) + t * (x[2] - x[3]);
  const Vec3 dt = (1 - s) * (x[3] - x[0]) + s * (x[2] - x[1]);
  return ds.cross(dt);
}

double area(const BilinearPatch& patch) {
  double sum = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) sum += weight4[i] * weight4[j] * area_vector(patch, gauss4[i], gauss4[j]).norm();
  return sum;
}

double cone_volume(const BilinearPatch& patch, const Vec3& apex) {
  // The integrand is quadratic in s and in t.
  double sum = 0;
  for (const double s : gauss2)
    for (const double t : gauss2) sum += (point(patch, s, t) - apex).dot(area_vector(patch, s, t));
  return sum / 12;
}

PatchFoot closest(const BilinearPatch& x, const Vec3& p) {
  PatchFoot best;
  const auto offset = [&](double s, double t) -> Vec3 { return point(x, s, t) - p; };
  const auto try_point = [&](double s, double t) { best.offer(s, t, offset(s, t).squaredNorm()); };
  try_point(closest_fraction(x[0], x[1], p), 0);
  try_point(closest_fraction(x[3], x[2], p), 1);
  try_point(0, closest_fraction(x[0], x[3], p));
  try_point(1, closest_fraction(x[1], x[2], p));

  const Vec3 twist = x[0] - x[1] + x[2] - x[3];
  double s = 0.5, t = 0.5;
  Vec3 r = offset(s, t);
  for (int iteration = 0; iteration < 30; ++iteration) {
    const Vec3 ds = x[1] - x[0] + t * twist;
    const Vec3 dt = x[3] - x[0] + s * twist;
    const double gs = r.dot(ds), gt = r.dot(dt);
    const double ss = ds.squaredNorm(), tt = dt.squaredNorm();
    double st = ds.dot(dt) + r.dot(twist);
    if (st * st > 0.999 * ss * tt) st = ds.dot(dt);  // not convex here: without the curvature term
    if (newton_in_square({gs, gt, ss, st, tt}, offset, s, t, r, best) < 1e-14) break;
  }
  return best;
}

Crossing pierce(const BilinearPatch& x, const Vec3& origin, const Vec3& direction) {
  constexpr double near_rim = 1e-9, flat = 1e-7;
  Crossing result;
  // Seen along the ray the patch is plane, and the origin is one point of it: A + s B + t C + s t D = 0.
  const Vec3 d = direction.normalized();
  const Vec3 e1 = d.unitOrthogonal(), e2 = d.cross(e1);
  const auto flattened = [&](const Vec3& v) { return Eigen::Vector2d(v.dot(e1), v.dot(e2)); };
  const Eigen::Vector2d a = flattened(x[0] - origin), b = flattened(x[1] - x[0]), c = flattened(x[3] - x[0]);
  const Eigen::Vector2d twist = flattened(x[0] - x[1] + x[2] - x[3]);
  // No s solves it unless (A + t C) and (B + t D) are parallel.
  const double q2 = cross2(c, twist), q1 = cross2(a, twist) + cross2(c, b), q0 = cross2(a, b);
  std::array<double, 2> roots;
  int n_roots = 0;
  const double scale = std::abs(q2) + std::abs(q1) + std::abs(q0);
  if (scale == 0) {
    result.unsure = true;
    return result;
  }
  if (std::abs(q2) < 1e-14 * scale) {
    if (std::abs(q1) > 1e-14 * scale) roots[n_roots++] = -q0 / q1;
  } else {
    const double discriminant = q1 * q1 - 4 * q2 * q0;
    if (discriminant < 0) return result;
    const double half = -0.5 * (q1 + std::copysign(std::sqrt(discriminant), q1));
    roots[n_roots++] = half / q2;
    if (half != 0) roots[n_roots++] = q0 / half;
  }
  for (int i = 0; i < n_roots; ++i) {
    const double t = roots[i];
    if (!(t > -near_rim && t < 1 + near_rim)) continue;
    const Eigen::Vector2d along = b + t * twist;
    const double length2 = along.squaredNorm();
    const double s = length2 > 0 ? -(a + t * c).dot(along) / length2 : 0.5;
    if (!(s > -near_rim && s < 1 + near_rim)) continue;
    const Vec3 normal = area_vector(x, s, t);
    const double size = std::max({(x[1] - x[0]).norm(), (x[3] - x[0]).norm(), (x[2] - x[0]).norm()});
    const double height = (point(x, s, t) - origin).dot(d);
    if (height < -near_rim * size) continue;
    const double slope = normal.dot(d);
    if (s < near_rim || s > 1 - near_rim || t < near_rim || t > 1 - near_rim || height < near_rim * size ||
        std::abs(slope) < flat * size * size)
      result.unsure = true;
    result.count += slope > 0 ? 1 : -1;
  }
  return result;
}

}  // namespace hextwist
