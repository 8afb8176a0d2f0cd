// Closest points on OpenCASCADE entities against OpenCASCADE's own slow extrema and against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geom/occ_shapes.h"
#include "support/grids.h"

namespace hextwist {
namespace {

using test::OccShape;

// Points around and on the entity's box: a third far, a third near, a third on the entity itself.
std::vector<Vec3> sample_points(const Model& model, Owner entity, int n, std::mt19937& random) {
  const Box box = model.box(entity);
  const double size = std::max(box.diagonal(), 1e-3 * model.box().diagonal());
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) {
    const Vec3 r(unit(random), unit(random), unit(random));
    Vec3 p = (box.min + box.max) / 2 + size * r;
    if (i % 3 > 0) p = model.project(entity, p).point;
    if (i % 3 == 1) p += 0.05 * size * Vec3(unit(random), unit(random), unit(random));
    points.push_back(p);
  }
  return points;
}

// Every entity, unseeded: as close as brute force says, on the entity, parameters that give the point.
void expect_closest(const OccShape& shape, const Model& model, int n, unsigned seed, double accuracy = 1e-9) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const double size = model.box().diagonal();
  for (int dim = 0; dim <= 2; ++dim) {
    for (int id = 1; id <= model.count(dim); ++id) {
      const Owner entity{dim, id};
      const std::vector<Vec3> points = sample_points(model, entity, n, random);
      std::vector<Projection> result(points.size());
      model.project(entity, points, {}, result);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double truth = shape.distance(entity, points[i]);
        const double slack = accuracy * size + 2 * model.tolerance(entity);
        EXPECT_NEAR(result[i].distance, (result[i].point - points[i]).norm(), 1e-12 * size);
        EXPECT_LE(result[i].distance, truth + slack)
            << to_string(entity) << " " << model.type(entity) << ": point " << i << ", " << points[i].transpose();
        EXPECT_LE(shape.distance(entity, result[i].point), slack) << to_string(entity) << " is missed";
        if (dim > 0) {
          EXPECT_LE((model.point(entity, result[i].parameters) - result[i].point).norm(), 1e-13 * size)
              << to_string(entity);
        }
      }
    }
  }
}

TEST(occ_projection, agrees_with_brute_force_on_primitives) {
  for (const OccShape& shape :
       {OccShape::cylinder(2, 5), OccShape::cylinder_sector(3, 4, 0.4, 1.9), OccShape::cylinder_sector(3, 4, 2.5, 6),
        OccShape::sphere(3), OccShape::sphere_patch(3, -0.4, 1.1, 2.5), OccShape::cone(3, 0, 4),
        OccShape::cone(1, 3, 4), OccShape::torus(5, 1.5), OccShape::brick(1, 2, 3),
        OccShape::brick_with_hole(10, 6, 2, 1.5)}) {
    expect_closest(shape, *shape.import().model, 18, 1);
    const OccShape moved = shape.moved({3, -40, 7}, 1.2);
    expect_closest(moved, *moved.import().model, 6, 2);
  }
}

TEST(occ_projection, agrees_with_brute_force_on_splines) {
  for (const OccShape& shape :
       {OccShape::loft(), OccShape::vase(), OccShape::cylinder(2, 5).as_nurbs(), OccShape::sphere(3).as_nurbs(),
        OccShape::torus(5, 1.5).as_nurbs(), OccShape::brick_with_hole(10, 6, 2, 1.5).as_nurbs()}) {
    expect_closest(shape, *shape.import().model, 12, 3, 1e-7);
  }
}

TEST(occ_projection, agrees_with_brute_force_on_real_parts) {
  const auto data = test::data_folder();
  if (data.empty()) GTEST_SKIP() << "no data folder";
  for (const char* name : {"bracket_fillet", "cyl_ogrid", "plate_hole", "ring_twist90", "sphere7", "two_material"}) {
    SCOPED_TRACE(name);
    const auto file = data / "cad" / (std::string(name) + ".brep");
    expect_closest(OccShape::brep(file), *read_cad(file).model, 6, 4, 1e-7);
  }
}

}  // namespace
}  // namespace hextwist
