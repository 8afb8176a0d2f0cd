// Parts joined to a file one at a time.
#include <random>
#include <regex>

#include "hextwist/parts/files.h"
#include "hextwist/parts/id_set.h"
#include "hextwist/parts/join_on_disk.h"
#include "hextwist/parts/own_part.h"
#include "hextwist/parts/split.h"
#include "slices_support.h"

namespace hextwist {
namespace {

/// Divides a mesh and writes the parts; pieces that differ are made of each part first.
void write_parts(const Mesh& mesh, const std::filesystem::path& name, int n, PartitionBy by,
                 const std::function<void(int, Mesh&)>& change = {}) {
  const MeshedModel whole{mesh, nullptr, {}};
  const std::vector<int> part_of_hex = partition(whole.mesh, n, by);
  const Splitting splitting(whole, part_of_hex, n);
  PartOutput files(name, n);
  std::vector<std::string> notices;
  for (int p = 0; p < n; ++p) {
    MeshPart part = splitting.part(p);
    if (change) change(p, part.mesh);
    files.write({std::move(part.mesh), {}, std::move(part.file), {}}, notices);
  }
  files.commit();
}

/// Joined a part at a time and all at once: the same file, and the same words.
void expect_joined_alike(const std::filesystem::path& name, int n, const std::string& extension = ".e") {
  const auto folder = name.parent_path();
  const SplitName split{name, n};
  const auto lines = join_on_disk(split, folder / ("sliced" + extension), {});
  ASSERT_TRUE(lines);
  MeshFile at_once = read_parts(part_name(name, n, 0));
  std::vector<std::string> told = at_once.notices;
  for (std::string& line : write_mesh(folder / ("at_once" + extension), at_once.mesh, nullptr)) told.push_back(line);
  told.push_back(joined_text(at_once.mesh.n_hexes(), at_once.mesh.n_nodes(), n));
  EXPECT_EQ(*lines, told);
  EXPECT_TRUE(test::text_of(folder / ("sliced" + extension)) == test::text_of(folder / ("at_once" + extension)));
}

TEST(JoinOnDisk, parts_are_joined_one_at_a_time_as_in_memory) {
  const auto folder = test::output_folder();
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u, 6u})
    for (const bool gaps : {false, true})
      for (const PartitionBy by : {PartitionBy::boxes, PartitionBy::ids, PartitionBy::random}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + (gaps ? ", gaps" : ""));
        write_parts(test::sliceable(seed, gaps, {7, 5, 4}), folder / "parts.e", 5, by);
        expect_joined_alike(folder / "parts.e", 5, seed % 2 ? ".e" : ".g");
      }
}

TEST(JoinOnDisk, parts_that_lack_fields_or_groups_are_joined_as_in_memory) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::sliceable(3, true, {7, 5, 4});
  ASSERT_GT(mesh.fields.size(), 1u);
  for (const int lacks : {0, 1, 2}) {
    write_parts(mesh, folder / "lacks.e", 3, PartitionBy::slabs, [&](int p, Mesh& part) {
      if (p != lacks) return;
      part.fields.clear();
      for (NodeSet& set : part.node_sets) set.nodes.clear();
    });
    expect_joined_alike(folder / "lacks.e", 3);
  }
}

TEST(JoinOnDisk, parts_of_gmsh_are_joined_one_at_a_time) {
  const auto folder = test::output_folder();
  Mesh mesh = test::sliceable(2, false, {6, 4, 4});
  mesh.fields.clear();
  mesh.side_sets.clear();
  write_parts(mesh, folder / "gmsh.msh", 3, PartitionBy::boxes);
  expect_joined_alike(folder / "gmsh.msh", 3);
}

TEST(JoinOnDisk, wide_ids_are_joined_one_at_a_time) {
  const auto folder = test::output_folder();
  Mesh mesh = test::sliceable(4, false, {6, 4, 4});
  need_ids(mesh);
  for (std::int64_t& id : mesh.node_ids) id += std::int64_t{1} << 33;
  for (std::int64_t& id : mesh.hex_ids) id += std::int64_t{1} << 33;
  write_parts(mesh, folder / "wide.e", 4, PartitionBy::boxes);
  ASSERT_TRUE(join_on_disk({folder / "wide.e", 4}, folder / "sliced.e", {}));
  const Mesh at_once = read_parts(folder / "wide.e.4.0").mesh, sliced = read_mesh(folder / "sliced.e").mesh;
  EXPECT_TRUE(test::same_mesh(sliced, at_once));
  EXPECT_EQ(sliced.hex_ids.back(), mesh.hex_ids.back());
}

TEST(JoinOnDisk, what_has_to_be_joined_in_memory_is) {
  const auto folder = test::output_folder();
  const Mesh grid = test::grid(4, 3, 3);
  Mesh overlapping = grid, far = grid;
  overlapping.blocks = {{1, "", {0, 1, 2, 3}}, {2, "", {3, 4}}};
  need_ids(far);
  far.hex_ids.back() = std::int64_t{1} << 41;
  for (const auto& [name, mesh] : {std::pair("overlapping.e", &overlapping), {"far.e", &far}}) {
    write_parts(*mesh, folder / name, 2, PartitionBy::ids);
    EXPECT_FALSE(join_on_disk({folder / name, 2}, folder / "joined.e", {})) << name;
    std::filesystem::remove(folder / "joined.e");
    join_files(part_name(folder / name, 2, 0), folder / "joined.e");
    EXPECT_EQ(read_mesh(folder / "joined.e").mesh.n_hexes(), 36);
  }
  write_parts(grid, folder / "grid.e", 2, PartitionBy::ids);
  EXPECT_FALSE(join_on_disk({folder / "grid.e", 2}, folder / "joined.vtu", {}));
}

TEST(JoinOnDisk, parts_that_do_not_fit_are_refused_and_nothing_is_written) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::grid(4, 3, 2);
  const auto error_of = [&](const auto& join_them) {
    return std::regex_replace(test::error_of(join_them), std::regex(folder.string() + "/"), "");
  };
  const auto said = [&](const std::string& name) {
    const auto first = part_name(folder / name, 3, 0);
    const std::string text = error_of([&] { join_files(first, folder / "refused.e"); });
    EXPECT_EQ(text, error_of([&] { read_parts(first); })) << "as in memory";
    return text;
  };
  write_parts(mesh, folder / "moved.e", 3, PartitionBy::ids, [](int p, Mesh& part) {
    if (p == 2)
      for (Vec3& point : part.points) point.z() += 1;
  });
  EXPECT_EQ(said("moved.e"), "node 26 is at one place in moved.e.3.1 and at another in moved.e.3.2");
  write_parts(mesh, folder / "twice.e", 3, PartitionBy::ids, [](int p, Mesh& part) {
    if (p == 1) part.hex_ids.front() = 3;
  });
  EXPECT_EQ(said("twice.e"), "hex 3 is in twice.e.3.0 and in twice.e.3.1");
  write_parts(mesh, folder / "missing.e", 3, PartitionBy::ids);
  std::filesystem::remove(folder / "missing.e.3.2");
  EXPECT_EQ(said("missing.e"), "missing.e.3.2: this part of 3 is missing");
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    EXPECT_FALSE(entry.path().filename().string().starts_with("refused") || entry.path().extension() == ".part")
        << entry.path();
}

TEST(IdSet, knows_places_and_walks) {
  std::mt19937 random(7);
  for (const std::int64_t spread : {1, 3, 1000, 100000}) {
    IdSet set;
    std::vector<std::int64_t> ids;
    for (int i = 0; i < 3000; ++i) {
      const std::int64_t id =
          static_cast<std::int64_t>(random() % 3000) * spread + static_cast<std::int64_t>(random() % 2);
      const bool is_new = std::ranges::find(ids, id) == ids.end();
      EXPECT_EQ(set.add(id), is_new);
      if (is_new) ids.push_back(id);
    }
    std::ranges::sort(ids);
    EXPECT_EQ(set.size(), std::ssize(ids));
    EXPECT_EQ(set.highest(), ids.back());
    EXPECT_FALSE(set.is_sparse());
    IdSet::Walk walk(set);
    for (const std::int64_t id : ids) EXPECT_EQ(walk.next(), id);
    EXPECT_EQ(walk.next(), -1);
    std::vector<std::int64_t> asked;
    std::vector<Index> places;
    for (std::size_t i = 0; i < ids.size(); i += 1 + random() % 9)
      for (const bool is_there : {true, false}) {
        const std::int64_t id = ids[i] + !is_there;
        if (!is_there && i + 1 < ids.size() && ids[i + 1] == id) continue;
        asked.push_back(id);
        places.push_back(is_there ? static_cast<Index>(i) : -1);
      }
    EXPECT_EQ(set.places(asked), places);
    set.add(std::int64_t{1} << 40);
    EXPECT_TRUE(set.is_sparse());
  }
}

}  // namespace
}  // namespace hextwist
