// Finding places in a mesh, against brute force over all hexes.
#include "hextwist/mesh/locate.h"

#include <gtest/gtest.h>

#include <random>

#include "support/grids.h"

namespace hextwist {
namespace {

/// Hexes with bent faces: a grid with every node moved a little.
Mesh bent(int n, std::mt19937& random) {
  Mesh mesh = test::grid(n, n, n);
  std::uniform_real_distribution<double> move(-0.15, 0.15);
  for (Vec3& p : mesh.points) p += Vec3(move(random), move(random), move(random));
  return mesh;
}

TEST(box_tree, finds_the_nearest_item_and_the_lowest_of_equals) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (const int n : {1, 3, 5, 17, 200}) {
    std::vector<Vec3> points(static_cast<std::size_t>(n));
    std::vector<Box> boxes(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = Vec3(coordinate(random), coordinate(random), coordinate(random));
      if (i % 3 == 2) points[i] = points[i - 1];  // equal places
      boxes[i].add(points[i]);
    }
    const BoxTree tree(boxes);
    for (int round = 0; round < 100; ++round) {
      const Vec3 p(2 * coordinate(random), coordinate(random), coordinate(random));
      const auto distance = [&](std::int32_t i) { return (points[i] - p).squaredNorm(); };
      std::int32_t best = 0;
      for (std::int32_t i = 1; i < n; ++i)
        if (distance(i) < distance(best)) best = i;
      const NearItem found = tree.nearest(p, distance);
      EXPECT_EQ(found.item, best);
      EXPECT_EQ(found.distance2, distance(best));
      EXPECT_EQ(tree.nearest(p, distance, 0.99 * distance(best)).item, -1);
    }
  }
  EXPECT_EQ(BoxTree().nearest(Vec3::Zero(), [](std::int32_t) { return 0.0; }).item, -1);
}

TEST(locate, inverts_the_trilinear_map_inside_bent_hexes) {
  std::mt19937 random(2);
  const Mesh mesh = bent(4, random);
  const HexLocator locator(mesh);
  std::uniform_real_distribution<double> unit(0.001, 0.999);
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (int round = 0; round < 10; ++round) {
      const Vec3 at(unit(random), unit(random), unit(random));
      const std::array<Vec3, 8> corners = corners_of(mesh, h);
      const HexPlace place = locator.locate(trilinear_point(corners, at));
      EXPECT_EQ(place.hex, h);
      EXPECT_EQ(place.distance, 0);
      EXPECT_LE((place.at - at).norm(), 1e-10);
    }
}

TEST(locate, gives_the_nearest_place_outside) {
  std::mt19937 random(3);
  const Mesh mesh = bent(3, random);
  const HexLocator locator(mesh);
  std::uniform_real_distribution<double> coordinate(-2, 5);
  for (int round = 0; round < 200; ++round) {
    const Vec3 p(coordinate(random), coordinate(random), coordinate(random));
    const HexPlace place = locator.locate(p);
    double best = 1e300;
    for (Index h = 0; h < mesh.n_hexes(); ++h) best = std::min(best, closest_place(corners_of(mesh, h), p).distance);
    EXPECT_NEAR(place.distance, best, 1e-12);
    EXPECT_NEAR((trilinear_point(corners_of(mesh, place.hex), place.at) - p).norm(), best, 1e-9);
    // Nothing sampled on the mesh is nearer.
    for (const Vec3& q : mesh.points) EXPECT_GE((q - p).norm(), best - 1e-12);
  }
}

TEST(locate, in_a_grid_takes_the_lowest_hex_on_common_faces_and_the_box_outside) {
  const Mesh mesh = test::grid(2, 2, 2);
  const HexLocator locator(mesh);
  EXPECT_EQ(locator.locate({1, 1, 1}).hex, 0);
  EXPECT_EQ(locator.locate({1, 1.5, 1.5}).hex, 6);
  const HexPlace out = locator.locate({3, -1, 0.5});
  EXPECT_EQ(out.hex, 1);
  EXPECT_LE((out.at - Vec3(1, 0, 0.5)).norm(), 1e-12);
  EXPECT_NEAR(out.distance, std::sqrt(2.0), 1e-12);
  const std::array<Index, 2> some = {5, 6};
  EXPECT_EQ(HexLocator(mesh, some).locate({0.5, 0.5, 0.5}).hex, 5);
  EXPECT_EQ(HexLocator(Mesh{}).locate({0, 0, 0}).hex, -1);
}

}  // namespace
}  // namespace hextwist
