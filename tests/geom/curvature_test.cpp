// Curvature: closed forms, and OpenCASCADE against them and against differences of tangents.
#include "hextwist/geom/curvature.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <random>

#include "hextwist/geom/facet/curvature_internal.h"
#include "hextwist/geom/occ/model.h"
#include "support/analytic_model.h"
#include "support/grids.h"
#include "support/skins.h"

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

TEST(curvature, of_a_polyline_on_a_circle_is_one_over_its_radius_however_uneven_the_points) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> step(0.01, 0.3);
  for (const bool closed : {false, true}) {
    std::vector<Vec3> points;
    double angle = 0;
    for (int i = 0; i < 20; ++i, angle += step(random))
      points.emplace_back(3 * std::cos(angle), 3 * std::sin(angle), 1);
    if (closed) points.push_back(points.front());
    for (const double bend : segment_curvatures(points, closed)) EXPECT_NEAR(bend, 1.0 / 3, 1e-9);
  }
  const std::vector<Vec3> straight = {{0, 0, 0}, {1, 0, 0}, {3, 0, 1e-4}, {4, 0, 0}};
  EXPECT_EQ(segment_curvatures(straight, false), std::vector<double>(3, 0.0)) << "noise is no bend";
  EXPECT_EQ(segment_curvatures(std::span(straight).first(2), false), std::vector<double>(1, 0.0));
}

TEST(curvature, of_a_skin_is_that_of_the_surface_it_was_made_on) {
  // A round rod: even facets around, of different lengths along; and the ends of it are flat.
  const Mesh rod = test::round_grid(6, 5, 3);
  const auto model = test::facet_model_of(rod).model;
  int n_round = 0;
  for (int s = 1; s <= model->count(2); ++s) {
    const Projection foot = model->project({2, s}, Vec3(1, 0.2, 1.4));
    const double bend = curvature_of(*model)->curvature({2, s}, foot.parameters);
    const bool flat = std::abs(std::abs(model->normal(s, foot.parameters).z()) - 1) < 1e-9;
    EXPECT_EQ(curvature_of(*model)->bends({2, s}).empty(), flat);
    if (flat)
      EXPECT_EQ(bend, 0);
    else
      EXPECT_NEAR(bend, 1, 0.1);
    n_round += !flat;
  }
  EXPECT_GE(n_round, 1);
  for (int c = 1; c <= model->count(1); ++c) EXPECT_NEAR(curvature_of(*model)->curvature({1, c}, {0.1, 0}), 1, 1e-6);
  // What is cornered is no bend.
  const auto box = test::facet_model_of(test::grid(3, 3, 3)).model;
  for (int dim = 0; dim <= 3; ++dim)
    for (int id = 1; id <= box->count(dim); ++id) {
      EXPECT_TRUE(curvature_of(*box)->bends({dim, id}).empty());
      EXPECT_EQ(curvature_of(*box)->curvature({dim, id}, {0.5, 0.5}), 0);
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
