// Closest points on OpenCASCADE entities against OpenCASCADE's own slow extrema and against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>

#include <tbb/global_control.h>

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
        OccShape::cone(1, 3, 4), OccShape::torus(5, 1.5), OccShape::lemon(3, 5), OccShape::brick(1, 2, 3),
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

// Exact distance from a full torus, sphere, cylinder: what projection must reach to rounding.
TEST(occ_projection, is_exact_on_analytic_surfaces_and_their_splines) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto expect_distance = [&](const OccShape& shape, const char* type, const auto& truth) {
    const auto model = shape.import().model;
    for (int id = 1; id <= model->count(2); ++id) {
      if (model->type({2, id}) != type) continue;
      for (int i = 0; i < 300; ++i) {
        const Vec3 p = 8 * Vec3(unit(random), unit(random), unit(random));
        EXPECT_NEAR(model->project({2, id}, p).distance, truth(p), 1e-12) << p.transpose();
      }
    }
  };
  const auto sphere = [](const Vec3& p) { return std::abs(p.norm() - 3); };
  const auto torus = [](const Vec3& p) { return std::abs(std::hypot(std::hypot(p.x(), p.y()) - 5, p.z()) - 1.5); };
  const auto cylinder = [](const Vec3& p) {
    const double z = std::max({0.0, -p.z(), p.z() - 5});
    return std::hypot(std::hypot(p.x(), p.y()) - 2, z);
  };
  const auto cone = [](const Vec3& p) {  // its profile is the segment from (3, 0) to the tip (0, 4)
    const double r = std::hypot(p.x(), p.y());
    const double s = std::clamp(((r - 3) * -3 + p.z() * 4) / 25, 0.0, 1.0);
    return std::hypot(r - (3 - 3 * s), p.z() - 4 * s);
  };
  const auto lemon = [](const Vec3& p) {  // its profile is an arc around (-3, 0) from tip to tip
    const double r = std::hypot(p.x(), p.y());
    const bool beside = std::abs(std::atan2(p.z(), r + 3)) <= std::acos(0.6);
    return beside ? std::abs(std::hypot(r + 3, p.z()) - 5) : std::hypot(r, std::abs(p.z()) - 4);
  };
  expect_distance(OccShape::lemon(3, 5), "torus", lemon);
  expect_distance(OccShape::sphere(3), "sphere", sphere);
  expect_distance(OccShape::sphere(3).as_nurbs(), "bspline surface", sphere);
  expect_distance(OccShape::torus(5, 1.5), "torus", torus);
  expect_distance(OccShape::torus(5, 1.5).as_nurbs(), "bspline surface", torus);
  expect_distance(OccShape::cylinder(2, 5), "cylinder", cylinder);
  expect_distance(OccShape::cone(3, 0, 4), "cone", cone);
}

TEST(occ_projection, survives_centres_axes_poles_seams_and_far_points) {
  for (const OccShape& shape : {OccShape::sphere(3), OccShape::sphere(3).as_nurbs(), OccShape::cylinder(2, 5),
                                OccShape::cone(3, 0, 4), OccShape::torus(5, 1.5), OccShape::vase(),
                                OccShape::cylinder(2, 5).as_nurbs(), OccShape::cone(3, 0, 4).as_nurbs()}) {
    const auto model = shape.import().model;
    const std::vector<Vec3> points{{0, 0, 0},    {0, 0, 1},      {0, 0, 3},     {0, 0, -3},    {0, 0, 50},
                                   {3, 0, 0},    {2, 0, 2},      {2, 1e-15, 2}, {5, 0, 0},     {2, -1e-15, 2},
                                   {-1e5, 3, 8}, {0, 0, 4},      {5, 0, 1.5},   {-5, 0, -1.5}, {1e-9, 0, 4.1},
                                   {0, 2, 5},    {1e6, 1e6, 1e6}};
    for (int dim = 0; dim <= 2; ++dim) {
      for (int id = 1; id <= model->count(dim); ++id) {
        for (const Vec3& p : points) {
          const Projection foot = model->project({dim, id}, p);
          const double slack = 1e-9 * (1 + p.norm());
          ASSERT_TRUE(foot.point.allFinite());
          EXPECT_LE(foot.distance, shape.distance({dim, id}, p) + slack)
              << to_string(Owner{dim, id}) << " " << model->type({dim, id}) << " from " << p.transpose();
          EXPECT_LE(shape.distance({dim, id}, foot.point), 1e-6);
        }
      }
    }
  }
}

TEST(occ_projection, parameters_lie_in_the_range_of_the_entity) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const OccShape& shape : {OccShape::cylinder_sector(3, 4, 5, 8), OccShape::torus(5, 1.5), OccShape::loft()}) {
    const auto model = shape.import().model;
    for (int id = 1; id <= model->count(1); ++id) {
      const CurveRange range = model->range(id);
      for (int i = 0; i < 50; ++i) {
        const Projection foot = model->project({1, id}, 9 * Vec3(unit(random), unit(random), unit(random)));
        EXPECT_GE(foot.parameters.u, range.first);
        EXPECT_LE(foot.parameters.u, range.last);
        EXPECT_TRUE(std::isnan(foot.parameters.v));
      }
    }
  }
}

TEST(occ_projection, a_seed_nearby_gives_what_the_global_search_gives) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const OccShape& shape :
       {OccShape::loft(), OccShape::vase(), OccShape::sphere(3).as_nurbs(), OccShape::torus(5, 1.5),
        OccShape::cylinder(2, 5).as_nurbs(), OccShape::brick_with_hole(10, 6, 2, 1.5).as_nurbs()}) {
    const auto model = shape.import().model;
    const double size = model->box().diagonal();
    for (int dim = 1; dim <= 2; ++dim) {
      for (int id = 1; id <= model->count(dim); ++id) {
        std::vector<Vec3> points;
        std::vector<Parameters> seeds;
        for (int i = 0; i < 100; ++i) {
          const Vec3 on = model->project({dim, id}, size * Vec3(unit(random), unit(random), unit(random))).point;
          points.push_back(on + 1e-3 * size * Vec3(unit(random), unit(random), unit(random)));
          const Vec3 beside = on + 0.02 * size * Vec3(unit(random), unit(random), unit(random));
          seeds.push_back(i % 10 == 0 ? Parameters{} : model->project({dim, id}, beside).parameters);
        }
        std::vector<Projection> global(points.size()), seeded(points.size());
        model->project({dim, id}, points, {}, global);
        model->project({dim, id}, points, seeds, seeded);
        for (std::size_t i = 0; i < points.size(); ++i) {
          EXPECT_NEAR(seeded[i].distance, global[i].distance, 1e-12 * size)
              << to_string(Owner{dim, id}) << " " << model->type({dim, id}) << " " << i;
          EXPECT_LE((model->point({dim, id}, seeded[i].parameters) - seeded[i].point).norm(), 1e-13 * size);
        }
      }
    }
  }
}

TEST(occ_projection, a_useless_seed_does_no_harm) {
  const auto ball = OccShape::sphere(3).as_nurbs().import().model;
  const auto at_pole = ball->project({2, 1}, Vec3(0, 0, 9)).parameters;
  for (const Parameters seed : {at_pole, Parameters{1e9, -1e9}, Parameters{std::nan(""), 0.3}}) {
    const Vec3 p(1, -2, 0.5);
    Projection foot;
    ball->project({2, 1}, {&p, 1}, {&seed, 1}, {&foot, 1});
    EXPECT_NEAR(foot.distance, 3 - p.norm(), 1e-12);
  }
}

TEST(occ_projection, stops_at_the_boundary_of_a_trimmed_face) {
  const auto plate = OccShape::brick_with_hole(10, 6, 2, 1.5).import().model;
  int n_tested = 0;
  for (int id = 1; id <= plate->count(2); ++id) {
    if (plate->type({2, id}) != "plane" || plate->adjacent({2, id}, 1).size() != 5) continue;
    ++n_tested;
    const double z = plate->box({2, id}).min.z();
    const Projection in_hole = plate->project({2, id}, Vec3(5.6, 3, z + 1));
    EXPECT_LT((in_hole.point - Vec3(6.5, 3, z)).norm(), 1e-12);
    EXPECT_NEAR(in_hole.distance, std::hypot(0.9, 1), 1e-12);
    const Projection beside = plate->project({2, id}, Vec3(12, 7, z));
    EXPECT_LT((beside.point - Vec3(10, 6, z)).norm(), 1e-12);
    EXPECT_NEAR(plate->project({2, id}, Vec3(5, 3, z)).distance, 1.5, 1e-12);
    // On the rim nothing moves, not even by the tolerance of the edges.
    for (int k = 0; k < 60; ++k) {
      const double a = 0.1 * k;
      const Vec3 rim(5 + 1.5 * std::cos(a), 3 + 1.5 * std::sin(a), z);
      EXPECT_LT(plate->project({2, id}, rim).distance, 1e-13);
    }
  }
  EXPECT_EQ(n_tested, 2);
}

TEST(occ_projection, is_the_same_for_any_number_of_threads_and_any_batch) {
  std::mt19937 random(14);
  std::uniform_real_distribution<double> unit(-1, 1);
  const OccShape shape = OccShape::loft();
  std::vector<Vec3> points;
  for (int i = 0; i < 3000; ++i) points.push_back(10 * Vec3(unit(random), unit(random), unit(random) + 0.7));
  std::vector<std::vector<Projection>> results;
  for (const std::size_t n_threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, n_threads);
    const auto model = shape.import().model;  // fresh: nothing is prepared yet
    for (const Owner entity : {Owner{2, 1}, Owner{1, 1}}) {
      std::vector<Projection> out(points.size());
      model->project(entity, points, {}, out);
      results.push_back(out);
    }
  }
  for (std::size_t k = 2; k < results.size(); ++k) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(results[k][i].point, results[k % 2][i].point);
      EXPECT_EQ(results[k][i].parameters.u, results[k % 2][i].parameters.u);
    }
  }
}

TEST(occ_projection, every_query_may_be_asked_by_several_threads_at_once) {
  const OccShape shape = OccShape::brick_with_hole(10, 6, 2, 1.5).as_nurbs();
  const auto ask = [](const Model& model) {
    std::vector<double> answers;
    for (int id = 1; id <= model.count(2); ++id) {
      const Projection foot = model.project({2, id}, Vec3(4, 5, 3));
      answers.push_back(foot.distance);
      answers.push_back(model.normal(id, foot.parameters).sum());
      answers.push_back(model.measure({2, id}));
      answers.push_back(model.box({2, id}).diagonal());
    }
    for (int id = 1; id <= model.count(1); ++id) answers.push_back(model.measure({1, id}));
    answers.push_back(model.measure({3, 1}));
    for (double x = -0.5; x < 11; x += 0.7) answers.push_back(model.contains(1, Vec3(x, 3, 1)));
    for (int dim = 0; dim <= 2; ++dim) answers.push_back(static_cast<double>(model.near(dim, Vec3(4, 3, 0), 2).size()));
    return answers;
  };
  const std::vector<double> alone = ask(*shape.import().model);
  for (int round = 0; round < 5; ++round) {
    const auto model = shape.import().model;
    std::vector<std::vector<double>> answers(8);
    std::vector<std::thread> threads;
    for (auto& mine : answers) threads.emplace_back([&] { mine = ask(*model); });
    for (auto& thread : threads) thread.join();
    for (const auto& mine : answers) EXPECT_EQ(mine, alone);
  }
}

}  // namespace
}  // namespace hextwist
