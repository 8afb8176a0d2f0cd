// A stranger's project finds the installed library by CMake and by pkg-config, builds against it and refines with it.
#include <gtest/gtest.h>

#include <unistd.h>
#include <sstream>

#include <algorithm>

#include "consumer.h"
#include "hextwist/io/io.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist::test {
namespace {

class Consumer : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    // Each test may run as a process of its own, several at a time.
    prefix = std::filesystem::path(HEXTWIST_BINARY_DIR) / ("test-output/installed-" + std::to_string(getpid()));
    install(HEXTWIST_BINARY_DIR, prefix);
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(prefix); }
  inline static std::filesystem::path prefix;
  const std::filesystem::path examples = source_folder() / "examples";
};

class SlowConsumer : public Consumer {};

TEST_F(Consumer, builds_the_example_through_find_package) {
  const auto folder = output_folder() / "build";
  const Outcome built = build_with_cmake(prefix, examples / "minimal", folder);
  ASSERT_EQ(built.status, 0) << built.output;
  expect_minimal_refines(folder / "minimal");
}

TEST_F(SlowConsumer, a_front_moves_through_a_mesh_and_leaves_nothing_behind) {
  const auto folder = output_folder() / "build";
  const Outcome built = build_with_cmake(prefix, examples / "moving_front", folder);
  ASSERT_EQ(built.status, 0) << built.output;
  const Outcome ran = run(quoted(folder / "moving_front") + " 2 10");
  ASSERT_EQ(ran.status, 0) << ran.output;
  std::istringstream lines(ran.output);
  std::string line;
  std::getline(lines, line);  // titles
  int n_steps = 0;
  for (double step = 0, hexes = 0, fresh = 0, worst = 0, off = 0, seconds = 0;
       std::getline(lines, line) && std::istringstream(line) >> step >> hexes >> fresh >> worst >> off >> seconds;
       ++n_steps) {
    EXPECT_LE(hexes, 1.05 * fresh) << line;
    EXPECT_GE(worst, 0.405) << line;
    EXPECT_LE(off, 1e-12) << line;
  }
  EXPECT_EQ(n_steps, 10);
  EXPECT_NE(ran.output.find("coarsened: 1000 hexes"), std::string::npos) << ran.output;
}

TEST_F(Consumer, builds_the_C_example_through_find_package) {
  const auto folder = output_folder() / "build";
  const Outcome built = build_with_cmake(prefix, examples / "c", folder);
  ASSERT_EQ(built.status, 0) << built.output;
  expect_c_adapts(folder / "adapt");
}

TEST_F(SlowConsumer, builds_the_Gmsh_example_through_find_package) {
  if (run("find " + quoted(prefix) + " -name 'libhextwist_gmsh*' | grep .").status != 0)
    GTEST_SKIP() << "hextwist_gmsh is not built";
  const auto folder = output_folder() / "build";
  const Outcome built = build_with_cmake(prefix, examples / "gmsh", folder);
  ASSERT_EQ(built.status, 0) << built.output;
  const auto out = folder / "layers.msh";
  const Outcome refined = run(quoted(folder / "boundary_layer") + " " + quoted(out));
  ASSERT_EQ(refined.status, 0) << refined.output;
  EXPECT_TRUE(conformal(read_mesh(out).mesh));
}

TEST_F(SlowConsumer, builds_the_deal_II_example_which_refines_without_hanging_nodes) {
  if (run("ls /usr/share/cmake/deal.II/deal.IIConfig.cmake /usr/lib/*/cmake/deal.II/deal.IIConfig.cmake 2>/dev/null | "
          "grep .")
          .status != 0)
    GTEST_SKIP() << "deal.II is not installed (Debian: libdeal.ii-dev)";
  const auto folder = output_folder() / "build";
  const Outcome built = build_with_cmake(prefix, examples / "adapters/dealii", folder);
  ASSERT_EQ(built.status, 0) << built.output;
  const auto models = source_folder() / "models";
  const Outcome ran = run(quoted(folder / "adapt_dealii") + " " + quoted(models / "bracket.brep") + " " +
                          quoted(models / "bracket.msh"));
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("hanging nodes: no (deal.II's own: yes)"), std::string::npos) << ran.output;
}

TEST_F(Consumer, imports_the_installed_Python_package) {
  const Outcome found = run("cd " + quoted(prefix) + " && find \"$PWD\" -path '*/hextwist/__init__.py'");
  if (found.output.empty()) GTEST_SKIP() << "the Python module is not built";
  const auto package = std::filesystem::path(found.output.substr(0, found.output.find('\n'))).parent_path();
  const Outcome ran = run("PYTHONPATH=" + quoted(package.parent_path()) + " " HEXTWIST_PYTHON " -c " +
                          quoted("import hextwist; s = hextwist.Session(); "
                                 "s.cmd('create brick x 1 y 1 z 1 interval 2 2 2; refine hex 1'); "
                                 "print(hextwist.__file__, s.mesh.n_hexes)"));
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find(package.string()), std::string::npos) << ran.output;
}

TEST_F(Consumer, builds_the_example_through_pkg_config) {
  const auto program = output_folder() / "minimal";
  const Outcome built = build_with_pkg_config(prefix, HEXTWIST_CXX_COMPILER " " HEXTWIST_CXX_FLAGS,
                                              examples / "minimal/main.cpp", program);
  ASSERT_EQ(built.status, 0) << built.output;
  expect_minimal_refines(program);
}

TEST_F(Consumer, gets_every_public_header_and_no_other) {
  std::vector<std::string> installed, expected = {"hextwist.h"};
  const auto folder = prefix / "include/hextwist";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) installed.push_back(entry.path().lexically_relative(folder).string());
  for (const auto& header : public_headers()) expected.push_back(header.lexically_relative(source_folder()).string());
  std::ranges::sort(installed);
  std::ranges::sort(expected);
  EXPECT_EQ(installed, expected);
}

}  // namespace
}  // namespace hextwist::test
