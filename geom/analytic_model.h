// Closed-form models for tests: no CAD kernel, exact answers.
#pragma once

#include <memory>

#include "hextwist/geom/model.h"

namespace hextwist {

/// Box [0,x]x[0,y]x[0,z]: 8 vertices, 12 curves, 6 surfaces, 1 volume. Vertex ids: 1 + corner bits (x lowest).
/// Curve ids: 1 + 4 * axis + bits of the other two axes (lower axis first). Surface ids: 1 + 2 * axis + side.
std::shared_ptr<const Model> analytic_brick(double x, double y, double z);

/// Cylinder of radius r around the z axis from z = 0 to h: 2 closed curves (bottom, top) with one vertex each at
/// angle 0, 3 surfaces (side, bottom, top).
std::shared_ptr<const Model> analytic_cylinder(double r, double h);

/// Ball of radius r at the origin: one surface without curves or vertices.
std::shared_ptr<const Model> analytic_sphere(double r);

}  // namespace hextwist
