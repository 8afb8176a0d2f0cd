// Real meshes, against what an outside smoother made of them.
#include <fstream>

#include "hextwist/io/io.h"
#include "smooth_fixtures.h"
#include "support/checkers.h"

namespace hextwist::test {
namespace {

Mesh data_mesh(const char* file) {
  if (data_folder().empty()) return {};
  return read_mesh(data_folder() / "mesh" / file).mesh;
}

/// For docs/plot_convergence.py.
void write_history(const SmoothReport& report) {
  std::ofstream file(output_folder() / "history.csv");
  file << "sweep,stage,min,average,energy,updates,seconds\n";
  for (std::size_t i = 0; i < report.history.size(); ++i) {
    const SmoothStep& step = report.history[i];
    file << i << ',' << step.stage << ',' << step.min_shape << ',' << step.average_shape << ',' << step.energy << ','
         << step.node_updates << ',' << step.seconds << '\n';
  }
}

TEST(SmoothRealMesh, beats_Mesquite_on_the_teapot) {
  // Mesquite's shape improvement wrapper, boundary fixed: smallest shape 0.363 at an average of 0.819.
  Mesh mesh = data_mesh("teaport_14941.mesh");
  if (mesh.points.empty()) GTEST_SKIP() << "no test data";
  SmoothOptions options;
  options.record_history = true;
  const SmoothReport report = smooth_inside(mesh, options);
  write_history(report);
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
  SmoothOptions options;
  options.record_history = true;
  const SmoothReport report = smooth_inside(mesh, options);
  write_history(report);
  EXPECT_GT(report.shape_after.min, report.shape_before.min + 0.02);
  EXPECT_GT(report.shape_after.average, report.shape_before.average + 0.001);
}

TEST(SmoothRealMesh, reaches_what_Mesquite_reaches_within_a_few_sweeps) {
  Mesh mesh = data_mesh("teaport_14941.mesh");
  if (mesh.points.empty()) GTEST_SKIP() << "no test data";
  SmoothOptions options;
  options.iterations = 5;
  const SmoothReport report = smooth_inside(mesh, options);
  EXPECT_GE(report.shape_after.min, 0.363);
  EXPECT_GE(report.shape_after.average, 0.819);
  EXPECT_LE(report.node_updates, 4 * report.n_nodes);
}

}  // namespace
}  // namespace hextwist::test
