#include "hextwist/geom/facet/quadratic.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "hextwist/geom/facet/newton_internal.h"

namespace hextwist {
namespace {

// Roots and weights of the Legendre polynomial of degree 6, on [0, 1].
constexpr std::array<double, 6> gauss6 = {0.033765242898423986, 0.16939530676686774, 0.38069040695840156,
                                          0.61930959304159844,  0.83060469323313226, 0.96623475710157601};
constexpr std::array<double, 6> weight6 = {0.085662246189585173, 0.18038078652406930, 0.23395696728634552,
                                           0.23395696728634552,  0.18038078652406930, 0.085662246189585173};

std::array<double, 3> bernstein(double s) {
  return {(1 - s) * (1 - s), 2 * s * (1 - s), s * s};
}
std::array<double, 3> bernstein_slopes(double s) {
  return {2 * s - 2, 2 - 4 * s, 2 * s};
}
constexpr std::array<double, 3> bernstein_bend = {2, -4, 2};

Vec3 sum(const QuadraticPatch& x, const std::array<double, 3>& a, const std::array<double, 3>& b) {
  Vec3 result = Vec3::Zero();
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) result += a[i] * b[j] * x[i + 3 * j];
  return result;
}

/// Newton's method for the closest point of a patch, from a place in it, kept in the square.
void improve_from(const QuadraticPatch& x, const Vec3& p, double s, double t, PatchFoot& best) {
  const auto offset = [&](double at_s, double at_t) -> Vec3 { return point(x, at_s, at_t) - p; };
  Vec3 r = offset(s, t);
  for (int iteration = 0; iteration < 30; ++iteration) {
    const auto bs = bernstein(s), bt = bernstein(t), ds = bernstein_slopes(s), dt = bernstein_slopes(t);
    const Vec3 xs = sum(x, ds, bt), xt = sum(x, bs, dt);
    const double gs = r.dot(xs), gt = r.dot(xt);
    double ss = xs.squaredNorm() + r.dot(sum(x, bernstein_bend, bt));
    double tt = xt.squaredNorm() + r.dot(sum(x, bs, bernstein_bend));
    double st = xs.dot(xt) + r.dot(sum(x, ds, dt));
    if (!(ss > 0 && tt > 0 && st * st < 0.999 * ss * tt))  // not convex here: without the curvature terms
      ss = xs.squaredNorm(), tt = xt.squaredNorm(), st = xs.dot(xt);
    if (newton_in_square({gs, gt, ss, st, tt}, offset, s, t, r, best) < 1e-14) break;
  }
}

/// The halves of a patch in s (step 1) or t (step 3).
std::array<QuadraticPatch, 2> halves(const QuadraticPatch& x, int step) {
  std::array<QuadraticPatch, 2> half;
  const int other = step == 1 ? 3 : 1;
  for (int row = 0; row < 3; ++row) {
    const int at = other * row;
    const Vec3 &a = x[at], &b = x[at + step], &c = x[at + 2 * step];
    const Vec3 ab = (a + b) / 2, bc = (b + c) / 2, middle = (ab + bc) / 2;
    half[0][at] = a, half[0][at + step] = ab, half[0][at + 2 * step] = middle;
    half[1][at] = middle, half[1][at + step] = bc, half[1][at + 2 * step] = c;
  }
  return half;
}

/// How far the patch is from the bilinear one of its corners, squared: at most.
double bend2(const QuadraticPatch& x) {
  const BilinearPatch flat = corners(x);
  double most = 0;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) most = std::max(most, (x[i + 3 * j] - point(flat, i / 2.0, j / 2.0)).squaredNorm());
  return most;
}

void pierce_piece(const QuadraticPatch& x, const Vec3& origin, const Vec3& direction, double flat2, int depth,
                  Crossing& total) {
  Box box;
  for (const Vec3& p : x) box.add(p);
  const Vec3 slack = Vec3::Constant(1e-9 * box.diagonal());
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = (box.min[axis] - slack[axis] - origin[axis]) / direction[axis];
    const double high = (box.max[axis] + slack[axis] - origin[axis]) / direction[axis];
    enter = std::max(enter, std::min(low, high));
    leave = std::min(leave, std::max(low, high));
  }
  if (!(enter <= leave)) return;
  if (depth == 0 || bend2(x) <= flat2) {
    const Crossing crossing = pierce(corners(x), origin, direction);
    total.count += crossing.count;
    total.unsure = total.unsure || crossing.unsure;
    return;
  }
  for (const QuadraticPatch& half : halves(x, 1))
    for (const QuadraticPatch& quarter : halves(half, 3))
      pierce_piece(quarter, origin, direction, flat2, depth - 1, total);
}

}  // namespace

QuadraticSegment segment_through(const Vec3& from, const Vec3& middle, const Vec3& to) {
  return {from, 2 * middle - 0.5 * (from + to), to};
}

Vec3 point(const QuadraticSegment& x, double s) {
  // This form gives the ends bit for bit.
  return (1 - s) * ((1 - s) * x[0] + s * x[1]) + s * ((1 - s) * x[1] + s * x[2]);
}

Vec3 slope(const QuadraticSegment& x, double s) {
  return 2 * ((1 - s) * (x[1] - x[0]) + s * (x[2] - x[1]));
}

double length(const QuadraticSegment& x) {
  double sum = 0;
  for (int i = 0; i < 6; ++i) sum += weight6[i] * slope(x, gauss6[i]).norm();
  return sum;
}

PatchFoot closest(const QuadraticSegment& x, const Vec3& p) {
  PatchFoot best;
  best.offer(0, 0, (x[0] - p).squaredNorm());
  best.offer(1, 0, (x[2] - p).squaredNorm());
  const Vec3 bend = 2 * (x[0] - 2 * x[1] + x[2]);
  for (const double start : {0.15, 0.5, 0.85}) {
    double s = start;
    for (int iteration = 0; iteration < 30; ++iteration) {
      const Vec3 r = point(x, s) - p, d = slope(x, s);
      double curvature = d.squaredNorm() + r.dot(bend);
      if (!(curvature > 0.1 * d.squaredNorm())) curvature = d.squaredNorm();
      if (!(curvature > 0)) break;
      const double next = std::clamp(s - r.dot(d) / curvature, 0.0, 1.0);
      const double moved = std::abs(next - s);
      s = next;
      if (moved < 1e-15) break;
    }
    best.offer(s, 0, (point(x, s) - p).squaredNorm());
  }
  return best;
}

QuadraticPatch patch_through(const std::array<Vec3, 4>& c, const std::array<Vec3, 4>& e, const Vec3& middle) {
  QuadraticPatch x;
  for (int k = 0; k < 4; ++k) x[quadratic_cycle[k]] = c[k];
  x[1] = segment_through(c[0], e[0], c[1])[1];
  x[5] = segment_through(c[1], e[1], c[2])[1];
  x[7] = segment_through(c[2], e[2], c[3])[1];
  x[3] = segment_through(c[3], e[3], c[0])[1];
  Vec3 rest = Vec3::Zero();  // the middle without the point that is left
  for (const int k : {0, 2, 6, 8}) rest += x[k] / 16;
  for (const int k : {1, 3, 5, 7}) rest += x[k] / 8;
  x[4] = 4 * (middle - rest);
  return x;
}

Vec3 blended_middle(const std::array<Vec3, 4>& c, const std::array<Vec3, 4>& e) {
  return 0.5 * (e[0] + e[1] + e[2] + e[3]) - 0.25 * (c[0] + c[1] + c[2] + c[3]);
}

BilinearPatch corners(const QuadraticPatch& x) {
  return {x[0], x[2], x[8], x[6]};
}

Vec3 point(const QuadraticPatch& x, double s, double t) {
  return sum(x, bernstein(s), bernstein(t));
}

Vec3 area_vector(const QuadraticPatch& x, double s, double t) {
  return sum(x, bernstein_slopes(s), bernstein(t)).cross(sum(x, bernstein(s), bernstein_slopes(t)));
}

double area(const QuadraticPatch& x) {
  double total = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) total += weight6[i] * weight6[j] * area_vector(x, gauss6[i], gauss6[j]).norm();
  return total;
}

double cone_volume(const QuadraticPatch& x, const Vec3& apex) {
  // The integrand is of degree 5 in s and in t.
  double total = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      total +=
          weight6[i] * weight6[j] * (point(x, gauss6[i], gauss6[j]) - apex).dot(area_vector(x, gauss6[i], gauss6[j]));
  return total / 3;
}

PatchFoot closest(const QuadraticPatch& x, const Vec3& p) {
  PatchFoot best;
  const auto rim = [&](int a, int b, int c, double s, double t, bool along_s) {
    const PatchFoot foot = closest(QuadraticSegment{x[a], x[b], x[c]}, p);
    best.offer(along_s ? foot.s : s, along_s ? t : foot.s, foot.distance2);
  };
  rim(0, 1, 2, 0, 0, true);
  rim(6, 7, 8, 0, 1, true);
  rim(0, 3, 6, 0, 0, false);
  rim(2, 5, 8, 1, 0, false);
  // From the nearest of nine places.
  PatchFoot start;
  for (const double t : {0.15, 0.5, 0.85})
    for (const double s : {0.15, 0.5, 0.85}) start.offer(s, t, (point(x, s, t) - p).squaredNorm());
  improve_from(x, p, start.s, start.t, best);
  return best;
}

Crossing pierce(const QuadraticPatch& x, const Vec3& origin, const Vec3& direction) {
  Box box;
  for (const Vec3& p : x) box.add(p);
  const double flat = 1e-9 * box.diagonal();
  constexpr int deepest = 12;
  Crossing total;
  pierce_piece(x, origin, direction, flat * flat, deepest, total);
  return total;
}

}  // namespace hextwist
