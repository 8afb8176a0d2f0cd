// Meshes in parts: split, judged, joined.
#include <netcdf.h>

#include <numeric>
#include <random>

#include "hextwist/base/sorted.h"
#include "hextwist/parts/files.h"
#include "hextwist/parts/join.h"
#include "hextwist/parts/own_part.h"
#include "hextwist/parts/split.h"
#include "hextwist/patch/patch.h"
#include "io/io_support.h"
#include "split_judge.h"
#include "support/exodus_extras.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

std::string faults_text(const std::filesystem::path& name, int n_parts) {
  std::string text;
  for (const std::string& line : test::split_faults(name, n_parts)) text += line + "\n";
  return text;
}
void write_parts(const Mesh& mesh, const std::filesystem::path& name, const std::vector<int>& part_of_hex, int n) {
  const MeshedModel whole{mesh, nullptr, {}};
  const Splitting splitting(whole, part_of_hex, n);
  PartOutput files(name, n);
  std::vector<std::string> notices;
  for (int p = 0; p < n; ++p) {
    const MeshPart part = splitting.part(p);
    files.write({part.mesh, {}, part.file, {}}, notices);
  }
  files.commit();
}

/// Per hex a part, each at least once.
std::vector<int> random_parts(const Mesh& mesh, int n, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<int> part_of_hex(mesh.hexes.size());
  for (int& p : part_of_hex) p = static_cast<int>(random() % static_cast<unsigned>(n));
  std::iota(part_of_hex.begin(), part_of_hex.begin() + n, 0);
  return part_of_hex;
}

TEST(SplitName, is_told_from_that_of_any_part) {
  EXPECT_EQ(part_name("mesh.e", 8, 3), "mesh.e.8.3");
  EXPECT_EQ(part_name("a/mesh.e", 16, 3), "a/mesh.e.16.03");
  EXPECT_EQ(split_name("a/mesh.e.16.03").name, "a/mesh.e");
  EXPECT_EQ(split_name("a/mesh.e.16.03").n_parts, 16);
  for (const char* no : {"mesh.e", "mesh.e.8", "mesh.e.8.8", "mesh.e.0.0", "mesh.e.8.x", "8.0", ".8.0x", "mesh.e.8."})
    EXPECT_EQ(split_name(no).n_parts, 0) << no;
}

TEST(SplitName, is_that_of_a_gmsh_file_where_gmsh_has_split_it) {
  const auto folder = test::output_folder();
  EXPECT_EQ(part_name("a/mesh.msh", 8, 2), "a/mesh_3.msh");
  write_parts(test::grid(3, 2, 2), folder / "mesh.msh", {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2}, 3);
  EXPECT_EQ(split_name(folder / "mesh_2.msh").name, folder / "mesh.msh");
  EXPECT_EQ(split_name(folder / "mesh_2.msh").n_parts, 3);
  write_mesh(folder / "whole_2.msh", test::grid(2, 2, 2), nullptr);
  for (const char* no : {"whole_2.msh", "mesh_4.msh", "mesh.msh"}) EXPECT_EQ(split_name(folder / no).n_parts, 0) << no;
  std::filesystem::rename(folder / "mesh_1.msh", folder / "mesh_4.msh");
  EXPECT_EQ(split_name(folder / "mesh_4.msh").n_parts, 0);
  const auto refusal = [&] { return test::error_of([&] { read_parts(folder / "mesh_2.msh"); }); };
  EXPECT_EQ(refusal(), (folder / "mesh_1.msh").string() + ": this part of 3 is missing");
  std::filesystem::copy(folder / "mesh_3.msh", folder / "mesh_1.msh");
  EXPECT_EQ(refusal(), (folder / "mesh_1.msh").string() + ": is partition 3 of 3, by its name it would be 1");
}

TEST(Partition, gives_every_hex_a_part_and_every_part_a_fair_share) {
  std::mt19937 random(3);
  const Mesh mesh = test::shuffled(test::grid(12, 7, 5), random);
  for (const PartitionBy by : {PartitionBy::scotch, PartitionBy::slabs, PartitionBy::ids, PartitionBy::random}) {
    if (by == PartitionBy::scotch && !has_scotch()) continue;
    for (const int n : {1, 2, 3, 4, 8}) {
      const std::vector<int> part = partition(mesh, n, by);
      ASSERT_EQ(part.size(), mesh.hexes.size());
      std::vector<int> count(static_cast<std::size_t>(n), 0);
      for (const int p : part) ++count.at(static_cast<std::size_t>(p));
      const double fair = static_cast<double>(mesh.n_hexes()) / n;
      EXPECT_GE(std::ranges::min(count), 0.8 * fair);
      EXPECT_LE(std::ranges::max(count), 1.2 * fair);
      if (by != PartitionBy::scotch) {
        EXPECT_EQ(part, partition(mesh, n, by)) << "the same for the same mesh";
      }
    }
  }
}

TEST(Partition, refuses_more_parts_than_hexes) {
  EXPECT_EQ(test::error_of([] { partition(test::grid(2, 1, 1), 3, PartitionBy::slabs); }),
            "a mesh of 2 hexes has no 3 parts");
  EXPECT_EQ(test::error_of([] { partition(test::grid(2, 1, 1), 0, PartitionBy::slabs); }),
            "the number of parts must be at least 1");
}

TEST(Split, parts_are_right_for_others_and_joined_again_to_the_bit) {
  for (const unsigned seed : {1u, 2u, 3u})
    for (const bool gaps : {false, true})
      for (const int n : {1, 2, 3, 8, 11}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(n) + " parts");
        const Mesh mesh = test::rich_mesh(seed, gaps, {5, 4, 3});
        const auto name = test::output_folder() / "rich.e";
        write_parts(mesh, name, random_parts(mesh, n, seed), n);
        EXPECT_EQ(faults_text(name, n), "");
        EXPECT_TRUE(test::same_mesh(mesh, read_parts(part_name(name, n, 0)).mesh));
      }
}

TEST(Split, as_gmsh_does_and_joined_again_to_what_one_file_keeps) {
  for (const unsigned seed : {1u, 2u})
    for (const bool gaps : {false, true})
      for (const int n : {2, 3, 8}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(n) + " parts");
        const Mesh mesh = test::rich_mesh(seed, gaps, {5, 4, 3});
        const auto folder = test::output_folder();
        write_mesh(folder / "whole.msh", mesh, nullptr);
        write_parts(mesh, folder / "rich.msh", random_parts(mesh, n, seed), n);
        EXPECT_TRUE(test::same_mesh(read_mesh(folder / "whole.msh").mesh,
                                    read_parts(folder / ("rich_" + std::to_string(n) + ".msh")).mesh));
      }
}

TEST(Split, what_gmsh_divides_is_read_and_what_is_divided_here_gmsh_reads) {
  if (std::system("/usr/bin/python3 -c 'import gmsh' > /dev/null 2>&1") != 0) GTEST_SKIP() << "no python3 with Gmsh";
  const auto folder = test::output_folder();
  const MeshedModel whole = test::shipped("inclusion");
  write_mesh(folder / "whole.msh", whole.mesh, &whole.association);
  const std::string judge = "/usr/bin/python3 '" HEXTWIST_SOURCE_DIR "/tests/parts/gmsh_parts.py' ";
  const auto quoted = [&](const std::string& name) { return "'" + (folder / name).string() + "' "; };
  ASSERT_EQ(std::system((judge + "divide " + quoted("whole.msh") + "3 " + quoted("theirs")).c_str()), 0);
  for (const std::string kind : {"00", "01", "10", "11"}) {
    SCOPED_TRACE(kind);
    MeshFile read = read_parts(folder / ("theirs" + kind + "_2.msh"));
    if (kind[1] == '0') {  // text, of 16 digits
      ASSERT_EQ(read.mesh.n_nodes(), whole.mesh.n_nodes());
      for (Index n = 0; n < whole.mesh.n_nodes(); ++n)
        EXPECT_NEAR((read.mesh.points[n] - whole.mesh.points[n]).norm(), 0, 1e-13);
      read.mesh.points = whole.mesh.points;
    }
    EXPECT_TRUE(test::same_mesh(whole.mesh, read.mesh));
  }
  // Of parts with owners, as refined parts have.
  std::vector<int> part_of_hex = partition(whole.mesh, 3, PartitionBy::slabs);
  const Splitting splitting(whole, part_of_hex, 3);
  PartOutput output(folder / "ours.msh", 3);
  std::vector<std::string> notices;
  for (int p = 0; p < 3; ++p) {
    std::vector<Index> own;
    for (Index h = 0; h < whole.mesh.n_hexes(); ++h)
      if (part_of_hex[h] == p) own.push_back(h);
    const MeshPart part = splitting.part(p);
    output.write({part.mesh, make_patch(whole, own).meshed.association, part.file, {}}, notices);
  }
  output.commit();
  EXPECT_EQ(notices, std::vector<std::string>());
  EXPECT_TRUE(test::same_mesh(whole.mesh, read_parts(folder / "ours_1.msh").mesh));
  std::string expected;
  const std::string parts = quoted("ours_1.msh") + quoted("ours_2.msh") + quoted("ours_3.msh");
  ASSERT_EQ(std::system((judge + "count " + parts + "> " + quoted("found.txt")).c_str()), 0);
  std::istringstream found(test::text_of(folder / "found.txt"));
  std::int64_t n_nodes = 0, n_hexes = 0, n_different = 0, n_beside = 0, n_different_beside = 0;
  found >> n_nodes >> n_hexes >> n_different >> n_beside >> n_different_beside;
  EXPECT_EQ(n_nodes, whole.mesh.n_nodes());
  EXPECT_EQ(n_hexes, whole.mesh.n_hexes());
  EXPECT_EQ(n_different, n_hexes);
  EXPECT_GT(n_beside, 0);
  EXPECT_EQ(n_different_beside, n_beside);
  for (const Block& block : whole.mesh.blocks) {
    std::int64_t id = 0, n = 0;
    found >> id >> n;
    EXPECT_EQ(id, block.id);
    EXPECT_EQ(n, std::ssize(block.hexes));
  }
  for (int p = 1, partition = 0; p <= 3; ++p) {
    found >> partition;
    EXPECT_EQ(partition, p);
  }
}

TEST(Split, by_every_partition_of_a_file_and_back) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::rich_mesh(7, true, {7, 5, 4});
  write_mesh(folder / "whole.e", mesh, nullptr);
  const Mesh read = read_mesh(folder / "whole.e").mesh;
  for (const PartitionBy by : {PartitionBy::scotch, PartitionBy::slabs, PartitionBy::ids}) {
    if (by == PartitionBy::scotch && !has_scotch()) continue;
    split_file(folder / "whole.e", folder / "parts.e", 4, by);
    EXPECT_EQ(faults_text(folder / "parts.e", 4), "");
    join_files(folder / "parts.e.4.2", folder / "again.e");
    EXPECT_TRUE(test::same_mesh(read, read_mesh(folder / "again.e").mesh));
    EXPECT_EQ(test::text_of(folder / "again.e"), test::text_of(folder / "whole.e"));
  }
}

TEST(Split, ids_beyond_two_to_the_31_stay) {
  Mesh mesh = test::rich_mesh(5, true);
  constexpr std::int64_t far = 3'000'000'000'000;
  for (std::int64_t& id : mesh.node_ids) id += far;
  for (std::int64_t& id : mesh.hex_ids) id += far;
  std::vector<int> part_of_hex(mesh.hexes.size());
  for (std::size_t h = 0; h < part_of_hex.size(); ++h) part_of_hex[h] = static_cast<int>(h % 3);
  const auto name = test::output_folder() / "far.e";
  write_parts(mesh, name, part_of_hex, 3);
  EXPECT_EQ(faults_text(name, 3), "");
  EXPECT_TRUE(test::same_mesh(mesh, read_parts(part_name(name, 3, 1)).mesh));
}

TEST(Split, the_judge_sees_a_map_in_another_order) {
  const auto name = test::output_folder() / "wrong.e";
  const Mesh mesh = test::grid(4, 2, 2);
  write_parts(mesh, name, partition(mesh, 2, PartitionBy::slabs), 2);
  ASSERT_EQ(faults_text(name, 2), "");
  int file = 0, variable = 0;
  ASSERT_EQ(nc_open(part_name(name, 2, 1).c_str(), NC_WRITE, &file), NC_NOERR);
  ASSERT_EQ(nc_inq_varid(file, "n_comm_nids", &variable), NC_NOERR);
  std::vector<int> nodes(9);
  ASSERT_EQ(nc_get_var_int(file, variable, nodes.data()), NC_NOERR);
  std::swap(nodes[0], nodes[1]);
  ASSERT_EQ(nc_put_var_int(file, variable, nodes.data()), NC_NOERR);
  nc_close(file);
  EXPECT_EQ(faults_text(name, 2),
            "part 0: the maps of nodes for part 1 are in another order there\n"
            "part 1: the maps of nodes for part 0 are in another order there\n");
}

TEST(Split, all_time_steps_are_in_the_parts_and_joining_says_what_it_leaves_out) {
  const Mesh mesh = test::with_extras();
  const auto folder = test::output_folder();
  write_mesh(folder / "all.e", mesh, nullptr);
  split_file(folder / "all.e", folder / "all.e", 2, PartitionBy::slabs);
  EXPECT_EQ(faults_text(folder / "all.e", 2), "");
  const MeshFile part = read_mesh(folder / "all.e.2.1", "exodus");
  EXPECT_EQ(part.mesh.results->times, (std::vector<double>{0, 1, 2.5}));
  EXPECT_EQ(part.mesh.results->qa, mesh.results->qa);
  const MeshFile joined = read_parts(folder / "all.e.2.0");
  const Mesh whole = read_mesh(folder / "all.e").mesh;
  EXPECT_EQ(joined.mesh.fields[0], whole.fields[0]);
  ASSERT_FALSE(joined.notices.empty());
  EXPECT_NE(joined.notices.back().find("all.e: parts are joined without 2 more time steps, "), std::string::npos)
      << joined.notices.back();
}

TEST(Join, refuses_parts_that_do_not_belong_together) {
  const auto folder = test::output_folder();
  const auto split = [&](const Mesh& mesh, const char* name, int n) {
    write_parts(mesh, folder / name, partition(mesh, n, PartitionBy::slabs), n);
  };
  const auto said = [&](const char* part) {
    std::string text = test::error_of([&] { read_parts(folder / part); });
    for (std::size_t at; (at = text.find(folder.string() + "/")) != std::string::npos;)
      text.erase(at, folder.string().size() + 1);
    return text;
  };
  split(test::grid(4, 2, 2), "a.e", 2);
  split(test::grid(5, 2, 2), "b.e", 2);
  split(test::grid(4, 2, 2), "c.e", 4);
  EXPECT_EQ(said("a.e"), "a.e: parts are called name.e.8.0, name.e.8.1, ..., or name_1.msh, ... as Gmsh splits meshes");
  EXPECT_EQ(said("a.e.3.0"), "a.e.3.0: this part of 3 is missing");
  std::filesystem::copy(folder / "b.e.2.1", folder / "a.e.2.1", std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(said("a.e.2.0"), "a.e.2.1: is part of a mesh of 20 hexes and 54 nodes, a.e.2.0 of one of 16 and 45");
  std::filesystem::copy(folder / "c.e.4.1", folder / "a.e.2.1", std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(said("a.e.2.0"), "a.e.2.1: is one of 4 parts, not of 2");
  std::filesystem::copy(folder / "a.e.2.0", folder / "a.e.2.1", std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(said("a.e.2.0"), "hex 1 is in a.e.2.0 and in a.e.2.1");
  write_mesh(folder / "d.e", test::grid(4, 2, 2), nullptr);
  std::filesystem::copy(folder / "d.e", folder / "a.e.2.1", std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(said("a.e.2.0"), "a.e.2.1: does not say what it is a part of");
  std::filesystem::resize_file(folder / "b.e.2.1", 900);
  EXPECT_NE(said("b.e.2.0").find("b.e.2.1: "), std::string::npos);
  // The same counts, another place: of another run.
  Mesh moved = test::grid(4, 2, 2);
  for (Vec3& p : moved.points) p *= 2;
  split(moved, "e.e", 2);
  split(test::grid(4, 2, 2), "a.e", 2);
  std::filesystem::copy(folder / "e.e.2.1", folder / "a.e.2.1", std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(said("a.e.2.0"), "node 3 is at one place in a.e.2.0 and at another in a.e.2.1");
  // A part that is there twice under two names, the others missing: counts do not add up.
  Mesh two = test::grid(4, 2, 2);
  const std::vector<int> all_in_one(two.hexes.size(), 0);
  std::vector<int> parts(two.hexes.size(), 0);
  parts.back() = 1;
  write_parts(two, folder / "f.e", parts, 2);
  parts.assign(parts.size(), 0), parts[14] = 1;
  write_parts(two, folder / "g.e", parts, 2);
  std::filesystem::copy(folder / "g.e.2.1", folder / "f.e.2.1", std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(said("f.e.2.0"), "hex 15 is in f.e.2.0 and in f.e.2.1");
}

TEST(Join, nothing_is_written_where_a_part_can_not_be) {
  const auto folder = test::output_folder();
  write_mesh(folder / "a.e", test::grid(4, 2, 2), nullptr);
  EXPECT_THROW(split_file(folder / "a.e", folder / "none" / "b.e", 2, PartitionBy::slabs), Error);
  std::filesystem::create_directory(folder / "b.e.2.1");
  EXPECT_THROW(split_file(folder / "a.e", folder / "b.e", 2, PartitionBy::slabs), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "b.e.2.0"));
}

TEST(Split, second_order_is_refused) {
  const auto folder = test::output_folder();
  WriteOptions options;
  options.order = 2;
  write_mesh(folder / "a.e", test::grid(2, 2, 2), nullptr, options);
  EXPECT_NE(test::error_of([&] {
              split_file(folder / "a.e", folder / "b.e", 2, PartitionBy::slabs);
            }).find("a.e: hexes of 20 nodes are not split or joined; write it with 'set order 1' first"),
            std::string::npos);
}

}  // namespace
}  // namespace hextwist
