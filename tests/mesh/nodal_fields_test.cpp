// Nodal fields where nodes have ended up.
#include "hextwist/mesh/nodal_fields.h"

#include <gtest/gtest.h>

#include <random>

#include "support/grids.h"

namespace hextwist {
namespace {

double linear(const Vec3& p) {
  return 3 + 2 * p.x() - p.y() + p.z() / 2;
}
Field field_of(const Mesh& mesh, double (*f)(const Vec3&)) {
  Field field{"f", Field::On::node, 1, {}};
  for (const Vec3& p : mesh.points) field.values.push_back(f(p));
  return field;
}
Mesh distorted(unsigned seed) {
  std::mt19937 random(seed);
  Mesh mesh = test::shuffled(test::grid(4, 3, 5, {1, 2, 0.25}), random);
  std::uniform_real_distribution<double> by(-0.05, 0.05);
  for (Vec3& p : mesh.points) p += Vec3(by(random), by(random), by(random));
  return mesh;
}

TEST(NodalFields, what_is_linear_stays_so_wherever_nodes_go) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Mesh before = distorted(seed);
    before.fields = {field_of(before, linear)};
    Mesh after = before;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> by(-0.7, 0.7);  // past several hexes, and out of the mesh
    for (Vec3& p : after.points) p += Vec3(by(random), by(random), by(random));
    evaluate_where_moved(before, after);
    for (Index n = 0; n < after.n_nodes(); ++n) ASSERT_NEAR(after.fields[0].values[n], linear(after.points[n]), 1e-11);
  }
}

TEST(NodalFields, inside_the_mesh_the_hex_that_holds_the_place_counts) {
  // x^2 between the planes of a graded grid, and a node that goes through three of its hexes.
  Mesh before = test::grid(6, 2, 2);
  for (Vec3& p : before.points) p.x() = p.x() * p.x() / 6;
  const auto square = [](const Vec3& p) { return p.x() * p.x(); };
  before.fields = {field_of(before, square)};
  Mesh after = before;
  for (Vec3& p : after.points)
    if (p.y() == 1 && p.z() == 1) p.x() = 0.9 * (6 - p.x());
  evaluate_where_moved(before, after);
  for (Index n = 0; n < after.n_nodes(); ++n) {
    const double x = after.points[n].x();
    const double i = std::floor(std::sqrt(6 * x)), a = i * i / 6, b = (i + 1) * (i + 1) / 6;
    ASSERT_NEAR(after.fields[0].values[n], i == 6 ? 36 : a * a + (x - a) / (b - a) * (b * b - a * a), 1e-11);
  }
}

TEST(NodalFields, whole_numbers_stay_whole_and_what_has_no_value_keeps_its_own) {
  Mesh before = test::grid(2, 1, 1);
  before.fields = {{"class", Field::On::node, 1, {}, true}, {"part", Field::On::node, 2, {}}};
  for (Index n = 0; n < before.n_nodes(); ++n) {
    before.fields[0].values.push_back(n);
    for (int c = 0; c < 2; ++c)
      before.fields[1].values.push_back(before.points[n].x() > 1.5 ? std::numeric_limits<double>::quiet_NaN() : 7 + c);
  }
  Mesh after = before;
  after.points[1].x() = 1.8;
  after.points[4].x() = 0.8;
  evaluate_where_moved(before, after);
  EXPECT_EQ(after.fields[0].values[1], 2);
  EXPECT_EQ(after.fields[0].values[4], 4);
  EXPECT_EQ(after.fields[1].values[2], 7) << "there is no value at a corner of the hex: the one from before stays";
  EXPECT_NEAR(after.fields[1].values[9], 8, 1e-12);
}

TEST(NodalFields, a_crack_is_not_crossed) {
  // Two cubes whose common nodes are there twice, with a jump between them.
  Mesh before = test::grid(1, 1, 1);
  const Mesh other = before;
  for (const Vec3& p : other.points) before.points.push_back(p + Vec3(1, 0, 0));
  before.hexes.push_back(other.hexes[0]);
  for (Index& n : before.hexes[1]) n += 8;
  before.fields = {{"jump", Field::On::node, 1, std::vector<double>(16, 0)}};
  for (Index n = 8; n < 16; ++n) before.fields[0].values[n] = 5;
  Mesh after = before;
  after.points[1].x() = 1.25;
  evaluate_where_moved(before, after);
  EXPECT_EQ(after.fields[0].values, before.fields[0].values);
}

TEST(NodalFields, of_a_flat_hex_the_values_stay_finite) {
  Mesh before = test::grid(1, 1, 1);
  for (Vec3& p : before.points) p.z() = 0;
  before.fields = {field_of(before, linear)};
  Mesh after = before;
  for (Vec3& p : after.points) p += Vec3(0.1, 0.1, 0.1);
  evaluate_where_moved(before, after);
  for (const double value : after.fields[0].values) EXPECT_TRUE(std::isfinite(value));
}

}  // namespace
}  // namespace hextwist
