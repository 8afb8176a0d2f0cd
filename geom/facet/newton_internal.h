// One step of Newton's method for the closest place of a patch to a point, for patches of any degree.
#pragma once

#include <algorithm>
#include <cmath>

#include "hextwist/geom/facet/bilinear.h"

namespace hextwist {

/// Half the squared distance at (s, t): its slopes, and its second derivatives as far as they are convex.
struct DistanceAt {
  double gs, gt;
  double ss, st, tt;
};

/// Moves (s, t) within the unit square, by less than Newton's step where that would lead farther away, and offers the
/// place to `best`. offset(s, t): from the point to the patch; r: that at (s, t). Returns how far it went.
template <class Offset>
double newton_in_square(const DistanceAt& at, const Offset& offset, double& s, double& t, Vec3& r, PatchFoot& best) {
  // On the rim, a direction that leads out of the square is not taken.
  const bool free_s = !((s <= 0 && at.gs > 0) || (s >= 1 && at.gs < 0));
  const bool free_t = !((t <= 0 && at.gt > 0) || (t >= 1 && at.gt < 0));
  double step_s = 0, step_t = 0;
  const double det = at.ss * at.tt - at.st * at.st;
  if (free_s && free_t && det > 1e-12 * at.ss * at.tt) {
    step_s = (at.st * at.gt - at.tt * at.gs) / det;
    step_t = (at.st * at.gs - at.ss * at.gt) / det;
  } else if (free_s && at.ss > 0 && (!free_t || at.gs * at.gs * at.tt >= at.gt * at.gt * at.ss)) {
    step_s = -at.gs / at.ss;
  } else if (free_t && at.tt > 0) {
    step_t = -at.gt / at.tt;
  }
  const double before = r.squaredNorm();
  double new_s = s, new_t = t;
  for (double damping = 1; damping > 1e-3; damping *= 0.25) {
    new_s = std::clamp(s + damping * step_s, 0.0, 1.0);
    new_t = std::clamp(t + damping * step_t, 0.0, 1.0);
    r = offset(new_s, new_t);
    if (r.squaredNorm() <= before) break;
  }
  const double moved = std::max(std::abs(new_s - s), std::abs(new_t - t));
  s = new_s;
  t = new_t;
  best.offer(s, t, r.squaredNorm());
  return moved;
}

}  // namespace hextwist
