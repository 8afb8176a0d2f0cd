// Real meshes, against what an outside smoother made of them.
#include "hextwist/mesh/io.h"
#include "smooth_fixtures.h"
#include "support/checkers.h"

namespace hextwist::test {
namespace {

Mesh data_mesh(const char* file) {
  if (data_folder().empty()) return {};
  return read_mesh(data_folder() / "mesh" / file).mesh;
}

TEST(SmoothRealMesh, beats_Mesquite_on_the_teapot) {
  // Mesquite's shape improvement wrapper, boundary fixed: smallest shape 0.363 at an average of 0.819.
  Mesh mesh = data_mesh("teaport_14941.mesh");
  if (mesh.points.empty()) GTEST_SKIP() << "no test data";
  const SmoothReport report = smooth_inside(mesh);
  EXPECT_NEAR(report.shape_before.min, 0.243, 5e-4);
  EXPECT_NEAR(report.shape_before.average, 0.820, 5e-4);
  EXPECT_GE(report.shape_after.min, 0.44);
  EXPECT_GE(report.shape_after.average, 0.8205);
  EXPECT_EQ(report.shape_after.min, min_shape(mesh));
  EXPECT_TRUE(uninverted(mesh));
}

TEST(SmoothRealMesh, improves_smallest_and_average_shape_of_the_swivel) {
  Mesh mesh = data_mesh("swivel2_7494.mesh");
  if (mesh.points.empty()) GTEST_SKIP() << "no test data";
  const SmoothReport report = smooth_inside(mesh);
  EXPECT_GT(report.shape_after.min, report.shape_before.min + 0.02);
  EXPECT_GT(report.shape_after.average, report.shape_before.average + 0.001);
}

}  // namespace
}  // namespace hextwist::test
