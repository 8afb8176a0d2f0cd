// Values at points, and matrices from mesh to mesh.
#include "hextwist/mesh/interpolation.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "hextwist/mesh/locate.h"
#include "hextwist/mesh/topology.h"
#include "support/grids.h"

namespace hextwist {
namespace {

double linear(const Vec3& p) {
  return 3 + 2 * p.x() - p.y() + p.z() / 2;
}
std::vector<double> linear_at(const std::vector<Vec3>& points) {
  std::vector<double> values;
  for (const Vec3& p : points) values.push_back(linear(p));
  return values;
}
Mesh distorted(unsigned seed) {
  std::mt19937 random(seed);
  Mesh mesh = test::shuffled(test::grid(4, 3, 5, {1, 2, 0.25}), random);
  std::uniform_real_distribution<double> by(-0.05, 0.05);
  for (Vec3& p : mesh.points) p += Vec3(by(random), by(random), by(random));
  return mesh;
}
std::vector<Vec3> random_points(unsigned seed, std::size_t n, const Vec3& low, const Vec3& high) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> at(0, 1);
  std::vector<Vec3> points(n);
  for (Vec3& p : points) p = low + Vec3(at(random), at(random), at(random)).cwiseProduct(high - low);
  return points;
}
std::vector<double> times(const SparseRows& rows, const std::vector<double>& x) {
  std::vector<double> y(rows.first.size() - 1);
  for (std::size_t i = 0; i < y.size(); ++i)
    for (auto k = rows.first[i]; k < rows.first[i + 1]; ++k)
      y[i] += rows.values[static_cast<std::size_t>(k)] *
              x[static_cast<std::size_t>(rows.columns[static_cast<std::size_t>(k)])];
  return y;
}

TEST(Interpolation, finds_hexes_and_is_exact_for_what_is_linear) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    Mesh mesh = distorted(seed);
    mesh.fields = {{"f", Field::On::node, 1, linear_at(mesh.points)}};
    const auto points = random_points(seed, 500, {0.1, 0.1, 0.1}, {3.9, 5.9, 1.15});
    const Interpolation at = interpolation_at(mesh, points);
    const std::vector<double> values = values_at(mesh, mesh.fields[0], at);
    const std::vector<double> product = times(sparse_rows(mesh, at), mesh.fields[0].values);
    for (std::size_t i = 0; i < points.size(); ++i) {
      // In that hex, by its own map.
      ASSERT_EQ(closest_place(corners_of(mesh, at.hexes[i]), points[i]).distance, 0)
          << "seed " << seed << ", point " << i;
      ASSERT_EQ(at.distances[i], 0);
      ASSERT_NEAR(values[i], linear(points[i]), 1e-12);
      ASSERT_NEAR(product[i], values[i], 1e-12);
    }
  }
}

TEST(Interpolation, outside_the_nearest_place_counts) {
  Mesh mesh = test::grid(2, 2, 2);
  mesh.fields = {{"f", Field::On::node, 1, linear_at(mesh.points)},
                 {"of hexes", Field::On::hex, 2, std::vector<double>(16)},
                 {"whole", Field::On::node, 1, std::vector<double>(27), true}};
  std::iota(mesh.fields[1].values.begin(), mesh.fields[1].values.end(), 0.0);
  std::iota(mesh.fields[2].values.begin(), mesh.fields[2].values.end(), 0.0);
  const std::vector<Vec3> points = {{5, 1.5, 1.5}, {-1, -1, -1}, {1.9, 1.8, 1.7}};
  const Interpolation at = interpolation_at(mesh, points);
  EXPECT_DOUBLE_EQ(at.distances[0], 3);
  EXPECT_DOUBLE_EQ(at.distances[1], std::sqrt(3.0));
  EXPECT_EQ(at.hexes, (std::vector<Index>{7, 0, 7}));
  const auto values = values_at(mesh, mesh.fields[0], at);
  EXPECT_NEAR(values[0], linear({2, 1.5, 1.5}), 1e-12);
  EXPECT_NEAR(values[1], linear({0, 0, 0}), 1e-12);
  EXPECT_EQ(values_at(mesh, mesh.fields[1], at), (std::vector<double>{14, 15, 0, 1, 14, 15}));
  EXPECT_EQ(values_at(mesh, mesh.fields[2], at)[2], 26);
}

TEST(Interpolation, prolongation_keeps_nodes_and_what_is_linear_also_outside) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Mesh before = distorted(seed);
    Mesh after = before;
    std::mt19937 random(seed + 100);
    std::uniform_real_distribution<double> by(-0.2, 0.2);  // some get outside
    for (std::size_t n = 0; n < after.points.size(); n += 2)
      after.points[n] += Vec3(by(random), by(random), by(random));
    std::vector<Index> origin(after.hexes.size());
    std::iota(origin.begin(), origin.end(), 0);
    for (const auto& rows :
         {sparse_rows(before, prolongation(before, after, origin)), sparse_rows(before, prolongation(before, after))}) {
      const std::vector<double> values = times(rows, linear_at(before.points));
      for (std::size_t n = 0; n < after.points.size(); ++n) {
        ASSERT_NEAR(values[n], linear(after.points[n]), 1e-11) << "seed " << seed << ", node " << n;
        if (n % 2 == 0) continue;
        ASSERT_EQ(rows.first[n + 1] - rows.first[n], 1) << "a node that has not moved counts itself alone";
        ASSERT_EQ(rows.columns[static_cast<std::size_t>(rows.first[n])], static_cast<Index>(n));
        ASSERT_EQ(rows.values[static_cast<std::size_t>(rows.first[n])], 1);
      }
    }
  }
}

TEST(Interpolation, what_is_apart_stays_apart_where_hexes_say_where_they_come_from) {
  // Two cubes that share a place, not nodes: a crack. The new nodes on it are those of either side.
  Mesh before = test::grid(1, 1, 1);
  Mesh other = before;
  for (Vec3& p : other.points) p.x() += 1;
  for (Hex& hex : other.hexes)
    for (Index& n : hex) n += 8;
  before.points.insert(before.points.end(), other.points.begin(), other.points.end());
  before.hexes.push_back(other.hexes[0]);
  std::vector<double> side(16, 0);
  std::fill(side.begin() + 8, side.end(), 1.0);
  Mesh after = before;  // its nodes on the crack a little along it
  for (Vec3& p : after.points)
    if (p.x() == 1) p.y() = p.y() == 0 ? 0.25 : 0.75;
  const std::vector<Index> origin = {0, 1};
  EXPECT_EQ(times(sparse_rows(before, prolongation(before, after, origin)), side), side);
}

TEST(Interpolation, what_is_wrong_is_said) {
  const Mesh mesh = test::grid(2, 1, 1);
  const auto said = [](const auto& f) -> std::string {
    try {
      f();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const std::vector<Vec3> bad = {{0, 0, 0}, {0, std::nan(""), 0}};
  EXPECT_EQ(said([&] { interpolation_at(mesh, bad); }), "points[1]: a coordinate is not finite");
  EXPECT_EQ(said([&] { interpolation_at({}, bad); }), "there is no mesh to look for points in");
  const std::vector<Index> few = {0}, wrong = {0, 2}, negative = {-1, 0};
  EXPECT_EQ(said([&] { prolongation(mesh, mesh, few); }), "there are 1 origins for 2 hexes");
  EXPECT_EQ(said([&] { prolongation(mesh, mesh, wrong); }), "origin[1]: there is no hex 2");
  EXPECT_EQ(said([&] { prolongation(mesh, mesh, negative); }), "origin[0]: there is no hex -1");
  EXPECT_TRUE(interpolation_at(mesh, {}).hexes.empty());
}

}  // namespace
}  // namespace hextwist
