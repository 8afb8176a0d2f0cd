#include "hextwist/geom/facet/bilinear.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

namespace hextwist {
namespace {

struct Bilinear : testing::Test {
  std::mt19937 random{4711};
  double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(random); }
  Vec3 anywhere(double reach) { return Vec3(uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)); }
  /// A unit square with every corner moved.
  BilinearPatch patch(double noise) {
    BilinearPatch x = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
    for (Vec3& p : x) p += anywhere(noise);
    return x;
  }
};

TEST_F(Bilinear, corners_and_edges_are_reproduced_bit_for_bit) {
  for (int i = 0; i < 100; ++i) {
    const auto x = patch(0.3);
    EXPECT_EQ(point(x, 0, 0), x[0]);
    EXPECT_EQ(point(x, 1, 0), x[1]);
    EXPECT_EQ(point(x, 1, 1), x[2]);
    EXPECT_EQ(point(x, 0, 1), x[3]);
    const double s = uniform(0, 1);
    EXPECT_EQ(point(x, s, 0), Vec3((1 - s) * x[0] + s * x[1]));
    for (const Vec3& corner : x) EXPECT_EQ(closest(x, corner).distance2, 0);
  }
}

TEST_F(Bilinear, points_of_the_patch_are_their_own_closest_points) {
  for (int i = 0; i < 2000; ++i) {
    const auto x = patch(0.3);
    const double s = uniform(0, 1), t = uniform(0, 1);
    const PatchFoot foot = closest(x, point(x, s, t));
    EXPECT_LT(std::sqrt(foot.distance2), 1e-15);
    EXPECT_NEAR(foot.s, s, 1e-13);
    EXPECT_NEAR(foot.t, t, 1e-13);
  }
}

TEST_F(Bilinear, no_sampled_point_is_closer_than_the_closest) {
  constexpr int n = 40;
  for (int i = 0; i < 2000; ++i) {
    const auto x = patch(i % 2 ? 0.05 : 0.25);
    const Vec3 p = Vec3(0.5, 0.5, 0) + anywhere(1.5);
    const double distance = std::sqrt(closest(x, p).distance2);
    for (int a = 0; a <= n; ++a)
      for (int b = 0; b <= n; ++b)
        ASSERT_LE(distance, (point(x, a / double{n}, b / double{n}) - p).norm() + 1e-12) << i;
  }
}

TEST_F(Bilinear, degenerate_patches_have_closest_points_too) {
  const BilinearPatch triangle = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 1, 0)};
  const BilinearPatch line = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 0)};
  const BilinearPatch dot = {Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)};
  EXPECT_NEAR(std::sqrt(closest(triangle, Vec3(0.25, 0.25, 2)).distance2), 2, 1e-12);
  EXPECT_NEAR(std::sqrt(closest(line, Vec3(0.3, 4, 3)).distance2), 5, 1e-12);
  EXPECT_NEAR(std::sqrt(closest(dot, Vec3(1, 2, 4)).distance2), 1, 1e-12);
  EXPECT_EQ(area(line), 0);
}

TEST_F(Bilinear, areas_and_volumes_are_exact) {
  const BilinearPatch trapezoid = {Vec3(0, 0, 1), Vec3(4, 0, 1), Vec3(3, 2, 1), Vec3(1, 2, 1)};
  EXPECT_NEAR(area(trapezoid), 6, 1e-14);
  EXPECT_NEAR(cone_volume(trapezoid, Vec3(7, -3, -2)), 6, 1e-13);
  // Volume under the hyperbolic paraboloid z = x y over the unit square, closed by its shadow and four walls.
  const BilinearPatch saddle = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 1), Vec3(0, 1, 0)};
  const BilinearPatch floor = {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(1, 0, 0)};
  const BilinearPatch wall_x = {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(1, 0, 0)};
  const BilinearPatch wall_y = {Vec3(1, 1, 0), Vec3(0, 1, 0), Vec3(0, 1, 0), Vec3(1, 1, 1)};
  const Vec3 apex = anywhere(2);
  double sum = 0;
  for (const auto& x : {saddle, floor, wall_x, wall_y}) sum += cone_volume(x, apex);
  EXPECT_NEAR(sum, 0.25, 1e-14);
  // Its area: the integral of sqrt(1 + x^2 + y^2), here by a fine midpoint rule.
  double reference = 0;
  constexpr int n = 1000;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = (i + 0.5) / n, y = (j + 0.5) / n;
      reference += std::sqrt(1 + x * x + y * y) / (n * n);
    }
  EXPECT_NEAR(area(saddle), reference, 1e-6);
}

TEST_F(Bilinear, a_ray_that_aims_at_an_inner_point_pierces_there) {
  int n_sure = 0;
  for (int i = 0; i < 5000; ++i) {
    const auto x = patch(0.2);
    const double s = uniform(0.01, 0.99), t = uniform(0.01, 0.99);
    const Vec3 aim = point(x, s, t), origin = aim + 3 * anywhere(1).normalized();
    const Vec3 direction = aim - origin;
    // Both sides of the aim: only a patch that bends back is pierced twice, with opposite signs.
    const Crossing towards = pierce(x, origin, direction), away = pierce(x, origin, -direction);
    EXPECT_EQ(away.count, 0);
    if (towards.unsure) continue;
    ++n_sure;
    const int side = area_vector(x, s, t).dot(direction) > 0 ? 1 : -1;
    EXPECT_TRUE(towards.count == side || towards.count == 0) << i;
    const Vec3 square = area_vector(x, 0.5, 0.5).normalized();
    if (std::abs(square.dot(direction)) > 0.9 * direction.norm()) {
      EXPECT_EQ(towards.count, side) << i;
    }
    EXPECT_EQ(pierce(x, aim + direction, direction).count, 0);
  }
  EXPECT_GT(n_sure, 4900);
}

TEST_F(Bilinear, a_ray_through_the_rim_or_from_the_patch_itself_is_unsure) {
  const BilinearPatch square = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  EXPECT_TRUE(pierce(square, Vec3(0.5, 0, -1), Vec3(0, 0, 1)).unsure);
  EXPECT_TRUE(pierce(square, Vec3(1, 1, -1), Vec3(0, 0, 1)).unsure);
  EXPECT_TRUE(pierce(square, Vec3(0.5, 0.5, 0), Vec3(0, 0, 1)).unsure);
  EXPECT_TRUE(pierce(square, Vec3(-1, 0.5, 0), Vec3(1, 0, 0)).unsure);
  const Crossing clear = pierce(square, Vec3(0.5, 0.4, 2), Vec3(0, 0, -2));
  EXPECT_FALSE(clear.unsure);
  EXPECT_EQ(clear.count, -1);
}

}  // namespace
}  // namespace hextwist
