#include "consumer.h"

#include <gtest/gtest.h>

#include "hextwist/io/io.h"
#include "support/checkers.h"

namespace hextwist::test {

void install(const std::filesystem::path& build, const std::filesystem::path& prefix) {
  const Outcome installed = run("cmake --install " + quoted(build) + " --prefix " + quoted(prefix));
  ASSERT_EQ(installed.status, 0) << installed.output;
}

Outcome build_with_cmake(const std::filesystem::path& prefix, const std::filesystem::path& project,
                         const std::filesystem::path& folder) {
  return run("cmake -S " + quoted(project) + " -B " + quoted(folder) + " -G Ninja -DCMAKE_BUILD_TYPE=None" +
             " -DCMAKE_CXX_COMPILER=" HEXTWIST_CXX_COMPILER " -DCMAKE_CXX_FLAGS=" + quoted(HEXTWIST_CXX_FLAGS) +
             " -DCMAKE_PREFIX_PATH=" + quoted(prefix) + " && cmake --build " + quoted(folder));
}

Outcome build_with_pkg_config(const std::filesystem::path& prefix, const std::string& compiler,
                              const std::filesystem::path& source, const std::filesystem::path& program) {
  const Outcome found = run("cd " + quoted(prefix) + " && dirname \"$(find \"$PWD\" -name hextwist.pc)\"");
  const std::string folder = found.output.substr(0, found.output.find('\n'));
  // Where a shared library lies is for the user to say.
  return run("PKG_CONFIG_PATH=" + quoted(folder) + " && export PKG_CONFIG_PATH && " + compiler + " " + quoted(source) +
             " -o " + quoted(program) + " $(pkg-config --cflags --libs hextwist) -lm" +
             " -Wl,-rpath,$(pkg-config --variable=libdir hextwist)");
}

void expect_minimal_refines(const std::filesystem::path& program) {
  const auto models = source_folder() / "models";
  const auto out = program.parent_path() / "refined.msh";
  const Outcome refined = run(quoted(program) + " " + quoted(models / "bracket.brep") + " " +
                              quoted(models / "bracket.msh") + " " + quoted(out) + " 1 2");
  ASSERT_EQ(refined.status, 0) << refined.output;
  const Mesh mesh = read_mesh(out).mesh;
  EXPECT_GT(mesh.n_hexes(), read_mesh(models / "bracket.msh").mesh.n_hexes());
  EXPECT_TRUE(conformal(mesh));
  EXPECT_TRUE(uninverted(mesh));
  // An exception gets across the border of the library.
  const Outcome refused = run(quoted(program) + " no_such.brep no_such.msh out.msh 1");
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.output.find("no_such.brep"), std::string::npos) << refused.output;
}

void expect_c_adapts(const std::filesystem::path& program) {
  const auto models = source_folder() / "models";
  const auto out = program.parent_path() / "adapted.msh";
  const Outcome adapted = run(quoted(program) + " " + quoted(models / "bracket.brep") + " " +
                              quoted(models / "bracket.msh") + " " + quoted(out));
  ASSERT_EQ(adapted.status, 0) << adapted.output;
  EXPECT_TRUE(conformal(read_mesh(out).mesh));
}

}  // namespace hextwist::test
