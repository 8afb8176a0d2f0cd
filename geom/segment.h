// Points and straight segments.
#pragma once

#include <algorithm>

#include "hextwist/base/types.h"

namespace hextwist {

/// Closest point of a segment as a fraction of it, 0 where it has no length.
inline double closest_fraction(const Vec3& from, const Vec3& to, const Vec3& p) {
  const Vec3 along = to - from;
  const double length2 = along.squaredNorm();
  return length2 > 0 ? std::clamp((p - from).dot(along) / length2, 0.0, 1.0) : 0;
}

/// Squared distance of a point from a segment.
inline double segment_distance2(const Vec3& from, const Vec3& to, const Vec3& p) {
  return (from + closest_fraction(from, to, p) * (to - from) - p).squaredNorm();
}

}  // namespace hextwist
