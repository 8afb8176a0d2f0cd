// OpenCASCADE solids made in memory, with slow and independent answers to compare with. No OpenCASCADE header is
// reached from here, so the tests compile like those of any other layer.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hextwist/geom/occ/model.h"

namespace hextwist::test {

/// A shape, the model of it, and brute force.
class OccShape {
 public:
  static OccShape cylinder(double r, double h);
  /// The part of a cylinder between two angles, away from the seam or across it.
  static OccShape cylinder_sector(double r, double h, double from, double to);
  static OccShape sphere(double r);
  static OccShape sphere_patch(double r, double from_latitude, double to_latitude, double longitude);
  static OccShape cone(double r_bottom, double r_top, double h);
  static OccShape torus(double major, double minor);
  /// The inner part of a torus whose minor radius is the larger: pointed on the axis.
  static OccShape lemon(double major, double minor);
  static OccShape brick(double x, double y, double z);
  /// Brick with a vertex more, on one of its edges.
  static OccShape brick_with_vertex(double x, double y, double z, const Vec3& at);
  /// Brick with a cylindrical hole along z in its middle.
  static OccShape brick_with_hole(double x, double y, double z, double r);
  /// Brick with a face inside, across the middle of x and from y = 0 to depth, that bounds nothing.
  static OccShape brick_with_face_inside(double x, double y, double z, double depth);
  /// A ball with a smaller one taken out of its middle; the upper half of a ball.
  static OccShape hollow_ball(double outer, double inner);
  static OccShape dome(double r);
  /// Cylinders one behind the other, fused, whose seams lie at different angles.
  static OccShape fused_shaft();
  /// Smooth loft through circles and ellipses: a closed B-spline side.
  static OccShape loft();
  /// Surface of revolution of a spline that starts on the axis: a pole on a general surface.
  static OccShape vase();
  /// A polygon of the plane z = 0, moved along a vector.
  static OccShape extruded(const std::vector<std::array<double, 2>>& polygon, const Vec3& along);
  /// A polygon (x > 0) or a disc of the plane z = 0, turned about the y axis.
  static OccShape turned(const std::vector<std::array<double, 2>>& polygon, double angle);
  static OccShape turned_disc(double x, double r, double angle);
  /// Solids that only touch.
  static OccShape together(const std::vector<OccShape>& solids);
  /// Two bricks side by side (separate solids that touch), named in no file.
  static OccShape two_bricks();
  /// The faces of a brick and of a smaller one inside it, each on its own.
  static OccShape loose_faces_with_cavity();
  static OccShape open_shell();
  /// The faces of two bricks that touch, each on its own, those of the second one first if `turned`.
  static OccShape loose_faces_that_touch(bool turned);
  static OccShape brep(const std::filesystem::path& file);

  /// The same solid with every curve and surface a NURBS.
  OccShape as_nurbs() const;
  OccShape moved(const Vec3& by, double angle) const;
  OccShape reversed() const;

  CadImport import(const CadOptions& options = {}) const;
  /// Writes through OpenCASCADE directly, in the given unit ("MM", "M", "INCH") for STEP and IGES.
  void write(const std::filesystem::path& file, const std::string& unit = "MM") const;
  /// Distance from an entity (ids as in the model), by OpenCASCADE's general algorithm.
  double distance(Owner entity, const Vec3& p) const;
  int count(int dim) const;

 private:
  struct Impl;
  explicit OccShape(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<Impl> impl_;
};

}  // namespace hextwist::test
