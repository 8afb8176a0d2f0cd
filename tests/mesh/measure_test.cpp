#include "hextwist/mesh/quality/measure.h"

#include <gtest/gtest.h>

#include <random>

#include "hextwist/base/same_bits.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/quality/validity.h"
#include "support/grids.h"
#include "support/seed.h"

namespace hextwist {
namespace {

/// A grid whose nodes are off their places by up to so many edges.
Mesh shaken(double by, unsigned seed) {
  Mesh mesh = test::grid(5, 4, 3);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> off(-by, by);
  for (Vec3& p : mesh.points) p += Vec3(off(random), off(random), off(random));
  return mesh;
}

TEST(measure, has_the_bits_of_each_metric_and_knows_whether_all_are_valid) {
  const unsigned seed = test::random_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  int n_valid = 0, n_meshes = 0;
  for (const double by : {0.0, 0.01, 0.1, 0.2, 0.25, 0.3, 0.35, 0.45, 0.7})
    for (unsigned round = 0; round < 20; ++round) {
      const Mesh mesh = shaken(by, seed + round);
      const Measures all = measure(mesh);
      EXPECT_TRUE(same_bits(all.shape, quality(Metric::shape, mesh)));
      EXPECT_TRUE(same_bits(all.scaled_jacobian, quality(Metric::scaled_jacobian, mesh)));
      EXPECT_TRUE(same_bits(all.volume, quality(Metric::volume, mesh)));
      bool valid = true;  // one by one, by the judge alone
      for (Index h = 0; h < mesh.n_hexes(); ++h) valid &= judge(mesh, h).fault == HexFault::none;
      EXPECT_EQ(all.all_valid, valid);
      EXPECT_EQ(all_valid(mesh), valid);
      n_valid += valid;
      ++n_meshes;
    }
  EXPECT_GE(n_valid, 40);  // both answers are given
  EXPECT_LE(n_valid, n_meshes - 20);
}

TEST(measure, flat_and_turned_hexes_are_not_valid) {
  Mesh mesh = test::grid(4, 4, 4);
  EXPECT_TRUE(measure(mesh).all_valid);
  Mesh flat = mesh;
  for (Vec3& p : flat.points) p.z() *= 1e-9;
  EXPECT_TRUE(measure(flat).all_valid);  // thin, but a box: its scaled Jacobian is 1
  Mesh sheared = mesh;
  for (Vec3& p : sheared.points) p.x() += 1e8 * p.z();
  EXPECT_FALSE(measure(sheared).all_valid);
  Mesh turned = mesh;
  for (Vec3& p : turned.points) p.z() = -p.z();
  EXPECT_FALSE(measure(turned).all_valid);
}

}  // namespace
}  // namespace hextwist
