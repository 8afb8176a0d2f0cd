// Lifting the worst scaled Jacobians.
#include "hextwist/mesh/smooth/lift.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "hextwist/mesh/quality/validity.h"
#include "smooth_fixtures.h"

namespace hextwist::test {
namespace {

constexpr double wanted = 0.5;

void lift(Mesh& mesh, const SmoothOptions& options = {}) {
  Association nothing;
  lift_scaled_jacobians(mesh, nothing, nullptr, options, wanted, 10);
}

TEST(Lift, raises_the_worst_and_moves_only_what_it_may) {
  double gained = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const Mesh start = [&] {
      Mesh mesh = seed % 3 == 0 ? pinwheel(3 + static_cast<int>(seed % 4), 3, 4) : shuffled(grid(5, 5, 5), random);
      shake(mesh, 0.3, random);
      return mesh;
    }();
    Mesh mesh = start;
    SmoothOptions options;
    for (Index n = 0; n < mesh.n_nodes(); n += 5) options.fixed.push_back(n);
    lift(mesh, options);
    EXPECT_GE(min_scaled_jacobian(mesh), min_scaled_jacobian(start));
    EXPECT_GE(min_shape(mesh), min_shape(start));
    gained += min_scaled_jacobian(mesh) - min_scaled_jacobian(start);
    for (const Index n : options.fixed) EXPECT_EQ(mesh.points[n], start.points[n]);
  }
  EXPECT_GT(gained / 12, 0.05);
}

TEST(Lift, does_nothing_where_all_is_good) {
  const Mesh start = grid(4, 4, 4);
  Mesh mesh = start;
  lift(mesh);
  EXPECT_EQ(mesh.points, start.points);
}

TEST(Lift, gives_the_same_bits_for_any_number_of_threads) {
  std::mt19937 random(7);
  Mesh start = shuffled(grid(16, 15, 14), random);
  shake(start, 0.35, random);
  std::vector<Vec3> first;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    Mesh mesh = start;
    lift(mesh);
    if (first.empty()) first = mesh.points;
    EXPECT_EQ(mesh.points, first) << threads << " threads";
  }
}

}  // namespace
}  // namespace hextwist::test
