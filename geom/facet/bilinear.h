// The bilinear patch: the shape that a hex gives to its four-cornered faces.
//
// A quad of a skin is taken as this patch, not as triangles. Its corners and straight edges are exactly on it, so are
// all points where a refinement puts the children of the face, and the trilinear hexes behind a skin of such patches
// fill exactly the volume inside it.
#pragma once

#include <array>

#include "hextwist/base/types.h"

namespace hextwist {

/// Corners in cyclic order: (s, t) = (0, 0), (1, 0), (1, 1), (0, 1).
using BilinearPatch = std::array<Vec3, 4>;

Vec3 point(const BilinearPatch& patch, double s, double t);
/// d/ds x d/dt: counter-clockwise side, length = area per parameter area; zero where degenerate.
Vec3 area_vector(const BilinearPatch& patch, double s, double t);

/// Area by 4x4 Gauss points: exact for planar convex patches.
double area(const BilinearPatch& patch);
/// Signed volume of the cone from `apex` to the patch; exact. Summed over a closed skin: the volume inside.
double cone_volume(const BilinearPatch& patch, const Vec3& apex);

/// Where on [0,1]^2, and how far squared.
struct PatchFoot {
  double s = 0;
  double t = 0;
  double distance2 = std::numeric_limits<double>::infinity();

  /// Becomes that place where it is nearer.
  void offer(double other_s, double other_t, double other_distance2) {
    if (other_distance2 < distance2) *this = {other_s, other_t, other_distance2};
  }
};
/// Closest point: the rim in closed form, the inside by Newton's method from the centre; never farther than the rim.
/// Strictly the closest while the patch is less bent than the point is near (its curvature radius above the distance).
PatchFoot closest(const BilinearPatch& patch, const Vec3& p);

/// How often a ray pierces the patch from behind (+1) or from the front (-1), and whether it does so too near to the
/// rim, to its own origin, or too flatly to be sure.
struct Crossing {
  int count = 0;
  bool unsure = false;
};
Crossing pierce(const BilinearPatch& patch, const Vec3& origin, const Vec3& direction);

}  // namespace hextwist
