// Closed-form models for tests: no CAD kernel, exact answers.
//
// Angles run from 0 to 2 pi. tolerance() is 0; contains() takes points up to 1e-12 of the model size outside, so that
// projected points count as on the boundary. Names are "". Sizes must be positive and finite, else Error is thrown.
#pragma once

#include <memory>

#include "hextwist/geom/model.h"

namespace hextwist {

/// Box [0,x]x[0,y]x[0,z]: 8 vertices, 12 curves, 6 surfaces, 1 volume. Vertex ids: 1 + corner bits (x lowest).
/// Curve ids: 1 + 4 * axis + bits of the other two axes (lower axis first). Surface ids: 1 + 2 * axis + side.
/// Parameters: the coordinate along a curve; the two coordinates along a surface, lower axis first.
std::shared_ptr<const Model> analytic_brick(double x, double y, double z);

/// Cylinder of radius r around the z axis from z = 0 to h: 2 closed curves (1 bottom, 2 top) with one vertex each at
/// angle 0, 3 surfaces (1 side, 2 bottom, 3 top). Parameters: angle on curves, (angle, z) on the side, (x, y) on the
/// ends. A point on the axis goes to the side at the angle of its seed, 0 without one.
std::shared_ptr<const Model> analytic_cylinder(double r, double h);

/// Ball of radius r at the origin: one surface without curves or vertices. Parameters: (longitude, latitude).
/// The centre goes to the parameters of its seed, to (0, 0) without one.
std::shared_ptr<const Model> analytic_sphere(double r);

}  // namespace hextwist
