// Editors, code browsers and documentation tools read the tree as it is cloned, before anything is built: with
// compile_flags.txt, which clangd finds by itself, every include resolves.
#include <gtest/gtest.h>

#include <fstream>

#include "source_tree.h"
#include "support/grids.h"

namespace hextwist::test {
namespace {

TEST(SlowFreshClone, reads_without_a_build) {
  const std::filesystem::path clone = output_folder() / "clone";
  std::filesystem::create_directories(clone);
  const Outcome copied = run("cd " + quoted(source_folder()) +
                             " && git ls-files -z | tar c --null --files-from=- | tar x -C " + quoted(clone));
  if (copied.status != 0 || !std::filesystem::exists(clone / "compile_flags.txt"))
    GTEST_SKIP() << "not a clone: " << copied.output;
  std::string flags;
  for (const std::string& flag : lines(content(clone / "compile_flags.txt"))) flags += " " + quoted(flag);
  const auto wrong = [&](const std::string& file) {
    return run("cd " + quoted(clone) + " && " HEXTWIST_CXX_COMPILER + flags + " -w -fsyntax-only " + file).output;
  };
  for (const char* file : {"include/hextwist/hextwist.h", "embed/c.h", "embed/gmsh_take.cpp", "geom/occ/heal.cpp",
                           "io/exodus/read.cpp", "session/session.cpp", "tests/patch/adapt_test.cpp"})
    EXPECT_EQ(wrong(file), "");
  std::ofstream(clone / "broken.cpp") << "#include \"hextwist/mesh/no_such.h\"\n";
  EXPECT_NE(wrong("broken.cpp").find("no_such.h"), std::string::npos);
}

}  // namespace
}  // namespace hextwist::test
