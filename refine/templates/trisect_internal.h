// How the trisecting templates come about: shared by the table and by the program that optimises node places.
#pragma once

#include "hextwist/refine/templates/cube_mesh.h"
#include "hextwist/refine/templates/trisect.h"

namespace hextwist {

/// Where nodes of templates go in the unit cube. The nodes inside faces depend on these numbers alone; those inside
/// the hex are only started from them.
struct TrisectPlaces {
  double depth = 0.66;              ///< how far the inner nodes of the one-edge pattern lie across the face
  double spread = 1.0 / 6;          ///< and how far to either side of its middle
  double inner_margin = 0.3;        ///< the inner hex of concave templates is [m, 1 - m]^3
  double central_margin = 1.0 / 3;  ///< the central quad of L and U patterns is [m, 1 - m]^2
  double central_depth = 0.5;       ///< how far down its block goes in the frustum
};

/// Nodes inside a face whose cut edges are the bits of `code`, with the codes that symmetries turn it into.
FacePattern trisect_face_pattern(int code, const TrisectPlaces& places);

/// The template of an edge mask as a mesh of the unit cube.
CubeMesh trisect_cube(int edge_mask, const TrisectPlaces& places);

/// The symmetry of the cube that maps a point p to q with q[axis[b]] = p[b], or 1 - p[b] where bit axis[b] of flip is
/// set.
struct CubeSymmetry {
  std::array<int, 3> axis = {0, 1, 2};
  int flip = 0;

  int corner(int c) const;
  int edge_mask(int mask) const;
  Vec3 back(const Vec3& q) const;  ///< p from q
  bool mirrors() const;            ///< changes orientation
};

/// The symmetry that takes a mask to the lowest of its 48 images.
CubeSymmetry to_canonical(int edge_mask);

/// L or U: two adjacent or three cut edges.
bool is_corner_pattern(int face_code);

}  // namespace hextwist
