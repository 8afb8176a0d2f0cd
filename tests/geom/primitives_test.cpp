#include "hextwist/geom/primitives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "support/analytic_model.h"
#include "support/model_checks.h"

namespace hextwist {
namespace {

constexpr double pi = std::numbers::pi;

TEST(cad_primitives, have_the_sizes_asked_for_and_their_middle_at_the_origin) {
  const auto brick = cad_brick({10, 5, 2}).model, cylinder = cad_cylinder({3, 10}).model,
             sphere = cad_sphere({5}).model;
  EXPECT_NEAR(brick->measure({3, 1}), 100, 1e-10);
  EXPECT_NEAR(cylinder->measure({3, 1}), 90 * pi, 1e-8);
  EXPECT_NEAR(sphere->measure({3, 1}), 500 * pi / 3, 1e-8);
  EXPECT_NEAR(sphere->measure({2, 1}), 100 * pi, 1e-8);
  double area = 0;
  for (int s = 1; s <= 3; ++s) area += cylinder->measure({2, s});
  EXPECT_NEAR(area, 78 * pi, 1e-8);
  const auto half = [](const std::shared_ptr<const Model>& model) {
    EXPECT_LT((model->box().min + model->box().max).norm(), 1e-6);
    return Vec3(model->box().max);
  };
  EXPECT_LT((half(brick) - Vec3(5, 2.5, 1)).norm(), 1e-6);
  EXPECT_LT((half(cylinder) - Vec3(3, 3, 5)).norm(), 1e-6);
  EXPECT_LT((half(sphere) - Vec3(5, 5, 5)).norm(), 1e-6);
}

TEST(cad_primitives, agree_with_closed_forms_on_closest_points) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> at(-6, 6);
  const auto nearest = [](const Model& model, const Vec3& p) {
    double distance = std::numeric_limits<double>::infinity();
    for (int s = 1; s <= model.count(2); ++s) distance = std::min(distance, model.project({2, s}, p).distance);
    return distance;
  };
  struct Pair {
    std::shared_ptr<const Model> cad, exact;
    Vec3 shift;  ///< the closed forms of brick and cylinder stand on z = 0
  };
  const std::array pairs = {Pair{cad_brick({8, 4, 2}).model, analytic_brick(8, 4, 2), Vec3(4, 2, 1)},
                            Pair{cad_cylinder({3, 10}).model, analytic_cylinder(3, 10), Vec3(0, 0, 5)},
                            Pair{cad_sphere({5}).model, analytic_sphere(5), Vec3(0, 0, 0)}};
  for (const auto& [cad, exact, shift] : pairs)
    for (int i = 0; i < 300; ++i) {
      const Vec3 p(at(random), at(random), at(random));
      EXPECT_NEAR(nearest(*cad, p), nearest(*exact, p + shift), 1e-9);
      EXPECT_EQ(cad->contains(1, p), exact->contains(1, p + shift));
    }
}

TEST(cad_primitives, sizes_out_of_range_are_refused_by_name) {
  const auto message_of = [](const std::function<void()>& call) -> std::string {
    try {
      call();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message_of([] { cad_brick({1, 1, 0}); }), "height of a brick must lie between 1e-06 and 1e+09, not 0");
  EXPECT_EQ(message_of([] { cad_cylinder({-1, 1}); }), "radius of a cylinder must lie between 1e-06 and 1e+09, not -1");
  EXPECT_EQ(message_of([] { cad_sphere({1e-7}); }), "radius of a sphere must lie between 1e-06 and 1e+09, not 1e-07");
  EXPECT_EQ(message_of([] { cad_sphere({1e10}); }), "radius of a sphere must lie between 1e-06 and 1e+09, not 1e+10");
  EXPECT_EQ(message_of([] { cad_sphere({1e-6}); }), "no error");
}

}  // namespace
}  // namespace hextwist
