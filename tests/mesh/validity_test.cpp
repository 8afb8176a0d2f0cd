#include "hextwist/mesh/quality/validity.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <numbers>
#include <random>

#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/smooth/smooth.h"
#include "hextwist/mesh/validate/validate.h"
#include "support/checkers.h"
#include "support/cube.h"
#include "support/grids.h"

using namespace hextwist;
using namespace hextwist::test;

namespace {

/// A tower of height 2 whose top is turned and longer than wide: beyond some 0.42 turns it is inverted in its middle,
/// though all corners are sound.
Corners twisted(double turns) {
  Corners x = cube();
  const Vec3 middle(0.5, 0.5, 0);
  const Eigen::AngleAxisd turn(turns * 2 * std::numbers::pi, Vec3::UnitZ());
  for (int c = 0; c < 8; ++c) {
    x[c].z() *= 2;
    if (c & 4) x[c] = turn * Vec3(1.5, 0.5, 1).cwiseProduct(x[c] - middle) + middle;
  }
  return x;
}

/// The Jacobian of the trilinear map by its definition.
double jacobian(const Corners& x, const Vec3& at) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  for (int c = 0; c < 8; ++c)
    for (int axis = 0; axis < 3; ++axis) {
      double weight = 1;
      for (int i = 0; i < 3; ++i) weight *= i == axis ? (c >> i & 1 ? 1 : -1) : (c >> i & 1 ? at[i] : 1 - at[i]);
      matrix.col(axis) += weight * x[c];
    }
  return matrix.determinant();
}

double least_sample(const Corners& x, int n) {
  double least = INFINITY;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) least = std::min(least, jacobian(x, Vec3(i, j, k) / n));
  return least;
}

Corners wobbly(std::mt19937& random, double by) {
  std::uniform_real_distribution<double> offset(-by, by);
  Corners x = cube();
  for (Vec3& p : x) p += Vec3(offset(random), offset(random), offset(random));
  return x;
}

Mesh mesh_of(const std::vector<Corners>& hexes) {
  Mesh mesh;
  for (const Corners& x : hexes) {
    Hex& hex = mesh.hexes.emplace_back();
    for (int c = 0; c < 8; ++c) {
      hex[c] = mesh.n_nodes();
      mesh.points.push_back(x[c]);
    }
  }
  return mesh;
}

}  // namespace

TEST(Validity, says_what_is_wrong_with_a_hex_and_where) {
  EXPECT_EQ(judge(cube()).fault, HexFault::none);
  EXPECT_EQ(judge(twisted(0.4)).fault, HexFault::none);
  Corners mirrored = cube();
  for (Vec3& p : mirrored) p.z() = -p.z();
  EXPECT_EQ(judge(mirrored).fault, HexFault::corner);
  EXPECT_EQ(judge(mirrored).value, -1);

  const HexVerdict middle = judge(twisted(0.55));
  ASSERT_GT(min_corner_jacobian(twisted(0.55)), 0);
  EXPECT_EQ(middle.fault, HexFault::inside);
  EXPECT_LT(middle.value, 0);
  EXPECT_NEAR(middle.value, jacobian(twisted(0.55), middle.at), 1e-14);
  EXPECT_EQ(judge(twisted(0.5)).fault, HexFault::inside);

  Corners flat = cube();
  flat[7] = (flat[3] + flat[5] + flat[6] - flat[1] - flat[2] - flat[4] + flat[0]);  // the cube's own
  flat[0] = (flat[1] + flat[2] + flat[4]) / 3 - Vec3::Constant(1e-8);               // in the plane of its neighbours
  EXPECT_EQ(judge(flat).fault, HexFault::flat);
  EXPECT_LT(judge(flat).value, least_scaled_jacobian);
  EXPECT_GT(judge(flat).value, 0);
}

TEST(Validity, leaves_thin_and_large_and_far_hexes_alone) {
  for (const double thin : {1e-3, 1e-6, 1e-9})
    for (const double size : {1e-6, 1.0, 1e6}) {
      Corners x = cube();
      for (Vec3& p : x) p = size * Vec3(p.x(), p.y(), thin * p.z()) + Vec3(10 * size, 0, 0);
      EXPECT_EQ(judge(x).fault, HexFault::none) << thin << ' ' << size;
    }
}

TEST(Validity, agrees_with_a_dense_sample_of_random_hexes) {
  std::mt19937 random(5);
  int n_inside = 0, n_valid = 0;
  for (int i = 0; i < 4000; ++i) {
    Corners x = wobbly(random, 0.1 * (i % 6));
    if (i % 3 == 0)
      for (int c = 0; c < 8; ++c) x[c] = twisted(0.3 + 0.3 * i / 4000)[c] + 0.3 * (x[c] - cube()[c]);
    const HexVerdict verdict = judge(x);
    const double sample = least_sample(x, 12);
    if (verdict.fault == HexFault::none) {
      EXPECT_GT(sample, 0) << i;
      ++n_valid;
    } else if (verdict.fault == HexFault::inside) {
      EXPECT_LE(jacobian(x, verdict.at), 1e-12) << i;
      EXPECT_NEAR(jacobian(x, verdict.at), verdict.value, 1e-12) << i;
      ++n_inside;
    } else if (verdict.fault == HexFault::corner) {
      EXPECT_NEAR(verdict.value, min_corner_jacobian(x), 1e-13) << i;
    }
  }
  EXPECT_GT(n_valid, 500);
  EXPECT_GT(n_inside, 200);
}

TEST(Validity, does_not_depend_on_how_a_hex_is_turned) {
  std::mt19937 random(6);
  for (int i = 0; i < 300; ++i) {
    const Corners x = i % 2 ? wobbly(random, 0.5) : twisted(0.35 + 0.3 * i / 300);
    Corners turned;
    for (int c = 0; c < 8; ++c) turned[c] = x[(c >> 2) | (c & 3) << 1];  // axes x y z to y z x
    EXPECT_EQ(judge(turned).fault, judge(x).fault) << i;
  }
}

TEST(Validity, is_the_same_one_by_one_together_and_on_any_number_of_threads) {
  std::mt19937 random(7);
  std::vector<Corners> hexes;
  for (int i = 0; i < 9001; ++i) hexes.push_back(i % 3 ? wobbly(random, 0.4) : twisted(0.3 + 0.4 * i / 9001));
  const Mesh mesh = mesh_of(hexes);
  std::vector<Index> expected, every;
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    every.push_back(h);
    if (judge(mesh, h).fault != HexFault::none) expected.push_back(h);
  }
  ASSERT_GT(expected.size(), 100u);
  for (const int threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    EXPECT_EQ(inverted_hexes(mesh), expected);
    EXPECT_EQ(inverted_hexes(mesh, every), expected);
    EXPECT_FALSE(all_valid(mesh));
  }
  std::erase_if(expected, [](Index h) { return h < 5000; });
  EXPECT_EQ(inverted_hexes(mesh, 5000), expected);
  EXPECT_TRUE(all_valid(grid(7, 5, 3)));
}

TEST(Validity, is_what_validate_reports) {
  const Mesh mesh = mesh_of({cube(), twisted(0.55)});
  const auto found = validate(mesh, {.relative_tolerance = 0});
  const auto is_inverted = [](const Violation& v) { return v.kind == ViolationKind::inverted; };
  ASSERT_EQ(std::ranges::count_if(found, is_inverted), 1);
  const auto& violation = *std::ranges::find_if(found, is_inverted);
  EXPECT_EQ(violation.hexes, std::vector<Index>{1});
  EXPECT_NE(violation.text.find("hex 2 is inverted inside: its Jacobian is positive at the corners, but -"),
            std::string::npos)
      << violation.text;
  EXPECT_FALSE(has_only_warnings(mesh));
}

TEST(Validity, is_restored_by_untangling_where_only_the_inside_is_inverted) {
  // A column in a grid whose middle node plane is turned by more than half a turn over one layer.
  Mesh mesh = grid(3, 3, 3, Vec3(1, 1, 2));
  const Eigen::AngleAxisd turn(1.08 * std::numbers::pi, Vec3::UnitZ());
  const Vec3 middle(1.5, 1.5, 0);
  for (const Index i : {1, 2})
    for (const Index j : {1, 2}) {
      Vec3& p = mesh.points[i + 4 * (j + 4 * 2)];
      p = turn * (p - middle) + middle;
    }
  const auto bad = inverted_hexes(mesh);
  ASSERT_FALSE(bad.empty());
  Association none;
  SmoothOptions options;
  options.scheme = SmoothScheme::untangle;
  const SmoothReport report = smooth(mesh, none, nullptr, options);
  EXPECT_EQ(report.inverted_before, static_cast<Index>(bad.size()));
  EXPECT_TRUE(report.not_repaired.empty());
  EXPECT_TRUE(inverted_hexes(mesh).empty());
  EXPECT_TRUE(uninverted(mesh));
}

TEST(Validity, is_not_lost_by_smoothing) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> offset(-0.45, 0.45);
  for (int run = 0; run < 20; ++run) {
    Mesh mesh = grid(4, 4, 4);
    for (Vec3& p : mesh.points)
      if ((p.array() > 0.5).all() && (p.array() < 3.5).all()) p += Vec3(offset(random), offset(random), offset(random));
    const auto before = inverted_hexes(mesh);
    Association none;
    for (const SmoothScheme scheme :
         {SmoothScheme::mean_ratio, SmoothScheme::condition_number, SmoothScheme::laplacian}) {
      Mesh smoothed = mesh;
      SmoothOptions options;
      options.scheme = scheme;
      const SmoothReport report = smooth(smoothed, none, nullptr, options);
      for (const Index h : inverted_hexes(smoothed))
        EXPECT_TRUE(std::ranges::binary_search(before, h)) << run << ' ' << name(scheme) << ' ' << h;
      EXPECT_EQ(inverted_hexes(smoothed), report.not_repaired);
    }
  }
}
