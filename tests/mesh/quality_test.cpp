#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/quality/validity.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "hextwist/mesh/corners.h"
#include "support/grids.h"

namespace hextwist {
namespace {

/// Cubes with every corner moved by up to `wobble`, at many scales and places: good, bad and inverted ones.
Mesh wobbly(std::mt19937& random, int n, double wobble) {
  std::uniform_real_distribution<double> step(-wobble, wobble), decade(-4, 4);
  Mesh mesh;
  for (int h = 0; h < n; ++h) {
    const double scale = std::pow(10, decade(random));
    Hex hex;
    for (int c = 0; c < 8; ++c) {
      hex[c] = mesh.n_nodes();
      mesh.points.push_back(scale *
                            Vec3((c & 1) + step(random), (c >> 1 & 1) + step(random), (c >> 2 & 1) + step(random)));
    }
    mesh.hexes.push_back(hex);
  }
  return mesh;
}

using Corners = std::array<Vec3, 8>;
Corners cube() {
  Corners x;
  for (int c = 0; c < 8; ++c) x[c] = Vec3(c & 1, c >> 1 & 1, c >> 2 & 1);
  return x;
}

TEST(quality, is_one_for_cubes_of_any_size) {
  for (const double size : {1e-40, 1e-9, 1.0, 1e30}) {
    Corners x = cube();
    for (Vec3& p : x) p *= size;
    EXPECT_NEAR(quality(Metric::shape, x), 1, 1e-14) << size;
    EXPECT_NEAR(quality(Metric::scaled_jacobian, x), 1, 1e-14) << size;
  }
}

TEST(quality, of_bricks_and_sheared_cubes_is_what_the_formulas_say) {
  Corners brick = cube(), sheared = cube();
  for (Vec3& p : brick) p = p.cwiseProduct(Vec3(1, 2, 5));
  EXPECT_NEAR(quality(Metric::shape, brick), 3 * std::cbrt(100.0) / 30, 1e-14);
  EXPECT_NEAR(quality(Metric::scaled_jacobian, brick), 1, 1e-14);
  const double angle = 0.3;
  for (Vec3& p : sheared) p = Vec3(p.x() + p.y() * std::cos(angle), p.y() * std::sin(angle), p.z());
  EXPECT_NEAR(quality(Metric::shape, sheared), std::pow(std::sin(angle), 2.0 / 3), 1e-14);
  EXPECT_NEAR(quality(Metric::scaled_jacobian, sheared), std::sin(angle), 1e-14);
}

TEST(quality, of_mirrored_flat_and_collapsed_hexes) {
  Corners mirrored = cube(), flat = cube(), collapsed = cube(), point;
  for (Vec3& p : mirrored) p.z() = -p.z();
  EXPECT_EQ(quality(Metric::shape, mirrored), 0);
  EXPECT_NEAR(quality(Metric::scaled_jacobian, mirrored), -1, 1e-14);
  EXPECT_EQ(min_corner_jacobian(mirrored), -1);
  for (Vec3& p : flat) p.z() = 0;
  collapsed[1] = collapsed[0];
  point.fill(Vec3(1, 2, 3));
  for (const Corners& x : {flat, collapsed, point}) {
    EXPECT_EQ(quality(Metric::shape, x), 0);
    EXPECT_EQ(quality(Metric::scaled_jacobian, x), 0);
    EXPECT_EQ(min_corner_jacobian(x), 0);
  }
}

TEST(quality, does_not_depend_on_how_a_hex_is_turned) {
  std::mt19937 random(4);
  Mesh mesh = wobbly(random, 50, 0.3);
  const auto before = quality(Metric::shape, mesh), jacobian = quality(Metric::scaled_jacobian, mesh);
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    const Hex hex = mesh.hexes[h];
    for (int c = 0; c < 8; ++c) mesh.hexes[h][c] = hex[(c >> 2) | (c & 3) << 1];  // axes x y z to y z x
  }
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    EXPECT_NEAR(quality(Metric::shape, mesh, h), before[h], 1e-12);
    EXPECT_NEAR(quality(Metric::scaled_jacobian, mesh, h), jacobian[h], 1e-12);
  }
}

TEST(quality, is_bit_for_bit_the_same_one_by_one_together_and_on_any_number_of_threads) {
  std::mt19937 random(8);
  const Mesh mesh = wobbly(random, 10007, 0.4);
  for (const Metric metric : metrics()) {
    std::vector<std::vector<double>> runs;
    std::vector<Summary> summaries;
    for (const int threads : {1, 2, 8}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      runs.push_back(quality(metric, mesh));
      summaries.push_back(summarize(runs.back()));
    }
    for (int i = 1; i < 3; ++i) {
      EXPECT_EQ(runs[i], runs[0]);
      EXPECT_EQ(summaries[i].average, summaries[0].average);
      EXPECT_EQ(summaries[i].std_dev, summaries[0].std_dev);
      EXPECT_EQ(summaries[i].min_hex, summaries[0].min_hex);
    }
    const double average = average_volume(mesh);
    for (Index h = 0; h < mesh.n_hexes(); ++h)
      ASSERT_EQ(quality(metric, mesh, h, average), runs[0][h]) << name(metric) << h;
  }
  const auto jacobians = min_corner_jacobian(mesh);
  for (Index h = 0; h < mesh.n_hexes(); ++h) ASSERT_EQ(min_corner_jacobian(mesh, h), jacobians[h]);
}

TEST(quality, smallest_corner_jacobian_is_that_of_a_plain_loop) {
  std::mt19937 random(9);
  const Mesh mesh = wobbly(random, 500, 0.6);
  const auto jacobians = min_corner_jacobian(mesh);
  int n_negative = 0;
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    double least = INFINITY;
    for (int c = 0; c < 8; ++c) {
      Eigen::Matrix3d a;
      for (int axis = 0; axis < 3; ++axis)
        a.col(axis) = mesh.points[mesh.hexes[h][c | 1 << axis]] - mesh.points[mesh.hexes[h][c & ~(1 << axis)]];
      least = std::min(least,
                       a.col(0).dot(Vec3(a(1, 1) * a(2, 2) - a(2, 1) * a(1, 2), a(2, 1) * a(0, 2) - a(0, 1) * a(2, 2),
                                         a(0, 1) * a(1, 2) - a(1, 1) * a(0, 2))));
    }
    EXPECT_NEAR(jacobians[h], least, 1e-12 * std::abs(least));
    n_negative += least < 0;
  }
  EXPECT_GT(n_negative, 50);
  EXPECT_LT(n_negative, 450);
}

TEST(quality, summary_of_known_values) {
  const std::vector<double> values = {3, 1, 4, 1, 5, 5};
  const Summary all = summarize(values);
  EXPECT_EQ(all.count, 6);
  EXPECT_NEAR(all.average, 19.0 / 6, 1e-15);
  EXPECT_NEAR(all.std_dev, std::sqrt(77.0 / 6 - 361.0 / 36), 1e-14);
  EXPECT_EQ(all.min, 1);
  EXPECT_EQ(all.max, 5);
  EXPECT_EQ(all.min_hex, 1);
  EXPECT_EQ(all.max_hex, 4);
  const Summary some = summarize(values, std::vector<Index>{5, 3, 4, 1});
  EXPECT_EQ(some.count, 4);
  EXPECT_EQ(some.average, 3);
  EXPECT_EQ(some.std_dev, 2);
  EXPECT_EQ(some.min_hex, 1);
  EXPECT_EQ(some.max_hex, 4);
  const Summary none = summarize({});
  EXPECT_EQ(none.count, 0);
  EXPECT_EQ(none.average, 0);
  EXPECT_EQ(none.min_hex, -1);
}

TEST(quality, metrics_are_known_by_name_however_it_is_written) {
  for (const char* word : {"shape", "Shape", "sha", "SHAP"}) EXPECT_EQ(metric(word), Metric::shape) << word;
  for (const char* word : {"scaled Jacobian", "SCALED_JACOBIAN", "scaled-jac", "scaledJacobian", "sc jac", "scaled"})
    EXPECT_EQ(metric(word), Metric::scaled_jacobian) << word;
  for (const char* word : {"jacobian", "JACOB", "j"}) EXPECT_EQ(metric(word), Metric::jacobian) << word;
  for (const char* word : {"condition", "condition_number", "cond num"})
    EXPECT_EQ(metric(word), Metric::condition_number) << word;
  EXPECT_EQ(metric("diag"), Metric::diagonal);
  EXPECT_EQ(metric("dim"), Metric::dimension);
  for (const Metric m : metrics()) EXPECT_EQ(metric(name(m)), m);
}

TEST(quality, unknown_and_ambiguous_metrics_are_errors_that_list_the_known) {
  const auto message = [](const char* word) {
    try {
      metric(word);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const std::string known =
      "known are shape, scaled Jacobian, mean ratio, condition number, skew, stretch, taper, aspect ratio, edge ratio, "
      "diagonal, relative size, shear, oddy, distortion, volume, Jacobian, dimension";
  EXPECT_EQ(message("nonsense"), "unknown quality metric 'nonsense': " + known);
  EXPECT_EQ(message(""), "unknown quality metric '': " + known);
  EXPECT_EQ(message("shape jacobian"), "unknown quality metric 'shape jacobian': " + known);
  EXPECT_EQ(message("s"), "ambiguous quality metric 's': could be shape, scaled Jacobian, skew, stretch, shear");
  EXPECT_EQ(message("di"), "ambiguous quality metric 'di': could be diagonal, distortion, dimension");
}

/// Prints what a million hexes cost. Run by hand: --gtest_also_run_disabled_tests --gtest_filter=*million*
TEST(quality, DISABLED_of_a_million_hexes_is_quick) {
  const Mesh mesh = test::grid(100, 100, 100);
  for (const int threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const auto clock = [&](const char* what, auto f) {
      const auto start = std::chrono::steady_clock::now();
      f();
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      std::printf("  %d threads, %-16s %.3f s\n", threads, what, seconds.count());
    };
    for (const Metric metric : metrics()) clock(name(metric), [&] { quality(metric, mesh); });
    clock("corner Jacobian", [&] { min_corner_jacobian(mesh); });
    clock("validity", [&] { all_valid(mesh); });
    const auto values = quality(Metric::shape, mesh);
    clock("summary", [&] { summarize(values); });
  }
}

}  // namespace
}  // namespace hextwist
