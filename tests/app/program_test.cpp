// The built program, end to end: exit statuses, files, report.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "hextwist/io/io.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist {
namespace {

using Json = nlohmann::json;

/// The folder of this test, emptied when it starts.
const std::filesystem::path& folder() {
  static std::filesystem::path result;
  static const testing::TestInfo* of = nullptr;
  if (const auto* now = testing::UnitTest::GetInstance()->current_test_info(); now != of) {
    of = now;
    result = test::output_folder();
  }
  return result;
}

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

struct Outcome {
  int status = -1;
  std::string out, err;
};

std::string quoted(const std::string& text) {
  return "'" + text + "'";
}

/// Runs the program with arguments as a shell would see them, and a text on standard input.
Outcome run(const std::string& arguments, const std::string& input = "") {
  std::ofstream(folder() / "stdin") << input;
  const std::string command = quoted(HEXTWIST_PROGRAM) + " " + arguments + " < " +
                              quoted((folder() / "stdin").string()) + " > " + quoted((folder() / "stdout").string()) +
                              " 2> " + quoted((folder() / "stderr").string());
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(folder() / "stdout"), content(folder() / "stderr")};
}

std::string path(const std::string& name) {
  return (folder() / name).string();
}

Json report(const std::string& name) {
  return Json::parse(content(path(name)));
}

TEST(Program, done_is_zero) {
  const Outcome outcome =
      run("-c 'create brick x 1 interval 4; refine hex 1' -o " + path("a.vtu") + " --json " + path("a.json"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("64 -> 138 hexes"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(path("a.vtu")));
  EXPECT_TRUE(report("a.json")["ok"]);
}

TEST(Program, view_makes_a_page_or_says_what_is_missing) {
  run("-c 'create brick x 1 interval 2' -o " + path("a.msh"));
  EXPECT_EQ(run("view " + path("a.msh") + " -o " + path("a.png")).status, 2);
  EXPECT_EQ(run("view").status, 2);
  EXPECT_EQ(run("view --cad " + path("a.brep") + " --before " + path("a.msh")).status, 2);
  EXPECT_EQ(run("view " + path("none.msh") + " -o " + path("none.html")).status, 1);
  const Outcome outcome = run("view " + path("a.msh") + " --before " + path("a.msh") + " -o " + path("a.html"));
  if (outcome.status != 0) {
    EXPECT_NE(outcome.err.find("error: this program was built without its page, which needs Node.js and npm"),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path("a.html")));
    return;
  }
  EXPECT_NE(outcome.out.find("a.html: open it in a browser"), std::string::npos) << outcome.out;
  const std::string page = content(path("a.html"));
  for (const char* block : {"id=\"skin\"", "id=\"inside\"", "id=\"before-skin\"", "<title>a</title>"})
    EXPECT_NE(page.find(block), std::string::npos) << block;
}

TEST(Program, serve_refuses_what_it_cannot_do) {
  EXPECT_EQ(run("serve a.msh b.msh").status, 2);
  EXPECT_EQ(run("serve --port 99999").status, 2);
  for (const char* seconds : {"nan", "-1", "1e10", "inf", "soon"})
    EXPECT_EQ(run(std::string("serve --time-limit ") + seconds).status, 2) << seconds;
  const Outcome outcome = run("serve --address 203.0.113.7");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(
      outcome.err.find("203.0.113.7 cannot be listened on: it is taken, or is not an address of this machine") !=
          std::string::npos ||
      outcome.err.find("this program was built without") != std::string::npos)
      << outcome.err;
}

TEST(Program, a_failed_command_is_one_and_leaves_the_old_output) {
  std::ofstream(path("a.msh")) << "old";
  const Outcome outcome = run("-c 'create brick x 1 interval 4; refine hex 65; refine hex 1' -o " + path("a.msh") +
                              " --json " + path("a.json"));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(content(path("a.msh")), "old");
  EXPECT_NE(outcome.err.find("error: hex 65 does not exist; hexes are 1 to 64\n"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("\n                                          ^~\n"), std::string::npos) << outcome.err;
  const Json json = report("a.json");
  EXPECT_FALSE(json["ok"]);
  EXPECT_EQ(json["error"], "hex 65 does not exist; hexes are 1 to 64");
  ASSERT_EQ(json["commands"].size(), 2u);  // the third was not run
  EXPECT_FALSE(json["commands"][1]["ok"]);
  EXPECT_EQ(json["commands"][1]["command"], "refine hex 65");
  EXPECT_EQ(json["commands"][1]["error_place"]["column"], 41);
}

TEST(Program, wrong_usage_is_two) {
  for (const std::string arguments : {"--bogus", "a.msh b.msh", "-c", "--threads x", "-c reset -o out.bogus",
                                      "-c reset -o out", "check", "check --bogus a.msh", "-c reset --json"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_NE(outcome.err, "") << arguments;
  }
}

TEST(Program, help_and_version_are_done) {
  const std::string version = run("--version").out;
  EXPECT_TRUE(version.starts_with("hextwist " HEXTWIST_VERSION "\nbuilt with OpenCASCADE ")) << version;
  for (const char* library : {"CGAL ", "Eigen 3.", "oneTBB ", "Exodus II ", "NetCDF ", "muParser ", "CLI11 "})
    EXPECT_NE(version.find(library), std::string::npos) << library << "is not in: " << version;
  const Outcome help = run("--help");
  EXPECT_EQ(help.status, 0);
  for (const char* option : {"--cad", "-c", "-o", "--json", "--keep-going", "--threads", "--version"})
    EXPECT_NE(help.out.find(option), std::string::npos) << option;
}

TEST(Program, bad_input_is_one_clear_line) {
  std::ofstream(path("cut.msh")) << "$MeshFormat\n4.1 0 8\n";
  std::ofstream(path("cut.step")) << "ISO-10303-21;\nHEADER;\n";
  for (const std::string& arguments : std::vector<std::string>{
           path("none.msh"), path("cut.msh"), "--cad " + path("none.step"), "--cad " + path("cut.step"),
           path("none.jou"), "-c 'create brick x 1' -o /nowhere/at/all.vtu", "-c reset -o " + path("a.msh"),
           "-c 'create brick x 1' --json /nowhere/a.json", "-c 'import mesh none.msh'"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 1) << arguments;
    EXPECT_TRUE(outcome.err.starts_with("error: ")) << arguments << ": " << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << arguments << ": " << outcome.err;
  }
}

TEST(Program, a_full_disk_leaves_no_half_file) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const Outcome outcome = run("-c 'create brick x 1' --json /dev/full");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("the report can't be written"), std::string::npos) << outcome.err;
}

TEST(Program, commands_and_journals_run_in_their_order) {
  std::ofstream(path("a.jou")) << "refine hex 1 # comment\nquality hex all\n";
  const Outcome outcome =
      run("-c 'create brick x 1 interval 4' " + path("a.jou") + " -c list -c 'refine hex 64' --json " + path("a.json"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  std::vector<std::string> commands;
  const Json json = report("a.json");
  for (const Json& row : json["commands"]) commands.push_back(row["command"]);
  EXPECT_EQ(commands, (std::vector<std::string>{"create brick x 1 interval 4", "playback \"" + path("a.jou") + "\"",
                                                "refine hex 1", "quality hex all", "list", "refine hex 64"}));
}

TEST(Program, errors_in_journals_name_file_line_and_column) {
  std::ofstream(path("a.jou")) << "create brick x 1\n\nrefine hexx 1\n";
  const Outcome outcome = run(path("a.jou"));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(outcome.err.starts_with("error: " + path("a.jou") + ":3:8: expected node")) << outcome.err;
}

TEST(Program, keep_going_runs_the_rest_and_still_fails) {
  const Outcome outcome = run("--keep-going -c 'bogus; create brick x 1 interval 4; refine hex 99; refine hex 1' -o " +
                              path("a.vtu") + " --json " + path("a.json"));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_FALSE(std::filesystem::exists(path("a.vtu")));
  EXPECT_EQ(report("a.json")["commands"].size(), 4u);
  EXPECT_EQ(report("a.json")["commands"][3]["hexes_after"], 138);
}

TEST(Program, standard_input_is_read_when_there_are_no_commands) {
  const Outcome good = run("-o " + path("a.vtu"), "create brick x 1 \\\n interval 4\nrefine hex 1\nquit\nbogus\n");
  EXPECT_EQ(good.status, 0) << good.err;
  EXPECT_TRUE(std::filesystem::exists(path("a.vtu")));
  EXPECT_EQ(run("", "").status, 0);
  const Outcome bad = run("", "create brick x 1 \\\n interval 4\nrefine crve 1\nreset");
  EXPECT_EQ(bad.status, 1);
  EXPECT_TRUE(bad.err.starts_with("error: stdin:3:8: expected node")) << bad.err;
  EXPECT_EQ(run("--keep-going", "bogus\nbogus\ncreate brick x 1\n").status, 1);
}

TEST(Program, the_report_has_the_fields_that_scripts_rely_on) {
  run("-c 'create brick x 1 interval 4; refine hex 1' --json " + path("a.json"));
  const Json json = report("a.json");
  ASSERT_EQ(json["commands"].size(), 2u);
  for (const Json& row : json["commands"]) {
    for (const char* key :
         {"command", "ok", "error", "hexes_before", "hexes_after", "nodes_before", "nodes_after", "filled_hexes",
          "shape", "scaled_jacobian", "off_cad", "violations", "seconds", "peak_memory_bytes"})
      EXPECT_TRUE(row.contains(key)) << key;
    for (const char* key : {"max", "max_relative", "node", "owner"}) EXPECT_TRUE(row["off_cad"].contains(key)) << key;
    EXPECT_GT(row["seconds"]["total"], 0);
    EXPECT_GT(row["peak_memory_bytes"], 1000000);
    EXPECT_TRUE(row["violations"].is_array());
  }
  const Json& row = json["commands"][1];
  EXPECT_EQ(row["hexes_before"], 64);
  EXPECT_EQ(row["hexes_after"], 138);
  EXPECT_EQ(row["nodes_before"], 125);
  EXPECT_EQ(row["nodes_after"], 223);
  EXPECT_EQ(row["filled_hexes"], 0);
  EXPECT_TRUE(row["error"].is_null());
  for (const char* metric : {"shape", "scaled_jacobian"}) {
    EXPECT_NEAR(row[metric]["before"]["min"].get<double>(), 1, 1e-9);
    for (const char* key : {"min", "max", "average", "std_dev"})
      EXPECT_TRUE(row[metric]["after"][key].is_number()) << key;
    EXPECT_LT(row[metric]["after"]["min"].get<double>(), row[metric]["after"]["average"].get<double>());
  }
  EXPECT_TRUE(row["off_cad"]["node"].is_number_integer());
  EXPECT_TRUE(row["off_cad"]["owner"].is_string());
  EXPECT_GT(row["seconds"].size(), 3u);
}

TEST(Program, bytes_that_are_no_text_do_not_spoil_the_report) {
  const Outcome outcome = run("--json " + path("a.json"), "refine \xff\xfe \"\xc3\"\n");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(report("a.json")["commands"].size(), 1u);
}

TEST(Program, convert_writes_a_mesh_in_another_format) {
  ASSERT_EQ(run("-c 'create cylinder height 2 radius 1; block 1 volume 1 name \"rod\"' -o " + path("a.msh")).status, 0);
  const Outcome outcome = run("convert " + path("a.msh") + " " + path("a.bdf") + " --order 2 --json " + path("a.json"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read_mesh(path("a.bdf")).middles.nodes_per_hex, 20);
  EXPECT_EQ(run("convert " + path("a.bdf") + " " + path("b.unv")).status, 0);
  const MeshFile back = read_mesh(path("b.unv"));
  EXPECT_EQ(back.middles.nodes_per_hex, 20);
  EXPECT_EQ(back.mesh.blocks.at(0).name, "rod");
  for (const char* name : {"c.k", "c.cdb", "c.re2", "MESH/c.specfem", "c.mesh"}) {
    EXPECT_EQ(run("convert " + path("a.msh") + " " + path(name) + " --order 2").status, 0) << name;
    EXPECT_EQ(run("convert " + path(name) + " " + path("d.msh")).status, 0) << name;
    EXPECT_EQ(read_mesh(path("d.msh")).mesh.n_hexes(), back.mesh.n_hexes()) << name;
  }
  EXPECT_EQ(run("convert " + path("a.msh")).status, 2);
  EXPECT_EQ(run("convert " + path("a.msh") + " " + path("a.stl")).status, 2);
  EXPECT_EQ(run("convert " + path("none.msh") + " " + path("c.unv")).status, 1);
  EXPECT_FALSE(std::filesystem::exists(path("c.unv")));
}

/// Through formats whose libraries are others', read in a process of their own, and MFEM's, by its word in commands.
TEST(Program, convert_goes_through_formats_of_other_libraries) {
  ASSERT_EQ(run("-c 'create cylinder height 2 radius 1; block 1 volume 1 name \"rod\"; sideset 2 surface 1 name "
                "\"end\"' -o " +
                path("a.msh"))
                .status,
            0);
  const Mesh mesh = read_mesh(path("a.msh")).mesh;
  std::string before = "a.msh";
  for (const std::string name : {"b.cgns", "c.xdmf", "d.vtkhdf", "e.mfem", "f.vtu"}) {
    const Outcome outcome = run("convert " + path(before) + " " + path(name));
    if (outcome.err.find("built without") != std::string::npos) continue;
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const Mesh back = read_mesh(path(name)).mesh;
    EXPECT_EQ(back.points, mesh.points) << name;
    EXPECT_EQ(back.hexes, mesh.hexes) << name;
    EXPECT_EQ(back.blocks, mesh.blocks) << name;
    EXPECT_EQ(back.side_sets, mesh.side_sets) << name;
    before = name;
  }
  EXPECT_EQ(run(path("e.mfem") + " -c \"export mfem '" + path("g.mesh") + "'\"").status, 0);
  EXPECT_EQ(read_mesh(path("g.mesh")).mesh.blocks, mesh.blocks);
  EXPECT_EQ(run("--safe " + path("b.cgns") + " -c 'list hex 1'").status, 0);
}

TEST(Program, check_tells_good_meshes_from_bad_ones) {
  Mesh mesh = test::grid(2, 2, 2);
  write_mesh(path("good.msh"), mesh, nullptr);
  const Outcome good = run("check " + path("good.msh") + " --json " + path("a.json"));
  EXPECT_EQ(good.status, 0) << good.err;
  EXPECT_NE(good.out.find("no violations"), std::string::npos);
  EXPECT_TRUE(report("a.json")["ok"]);
  mesh.points[13] += Vec3(1.5, 1.5, 1.5);
  write_mesh(path("bad.msh"), mesh, nullptr);
  const Outcome bad = run("check " + path("bad.msh") + " --json " + path("a.json"));
  EXPECT_EQ(bad.status, 1);
  EXPECT_EQ(std::ranges::count(bad.err, '\n'), 1) << bad.err;
  EXPECT_FALSE(report("a.json")["commands"].back()["violations"].empty());
  EXPECT_EQ(run("check " + path("none.msh")).status, 1);
}

TEST(Program, check_on_real_cad) {
  if (test::data_folder().empty()) GTEST_SKIP() << "no real CAD here";
  const std::string part = (test::data_folder() / "cad" / "plate_hole").string();
  const Outcome outcome = run("check " + part + "_1k.msh --cad " + part + ".step --json " + path("a.json"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(report("a.json")["commands"].back()["off_cad"]["model"], "cad");
  EXPECT_EQ(run("check " + part + "_1k.msh --cad " + (test::data_folder() / "cad" / "sphere7.step").string()).status,
            1);
}

TEST(Program, the_main_job_end_to_end) {
  if (test::data_folder().empty()) GTEST_SKIP() << "no real CAD here";
  const std::string part = (test::data_folder() / "cad" / "plate_hole").string();
  const std::string out = path("fine.msh");
  const Outcome outcome =
      run("--cad " + part + ".step " + part + "_1k.msh -c 'refine curve all' -o " + out + " --json " + path("a.json"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json row = report("a.json")["commands"][2];
  EXPECT_LT(row["off_cad"]["max_relative"], 1e-9);
  const Mesh mesh = read_mesh(out).mesh;
  EXPECT_EQ(row["hexes_after"], mesh.n_hexes());
  EXPECT_TRUE(test::conformal(mesh));
  EXPECT_TRUE(test::uninverted(mesh));
  EXPECT_EQ(run("check " + out + " --cad " + part + ".step").status, 0);
}

TEST(Program, the_number_of_threads_does_not_change_the_result) {
  for (const char* threads : {"1", "2", "8"})
    ASSERT_EQ(
        run(std::string("--threads ") + threads + " -c 'create sphere radius 1 interval 2; refine surface 1' -o " +
            path(std::string("t") + threads + ".msh"))
            .status,
        0);
  EXPECT_EQ(content(path("t1.msh")), content(path("t2.msh")));
  EXPECT_EQ(content(path("t1.msh")), content(path("t8.msh")));
}

}  // namespace
}  // namespace hextwist
