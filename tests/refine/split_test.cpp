#include "hextwist/refine/split.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <random>

#include "hextwist/mesh/quality/quality.h"
#include "hextwist/refine/templates/trisect.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/refined.h"

namespace hextwist {
namespace {

using test::refined;

TEST(trisect_table, every_edge_marking_of_a_hex_fills_it_with_positive_hexes) {
  const Mesh cube = test::grid(1, 1, 1);
  for (int mask = 0; mask < n_trisect_codes; ++mask) {
    const std::vector<std::uint16_t> codes = {static_cast<std::uint16_t>(mask)};
    const Mesh mesh = refined(cube, split(cube.hexes, cube.n_nodes(), trisect_table(), codes));
    ASSERT_TRUE(test::conformal(mesh)) << mask;
    ASSERT_TRUE(test::uninverted(mesh)) << mask;
    ASSERT_NEAR(volume(mesh), 1, 1e-12) << mask;
  }
}

TEST(trisect_table, every_marking_of_the_twelve_nodes_of_two_hexes_is_conformal) {
  std::mt19937 random(1);
  for (int marks = 0; marks < 1 << 12; ++marks) {
    const Mesh mesh = test::shuffled(test::grid(2, 1, 1), random);
    std::vector<char> marked(12);
    for (int n = 0; n < 12; ++n) marked[n] = marks >> n & 1;
    const Mesh fine = refined(mesh, split(mesh.hexes, 12, trisect_table(), test::codes_of_nodes(mesh, marked)));
    ASSERT_TRUE(test::conformal(fine)) << marks;
    ASSERT_TRUE(test::uninverted(fine)) << marks;
    ASSERT_NEAR(volume(fine), 2, 1e-12) << marks;
  }
}

TEST(trisect_table, a_hex_has_the_counts_of_the_paper) {
  const auto n_children = [](int corners) {
    return trisect_table()->hex(edge_mask_of_corners(corners)).children.size();
  };
  EXPECT_EQ(n_children(0b11111111), 27u);
  EXPECT_EQ(n_children(0b00001111), 13u);
  EXPECT_EQ(n_children(0b00000011), 5u);
  EXPECT_EQ(n_children(0b00000001), 1u);
}

TEST(trisect_table, the_worst_child_of_any_node_marking_in_the_unit_cube_is_good) {
  const Mesh cube = test::grid(1, 1, 1);
  for (int corners = 0; corners < 256; ++corners) {
    const std::vector<std::uint16_t> codes = {static_cast<std::uint16_t>(edge_mask_of_corners(corners))};
    const Mesh mesh = refined(cube, split(cube.hexes, cube.n_nodes(), trisect_table(), codes));
    const double goal = is_convex(codes[0]) ? 0.44 : 0.40;
    EXPECT_GE(summarize(quality(Metric::shape, mesh)).min, goal) << corners;
    EXPECT_GE(summarize(quality(Metric::scaled_jacobian, mesh)).min, goal) << corners;
  }
}

TEST(trisect_table, a_single_interior_hex_of_a_unit_grid_is_refined_well_before_any_smoothing) {
  const Mesh grid = test::grid(3, 3, 3);
  std::vector<char> marked(grid.points.size(), 0);
  for (const Index n : grid.hexes[13]) marked[n] = 1;
  const Mesh mesh =
      refined(grid, split(grid.hexes, grid.n_nodes(), trisect_table(), test::codes_of_nodes(grid, marked)));
  EXPECT_GE(summarize(quality(Metric::shape, mesh)).min, 0.47);
  EXPECT_GE(summarize(quality(Metric::scaled_jacobian, mesh)).min, 0.47);
}

}  // namespace
}  // namespace hextwist
