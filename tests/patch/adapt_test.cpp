// Adaptive refinement: flags and sizes in, mesh and origin out, levels graded.
#include "hextwist/patch/adapt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hextwist/sizing/levelling.h"
#include "support/analytic_model.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

using test::brick;
using test::centroid;
using test::levels;

/// Hexes that share a node differ by at most one level; names the first that don't.
testing::AssertionResult graded(const Mesh& mesh) {
  const std::vector<int> level = levels(mesh);
  std::vector<int> low(mesh.points.size(), 99), high(mesh.points.size(), -1);
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (const Index n : mesh.hexes[h]) {
      low[n] = std::min(low[n], level[h]);
      high[n] = std::max(high[n], level[h]);
    }
  for (std::size_t n = 0; n < low.size(); ++n)
    if (high[n] > low[n] + 1)
      return testing::AssertionFailure() << "levels " << low[n] << " and " << high[n] << " meet at node " << n + 1;
  return testing::AssertionSuccess();
}

/// Centroids of children lie in their origin (a grid of unit cubes).
void expect_origins(const MeshedModel& input, const AdaptResult& result, double reach = 0.5) {
  ASSERT_EQ(result.origin.size(), result.refined.mesh.hexes.size());
  for (Index h = 0; h < result.refined.mesh.n_hexes(); ++h) {
    const Vec3 away = centroid(result.refined.mesh, h) - centroid(input.mesh, result.origin[h]);
    EXPECT_LE(away.cwiseAbs().maxCoeff(), reach) << h;
  }
}

TEST(adapt, cuts_flagged_hexes_into_27_and_says_where_children_come_from) {
  const MeshedModel input = brick(4, 4, 4);
  std::vector<std::uint8_t> flags(64, 0);
  flags[21] = flags[22] = 1;
  const AdaptResult result = adapt(input, flags);
  expect_origins(input, result);
  EXPECT_EQ(std::ranges::count(result.origin, 21), 27);
  EXPECT_EQ(std::ranges::count(result.origin, 22), 27);
  const std::vector<int> level = levels(result.refined.mesh);
  for (std::size_t h = 0; h < level.size(); ++h)
    EXPECT_EQ(level[h], result.origin[h] == 21 || result.origin[h] == 22 ? 1 : 0);
  EXPECT_TRUE(test::conformal(result.refined.mesh));
  EXPECT_EQ(result.report.hexes_after, result.refined.mesh.n_hexes());
}

TEST(adapt, keeps_neighbours_within_one_level_over_repeated_calls) {
  MeshedModel mesh = brick(5, 5, 5);
  AdaptOptions options{.levelling = levelling_of(std::make_shared<const MeshedModel>(mesh))};
  for (int pass = 0; pass < 3; ++pass) {
    SCOPED_TRACE(pass);
    std::vector<std::uint8_t> flags(mesh.mesh.hexes.size(), 0);
    for (Index h = 0; h < mesh.mesh.n_hexes(); ++h)
      flags[h] = (centroid(mesh.mesh, h) - Vec3(2.5, 2.5, 2.5)).cwiseAbs().maxCoeff() < 0.5 * std::pow(1.0 / 3, pass);
    AdaptResult result = adapt(mesh, flags, options);
    EXPECT_GE(result.report.scaled_jacobian_after.min, 0.405);
    EXPECT_TRUE(graded(result.refined.mesh));
    EXPECT_TRUE(test::conformal(result.refined.mesh));
    EXPECT_TRUE(test::uninverted(result.refined.mesh));
    for (Index h = 0; h < mesh.mesh.n_hexes(); ++h)
      if (flags[h]) {
        EXPECT_EQ(std::ranges::count(result.origin, h), 27);
      }
    mesh = std::move(result.refined);
    options.levelling = result.levelling;
  }
  EXPECT_EQ(std::ranges::max(levels(mesh.mesh)), 3);
}

TEST(adapt, without_gradation_cuts_exactly_what_was_flagged) {
  const MeshedModel input = brick(4, 4, 4);
  std::vector<std::uint8_t> flags(64, 0);
  flags[0] = 1;
  const AdaptResult first =
      adapt(input, flags, {.levelling = levelling_of(std::make_shared<const MeshedModel>(input))});
  const MeshedModel& once = first.refined;
  const auto corner_flags = [&](const Mesh& mesh) {
    // All children of hex 0: those at its far corner have neighbours of level 0.
    std::vector<std::uint8_t> result(mesh.hexes.size(), 0);
    const std::vector<int> level = levels(mesh);
    for (std::size_t h = 0; h < result.size(); ++h) result[h] = level[h] == 1;
    return result;
  };
  const std::vector<std::uint8_t> again = corner_flags(once.mesh);
  const AdaptResult free = adapt(once, again, {.keep_gradation = false});
  const AdaptResult kept = adapt(once, again, {.levelling = first.levelling});
  EXPECT_FALSE(graded(free.refined.mesh));
  EXPECT_TRUE(graded(kept.refined.mesh));
  EXPECT_GT(kept.refined.mesh.n_hexes(), free.refined.mesh.n_hexes());
  ASSERT_FALSE(kept.report.notices.empty());
  EXPECT_NE(kept.report.notices.back().find("more than asked for, so that no piece of a transition is cut"),
            std::string::npos);
}

TEST(adapt, takes_a_wished_size_for_each_hex) {
  const MeshedModel input = brick(4, 4, 4);
  std::vector<double> sizes(64, std::numeric_limits<double>::infinity());
  sizes[21] = 0.4;
  sizes[42] = 0.12;
  const AdaptResult result = adapt(input, sizes);
  expect_origins(input, result, 1);  // repairing children of the second pass moves older nodes
  EXPECT_TRUE(test::conformal(result.refined.mesh));
  EXPECT_TRUE(test::uninverted(result.refined.mesh));
  for (Index h = 0; h < result.refined.mesh.n_hexes(); ++h) {
    const double size = std::cbrt(volume(result.refined.mesh, h));
    EXPECT_LE(size, std::sqrt(3.0) * sizes[result.origin[h]]) << h;
  }
  EXPECT_EQ(result.report.sizes->n_coarser, 0);
}

TEST(adapt, wished_sizes_raise_levels_as_flags_do) {
  const MeshedModel input = brick(4, 4, 4);
  std::vector<double> sizes(64, std::numeric_limits<double>::infinity());
  sizes[21] = sizes[22] = 0.4;
  std::vector<std::uint8_t> flags(64, 0);
  flags[21] = flags[22] = 1;
  const Mesh by_size = adapt(input, sizes).refined.mesh, by_flag = adapt(input, flags).refined.mesh;
  EXPECT_TRUE(by_size == by_flag) << "the same mesh, the same levels";
  EXPECT_EQ(std::ranges::count(levels(by_size), 1), 54);
  // Two passes at once: graded, and exactly without gradation.
  sizes[22] = 0.12;
  const Mesh twice = adapt(input, sizes).refined.mesh;
  EXPECT_EQ(std::ranges::max(levels(twice)), 2);
  EXPECT_TRUE(graded(twice));
  const AdaptResult free = adapt(input, sizes, {.keep_gradation = false});
  EXPECT_EQ(std::ranges::count(levels(free.refined.mesh), 2), 729);
  EXPECT_FALSE(graded(free.refined.mesh));
  for (Index h = 0; h < free.refined.mesh.n_hexes(); ++h)
    if (levels(free.refined.mesh)[h] == 2) {
      EXPECT_EQ(free.origin[h], 22);
    }
}

TEST(adapt, a_hex_between_flagged_ones_is_cut_as_they_are_and_rises_with_them) {
  const MeshedModel input = brick(3, 3, 3);
  std::vector<std::uint8_t> flags(27, 1);
  flags[13] = 0;
  const Mesh mesh = adapt(input, flags).refined.mesh;
  EXPECT_EQ(mesh.n_hexes(), 27 * 27);
  EXPECT_EQ(levels(mesh), std::vector<int>(27 * 27, 1));
}

TEST(adapt, neighbours_stay_within_one_level_over_mixed_calls) {
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    std::mt19937 random(seed);
    MeshedModel mesh = brick(4, 4, 3);
    AdaptOptions options{.levelling = levelling_of(std::make_shared<const MeshedModel>(mesh))};
    for (int call = 0; call < 4 && mesh.mesh.n_hexes() < 3000; ++call) {
      SCOPED_TRACE("seed " + std::to_string(seed) + " call " + std::to_string(call));
      const auto n = mesh.mesh.hexes.size();
      AdaptResult result;
      if (random() % 2) {
        std::vector<std::uint8_t> flags(n, 0);
        for (int i = 0; i < 4; ++i) flags[random() % n] = 1;
        result = adapt(mesh, flags, options);
      } else {
        std::vector<double> sizes(n, std::numeric_limits<double>::infinity());
        const auto h = static_cast<Index>(random() % n);
        sizes[h] = std::cbrt(volume(mesh.mesh, h)) / (random() % 2 ? 2.5 : 6);
        options.bias = random() % 2 ? 1 : 1.6;
        result = adapt(mesh, sizes, options);
      }
      EXPECT_TRUE(graded(result.refined.mesh));
      EXPECT_TRUE(test::conformal(result.refined.mesh));
      EXPECT_TRUE(test::uninverted(result.refined.mesh));
      EXPECT_GE(result.report.scaled_jacobian_after.min, 0.405);
      mesh = std::move(result.refined);
      options.levelling = result.levelling;
    }
  }
}

TEST(adapt, without_flags_returns_the_mesh_as_it_was) {
  const MeshedModel input = brick(2, 2, 2);
  const AdaptResult result = adapt(input, std::vector<std::uint8_t>(8, 0));
  EXPECT_EQ(result.refined.mesh.hexes, input.mesh.hexes);
  EXPECT_EQ(levels(result.refined.mesh), std::vector<int>(8, 0));
  EXPECT_EQ(result.origin, (std::vector<Index>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(adapt, flags_or_sizes_that_do_not_fit_are_refused) {
  const MeshedModel input = brick(2, 2, 2);
  const auto refusal = [&](auto values) {
    try {
      adapt(input, values);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("not refused");
  };
  EXPECT_EQ(refusal(std::vector<std::uint8_t>(7, 1)), "there are 7 flags for 8 hexes");
  EXPECT_EQ(refusal(std::vector<double>(9, 1.0)), "there are 9 sizes for 8 hexes");
  EXPECT_EQ(refusal(std::vector<double>{1, 1, 1, 0, 1, 1, 1, 1}),
            "field \"size\" is 0.000000 at hex 4: sizes must be positive");
}

}  // namespace
}  // namespace hextwist
