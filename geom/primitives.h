// Small solids for people without CAD files: `create brick | cylinder | sphere`.
//
// Every one is centred at the origin. mesh/primitives.h makes hex meshes that lie exactly on them.
#pragma once

#include "hextwist/geom/occ/model.h"

namespace HEXTWIST_API hextwist {

/// Sides along x, y and z.
struct BrickShape {
  double width = 1;   ///< along x, model units
  double depth = 1;   ///< along y
  double height = 1;  ///< along z
};
/// Axis along z, seam of the CAD at y = 0, x > 0.
struct CylinderShape {
  double radius = 1;  ///< model units
  double height = 1;  ///< along z; from -height / 2 to height / 2
};
/// Poles at z = -radius and z = radius, seam at y = 0, x > 0.
struct SphereShape {
  double radius = 1;  ///< model units
};

/// Throws Error naming the size that is not a number between 1e-6 and 1e9, the range in which OpenCASCADE's own
/// tolerance of 1e-7 leaves a sound solid.
void check_shape(const BrickShape& shape);
/// The same of a cylinder.
void check_shape(const CylinderShape& shape);
/// The same of a sphere.
void check_shape(const SphereShape& shape);

/// The solid as an OpenCASCADE model: 8 vertices, 12 curves, 6 surfaces. Throws Error like check_shape().
CadImport cad_brick(const BrickShape& shape);
/// The same of a cylinder: 2 vertices, 3 curves (the seam is one), 3 surfaces.
CadImport cad_cylinder(const CylinderShape& shape);
/// The same of a sphere: 2 vertices (the poles), 3 curves (the seam, and both poles again as curves of length 0), 1
/// surface.
CadImport cad_sphere(const SphereShape& shape);

}  // namespace hextwist
