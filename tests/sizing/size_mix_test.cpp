// Sizes met by factors of two and three: what method auto tries, and what it takes.
#include <gtest/gtest.h>

#include <cmath>

#include "hextwist/geom/analytic_model.h"
#include "hextwist/sizing/request.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

using test::brick;

RefineResult checked(const MeshedModel& input, const Request& request) {
  RefineResult result = refine(input, request);
  test::expect_sound(result);
  return result;
}

double distance(const RefineResult& result) {
  double sum = 0;
  for (const double ratio : result.report.sizes->ratio) sum += std::abs(std::log(ratio));
  return sum / static_cast<double>(result.report.sizes->ratio.size());
}

std::string notices(const RefineResult& result) {
  std::string all;
  for (const std::string& line : result.report.notices) all += line + "\n";
  return all;
}

TEST(size_mix, a_layer_of_unit_cubes_meets_wishes_of_products_of_twos_and_threes_exactly) {
  const MeshedModel input = brick(4, 4, 4);
  for (const int pieces : {2, 3, 4, 6}) {
    SCOPED_TRACE(pieces);
    const RefineResult result =
        checked(input, {.kind = TargetKind::surface, .targets = {5}, .depth = 1, .size = 1.0 / pieces});
    EXPECT_EQ(result.report.sizes->hexes.size(), 16U * pieces * pieces * pieces);
    EXPECT_NEAR(distance(result), 0, 1e-9);
    EXPECT_EQ(result.report.sizes->met(), 1);
  }
}

TEST(size_mix, auto_comes_no_farther_from_the_wish_than_threes_alone) {
  const MeshedModel input = brick(5, 4, 3);
  for (const double size : {0.55, 0.5, 0.45, 0.36, 0.28, 0.22, 0.17}) {
    SCOPED_TRACE(size);
    Request request{.kind = TargetKind::surface, .targets = {5}, .depth = 1, .size = size};
    const RefineResult by_auto = checked(input, request);
    request.method = Method::single;
    const RefineResult by_threes = checked(input, request);
    EXPECT_LE(distance(by_auto), distance(by_threes) * 1.0500001);
    EXPECT_GE(by_auto.report.sizes->met(), by_threes.report.sizes->met() - 0.05);
    EXPECT_EQ(by_threes.report.notices.size(), 0U);
  }
}

TEST(size_mix, both_are_told_when_both_were_tried) {
  const MeshedModel input = brick(4, 4, 4);
  Request request{.kind = TargetKind::surface, .targets = {5}, .depth = 1, .size = 0.5};
  const RefineResult halved = checked(input, request);
  EXPECT_NE(
      notices(halved).find("one into eight where that comes nearer, else one into 27: sizes are off by a factor of "
                           "1.00 on average, not 1.50; the worst shape is "),
      std::string::npos)
      << notices(halved);
  request.method = Method::parallel;
  const RefineResult parallel = checked(input, request);
  EXPECT_TRUE(parallel.refined.mesh == halved.refined.mesh);
  request.method = Method::automatic;
  request.size = 1.0 / 3;  // a factor of three: nothing to choose
  EXPECT_EQ(notices(checked(input, request)), "");
}

TEST(size_mix, an_edge_is_left_alone_until_it_is_longer_than_the_wish_by_sqrt_3) {
  const MeshedModel input = brick(3, 3, 3);
  const RefineResult result = checked(input, {.kind = TargetKind::surface, .targets = {5}, .depth = 1, .size = 0.58});
  EXPECT_TRUE(result.refined.mesh == input.mesh);
}

TEST(size_mix, a_dry_run_counts_what_would_come_out) {
  const MeshedModel input = brick(4, 4, 4);
  Request request{.kind = TargetKind::surface, .targets = {5}, .depth = 1, .size = 0.5};
  const RefineResult real = checked(input, request);
  request.dry_run = true;
  const RefineResult dry = refine(input, request);
  EXPECT_EQ(dry.report.hexes_after, real.report.hexes_after);
  EXPECT_FALSE(dry.report.sizes);
  EXPECT_TRUE(dry.refined.mesh.hexes.empty());
}

TEST(size_mix, smoothing_comes_after_the_choice) {
  const MeshedModel input = brick(4, 4, 4);
  Request request{.kind = TargetKind::surface, .targets = {5}, .depth = 1, .size = 0.5};
  const RefineResult rough = checked(input, request);
  request.smooth = true;
  const RefineResult smooth = checked(input, request);
  EXPECT_EQ(smooth.refined.mesh.n_hexes(), rough.refined.mesh.n_hexes());
  EXPECT_GT(smooth.report.shape_after.min, rough.report.shape_after.min);
}

}  // namespace
}  // namespace hextwist
