#include "hextwist/geom/primitives.h"

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <gp_Ax2.hxx>
#include <sstream>

namespace hextwist {
namespace {

constexpr double smallest = 1e-6, largest = 1e9;

void check_size(const char* shape, const char* what, double size) {
  if (size >= smallest && size <= largest) return;
  std::ostringstream text;
  text << what << " of a " << shape << " must lie between " << smallest << " and " << largest << ", not " << size;
  throw Error(text.str());
}

}  // namespace

void check_shape(const BrickShape& shape) {
  check_size("brick", "width", shape.width);
  check_size("brick", "depth", shape.depth);
  check_size("brick", "height", shape.height);
}

void check_shape(const CylinderShape& shape) {
  check_size("cylinder", "radius", shape.radius);
  check_size("cylinder", "height", shape.height);
}

void check_shape(const SphereShape& shape) {
  check_size("sphere", "radius", shape.radius);
}

CadImport cad_brick(const BrickShape& shape) {
  check_shape(shape);
  const gp_Pnt corner(-shape.width / 2, -shape.depth / 2, -shape.height / 2);
  return cad_from_shape(BRepPrimAPI_MakeBox(corner, shape.width, shape.depth, shape.height).Shape());
}

CadImport cad_cylinder(const CylinderShape& shape) {
  check_shape(shape);
  const gp_Ax2 axes(gp_Pnt(0, 0, -shape.height / 2), gp::DZ(), gp::DX());
  return cad_from_shape(BRepPrimAPI_MakeCylinder(axes, shape.radius, shape.height).Shape());
}

CadImport cad_sphere(const SphereShape& shape) {
  check_shape(shape);
  const gp_Ax2 axes(gp::Origin(), gp::DZ(), gp::DX());
  return cad_from_shape(BRepPrimAPI_MakeSphere(axes, shape.radius).Shape());
}

}  // namespace hextwist
