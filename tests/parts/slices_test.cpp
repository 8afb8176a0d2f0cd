// One file of the whole read in slices, and what is made of them.
#include <exodusII.h>

#include <random>
#include <regex>

#include "hextwist/io/results.h"
#include "hextwist/io/slice.h"
#include "hextwist/parts/files.h"
#include "hextwist/parts/id_set.h"
#include "hextwist/parts/join.h"
#include "hextwist/parts/join_on_disk.h"
#include "hextwist/parts/on_disk.h"
#include "hextwist/parts/own_part.h"
#include "hextwist/parts/split.h"
#include "hextwist/session/session.h"
#include "io/io_support.h"
#include "split_judge.h"
#include "support/exodus_extras.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

/// Blocks that do not overlap, sets, fields.
Mesh sliceable(unsigned seed, bool gaps, const std::array<int, 3>& n) {
  Mesh mesh = test::rich_mesh(seed, gaps, n);
  std::vector<std::uint8_t> has(mesh.hexes.size(), 0);
  for (Block& block : mesh.blocks) std::erase_if(block.hexes, [&](Index h) { return has[h]++ > 0; });
  return mesh;
}

std::string faults_text(const std::filesystem::path& name, int n_parts) {
  std::string text;
  for (const std::string& line : test::split_faults(name, n_parts)) text += line + "\n";
  return text;
}

std::vector<MeshedModel> slices_of(const std::filesystem::path& file, int n) {
  std::vector<MeshedModel> slices;
  const std::optional<SlicedFile> sliced = in_slices(file);
  EXPECT_TRUE(sliced);
  for (int s = 0; sliced && s < n; ++s) {
    MeshSlice slice = read_slice(*sliced, s, n);
    need_ids(slice.file.mesh);
    slice.file.mesh.results = nullptr;
    slices.push_back({std::move(slice.file.mesh), nullptr, {}});
  }
  return slices;
}

void expect_slices_make(const std::filesystem::path& file, const Mesh& whole, int n) {
  const std::vector<MeshedModel> slices = slices_of(file, n);
  for (const MeshedModel& slice : slices) {
    EXPECT_LE(slice.mesh.n_hexes(), whole.n_hexes() / n + 1);
    if (slice.mesh.n_hexes() == 0) continue;
    EXPECT_EQ(slice.mesh.fields.size(), whole.fields.size()) << "also in a slice that has none of its values";
    EXPECT_EQ(slice.mesh.blocks.size(), whole.blocks.size());
  }
  EXPECT_TRUE(test::same_mesh(whole, join(slices, [](std::size_t) { return std::string("slice"); }).mesh));
}

TEST(Slices, joined_are_what_is_read_at_once) {
  for (const std::string extension : {".e", ".vtu"})
    for (const unsigned seed : {1u, 2u, 3u, 4u})
      for (const bool gaps : {false, true})
        for (const int n : {1, 2, 3, 7, 200}) {
          SCOPED_TRACE(extension + ", seed " + std::to_string(seed) + ", " + std::to_string(n) + " slices");
          const auto file = test::output_folder() / ("rich" + extension);
          write_mesh(file, sliceable(seed, gaps, {6, 5, 4}), nullptr);
          const Mesh whole = read_mesh(file).mesh;
          ASSERT_FALSE(whole.fields.empty() || whole.node_sets.empty() || whole.side_sets.empty());
          expect_slices_make(file, whole, n);
        }
}

/// What VTK writes in all its ways, and with blocks as others give them.
TEST(Slices, of_vtu_as_vtk_writes_it_are_what_is_read_at_once) {
  const auto folder = test::output_folder();
  write_mesh(folder / "ours.vtu", sliceable(3, true, {6, 5, 4}), nullptr);
  const bool there = test::vtk_python(folder, "folder = '" + folder.string() + R"('
import vtk
reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(folder + '/ours.vtu')
reader.Update()
ours = reader.GetOutput()
theirs = vtk.vtkUnstructuredGrid()
theirs.CopyStructure(ours)
material = vtk.vtkIntArray()
material.SetName('MaterialID')
speed = vtk.vtkFloatArray()
speed.SetName('speed')
speed.SetNumberOfComponents(3)
for i in range(ours.GetNumberOfCells()):
    material.InsertNextValue(9 if i == 2 else 4 if i > 50 else 0 if i == 7 else 3)
for i in range(ours.GetNumberOfPoints()):
    speed.InsertNextTuple3(i, i / 7, -i)
theirs.GetCellData().AddArray(material)
theirs.GetPointData().AddArray(speed)
for name, grid in (('ours', ours), ('theirs', theirs)):
    write_all_ways(grid, folder + '/' + name + '_')
)");
  if (!there) GTEST_SKIP() << "no python3 with VTK";
  int n_sliced = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const auto name = entry.path().filename().string();
    if (!name.starts_with("ours_") && !name.starts_with("theirs_")) continue;
    SCOPED_TRACE(name);
    if (name.find("Ascii") != std::string::npos) {
      EXPECT_FALSE(in_slices(entry.path()));
      continue;
    }
    ++n_sliced;
    const Mesh whole = read_mesh(entry.path()).mesh;
    EXPECT_EQ(whole.blocks.size(), name.starts_with("ours") ? sliceable(3, true, {6, 5, 4}).blocks.size() : 3u);
    for (const int n : {1, 3, 8}) expect_slices_make(entry.path(), whole, n);
  }
  EXPECT_EQ(n_sliced, 64);
}

TEST(Slices, of_vtu_are_not_made_of_what_they_would_lose) {
  const auto folder = test::output_folder();
  const Mesh grid = test::grid(4, 3, 2);
  write_mesh(folder / "text.vtu", grid, nullptr, {.binary = false});
  EXPECT_FALSE(in_slices(folder / "text.vtu"));
  write_mesh(folder / "whole.vtu", grid, nullptr);
  ASSERT_TRUE(in_slices(folder / "whole.vtu"));
  Session session;
  session.run("create brick x 3 interval 3");
  session.run("set order 2");
  session.export_mesh(folder / "second.vtu");
  EXPECT_FALSE(in_slices(folder / "second.vtu"));
  // Damage is found by the slice that has it, in the same words.
  std::string text = test::text_of(folder / "whole.vtu");
  const auto error_of = [&](const auto& read) -> std::string {
    try {
      read();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  const std::size_t at = text.find("Name=\"connectivity\""), offset_at = text.find("offset=\"", at) + 8;
  const std::size_t data = text.find('_', text.find("<AppendedData")) + 1 + std::stoul(text.substr(offset_at));
  const std::int32_t wrong = 77;
  std::memcpy(&text[data + 8 + 4 * (8 * 23 + 3)], &wrong, sizeof wrong);
  test::write_text(folder / "damaged.vtu", text);
  const std::string at_once = error_of([&] { read_mesh(folder / "damaged.vtu"); });
  EXPECT_EQ(at_once, (folder / "damaged.vtu").string() + ": cell 24 names point 77 of 60 (counted from 0)");
  const std::optional<SlicedFile> sliced = in_slices(folder / "damaged.vtu");
  ASSERT_TRUE(sliced);
  EXPECT_EQ(error_of([&] { read_slice(*sliced, 1, 2); }), at_once);
  EXPECT_EQ(error_of([&] { read_slice(*sliced, 0, 2); }), "no error") << "not its business";
}

TEST(Slices, are_not_made_of_what_they_would_lose) {
  const auto folder = test::output_folder();
  write_mesh(folder / "far.e", test::grid(4, 3, 2), nullptr);
  EXPECT_TRUE(in_slices(folder / "far.e"));
  // An id that only a table of 8 GB would show to be there once.
  float version = 0;
  int memory = 8, disk = 0;
  const int file = ex_open((folder / "far.e").c_str(), EX_WRITE, &memory, &disk, &version);
  std::vector<int> ids(60);
  std::iota(ids.begin(), ids.end(), 1);
  ids[58] = 2'000'000'000;
  ASSERT_GE(ex_put_id_map(file, EX_NODE_MAP, ids.data()), 0);
  ex_close(file);
  EXPECT_FALSE(in_slices(folder / "far.e"));
  write_mesh(folder / "grid.msh", test::grid(4, 3, 2), nullptr);
  EXPECT_FALSE(in_slices(folder / "grid.msh"));
  Session session;
  session.run("create brick x 3 interval 3");
  session.run("set order 2");
  session.export_mesh(folder / "second.e");
  EXPECT_FALSE(in_slices(folder / "second.e"));
  write_mesh(folder / "extras.e", test::with_extras(), nullptr);
  const std::optional<SlicedFile> sliced = in_slices(folder / "extras.e");
  ASSERT_TRUE(sliced);
  const MeshSlice extras = read_slice(*sliced, 1, 2);
  EXPECT_NE(extras.left_out.find("2 more time steps"), std::string::npos) << extras.left_out;
  EXPECT_FALSE(extras.file.mesh.results->qa.empty());
  // Another mesh under the same name meanwhile.
  write_mesh(folder / "extras.e", test::grid(4, 3, 2), nullptr, {.overwrite = true});
  try {
    read_slice(*sliced, 0, 2);
    ADD_FAILURE() << "the file was changed";
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), (folder / "extras.e").string() + ": was changed while it was read");
  }
}

TEST(Slices, a_damaged_file_is_refused_as_at_once) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(4, 3, 2);
  write_mesh(folder / "damaged.e", mesh, nullptr);
  float version = 0;
  int memory = 8, disk = 0;
  const int file = ex_open((folder / "damaged.e").c_str(), EX_WRITE, &memory, &disk, &version);
  std::vector<int> nodes(static_cast<std::size_t>(8 * mesh.n_hexes()));
  std::vector<std::int64_t> blocks(1);
  ex_set_int64_status(file, EX_IDS_INT64_API);
  ASSERT_GE(ex_get_ids(file, EX_ELEM_BLOCK, blocks.data()), 0);
  ASSERT_GE(ex_get_conn(file, EX_ELEM_BLOCK, blocks[0], nodes.data(), nullptr, nullptr), 0);
  nodes.back() = 61;
  ASSERT_GE(ex_put_conn(file, EX_ELEM_BLOCK, blocks[0], nodes.data(), nullptr, nullptr), 0);
  ex_close(file);
  const auto said = [&](const auto& read) -> std::string {
    try {
      read();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  const std::optional<SlicedFile> sliced = in_slices(folder / "damaged.e");
  ASSERT_TRUE(sliced);
  const std::string at_once = said([&] { read_mesh(folder / "damaged.e"); });
  EXPECT_EQ(at_once, (folder / "damaged.e").string() + ": element 24 names node 61 of 60");
  EXPECT_EQ(said([&] { read_slice(*sliced, 1, 2); }), at_once);
  EXPECT_EQ(said([&] { read_slice(*sliced, 0, 2); }), "no error") << "not its business";
}

TEST(Slices, a_file_is_divided_as_in_memory) {
  const auto folder = test::output_folder();
  for (const bool gaps : {false, true})
    for (const PartitionBy by : {PartitionBy::boxes, PartitionBy::slabs, PartitionBy::ids, PartitionBy::random}) {
      const Mesh mesh = sliceable(5, gaps, {7, 5, 4});
      write_mesh(folder / "whole.e", mesh, nullptr);
      OnDiskOptions options;
      options.n_parts = 5;
      options.by = by;
      std::vector<std::string> lines;
      ASSERT_TRUE(split_on_disk(folder / "whole.e", folder / "sliced.e", options,
                                [&](const std::string& line) { lines.push_back(line); }));
      EXPECT_EQ(faults_text(folder / "sliced.e", 5), "");
      const MeshedModel whole{read_mesh(folder / "whole.e").mesh, nullptr, {}};
      const std::vector<int> part_of_hex = partition(whole.mesh, 5, by);
      const Splitting splitting(whole, part_of_hex, 5);
      PartOutput files(folder / "at_once.e", 5);
      std::vector<std::string> notices;
      for (int p = 0; p < 5; ++p) {
        MeshPart part = splitting.part(p);
        files.write({std::move(part.mesh), {}, std::move(part.file), {}}, notices);
      }
      files.commit();
      for (int p = 0; p < 5; ++p)
        EXPECT_TRUE(test::text_of(part_name(folder / "sliced.e", 5, p)) ==
                    test::text_of(part_name(folder / "at_once.e", 5, p)))
            << "part " << p;
      ASSERT_FALSE(lines.empty());
      EXPECT_EQ(lines.back().substr(0, lines.back().find(" of at")), "140 hexes in 5 parts");
    }
}

TEST(Slices, nodes_of_no_hex_are_told) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(5, 2, 2);
  mesh.points.emplace_back(9, 9, 9);
  write_mesh(folder / "loose.e", mesh, nullptr);
  OnDiskOptions options;
  options.n_parts = 3;
  std::string lines;
  split_on_disk(folder / "loose.e", folder / "parts.e", options,
                [&](const std::string& line) { lines += line + "\n"; });
  EXPECT_NE(lines.find("left out 1 node of no hex"), std::string::npos) << lines;
}

TEST(Slices, a_file_of_the_whole_is_refined_part_after_part_as_at_once) {
  const auto folder = test::output_folder();
  Session session;
  session.run("create brick x 4 y 3 z 2 interval 12 6 5; nodeset 7 add surface 1 2; sideset 3 add surface 5");
  session.export_mesh(folder / "whole.e");
  Session again;
  again.import_mesh(folder / "whole.e");
  const std::string commands = "refine surface 2 depth 1; refine surface 3";
  again.run(commands);
  again.export_mesh(folder / "serial.e");
  OnDiskOptions options;
  options.n_parts = 3;
  options.by = PartitionBy::ids;
  refine_on_disk(folder / "whole.e", PartCommands(std::vector{commands}), folder / "fine.e", options,
                 [](const std::string&) {});
  EXPECT_EQ(faults_text(folder / "fine.e", 3), "");
  join_files(part_name(folder / "fine.e", 3, 0), folder / "joined.e");
  EXPECT_TRUE(test::text_of(folder / "joined.e") == test::text_of(folder / "serial.e"));
  options.n_parts = 500;
  try {
    refine_on_disk(folder / "whole.e", PartCommands(std::vector{commands}), folder / "no.e", options,
                   [](const std::string&) {});
    ADD_FAILURE() << "more parts than hexes";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "a mesh of 360 hexes has no 500 parts");
  }
}

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

TEST(Slices, parts_are_joined_one_at_a_time_as_in_memory) {
  const auto folder = test::output_folder();
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u, 6u})
    for (const bool gaps : {false, true})
      for (const PartitionBy by : {PartitionBy::boxes, PartitionBy::ids, PartitionBy::random}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + (gaps ? ", gaps" : ""));
        write_parts(sliceable(seed, gaps, {7, 5, 4}), folder / "parts.e", 5, by);
        expect_joined_alike(folder / "parts.e", 5, seed % 2 ? ".e" : ".g");
      }
}

TEST(Slices, parts_that_lack_fields_or_groups_are_joined_as_in_memory) {
  const auto folder = test::output_folder();
  const Mesh mesh = sliceable(3, true, {7, 5, 4});
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

TEST(Slices, parts_of_gmsh_are_joined_one_at_a_time) {
  const auto folder = test::output_folder();
  Mesh mesh = sliceable(2, false, {6, 4, 4});
  mesh.fields.clear();
  mesh.side_sets.clear();
  write_parts(mesh, folder / "gmsh.msh", 3, PartitionBy::boxes);
  expect_joined_alike(folder / "gmsh.msh", 3);
}

TEST(Slices, wide_ids_are_joined_one_at_a_time) {
  const auto folder = test::output_folder();
  Mesh mesh = sliceable(4, false, {6, 4, 4});
  need_ids(mesh);
  for (std::int64_t& id : mesh.node_ids) id += std::int64_t{1} << 33;
  for (std::int64_t& id : mesh.hex_ids) id += std::int64_t{1} << 33;
  write_parts(mesh, folder / "wide.e", 4, PartitionBy::boxes);
  ASSERT_TRUE(join_on_disk({folder / "wide.e", 4}, folder / "sliced.e", {}));
  const Mesh at_once = read_parts(folder / "wide.e.4.0").mesh, sliced = read_mesh(folder / "sliced.e").mesh;
  EXPECT_TRUE(test::same_mesh(sliced, at_once));
  EXPECT_EQ(sliced.hex_ids.back(), mesh.hex_ids.back());
}

TEST(Slices, what_has_to_be_joined_in_memory_is) {
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

TEST(Slices, parts_that_do_not_fit_are_refused_and_nothing_is_written) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::grid(4, 3, 2);
  const auto error_of = [&](const auto& join_them) -> std::string {
    try {
      join_them();
    } catch (const Error& error) {
      return std::regex_replace(error.what(), std::regex(folder.string() + "/"), "");
    }
    return "joined";
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
