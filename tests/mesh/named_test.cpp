// What the user named inside the mesh keeps its shape when nodes are smoothed.
#include <gtest/gtest.h>

#include <random>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/smooth/smooth.h"
#include "hextwist/mesh/topology.h"
#include "support/grids.h"

using namespace hextwist;
using namespace hextwist::test;

namespace {

constexpr int n = 6;

Index node(int i, int j, int k) {
  return i + (n + 1) * (j + (n + 1) * k);
}
Index hex(int i, int j, int k) {
  return i + n * (j + n * k);
}

/// A grid whose inner nodes were moved a little, but in the plane x = 3 within it.
Mesh disturbed(unsigned seed, bool on_line = false) {
  Mesh mesh = grid(n, n, n);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> offset(-0.3, 0.3);
  for (int i = 1; i < n; ++i)
    for (int j = 1; j < n; ++j)
      for (int k = 1; k < n; ++k) {
        Vec3 by(offset(random), offset(random), offset(random));
        if (i == 3) by.x() = 0;
        if (on_line && i == 3 && j == 3) by.y() = 0;
        mesh.points[node(i, j, k)] += by;
      }
  return mesh;
}

void smooth_all(Mesh& mesh) {
  Association none;
  const SmoothReport report = smooth(mesh, none, nullptr);
  EXPECT_GT(report.n_nodes, 60);
}

/// How far nodes with i = 3 are from x = 3, and how many of them moved.
struct Plane {
  double off = 0;
  int n_moved = 0;
};
Plane plane(const Mesh& before, const Mesh& after) {
  Plane result;
  for (int j = 0; j <= n; ++j)
    for (int k = 0; k <= n; ++k) {
      const Vec3& p = after.points[node(3, j, k)];
      result.off = std::max(result.off, std::abs(p.x() - 3));
      result.n_moved += p != before.points[node(3, j, k)];
    }
  return result;
}

std::vector<Index> hexes_where(auto wanted) {
  std::vector<Index> hexes;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        if (wanted(i, j, k)) hexes.push_back(hex(i, j, k));
  return hexes;
}
std::vector<Index> left() {
  return hexes_where([](int i, int, int) { return i < 3; });
}
std::vector<Index> every() {
  return hexes_where([](int, int, int) { return true; });
}

void expect_plane_kept(Mesh mesh) {
  const Mesh before = mesh;
  smooth_all(mesh);
  const Plane kept = plane(before, mesh);
  EXPECT_LT(kept.off, 1e-12);
  EXPECT_GT(kept.n_moved, 15);  // within the plane
}

}  // namespace

TEST(Named, nothing_is_held_where_nothing_is_named) {
  Mesh mesh = disturbed(1);
  mesh.blocks = {{1, "all", every()}};
  const Mesh before = mesh;
  smooth_all(mesh);
  EXPECT_GT(plane(before, mesh).off, 1e-3);
}

TEST(Named, block_boundaries_keep_their_plane_whether_blocks_overlap_or_leave_hexes_out) {
  Mesh mesh = disturbed(2);
  mesh.blocks = {{1, "A", left()}};
  expect_plane_kept(mesh);
  mesh.blocks.push_back({2, "all", every()});
  expect_plane_kept(mesh);
  mesh.blocks.push_back({3, "B", hexes_where([](int i, int, int) { return i >= 3; })});
  expect_plane_kept(mesh);
}

TEST(Named, side_sets_inside_keep_their_plane_and_their_rim) {
  Mesh mesh = disturbed(3);
  SideSet set{1, "fault", {}};
  for (int j = 0; j < n; ++j)
    for (int k = 0; k < n; ++k) set.sides.push_back({hex(2, j, k), 1});
  std::ranges::sort(set.sides);
  mesh.side_sets = {set};
  expect_plane_kept(mesh);

  // Half of it: its rim is the line y = 3.
  mesh = disturbed(3, true);
  std::erase_if(set.sides, [](Side side) { return side.hex / n % n >= 3; });
  mesh.side_sets = {set};
  const Mesh before = mesh;
  smooth_all(mesh);
  int n_moved = 0;
  for (int k = 1; k < n; ++k) {
    const Vec3& p = mesh.points[node(3, 3, k)];
    EXPECT_NEAR(p.x(), 3, 1e-12);
    EXPECT_NEAR(p.y(), 3, 1e-12);
    n_moved += p != before.points[node(3, 3, k)];
    EXPECT_NEAR(mesh.points[node(3, 1, k)].x(), 3, 1e-12);
  }
  EXPECT_GT(n_moved, 2);
}

TEST(Named, node_sets_on_planes_lines_and_points_inside_keep_their_shape) {
  Mesh mesh = disturbed(4);
  NodeSet set{1, "sheet", {}};
  for (int j = 0; j <= n; ++j)
    for (int k = 0; k <= n; ++k) set.nodes.push_back(node(3, j, k));
  std::ranges::sort(set.nodes);
  mesh.node_sets = {set};
  expect_plane_kept(mesh);

  mesh = disturbed(4, true);
  set.nodes.clear();
  for (int k = 1; k < n; ++k) set.nodes.push_back(node(3, 3, k));
  mesh.node_sets = {set, {2, "sensor", {node(2, 2, 2)}}, {3, "all", {}}};
  for (Index i = 0; i < mesh.n_nodes(); ++i) mesh.node_sets[2].nodes.push_back(i);
  const Mesh before = mesh;
  smooth_all(mesh);
  for (int k = 1; k < n; ++k) {
    EXPECT_NEAR(mesh.points[node(3, 3, k)].x(), 3, 1e-12);
    EXPECT_NEAR(mesh.points[node(3, 3, k)].y(), 3, 1e-12);
  }
  EXPECT_EQ(mesh.points[node(3, 3, 1)], before.points[node(3, 3, 1)]);  // the ends of the line stay
  EXPECT_EQ(mesh.points[node(2, 2, 2)], before.points[node(2, 2, 2)]);
  EXPECT_NE(mesh.points[node(4, 4, 4)], before.points[node(4, 4, 4)]);
}

TEST(Named, a_region_of_a_node_set_moves_inside_and_keeps_its_boundary) {
  Mesh mesh = disturbed(5);
  NodeSet set{1, "region", {}};
  for (int i = 0; i <= 3; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) set.nodes.push_back(node(i, j, k));
  std::ranges::sort(set.nodes);
  mesh.node_sets = {set};
  const Mesh before = mesh;
  expect_plane_kept(mesh);
  smooth_all(mesh);
  EXPECT_NE(mesh.points[node(2, 2, 2)], before.points[node(2, 2, 2)]);
}

TEST(Named, what_bends_stays_and_a_straight_fold_slides_along_itself) {
  // Block A is the quarter x < 3, y < 3: its boundary folds along the line x = y = 3.
  Mesh mesh = grid(n, n, n);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> offset(-0.3, 0.3);
  for (int k = 1; k < n; ++k) mesh.points[node(3, 3, k)].z() += offset(random);
  mesh.blocks = {{1, "A", hexes_where([](int i, int j, int) { return i < 3 && j < 3; })}};
  Mesh before = mesh;
  smooth_all(mesh);
  for (int k = 1; k < n; ++k) {
    EXPECT_NEAR(mesh.points[node(3, 3, k)].x(), 3, 1e-12);
    EXPECT_NEAR(mesh.points[node(3, 3, k)].y(), 3, 1e-12);
    EXPECT_NE(mesh.points[node(3, 3, k)].z(), before.points[node(3, 3, k)].z());
  }
  // The same with an uneven plane.
  mesh = disturbed(7);
  for (int j = 1; j < n; ++j)
    for (int k = 1; k < n; ++k) mesh.points[node(3, j, k)].x() += 0.2 * offset(random);
  mesh.blocks = {{1, "A", left()}};
  before = mesh;
  smooth_all(mesh);
  EXPECT_EQ(plane(before, mesh).n_moved, 0);
}
