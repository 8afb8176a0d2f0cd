// Curvature: closed forms, and OpenCASCADE against them and against differences of tangents.
#include "hextwist/geom/curvature.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>

#include "hextwist/geom/analytic_model.h"
#include "hextwist/geom/occ_model.h"

namespace hextwist {
namespace {

std::shared_ptr<const Model> shipped(const char* name) {
  return read_cad(std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models" / name).model;
}

TEST(curvature, of_closed_forms) {
  EXPECT_EQ(curvature_of(*analytic_brick(1, 2, 3))->curvature({2, 3}, {0.5, 0.5}), 0);
  const auto cylinder = analytic_cylinder(4, 1);
  EXPECT_EQ(curvature_of(*cylinder)->curvature({1, 1}, {0.5, 0}), 0.25);
  EXPECT_EQ(curvature_of(*cylinder)->curvature({2, 1}, {0.5, 0.5}), 0.25);
  EXPECT_EQ(curvature_of(*cylinder)->curvature({2, 2}, {0.5, 0.5}), 0);
  EXPECT_EQ(curvature_of(*analytic_sphere(2))->curvature({2, 1}, {0.5, 0.5}), 0.5);
}

TEST(curvature, of_the_cylinder_and_the_sphere_in_files_is_one_over_their_radius) {
  const auto cylinder = shipped("cylinder.brep"), sphere = shipped("sphere.brep");
  for (const auto& model : {cylinder, sphere})
    for (int s = 1; s <= model->count(2); ++s) {
      const std::string type = model->type({2, s});
      const Projection foot = model->project({2, s}, Vec3(1, 2, 3));
      const double bend = curvature_of(*model)->curvature({2, s}, foot.parameters);
      if (type == "plane")
        EXPECT_EQ(bend, 0);
      else
        // The box of a whole cylinder or sphere is as wide as two radii.
        EXPECT_NEAR(bend, 2 / (model->box().max - model->box().min).x(), 1e-9) << type;
    }
}

TEST(curvature, of_curves_is_how_fast_their_tangent_turns) {
  for (const char* name : {"ring_twist.brep", "pipe_tee.brep", "plate_hole.brep", "curved_plate.brep", "sphere.brep"}) {
    SCOPED_TRACE(name);
    const auto model = shipped(name);
    for (int c = 1; c <= model->count(1); ++c) {
      const CurveRange range = model->range(c);
      for (const double u : {0.21, 0.5, 0.83}) {
        const double t = range.first + u * (range.last - range.first), step = 1e-5 * (range.last - range.first);
        const double length = (model->point({1, c}, {t + step, 0}) - model->point({1, c}, {t - step, 0})).norm();
        const double turned = (model->tangent(c, t + step) - model->tangent(c, t - step)).norm();
        const double expected = length > 0 ? turned / length : 0;
        EXPECT_NEAR(curvature_of(*model)->curvature({1, c}, {t, 0}), expected, 1e-4 * (expected + 0.01)) << c;
      }
    }
  }
}

TEST(curvature, of_a_spline_surface_is_how_fast_its_normal_turns_at_most) {
  const auto model = shipped("curved_plate.brep");
  const double size = model->box().diagonal();
  for (int s = 1; s <= model->count(2); ++s) {
    const Projection foot = model->project({2, s}, (model->box({2, s}).min + model->box({2, s}).max) / 2);
    const Vec3 normal = model->normal(s, foot.parameters);
    // Turn of the normal per length, over steps in all tangential directions.
    const Vec3 a = normal.unitOrthogonal(), b = normal.cross(a);
    double most = 0;
    for (int i = 0; i < 90; ++i) {
      const double angle = i * 3.14159265358979 / 90, step = 1e-4 * size;
      const Vec3 away = step * (std::cos(angle) * a + std::sin(angle) * b);
      const Projection forth = model->project({2, s}, foot.point + away),
                       back = model->project({2, s}, foot.point - away);
      most = std::max(most, (model->normal(s, forth.parameters) - model->normal(s, back.parameters)).norm() /
                                (forth.point - back.point).norm());
    }
    EXPECT_NEAR(curvature_of(*model)->curvature({2, s}, foot.parameters), most, 0.01 * most + 1e-4 / size) << s;
  }
}

}  // namespace
}  // namespace hextwist
