// Small solids for people without CAD files: `create brick | cylinder | sphere`.
//
// Every one is centred at the origin. mesh/primitives.h makes hex meshes that lie exactly on them.
#pragma once

#include "hextwist/geom/occ/model.h"

namespace HEXTWIST_API hextwist {

/// Sides along x, y and z.
struct BrickShape {
  double width = 1;
  double depth = 1;
  double height = 1;
};
/// Axis along z, seam of the CAD at y = 0, x > 0.
struct CylinderShape {
  double radius = 1;
  double height = 1;
};
/// Poles at z = -radius and z = radius, seam at y = 0, x > 0.
struct SphereShape {
  double radius = 1;
};

/// Throws Error naming the size that is not a number between 1e-6 and 1e9, the range in which OpenCASCADE's own
/// tolerance of 1e-7 leaves a sound solid.
void check_shape(const BrickShape& shape);
void check_shape(const CylinderShape& shape);
void check_shape(const SphereShape& shape);

/// The solid as an OpenCASCADE model. Throws Error like check_shape().
CadImport cad_brick(const BrickShape& shape);
CadImport cad_cylinder(const CylinderShape& shape);
CadImport cad_sphere(const SphereShape& shape);

}  // namespace hextwist
