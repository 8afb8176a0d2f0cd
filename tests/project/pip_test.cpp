// pip makes a wheel of the Python package and installs it in a fresh environment, where it reads CAD in a process of
// its own.
#include <gtest/gtest.h>

#include "source_tree.h"
#include "support/grids.h"

namespace hextwist::test {
namespace {

TEST(Pip, installs_the_package_in_a_fresh_environment) {
  const std::string python = HEXTWIST_PYTHON;
  if (python.empty()) GTEST_SKIP() << "the Python module is not built";
  if (run(quoted(python) + " -c 'import venv, ensurepip, setuptools, wheel, numpy'").status != 0)
    GTEST_SKIP() << "venv, setuptools, wheel or numpy is not installed";
  const auto folder = output_folder();
  const Outcome made = run(quoted(python) + " -m venv --system-site-packages " + quoted(folder / "fresh"));
  ASSERT_EQ(made.status, 0) << made.output;
  // What pip reads, in a folder of its own: it leaves things there. The compiled part is that of this build.
  std::filesystem::create_directory(folder / "source");
  for (const char* file : {"pyproject.toml", "setup.py", "README.md", "CMakeLists.txt"})
    std::filesystem::copy_file(source_folder() / file, folder / "source" / file);
  const Outcome installed =
      run("HEXTWIST_BUILD=" HEXTWIST_BINARY_DIR " " + quoted(folder / "fresh/bin/pip") +
          " install --no-build-isolation --no-index --no-cache-dir -v " + quoted(folder / "source"));
  ASSERT_EQ(installed.status, 0) << installed.output;
  const Outcome ran =
      run("cd / && env -u PYTHONPATH " + quoted(folder / "fresh/bin/python") + " -c " +
          quoted("import hextwist, hextwist.gmsh; s = hextwist.Session(); s.cmd('set reading fenced on'); "
                 "s.import_cad('" +
                 (source_folder() / "models/bracket.step").string() +
                 "'); "
                 "s.import_mesh('" +
                 (source_folder() / "models/bracket.msh").string() +
                 "'); "
                 "s.cmd('refine curve 5'); print(hextwist.__file__, hextwist.__version__, s.mesh.n_hexes > 488)"));
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find((folder / "fresh").string()), std::string::npos) << ran.output;
  EXPECT_NE(ran.output.find("True"), std::string::npos) << ran.output;
  const Outcome removed = run(quoted(folder / "fresh/bin/pip") + " uninstall -y hextwist");
  EXPECT_EQ(removed.status, 0) << removed.output;
}

}  // namespace
}  // namespace hextwist::test
