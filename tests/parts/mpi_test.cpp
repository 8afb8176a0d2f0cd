// Refinements by several processes, against those by one: the joined parts are the same file, byte for byte.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "hextwist/io/file_part.h"
#include "hextwist/io/results.h"
#include "hextwist/parts/files.h"
#include "hextwist/session/session.h"
#include "io/io_support.h"
#include "ranks_support.h"
#include "split_judge.h"
#include "support/exodus_extras.h"

namespace hextwist {
namespace {

using test::model;
using test::Outcome;
using test::run_ranks;

struct Case {
  std::string mesh, cad, commands;
};

/// Returns what was said.
std::string expect_same_file(const Case& each, int n, const std::string& by, const std::string& more = "") {
  SCOPED_TRACE(each.commands + " of " + each.mesh + " by " + std::to_string(n) + " ranks, " + by);
  const auto folder = test::output_folder();
  Session session;
  if (!each.cad.empty()) session.import_cad(each.cad);
  session.import_mesh(each.mesh);
  session.run(each.commands);
  session.export_mesh(folder / "serial.e");
  const std::string cad = each.cad.empty() ? "" : "--cad '" + each.cad + "' ";
  const Outcome outcome = run_ranks(n, cad + "'" + each.mesh + "' --by " + by + " " + more + " -c '" + each.commands +
                                           "' -o '" + (folder / "parts.e").string() + "'");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  if (outcome.status != 0) return outcome.err;
  std::string faults;
  for (const std::string& line : test::split_faults(folder / "parts.e", n)) faults += line + "\n";
  EXPECT_EQ(faults, "");
  join_files(part_name(folder / "parts.e", n, 0), folder / "joined.e");
  EXPECT_TRUE(test::same_mesh(read_mesh(folder / "serial.e").mesh, read_mesh(folder / "joined.e").mesh));
  EXPECT_EQ(test::text_of(folder / "joined.e") == test::text_of(folder / "serial.e"), true) << outcome.out;
  return outcome.out;
}

/// Written once per test.
std::string brick(const std::string& interval) {
  const auto file = std::filesystem::path(HEXTWIST_TEST_OUTPUT) / ("brick." + interval + ".msh");
  Session session;
  session.run("create brick x 4 y 3 z 2 interval " + interval);
  session.export_mesh(file);
  return file.string();
}

TEST(InRanks, a_curve_of_a_model_is_refined_by_three_as_by_one) {
  expect_same_file({model("cam.msh"), model("cam.brep"), "refine curve 1 depth 1"}, 3, "slabs");
}
TEST(InRanks, hexes_of_a_grid_are_refined_by_two_as_by_one) {
  expect_same_file({brick("20 8 6"), "", "refine hex 1 to 400 by 7"}, 2, "ids");
}

/// These once were made in another order: nodes that are lifted by what is lowest anywhere, passes that not all have.
TEST(InRanks, nodes_are_in_the_order_of_one_process_where_halos_are_narrow) {
  std::string list;
  for (int id = 1; id <= 400; id += 7) list += " " + std::to_string(id);
  expect_same_file({brick("20 8 6"), "", "refine hex" + list}, 2, "slabs");
}
TEST(SlowInRanks, nodes_are_in_the_order_of_one_process_where_halos_are_narrow) {
  for (const char* rings : {"--rings 2", "--rings 3", "--rings 4"})
    for (const char* by : {"slabs", "boxes", "random"})
      expect_same_file({model("cam.msh"), model("cam.brep"), "refine surface 2"}, 4, by, rings);
}
TEST(InRanks, later_commands_name_ids_of_what_the_first_has_made) {
  expect_same_file({brick("20 6 4"), "",
                    "refine hex 7; refine hex 3 490 to 500 by 3 transition nested; "
                    "refine node 12 600 1200"},
                   3, "slabs");
}

TEST(InRanks, ids_beyond_two_to_the_31_go_on_from_there) {
  Mesh mesh = read_mesh(brick("8 4 4")).mesh;
  constexpr std::int64_t far = 5'000'000'000'000;
  for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.node_ids.push_back(far + 3 * n);
  for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.hex_ids.push_back(far + 2 * h);
  const auto file = std::filesystem::path(HEXTWIST_TEST_OUTPUT) / "far.e";
  write_mesh(file, mesh, nullptr);
  expect_same_file({file.string(), "", "refine hex 5000000000002 5000000000040"}, 3, "random");
}

/// Ranks read parts that are there already, each its own; as many as there are, fewer and more.
TEST(InRanks, parts_that_are_split_already_are_read_by_their_ranks) {
  const auto folder = test::output_folder();
  const std::string whole = brick("12 6 5"), commands = "refine hex 3 to 300 by 11";
  split_file(whole, folder / "split.e", 3, PartitionBy::random);
  Session session;
  session.import_mesh(whole);
  session.run(commands);
  session.export_mesh(folder / "serial.e");
  for (const int n : {2, 3, 4}) {
    const Outcome outcome = run_ranks(n, "'" + (folder / "split.e.3.1").string() + "' -c '" + commands + "' -o '" +
                                             (folder / "fine.e").string() + "'");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    join_files(part_name(folder / "fine.e", n, 0), folder / "joined.e");
    EXPECT_EQ(test::text_of(folder / "joined.e") == test::text_of(folder / "serial.e"), true) << outcome.out;
  }
  std::filesystem::remove(folder / "split.e.3.2");
  const Outcome missing = run_ranks(2, "'" + (folder / "split.e.3.1").string() + "' -c '" + commands + "'");
  EXPECT_EQ(missing.status, 1);
  EXPECT_NE(missing.err.find("error: rank 1: " + (folder / "split.e.3.2").string() + ": this part of 3 is missing"),
            std::string::npos)
      << missing.err;
}
TEST(InRanks, a_file_that_is_not_split_is_read_in_slices) {
  const auto file = std::filesystem::path(HEXTWIST_TEST_OUTPUT) / "in_slices.e";
  Session session;
  session.run(
      "create brick x 4 y 3 z 2 interval 12 6 5; nodeset 7 add surface 1 2; sideset 3 add surface 5; "
      "block 1 add hex 1 to 100");
  session.export_mesh(file);
  for (const char* by : {"boxes", "random", "ids"})
    expect_same_file({file.string(), "", "refine surface 2 depth 1; refine surface 3"}, 3, by);
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(5, 2, 2);
  mesh.points.emplace_back(9, 9, 9);
  write_mesh(folder / "loose.e", mesh, nullptr);
  for (const char* by : {"slabs", "scotch"}) {  // in slices, by the first
    const Outcome outcome = run_ranks(2, "'" + (folder / "loose.e").string() + "' --by " + by +
                                             " -c 'refine hex 1' -o '" + (folder / "fine.e").string() + "'");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("left out 1 node of no hex"), std::string::npos) << outcome.out;
  }
}

TEST(InRanks, what_parts_would_lose_is_refused) {
  const auto file = test::output_folder() / "wedge.msh";
  std::ofstream(file) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
                         "5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n9 2 0 0.5\n10 2 1 0.5\n$EndNodes\n$Elements\n2\n"
                         "1 5 2 1 1 1 2 3 4 5 6 7 8\n2 6 2 1 1 2 6 9 3 7 10\n$EndElements\n";
  const Outcome outcome = run_ranks(1, "'" + file.string() + "' -c 'refine hex 1'");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("other elements are not done in parts"), std::string::npos) << outcome.err;
}
TEST(InRanks, hexes_are_shared_out_again_where_one_rank_has_too_many) {
  expect_same_file({brick("16 6 5"), "", "refine hex 1 to 60 numsplit 1"}, 2, "slabs");
  const Outcome outcome = run_ranks(2, "'" + brick("16 6 5") + "' --by slabs --rings 3 -c 'refine surface 1 depth 2'");
  EXPECT_NE(outcome.out.find("hexes are shared out again by what becomes of them"), std::string::npos) << outcome.out;
  const std::string load = outcome.out.substr(outcome.out.rfind("the largest part has "));
  EXPECT_LE(std::stod(load.substr(std::string("the largest part has ").size())), 1.2) << outcome.out;
}

/// By all kinds of partitions in turn.
void expect_same_files(const std::vector<Case>& cases, const std::string& more) {
  std::vector<std::string> by = {"slabs", "ids", "random", "boxes"};
  if (has_scotch()) by.push_back("scotch");
  std::size_t i = 0;
  for (const Case& each : cases)
    for (const int n : {1, 2, 3, 4, 8}) expect_same_file(each, n, by[i++ % by.size()], more);
}

/// So large that halos do not cover it.
TEST(SlowInRanks, hexes_nodes_and_surfaces_of_a_grid) {
  const std::string grid = brick("24 10 8");
  expect_same_files({{grid, "", "refine hex 1 to 1900 by 13"},
                     {grid, "", "refine node 40 77 900 to 1300"},
                     {grid, "", "refine surface 1 depth 2"}},
                    "");
}
TEST(SlowInRanks, all_of_a_grid_and_levels_and_filled_regions) {
  const std::string grid = brick("24 10 8");
  expect_same_files({{grid, "", "refine volume all"},
                     {grid, "", "refine hex 5 80 to 200 1000 to 1100 numsplit 2"},
                     {grid, "", "refine hex 1 to 1900 by 17 concave fill"}},
                    "");
}
TEST(SlowInRanks, curves_and_surfaces_of_a_model) {
  const std::string cam = model("cam.msh"), cad = model("cam.brep");
  expect_same_files({{cam, cad, "refine curve 1"},
                     {cam, cad, "refine vertex 1; refine surface 2"},
                     {cam, cad, "refine surface 3 depth 1; refine surface 1"}},
                    "");
}

TEST(InRanks, an_error_of_one_is_one_line_with_its_rank_and_nothing_is_written) {
  const auto folder = test::output_folder();
  const std::string mesh = brick("6 4 4");
  std::filesystem::create_directory(folder / "a.e.2.1");
  const Outcome outcome = run_ranks(2, "'" + mesh + "' -c 'refine hex 1' -o '" + (folder / "a.e").string() + "'");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("error: rank 1: " + (folder / "a.e.2.1").string()), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "a.e.2.0"));
}

/// And no rank has the whole mesh.
void expect_same_in_parts(const Case& each, int n, const std::string& by) {
  const std::string said = expect_same_file(each, n, by);
  EXPECT_EQ(said.find("the first process"), std::string::npos) << said;
  EXPECT_NE(said.find("actual / wished size of "), std::string::npos) << said;
}
TEST(InRanks, sizes_are_met_in_parts_as_by_one) {
  const std::string grid = brick("24 10 8");
  expect_same_in_parts({model("cam.msh"), model("cam.brep"), "refine curve 1 size 0.3 bias 1.4"}, 3, "slabs");
  expect_same_in_parts({grid, "", "refine curve 1 size 0.05 bias 1.5 transition regular"}, 3, "boxes");
  expect_same_in_parts({grid, "",
                        "sizing function f linear vertex 2 size 0.1 growth 1.4; sizing function most constant 0.15; "
                        "sizing function both minimum f most; refine hex in surface 1 sizing_function both"},
                       2, "slabs");
}
TEST(SlowInRanks, sizes_are_met_in_parts_as_by_one) {
  const std::string grid = brick("24 10 8"), cam = model("cam.msh"), cad = model("cam.brep");
  for (const int n : {1, 2, 4})
    for (const char* by : {"slabs", "boxes", "random"}) {
      expect_same_in_parts({grid, "", "refine surface 1 size 0.08 bias 1.4"}, n, by);
      expect_same_in_parts({grid, "", "refine vertex 1 size 0.01 bias 1.6; refine curve 2"}, n, by);
      expect_same_in_parts({grid, "", "refine volume all sizing_function \"0.05 + 0.05*abs(x)\""}, n, by);
      expect_same_in_parts({cam, cad, "refine curve 3 size 0.2 bias 1.5 method single"}, n, by);
      expect_same_in_parts({cam, cad, "sizing function f curvature 3; refine volume 1 sizing_function f"}, n, by);
    }
}
/// Ranks that have nothing of the target ask as often as those that have.
TEST(InRanks, sizes_are_met_where_one_rank_has_all_of_the_target) {
  const std::string bar = brick("12 9 6");
  for (const char* target : {"node 1", "node in surface 4", "node with x_coord < -1.9", "edge in vertex 1",
                             "face in vertex 1", "face in surface 4", "hex 1"}) {
    const std::string refine = "refine " + std::string(target) + " sizing_function ";
    expect_same_in_parts({bar, "", refine + "\"0.1\""}, 3, "slabs");
  }
  expect_same_in_parts({bar, "", "refine node 1 sizing_function \"0.1\" depth 1"}, 3, "boxes");
  expect_same_in_parts({bar, "", "refine edge in vertex 1 sizing_function \"0.1\" method single"}, 3, "boxes");
  expect_same_in_parts({bar, "", "sizing function f constant 0.1; refine face in vertex 1 sizing_function f"}, 3,
                       "boxes");
}
/// What each part can't do by itself.
TEST(InRanks, sizes_coarser_hexes_and_smoothing_are_done_by_the_first_of_three_as_by_one) {
  const std::string grid = brick("12 6 5");
  expect_same_file({grid, "",
                    "sizing function f linear curve 1 size 0.08; refine volume all sizing_function f; "
                    "smooth volume all iterations 2"},
                   3, "slabs");
  expect_same_file({grid, "", "refine hex 20 to 60; refine hex 400 to 420; coarsen hex in surface 1"}, 2, "boxes");
  expect_same_file({model("cam.msh"), model("cam.brep"), "{s = 2}\nrefine curve {s} size 0.4 bias 1.4; undo; redo"}, 3,
                   "random");
}
TEST(SlowInRanks, what_the_first_does) {
  const std::string grid = brick("12 6 5"), cam = model("cam.msh"), cad = model("cam.brep");
  expect_same_files({{grid, "", "refine surface 1 size 0.2"},
                     {grid, "", "refine hex 9 to 90 numsplit 2; coarsen hex all; refine node 7 method parallel"},
                     {grid, "", "refine hex 1 100 300 smooth; refine edge 5; sideset 9 add surface 2; undo"},
                     {cam, cad, "refine surface 2 size 0.6 bias 1.3; refine curve 1 size 0.2 bias 2"},
                     {cam, cad, "refine surface 1 direction layers 2; refine volume 1 size 0.4 dry_run"}},
                    "");
}
TEST(InRanks, it_is_said_what_the_first_does_and_why) {
  const std::string mesh = brick("6 4 4");
  const auto said = [&](const std::string& commands) {
    return run_ranks(2, "'" + mesh + "' -c '" + commands + "'").out;
  };
  EXPECT_NE(
      said("refine curve 1 size 0.1")
          .find("a size that is the same everywhere: it may be met by one into eight, whose sheets run through the "
                "whole mesh: the first process does it, with the whole mesh"),
      std::string::npos);
  EXPECT_NE(said("refine hex 1; refine hex 4").find("a second level: "), std::string::npos);
  EXPECT_NE(said("refine hex 1; coarsen hex all").find("'coarsen': "), std::string::npos);
}
TEST(InRanks, groups_that_the_first_deletes_are_gone) {
  const auto file = std::filesystem::path(HEXTWIST_TEST_OUTPUT) / "groups.e";
  Session session;
  session.run(
      "create brick x 4 y 3 z 2 interval 6 4 3; nodeset 5 add surface 1; nodeset 7 add surface 1 2; "
      "sideset 3 add surface 5; block 4 add hex 1 to 20");
  session.export_mesh(file);
  for (const char* commands :
       {"delete nodeset all; delete block all", "delete sideset all", "nodeset 5 remove node all",
        "block 9 add hex all; delete block 1", "reset nodeset", "reset block; refine hex 1"})
    expect_same_file({file.string(), "", commands}, 3, "slabs");
  expect_same_file({file.string(), "", "surface 1 name \"inlet\"; refine surface inlet depth 1; delete block 4"}, 2,
                   "boxes");
}
TEST(InRanks, no_command_of_the_first_sees_how_ranks_know_their_hexes) {
  const auto folder = test::output_folder();
  const std::string mesh = brick("6 4 4");
  const Outcome outcome =
      run_ranks(2, "'" + mesh + "' --by slabs -c 'smooth volume all; list field; export mesh \"" +
                       (folder / "inside.vtu").string() + "\"' -o '" + (folder / "out.msh").string() + "'");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("there are no fields"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("shared out again"), std::string::npos) << "hexes go back to where they were";
  EXPECT_EQ(test::text_of(folder / "inside.vtu").find("hextwist-mpi"), std::string::npos);
  EXPECT_TRUE(read_mesh(folder / "inside.vtu").mesh.fields.empty());
  EXPECT_TRUE(read_parts(folder / "out_1.msh").mesh.fields.empty());
}
TEST(InRanks, what_the_first_makes_and_parts_would_lose_is_refused) {
  const auto folder = test::output_folder();
  const std::string mesh = brick("6 4 4"), journal = test::write_text(folder / "a.jou", "set order 2\n").string();
  const auto refusal = [&](const std::string& commands) {
    const Outcome outcome =
        run_ranks(2, "'" + mesh + "' -c '" + commands + "' -o '" + (folder / "no.e").string() + "'");
    EXPECT_EQ(outcome.status, 1);
    EXPECT_FALSE(std::filesystem::exists(folder / "no.e.2.0")) << commands;
    return outcome.err.substr(0, outcome.err.find('\n'));
  };
  const auto names = [&](const std::string& commands, const std::string& what) {
    const std::string said = refusal(commands);
    EXPECT_NE(said.find(what), std::string::npos) << commands << ": " << said;
  };
  names("set order 2; refine hex 1", "'set order 2': hexes of 20 nodes are not done in parts");
  names("playback \"" + journal + "\"; refine hex 1", "'set order 2': hexes of 20 nodes are not done in parts");
  names("block all element type hex20", "hexes of 20 nodes are not done in parts");
  names("block 1 attribute count 2; block 1 attribute index 2 0.5", "attribute 'attribute_1' of hexes");
  names("periodic surface 1 4", "'periodic'");
  names("refine hex 1; volume all move x 1", "'move' puts the mesh on another model");
  expect_same_file({mesh, "", "set order 2; refine hex 1; set order 1"}, 2, "boxes");
}
TEST(InRanks, what_a_file_says_of_the_whole_stays) {
  const auto folder = std::filesystem::path(HEXTWIST_TEST_OUTPUT) / "of_the_whole";
  std::filesystem::create_directories(folder);
  Mesh mesh = test::grid(6, 3, 2);
  mesh.blocks = {{2, "left", {0, 1, 2, 3}}};
  FileResults results;
  results.times = {2.5};
  results.properties = {{FileResults::Of::block, "MATERIAL", {{2, 11}}}};
  results.title = "a bar under load";
  results.info = {"first line"};
  results.qa = {{"MESHER", "1.2", "01/02/2026", "10:20:30"}};
  mesh.results = std::make_shared<const FileResults>(results);
  mesh.points.emplace_back(9, 9, 9);
  write_mesh(folder / "whole.e", mesh, nullptr);
  split_file(folder / "whole.e", folder / "parts.e", 2, PartitionBy::ids);
  join_files(folder / "parts.e.2.0", folder / "rejoined.e");
  // In slices, by the first, of parts, by the first again.
  for (const char* by : {"boxes", "scotch"})
    if (has_scotch() || by[0] == 'b') expect_same_file({(folder / "rejoined.e").string(), "", "refine hex 1 2"}, 3, by);
  expect_same_file({(folder / "rejoined.e").string(), "", "refine hex 1; smooth volume all"}, 2, "boxes");
  // Nodes of no hex are left out, but have had their ids.
  for (const std::string commands : {"refine hex 1 2", "smooth volume all; refine hex 1 2"})
    for (const char* by : {"boxes", "scotch"})
      for (const int n : {1, 2}) {
        if (!has_scotch() && by[0] == 's') continue;
        Session session;
        session.import_mesh(folder / "whole.e");
        session.run(commands);
        const Outcome outcome = run_ranks(n, "'" + (folder / "whole.e").string() + "' --by " + by + " -c '" + commands +
                                                 "' -o '" + (folder / "fine.e").string() + "'");
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        const Mesh fine = read_parts(part_name(folder / "fine.e", n, 0)).mesh, &serial = session.meshed().mesh;
        EXPECT_EQ(node_id(fine, fine.n_nodes() - 1), node_id(serial, serial.n_nodes() - 1)) << commands;
        EXPECT_EQ(fine.n_nodes(), serial.n_nodes() - 1) << "without that of no hex";
      }
}
TEST(InRanks, a_fault_of_a_part_is_named_with_its_file) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(4, 2, 2);
  std::swap(mesh.points[mesh.hexes[3][0]], mesh.points[mesh.hexes[3][1]]);  // the last along x
  write_mesh(folder / "whole.e", mesh, nullptr);
  split_file(folder / "whole.e", folder / "parts.e", 2, PartitionBy::slabs);
  const Outcome outcome = run_ranks(2, "'" + (folder / "parts.e.2.0").string() + "' -c 'refine hex 1'");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("error: rank 1: " + (folder / "parts.e.2.1").string() + ": "), std::string::npos)
      << outcome.err;
}
TEST(InRanks, what_files_of_any_rank_lose_is_said_once) {
  const auto folder = test::output_folder();
  Mesh mesh = test::with_extras();
  write_mesh(folder / "whole.e", mesh, nullptr);
  split_file(folder / "whole.e", folder / "parts.e", 2, PartitionBy::slabs);
  const Outcome outcome = run_ranks(2, "'" + (folder / "parts.e.2.0").string() + "' -c 'refine hex 1'");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  // Only the second has members of it.
  const std::string lost = "distribution factors of nodeset 3";
  EXPECT_NE(outcome.out.find((folder / "parts.e").string() + ": parts are refined without "), std::string::npos);
  EXPECT_NE(outcome.out.find(lost), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find(lost), outcome.out.rfind(lost)) << outcome.out;
}
TEST(InRanks, a_part_of_another_mesh_is_named_and_not_those_that_agree) {
  const auto folder = test::output_folder();
  write_mesh(folder / "a.e", test::grid(4, 2, 2), nullptr);
  write_mesh(folder / "b.e", test::grid(5, 2, 2), nullptr);
  split_file(folder / "b.e", folder / "b.e", 4, PartitionBy::ids);
  for (const int foreign : {0, 2})
    for (const int n : {2, 4}) {
      split_file(folder / "a.e", folder / "a.e", 4, PartitionBy::ids);
      const auto file = part_name(folder / "a.e", 4, foreign);
      std::filesystem::copy_file(part_name(folder / "b.e", 4, foreign), file,
                                 std::filesystem::copy_options::overwrite_existing);
      const Outcome outcome = run_ranks(n, "'" + (folder / "a.e.4.1").string() + "' -c 'refine hex 1'");
      EXPECT_EQ(outcome.status, 1);
      EXPECT_NE(outcome.err.find("error: rank " + std::to_string(foreign * n / 4) + ": " + file.string() +
                                 ": is part of a mesh of 20 hexes and 54 nodes, others of one of 16 and 45\n"),
                std::string::npos)
          << outcome.err;
    }
  write_mesh(folder / "one.e", test::grid(1, 1, 1), nullptr);
  const Outcome too_few = run_ranks(2, "'" + (folder / "one.e").string() + "' -c 'refine hex 1'");
  EXPECT_NE(too_few.err.find("error: a mesh of 1 hex has no 2 parts\n"), std::string::npos) << too_few.err;
}
TEST(InRanks, parts_do_not_get_the_names_of_other_formats) {
  const Outcome outcome = run_ranks(2, "none.e -c 'refine hex 1' -o out.vtu");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("error: out.vtu: parts are not written as .vtu files; "), std::string::npos)
      << outcome.err;
}
/// In messages of a socket, whose ends are those of what was written.
TEST(InRanks, an_error_is_written_at_once) {
  std::array<int, 2> ends{};
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);
    execl(HEXTWIST_MPI_PROGRAM, "hextwist-mpi", "none.e", "-c", "refine hex 1", nullptr);
    _exit(127);
  }
  close(ends[1]);
  std::vector<std::string> messages;
  std::array<char, 4096> buffer{};
  for (ssize_t n = 0; (n = recv(ends[0], buffer.data(), buffer.size(), 0)) > 0;)
    messages.emplace_back(buffer.data(), static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  const auto error =
      std::ranges::find_if(messages, [](const std::string& message) { return message.starts_with("error: "); });
  ASSERT_NE(error, messages.end());
  EXPECT_TRUE(error->starts_with("error: rank 0: none.e: ") && error->ends_with("\n")) << *error;
}
TEST(InRanks, lines_of_other_programs_are_skipped_and_said_once) {
  const std::string mesh = brick("6 4 4"), note = "'graphics' is skipped";
  for (const char* commands : {"graphics off; refine hex 1", "graphics off; smooth volume all"}) {
    const Outcome outcome = run_ranks(2, "'" + mesh + "' -c '" + commands + "'");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find(note), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.out.find(note), outcome.out.rfind(note)) << outcome.out;
  }
}
TEST(InRanks, commands_of_a_session_are_refused_by_name) {
  const std::string mesh = brick("6 4 4");
  const auto said = [&](const std::string& commands) {
    const Outcome outcome = run_ranks(2, "'" + mesh + "' -c '" + commands + "'");
    EXPECT_EQ(outcome.status, 1);
    return outcome.err.substr(0, outcome.err.find('\n'));
  };
  EXPECT_NE(said("refine hex 1; reset").find("'reset' is for sessions of hextwist"), std::string::npos);
  EXPECT_NE(said("import mesh \"a.msh\"").find("'import' is for sessions of hextwist"), std::string::npos);
  EXPECT_NE(said("{n = 4}\ncreate brick x {n}").find("rank 0: a command has put the mesh on another model"),
            std::string::npos);
  EXPECT_NE(said("coarsen hex 1").find("rank 0: no hex can become coarser"), std::string::npos);
}

}  // namespace
}  // namespace hextwist
