// Energies of one node against quality(), their derivatives against differences.
#include <gtest/gtest.h>

#include "hextwist/mesh/smooth/condition_internal.h"
#include "hextwist/mesh/smooth/lift_patch_internal.h"
#include "hextwist/mesh/smooth/sweep_internal.h"
#include "smooth_fixtures.h"

namespace hextwist::test {
namespace {

struct Case {
  Mesh mesh;
  SmoothProblem problem;
  SweepRule rule;
};

Case shaken_grid(unsigned seed, double weight) {
  std::mt19937 random(seed);
  Case c{shuffled(seed % 2 ? grid(3, 3, 3) : pinwheel(5, 2, 3), random), {}, {}};
  shake(c.mesh, 0.15, random);
  c.problem = make_smooth_problem(c.mesh, {}, nullptr, {});
  c.rule.weight = weight;
  c.rule.reference = 1.7;
  return c;
}

template <class Patch>
void load(Patch& patch, const Case& c, Index slot) {
  const Index first = c.problem.first_ring[slot];
  patch.load(c.mesh.points.data(), c.mesh.points[c.problem.nodes[slot]],
             {c.problem.rings.data() + first, static_cast<std::size_t>(c.problem.first_ring[slot + 1] - first)});
}

template <class Patch>
void expect_derivatives_right(double weight) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Case c = shaken_grid(seed, weight);
    ASSERT_GT(c.problem.n_nodes(), 4);
    Patch patch(c.problem, c.rule);
    for (Index slot = 0; slot < c.problem.n_nodes(); ++slot) {
      load(patch, c, slot);
      const Local local = patch.derivatives();
      const auto energy = [&](const Vec3& y) { return patch.at(y).energy; };
      ASSERT_TRUE(std::isfinite(local.energy)) << "seed " << seed;
      EXPECT_NEAR(energy(Vec3::Zero()), local.energy, 1e-12 * local.energy);
      const double step = 1e-4;
      const double scale = local.hessian.norm();
      for (int i = 0; i < 3; ++i) {
        const Vec3 e = step * Vec3::Unit(i);
        EXPECT_NEAR((energy(e) - energy(-e)) / (2 * step), local.gradient[i], 1e-5 * scale) << "seed " << seed;
        for (int j = 0; j < 3; ++j) {
          const Vec3 f = step * Vec3::Unit(j);
          const double second = (energy(e + f) - energy(e - f) - energy(f - e) + energy(-e - f)) / (4 * step * step);
          EXPECT_NEAR(second, local.hessian(i, j), 1e-4 * scale) << "seed " << seed << ", " << i << j;
        }
      }
    }
  }
}

TEST(SmoothDerivatives, of_the_mean_ratio_match_differences) {
  expect_derivatives_right<ShapePatch<false>>(0);
}
TEST(SmoothDerivatives, of_the_power_term_match_differences) {
  expect_derivatives_right<ShapePatch<true>>(0.3);
}
TEST(SmoothDerivatives, of_the_condition_number_match_differences) {
  expect_derivatives_right<ConditionPatch>(0);
  expect_derivatives_right<ConditionPatch>(0.3);
}

/// The patch of lifts, with a power of its own.
struct Lift : LiftPatch {
  Lift(const SmoothProblem& problem, const SweepRule& rule)
      : LiftPatch(problem, {0.5, 0, static_cast<int>(rule.weight)}) {}
};
TEST(SmoothDerivatives, of_lifts_match_differences) {
  expect_derivatives_right<Lift>(1);
  expect_derivatives_right<Lift>(2);
  expect_derivatives_right<Lift>(8);
}

TEST(SmoothDerivatives, hessian_of_the_mean_ratio_is_positive_definite) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Case c = shaken_grid(seed, 0);
    ShapePatch<false> patch(c.problem, c.rule);
    for (Index slot = 0; slot < c.problem.n_nodes(); ++slot) {
      load(patch, c, slot);
      const Local local = patch.derivatives();
      EXPECT_GT(local.hessian.determinant(), 0) << "seed " << seed;
      const Vec3 step = newton_step(local.hessian, local.gradient);
      EXPECT_LE((local.hessian * step + local.gradient).norm(), 1e-8 * local.gradient.norm()) << "seed " << seed;
    }
  }
}

TEST(SmoothPatch, sees_the_distortion_that_quality_sees) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Case c = shaken_grid(seed, 0);
    std::vector<double> h;
    hex_distortions(c.mesh, c.problem.hexes, h);
    for (std::size_t i = 0; i < h.size(); ++i)
      EXPECT_NEAR(std::pow(h[i], -2.0 / 3), quality(Metric::shape, c.mesh, c.problem.hexes[i]), 1e-12);
    // A hex's worst corner is seen by some of its nodes; all nodes of the pinwheel's and grid's inner hexes are free.
    ShapePatch<false> patch(c.problem, c.rule);
    double worst = 1, worst_around = 1;
    for (Index slot = 0; slot < c.problem.n_nodes(); ++slot) {
      load(patch, c, slot);
      worst = std::max(worst, patch.derivatives().worst);
      for (Index r = c.problem.first_ring[slot]; r < c.problem.first_ring[slot + 1]; ++r)
        worst_around = std::max(worst_around, std::pow(quality(Metric::shape, c.mesh, c.problem.ring_hex[r]), -1.5));
    }
    EXPECT_LE(worst, worst_around * (1 + 1e-12)) << "seed " << seed;
    EXPECT_GT(worst, 1 + 0.5 * (worst_around - 1)) << "seed " << seed;
  }
}

TEST(SmoothProblem, gives_nodes_that_share_a_hex_different_colours) {
  std::mt19937 random(1);
  const Mesh mesh = shuffled(pinwheel(7, 4, 4), random);
  const SmoothProblem problem = make_smooth_problem(mesh, {}, nullptr, {});
  std::vector<Index> colour(mesh.points.size(), -1);
  for (Index c = 0; c < problem.n_colours(); ++c)
    for (Index slot = problem.first_colour[c]; slot < problem.first_colour[c + 1]; ++slot)
      colour[problem.nodes[slot]] = c;
  for (const Hex& hex : mesh.hexes)
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < a; ++b) {
        EXPECT_TRUE(colour[hex[a]] < 0 || colour[hex[a]] != colour[hex[b]]);
      }
  EXPECT_GE(problem.n_colours(), 8);
}

}  // namespace
}  // namespace hextwist::test
