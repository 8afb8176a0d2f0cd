// Journals that are not trusted.
#include <gtest/gtest.h>

#include <fstream>

#include "session/session_fixture.h"

namespace hextwist {

using test::Fixture, test::folder, test::written;

namespace {

class Safe : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder() / "in/deep");
    std::filesystem::current_path(folder() / "in");
    Fixture outside;
    outside.session.run("create brick x 1 interval 2; export gmsh '../out.msh'; export gmsh 'in.msh'");
    f.session.run("create brick x 1 interval 2; set safe on");
  }
  void TearDown() override { std::filesystem::current_path(before); }

  const std::filesystem::path before = std::filesystem::current_path();
  Fixture f;
};

constexpr const char* elsewhere = "the session is safe: only files below ";

TEST_F(Safe, files_below_the_folder_are_read_and_written) {
  EXPECT_EQ(f.error("export gmsh 'deep/a.msh'; import gmsh 'deep/a.msh'; export gmsh 'deep/a.msh' overwrite"),
            "no error");
  EXPECT_EQ(f.error("record 'a.jou'; refine hex 1; record stop; draw hex all to 'a.html'; reset; import mesh 'in.msh'"),
            "no error");
  EXPECT_EQ(f.error("playback 'a.jou'"), "no error");
  EXPECT_NE(f.error("export gmsh 'in.msh'").find("exists already"), std::string::npos);
}

TEST_F(Safe, no_command_leaves_the_folder) {
  std::filesystem::create_symlink(folder() / "out.msh", folder() / "in/link.msh");
  std::filesystem::create_symlink(folder() / "nowhere.msh", folder() / "in/dangling.msh");
  std::filesystem::create_directory_symlink(folder(), folder() / "in/up");
  written("b.jou", "list\n");
  for (const char* command :
       {"import mesh '../out.msh'", "import mesh 'link.msh'", "import mesh 'up/out.msh'", "export gmsh '../x.msh'",
        "export gmsh 'deep/../../x.msh'", "export gmsh 'dangling.msh'", "export gmsh 'link.msh' overwrite",
        "export gmsh '/tmp/hextwist_safe.msh'", "export levels '../a.levels'", "import levels '../a.levels'",
        "import step '../a.step'", "playback '../b.jou'", "record '../c.jou'", "record '../b.jou' append",
        "draw hex all to '../a.png'", "sizing function fine field 'level' file '../out.msh'"})
    EXPECT_TRUE(f.error(command).starts_with(elsewhere)) << command << ": " << f.error(command);
  EXPECT_FALSE(std::filesystem::exists(folder() / "x.msh"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "nowhere.msh"));
}

TEST_F(Safe, what_a_file_includes_lies_below_the_folder_too) {
  std::ofstream(folder() / "secret.inp") << "*NODE\n1, 0, 0, 0\n";
  for (const std::string& name : {std::string("../secret.inp"), (folder() / "secret.inp").string()}) {
    std::ofstream("a.inp") << "*INCLUDE, INPUT=" << name << "\n";
    EXPECT_NE(f.error("import abaqus 'a.inp'").find(" is not below "), std::string::npos)
        << f.error("import abaqus 'a.inp'");
  }
}

TEST_F(Safe, files_that_belong_to_a_mesh_lie_below_the_folder_too) {
  EXPECT_EQ(f.error("export openfoam 'deep/a.foam'; import openfoam 'deep/a.foam'"), "no error");
  EXPECT_EQ(f.error("export specfem 'deep/a.specfem'; import specfem 'deep/a.specfem'"), "no error");
  std::filesystem::create_directories(folder() / "elsewhere/polyMesh");
  std::filesystem::create_directories("foam");
  std::filesystem::create_directory_symlink(folder() / "elsewhere", "foam/constant");
  std::filesystem::rename("deep/constant/polyMesh/points", folder() / "points");
  std::filesystem::create_symlink(folder() / "points", "deep/constant/polyMesh/points");
  std::filesystem::rename("deep/nodes_coords_file", folder() / "nodes");
  std::filesystem::create_symlink(folder() / "nodes", "deep/nodes_coords_file");
  for (const char* command : {"export openfoam 'foam/a.foam'", "import openfoam 'deep/a.foam'",
                              "import specfem 'deep/a.specfem'", "export specfem 'deep/a.specfem' overwrite"})
    EXPECT_TRUE(f.error(command).starts_with(elsewhere)) << command << ": " << f.error(command);
  EXPECT_TRUE(std::filesystem::is_empty(folder() / "elsewhere/polyMesh"));
}

TEST_F(Safe, cad_is_not_read_in_this_process) {
  std::filesystem::copy_file(std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models/bracket.brep", "a.brep");
  const std::string said = f.error("reset; import geometry 'a.brep'");
  EXPECT_TRUE(said == "no error" || said.find("are not installed") != std::string::npos) << said;
}

TEST_F(Safe, endings_are_those_of_their_kind) {
  EXPECT_NE(f.error("import gmsh 'a.txt'").find("files for this end in .msh"), std::string::npos);
  EXPECT_NE(f.error("export gmsh 'a'"), "no error");
  EXPECT_NE(f.error("import levels 'a.bin'").find("files for this end in .msh"), std::string::npos);
  EXPECT_NE(f.error("playback 'a.txt'").find("files for this end in .jou"), std::string::npos);
}

TEST_F(Safe, nothing_takes_it_back) {
  EXPECT_NE(f.error("set safe off"), "no error");
  EXPECT_NE(f.error("set reading fenced off").find("cannot be changed"), std::string::npos);
  EXPECT_NE(f.error("set reading memory 1e6").find("cannot be changed"), std::string::npos);
  EXPECT_NE(f.error("set max_hexes 1000000000").find("cannot be changed"), std::string::npos);
  EXPECT_NE(f.error("set max_memory 1000").find("cannot be changed"), std::string::npos);
  std::filesystem::current_path(folder());
  f.error("reset");
  f.error("undo 1");
  f.error("set safe on");
  f.error("set safe on; bogus");
  f.session.run("create brick x 1");
  EXPECT_TRUE(f.error("export gmsh '" + (folder() / "y.msh").string() + "'").starts_with(elsewhere));
}

TEST_F(Safe, a_pipe_is_no_ordinary_file) {
  if (std::system("mkfifo p.jou 2> /dev/null") != 0) GTEST_SKIP() << "no pipes";
  EXPECT_EQ(f.error("playback 'p.jou'"), "the session is safe: this is not an ordinary file");
  EXPECT_EQ(f.error("record 'p.jou' overwrite"), "the session is safe: this is not an ordinary file");
}

TEST_F(Safe, calls_of_the_program_itself_are_not_concerned) {
  f.session.import_mesh(folder() / "out.msh");
  f.session.export_mesh(folder() / "z.msh");
  EXPECT_TRUE(std::filesystem::exists(folder() / "z.msh"));
}

TEST(Record, insists_on_the_ending_of_journals) {
  Fixture f;
  for (const char* name : {".bashrc", "a.txt", "victim.png", "a"})
    EXPECT_TRUE(f.error("record '" + (folder() / name).string() + "' append").starts_with("journals end in .jou"))
        << name;
  EXPECT_EQ(f.error("record '" + (folder() / "A.JOU").string() + "'"), "no error");
}

}  // namespace
}  // namespace hextwist
