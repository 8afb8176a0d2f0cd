// The biquadratic patch and the quadratic segment: faces and edges of hexes of second order.
//
// Both are kept by their Bezier points, so that the box of these holds them and halves are cheap. The closest point,
// areas and rays are those of the curved shape; bilinear.h has the same for straight hexes.
#pragma once

#include <array>

#include "hextwist/geom/facet/bilinear.h"

namespace hextwist {

/// Bezier points of a curve from [0] to [2].
using QuadraticSegment = std::array<Vec3, 3>;
/// Bezier points, number i + 3 j for degree i in s and j in t. Corners in the cycle of bilinear.h are 0, 2, 8, 6.
using QuadraticPatch = std::array<Vec3, 9>;
inline constexpr std::array<int, 4> quadratic_cycle = {0, 2, 8, 6};

/// Through a point at its middle.
QuadraticSegment segment_through(const Vec3& from, const Vec3& middle, const Vec3& to);
Vec3 point(const QuadraticSegment& segment, double s);
/// d/ds
Vec3 slope(const QuadraticSegment& segment, double s);
double length(const QuadraticSegment& segment);
/// Where on [0, 1], and how far squared.
PatchFoot closest(const QuadraticSegment& segment, const Vec3& p);

/// Corners in cyclic order, middles of the edges that follow them, the middle.
QuadraticPatch patch_through(const std::array<Vec3, 4>& corners, const std::array<Vec3, 4>& edges, const Vec3& middle);
/// Middle of a patch that its edges alone say.
Vec3 blended_middle(const std::array<Vec3, 4>& corners, const std::array<Vec3, 4>& edges);
BilinearPatch corners(const QuadraticPatch& patch);

// As bilinear.h has them.
Vec3 point(const QuadraticPatch& patch, double s, double t);
Vec3 area_vector(const QuadraticPatch& patch, double s, double t);
/// By 6x6 Gauss points.
double area(const QuadraticPatch& patch);
/// Exact.
double cone_volume(const QuadraticPatch& patch, const Vec3& apex);
/// The rim and the inside by Newton's method, from several places; never farther than the rim.
PatchFoot closest(const QuadraticPatch& patch, const Vec3& p);
/// By halving until pieces are bilinear but for 1e-9 of their size.
Crossing pierce(const QuadraticPatch& patch, const Vec3& origin, const Vec3& direction);

}  // namespace hextwist
