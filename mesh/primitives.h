// Hex meshes of the solids of geom/primitives.h, every boundary node exactly on its surface, vertices and curves of
// the CAD (seams and poles too) covered by nodes and mesh edges. One block, named like the solid.
#pragma once

#include "hextwist/geom/primitives.h"
#include "hextwist/mesh/mesh.h"

namespace HEXTWIST_API hextwist {

/// Cells along x, y and z.
struct BrickIntervals {
  int width = 4;   ///< along x, at least 1
  int depth = 4;   ///< along y, at least 1
  int height = 4;  ///< along z, at least 1
};
/// A core of quarter x quarter cells, with its corners at 0, 90, 180 and 270 degrees, and four blocks around it.
struct CylinderIntervals {
  int quarter = 4;  ///< cells along a quarter of the circle
  int ring = 2;     ///< layers around the core
  int height = 4;   ///< cells along the axis
};
/// A core of (2 eighth)^3 cells and six blocks around it. The halves make a node at each pole and edges on the seam.
struct SphereIntervals {
  int eighth = 2;  ///< cells along an eighth of a great circle
  int shell = 2;   ///< layers around the core
};

/// All intervals from the one number of `create ... interval n`: n cells along each edge of a brick.
BrickIntervals brick_intervals(int n);
/// n cells along the height and each quarter circle; layers so that cells come out about as thick as wide.
CylinderIntervals cylinder_intervals(int n);
/// n cells along each eighth of a great circle; layers so that cells come out about as thick as wide.
SphereIntervals sphere_intervals(int n);

/// A grid; smallest scaled Jacobian 1.
/// Throws Error when a size or an interval is not positive, or the mesh would have more than 100 million hexes.
Mesh mesh_brick(const BrickShape& shape, const BrickIntervals& intervals = {});
/// Smallest scaled Jacobian above 0.8 for all intervals up to 32 (0.7 where a quarter has one cell, which no placement
/// can mend). Throws as mesh_brick().
Mesh mesh_cylinder(const CylinderShape& shape, const CylinderIntervals& intervals = {});
/// Smallest scaled Jacobian above 0.67 for all intervals up to 32. Throws as mesh_brick().
Mesh mesh_sphere(const SphereShape& shape, const SphereIntervals& intervals = {});

}  // namespace hextwist
