// Refinements from disk to disk, and what they and several processes share: sums by runs of ids.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "hextwist/io/io.h"
#include "hextwist/parts/files.h"
#include "hextwist/parts/on_disk.h"
#include "hextwist/parts/runs.h"
#include "hextwist/session/session.h"
#include "io/io_support.h"
#include "split_judge.h"

namespace hextwist {
namespace {

using IdRun = Run;  // testing::Test has a Run of its own

TEST(Runs, sums_over_lower_keys_are_those_of_keys_one_by_one) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto number = [&](unsigned n) { return static_cast<std::int64_t>(random() % n); };
    std::map<std::int64_t, Counts> all;
    for (int i = 0; i < 60; ++i) all[number(100)] = {number(3), number(2)};
    std::vector<IdRun> runs;
    for (int part = 0; part < 4; ++part) {
      std::vector<IdRun> mine;
      for (const auto& [key, counts] : all)
        if (random() % 2) add_key(mine, key, counts);
      runs.insert(runs.end(), mine.begin(), mine.end());
    }
    std::map<std::int64_t, Counts> there;
    for (const IdRun& run : runs)
      for (std::int64_t k = 0; k < run.n; ++k) there[run.first + k] = run.each;
    const RunStarts starts = starts_of(runs);
    EXPECT_EQ(starts.differs_at, -1);
    Counts total{};
    for (const auto& [key, counts] : there) {
      for (std::size_t r = 0; r < runs.size(); ++r)
        if (runs[r].first == key) {
          EXPECT_EQ(starts.before[r], total);
        }
      for (int k = 0; k < 2; ++k) total[k] += counts[k];
    }
    EXPECT_EQ(starts.total, total);
  }
}

TEST(Runs, that_contradict_each_other_are_found) {
  const std::vector<IdRun> runs = {{10, 5, {1, 0}}, {14, 1, {2, 0}}};
  EXPECT_EQ(starts_of(runs).differs_at, 14);
}

std::filesystem::path split_grid(const std::string& interval, int n, PartitionBy by) {
  const auto folder = test::output_folder();
  Session session;
  session.run("create brick x 4 y 3 z 2 interval " + interval + "; nodeset 7 add surface 1 2; sideset 3 add surface 5");
  session.export_mesh(folder / "whole.e");
  split_file(folder / "whole.e", folder / "parts.e", n, by);
  return folder;
}

void expect_same_on_disk(const std::string& commands, int n, PartitionBy by, int n_rings) {
  SCOPED_TRACE(commands + " in " + std::to_string(n) + " parts");
  const auto folder = split_grid("12 6 5", n, by);
  Session session;
  session.import_mesh(folder / "whole.e");
  session.run(commands);
  session.export_mesh(folder / "serial.e");
  refine_on_disk(part_name(folder / "parts.e", n, 0), PartCommands(std::vector{commands}), folder / "fine.e",
                 {n_rings, {}}, [](const std::string&) {});
  std::string faults;
  for (const std::string& line : test::split_faults(folder / "fine.e", n)) faults += line + "\n";
  EXPECT_EQ(faults, "");
  join_files(part_name(folder / "fine.e", n, 0), folder / "joined.e");
  EXPECT_TRUE(test::same_mesh(read_mesh(folder / "serial.e").mesh, read_mesh(folder / "joined.e").mesh));
  EXPECT_EQ(test::text_of(folder / "joined.e") == test::text_of(folder / "serial.e"), true);
  for (const auto& each : std::filesystem::directory_iterator(folder))
    EXPECT_NE(each.path().filename().string().substr(0, 9), ".hextwist") << "what was put aside is gone";
}

TEST(OnDisk, is_the_same_as_at_once) {
  expect_same_on_disk("refine volume all", 5, PartitionBy::boxes, 2);
  expect_same_on_disk("refine hex 1 to 300 by 13", 3, PartitionBy::random, 2);
  expect_same_on_disk("refine curve 1; refine surface 2", 4, PartitionBy::slabs, 2);
  // Low hexes of all kinds, none so low that the first step of lifting is for them.
  expect_same_on_disk("refine hex in surface 1 2", 3, PartitionBy::slabs, 2);
}
TEST(SlowOnDisk, is_the_same_as_at_once) {
  for (const int n : {1, 2, 8}) {
    expect_same_on_disk("refine hex 5 80 to 100 numsplit 2", n, PartitionBy::ids, 3);
    expect_same_on_disk("refine hex 1 to 300 by 17 concave fill", n, PartitionBy::boxes, 2);
    expect_same_on_disk("refine node 4 77 90 to 130", n, PartitionBy::random, 2);
    expect_same_on_disk("refine surface 1 depth 2; refine surface 3", n, PartitionBy::slabs, 2);
    expect_same_on_disk("refine volume all numsplit 2", n, PartitionBy::boxes, 2);
  }
}

TEST(OnDisk, says_what_is_wrong_and_writes_nothing) {
  const auto folder = split_grid("6 4 4", 2, PartitionBy::slabs);
  const auto said = [&](const std::string& commands) {
    return test::error_of([&] {
      refine_on_disk(folder / "parts.e.2.1", PartCommands(std::vector{commands}), folder / "no.e", {},
                     [](const std::string&) {});
    });
  };
  EXPECT_EQ(said("refine hex 1 97 98"), "there is no hex 97");
  EXPECT_NE(said("refine hex 1; refine hex 96").find("a second level: "), std::string::npos);
  EXPECT_NE(said("refine hex all smooth").find("smooth: "), std::string::npos);
  // Of nodes that are there, in different parts: the kind of request is what is wrong.
  EXPECT_NE(said("refine node 1 175 size 0.1 bias 1.5")
                .find("a size at nodes, edges, faces or hexes: others may be nearer; that is not done part after part"),
            std::string::npos)
      << said("refine node 1 175 size 0.1 bias 1.5");
  // What each part would find another way.
  for (const char* target :
       {"hex in sheet 1", "edge with id < 5", "hex in (block with element_count > 60)",
        "hex with x_coord > x_coord of node 7", "hex in (nodeset in surface 1)", "hex in (surface in block 1)"})
    EXPECT_NE(said("refine " + std::string(target)).find("that is not done part after part"), std::string::npos)
        << target << ": " << said("refine " + std::string(target));
  std::filesystem::remove(folder / "parts.e.2.1");
  EXPECT_EQ(said("refine hex 1"), (folder / "parts.e.2.1").string() + ": this part of 2 is missing");
  EXPECT_FALSE(std::filesystem::exists(folder / "no.e.2.0"));
}

TEST(OnDisk, a_list_of_vtu_files_has_all_arrays_of_its_pieces) {
  const auto folder = split_grid("6 4 4", 2, PartitionBy::slabs);
  refine_on_disk(folder / "parts.e.2.0", PartCommands(std::vector<std::string>{"refine hex 1"}), folder / "fine.pvtu",
                 {}, [](const std::string&) {});
  const std::string list = test::text_of(folder / "fine.pvtu");
  Index n_hexes = 0;
  for (const char* piece : {"fine_0.vtu", "fine_1.vtu"}) {
    EXPECT_NE(list.find("<Piece Source=\"" + std::string(piece) + "\"/>"), std::string::npos);
    n_hexes += read_mesh(folder / piece).mesh.n_hexes();
  }
  Session session;
  session.import_mesh(folder / "whole.e");
  session.run("refine hex 1");
  EXPECT_EQ(n_hexes, session.meshed().mesh.n_hexes());
  EXPECT_NE(list.find("<PPoints>\n<PDataArray type=\"Float64\""), std::string::npos) << list;
  EXPECT_NE(list.find("<PCellData>\n<PDataArray "), std::string::npos) << list;
}

}  // namespace
}  // namespace hextwist
