#include "support/analytic_model.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/model_checks.h"

namespace hextwist {
namespace {

constexpr double pi = std::numbers::pi;

struct AnalyticModel : testing::Test {
  std::mt19937 random{20240611};
  std::vector<std::shared_ptr<const Model>> all = {analytic_brick(3, 0.5, 7), analytic_cylinder(2, 5),
                                                   analytic_cylinder(3, 0.1), analytic_sphere(4)};
};

TEST_F(AnalyticModel, keeps_the_promises_of_every_model) {
  for (const auto& model : all) {
    test::expect_entities_consistent(*model);
    test::expect_projections_consistent(*model, random);
  }
}

TEST_F(AnalyticModel, measures_are_those_of_the_textbook) {
  EXPECT_DOUBLE_EQ(all[0]->measure({1, 9}), 7);
  EXPECT_DOUBLE_EQ(all[0]->measure({2, 1}), 3.5);
  EXPECT_DOUBLE_EQ(all[0]->measure({3, 1}), 10.5);
  EXPECT_DOUBLE_EQ(all[1]->measure({1, 1}), 4 * pi);
  EXPECT_DOUBLE_EQ(all[1]->measure({2, 1}), 20 * pi);
  EXPECT_DOUBLE_EQ(all[1]->measure({2, 3}), 4 * pi);
  EXPECT_DOUBLE_EQ(all[1]->measure({3, 1}), 20 * pi);
  EXPECT_DOUBLE_EQ(all[3]->measure({2, 1}), 64 * pi);
  EXPECT_DOUBLE_EQ(all[3]->measure({3, 1}), 256 * pi / 3);
}

TEST_F(AnalyticModel, a_brick_numbers_its_entities_like_the_reference_hex) {
  const Model& brick = *all[0];
  for (int dim = 0; dim < 4; ++dim) EXPECT_EQ(brick.count(dim), (std::array{8, 12, 6, 1})[dim]);
  EXPECT_EQ(brick.point({0, 6}, {}), Vec3(3, 0, 7));
  EXPECT_EQ(brick.point({1, 8}, {0.25, 0}), Vec3(3, 0.25, 7));  // along y at x = 1, z = 1
  EXPECT_EQ(brick.point({2, 4}, {1, 2}), Vec3(1, 0.5, 2));      // y = max
  EXPECT_EQ(brick.normal(4, {1, 2}), Vec3(0, 1, 0));
  EXPECT_EQ(brick.adjacent({1, 8}, 0), (std::vector<int>{6, 8}));
  EXPECT_EQ(brick.adjacent({1, 8}, 2), (std::vector<int>{2, 6}));
  EXPECT_EQ(brick.adjacent({2, 4}, 1), (std::vector<int>{2, 4, 11, 12}));
  EXPECT_EQ(brick.adjacent({3, 1}, 0).size(), 8u);
  EXPECT_EQ(brick.adjacent({0, 1}, 3), std::vector<int>{1});
}

TEST_F(AnalyticModel, a_cylinder_has_two_closed_curves_with_a_vertex_each) {
  const Model& cylinder = *all[1];
  EXPECT_DOUBLE_EQ(cylinder.range(1).period, 2 * pi);
  EXPECT_EQ(cylinder.adjacent({2, 1}, 1), (std::vector<int>{1, 2}));
  EXPECT_EQ(cylinder.adjacent({2, 3}, 0), std::vector<int>{2});
  EXPECT_EQ(cylinder.point({0, 2}, {}), Vec3(2, 0, 5));
  // Just below the seam the parameter stays inside the range, and the point does not jump.
  const auto foot = cylinder.project({1, 1}, Vec3(2, -1e-300, 0));
  EXPECT_LT(foot.parameters.u, 2 * pi);
  EXPECT_NEAR((foot.point - Vec3(2, 0, 0)).norm(), 0, 1e-15);
  EXPECT_LT((cylinder.tangent(1, pi / 2) - Vec3(-1, 0, 0)).norm(), 1e-15);
}

TEST_F(AnalyticModel, points_without_a_closest_one_follow_their_seed) {
  const Vec3 axis(0, 0, 1);
  const Parameters seed{pi / 2, 0};
  Projection foot;
  all[1]->project({2, 1}, {&axis, 1}, {&seed, 1}, {&foot, 1});
  EXPECT_LT((foot.point - Vec3(0, 2, 1)).norm(), 1e-15);
  const Vec3 centre = Vec3::Zero();
  all[3]->project({2, 1}, {&centre, 1}, {&seed, 1}, {&foot, 1});
  EXPECT_LT((foot.point - Vec3(0, 4, 0)).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(all[3]->project({2, 1}, centre).distance, 4);
}

TEST_F(AnalyticModel, contains_points_inside_and_on_the_boundary_only) {
  for (const auto& model : all) {
    const Box box = model->box();
    for (int i = 0; i < 200; ++i) {
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = std::uniform_real_distribution(1.2 * box.min[axis] - 1, 1.2 * box.max[axis] + 1)(random);
      const bool in = model->contains(1, p);
      for (int surface = 1; surface <= model->count(2); ++surface) {
        const auto foot = model->project({2, surface}, p);
        EXPECT_TRUE(model->contains(1, foot.point));
        EXPECT_FALSE(model->contains(1, foot.point + 1e-6 * model->normal(surface, foot.parameters)));
      }
      // A convex body holds exactly the points that see the outside of none of its faces from behind.
      bool behind_all = true;
      for (int surface = 1; surface <= model->count(2); ++surface) {
        const auto foot = model->project({2, surface}, p);
        behind_all = behind_all && (p - foot.point).dot(model->normal(surface, foot.parameters)) <= 0;
      }
      EXPECT_EQ(in, behind_all);
    }
  }
}

TEST(analytic_model, sizes_that_are_no_sizes_are_refused) {
  EXPECT_THROW(analytic_brick(1, 0, 1), Error);
  EXPECT_THROW(analytic_brick(1, 1, -2), Error);
  EXPECT_THROW(analytic_cylinder(0, 1), Error);
  EXPECT_THROW(analytic_cylinder(1, std::numeric_limits<double>::infinity()), Error);
  EXPECT_THROW(analytic_sphere(std::numeric_limits<double>::quiet_NaN()), Error);
  try {
    analytic_sphere(-1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("radius of a sphere must be positive"), std::string::npos);
  }
}

}  // namespace
}  // namespace hextwist
