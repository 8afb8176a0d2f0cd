// A stranger's project finds the installed library by CMake and by pkg-config, builds against it and refines with it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "hextwist/io/io.h"
#include "source_tree.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist::test {
namespace {

class SlowConsumer : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    // Each test may run as a process of its own, several at a time.
    prefix = std::filesystem::path(HEXTWIST_BINARY_DIR) / ("test-output/installed-" + std::to_string(getpid()));
    const Outcome installed = run("cmake --install " HEXTWIST_BINARY_DIR " --prefix " + quoted(prefix.string()));
    ASSERT_EQ(installed.status, 0) << installed.output;
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(prefix); }
  inline static std::filesystem::path prefix;
  const std::filesystem::path example = source_folder() / "examples/minimal";
  const std::filesystem::path models = source_folder() / "models";

  /// Configures and builds a project against the installed tree.
  static Outcome build_with_cmake(const std::filesystem::path& project, const std::filesystem::path& folder) {
    return run("cmake -S " + quoted(project) + " -B " + quoted(folder) + " -G Ninja -DCMAKE_BUILD_TYPE=None" +
               " -DCMAKE_CXX_COMPILER=" HEXTWIST_CXX_COMPILER " -DCMAKE_CXX_FLAGS=" + quoted(HEXTWIST_CXX_FLAGS) +
               " -DCMAKE_PREFIX_PATH=" + quoted(prefix) + " && cmake --build " + quoted(folder));
  }
  void expect_refines(const std::filesystem::path& program) {
    const auto out = program.parent_path() / "refined.msh";
    const Outcome refined = run(quoted(program.string()) + " " + quoted(models / "bracket.brep") + " " +
                                quoted(models / "bracket.msh") + " " + quoted(out.string()) + " 1 2");
    ASSERT_EQ(refined.status, 0) << refined.output;
    const Mesh mesh = read_mesh(out).mesh;
    EXPECT_GT(mesh.n_hexes(), read_mesh(models / "bracket.msh").mesh.n_hexes());
    EXPECT_TRUE(conformal(mesh));
    EXPECT_TRUE(uninverted(mesh));
    const Outcome refused = run(quoted(program.string()) + " no_such.brep no_such.msh out.msh 1");
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.output.find("no_such.brep"), std::string::npos) << refused.output;
  }
};

TEST_F(SlowConsumer, builds_the_example_through_find_package) {
  const auto folder = output_folder() / "build";
  const Outcome built = build_with_cmake(example, folder);
  ASSERT_EQ(built.status, 0) << built.output;
  expect_refines(folder / "minimal");
}

TEST_F(SlowConsumer, builds_the_C_example_through_find_package) {
  const auto folder = output_folder() / "build";
  const Outcome built = build_with_cmake(source_folder() / "examples/c", folder);
  ASSERT_EQ(built.status, 0) << built.output;
  const auto out = folder / "adapted.msh";
  const Outcome adapted = run(quoted(folder / "adapt") + " " + quoted(models / "bracket.brep") + " " +
                              quoted(models / "bracket.msh") + " " + quoted(out));
  ASSERT_EQ(adapted.status, 0) << adapted.output;
  EXPECT_TRUE(conformal(read_mesh(out).mesh));
}

TEST_F(SlowConsumer, builds_the_Gmsh_example_through_find_package) {
  if (run("find " + quoted(prefix) + " -name 'libhextwist_gmsh*' | grep .").status != 0)
    GTEST_SKIP() << "hextwist_gmsh is not built";
  const auto folder = output_folder() / "build";
  const Outcome built = build_with_cmake(source_folder() / "examples/gmsh", folder);
  ASSERT_EQ(built.status, 0) << built.output;
  const auto out = folder / "layers.msh";
  const Outcome refined = run(quoted(folder / "boundary_layer") + " " + quoted(out));
  ASSERT_EQ(refined.status, 0) << refined.output;
  EXPECT_TRUE(conformal(read_mesh(out).mesh));
}

TEST_F(SlowConsumer, imports_the_installed_Python_package) {
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

TEST_F(SlowConsumer, builds_the_example_through_pkg_config) {
  const Outcome found = run("cd " + quoted(prefix) + " && dirname \"$(find \"$PWD\" -name hextwist.pc)\"");
  const std::string folder = found.output.substr(0, found.output.find('\n'));
  const auto program = output_folder() / "minimal";
  const Outcome built = run("PKG_CONFIG_PATH=" + quoted(folder) + " && export PKG_CONFIG_PATH && " +
                            HEXTWIST_CXX_COMPILER " " HEXTWIST_CXX_FLAGS " " + quoted(example / "main.cpp") + " -o " +
                            quoted(program) + " $(pkg-config --cflags --libs hextwist)");
  ASSERT_EQ(built.status, 0) << built.output;
  expect_refines(program);
}

TEST_F(SlowConsumer, gets_every_public_header_and_no_other) {
  std::vector<std::string> installed, expected;
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
