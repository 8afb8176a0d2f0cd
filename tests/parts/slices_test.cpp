// One file of the whole read in slices, and what is made of them.
#include <exodusII.h>

#include <random>

#include "hextwist/io/results.h"
#include "hextwist/io/slice.h"
#include "hextwist/parts/files.h"
#include "hextwist/parts/join.h"
#include "hextwist/parts/on_disk.h"
#include "hextwist/parts/own_part.h"
#include "hextwist/parts/split.h"
#include "hextwist/session/session.h"
#include "slices_support.h"
#include "split_judge.h"
#include "support/exodus_extras.h"
#include "support/meshed.h"
#include "support/seed.h"

namespace hextwist {
namespace {

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

/// What slices make: nodes of no hex are in none.
Mesh without_loose_nodes(Mesh mesh) {
  need_ids(mesh);
  const MeshedModel whole{std::move(mesh), nullptr, {}};
  Mesh part = Splitting(whole, std::vector<int>(whole.mesh.hexes.size(), 0), 1).part(0).mesh;
  const MeshedModel pieces[] = {{std::move(part), nullptr, {}}};
  return join(pieces, [](std::size_t) { return std::string("mesh"); }).mesh;
}

TEST(Slices, joined_are_what_is_read_at_once) {
  for (const std::string extension : {".e", ".vtu", ".msh", ".2.msh"})
    for (const unsigned seed : {1u, 2u, 3u, 4u})
      for (const bool gaps : {false, true})
        for (const int n : {1, 2, 3, 7, 200}) {
          SCOPED_TRACE(extension + ", seed " + std::to_string(seed) + ", " + std::to_string(n) + " slices");
          const auto file = test::output_folder() / ("rich" + extension);
          write_mesh(file, test::sliceable(seed, gaps, {6, 5, 4}), nullptr,
                     {.binary = seed % 2 == 0 || extension == ".vtu", .gmsh_version = extension == ".msh" ? 41 : 22});
          const Mesh whole = read_mesh(file).mesh;
          ASSERT_FALSE(whole.fields.empty() || whole.node_sets.empty() || whole.side_sets.empty());
          expect_slices_make(file, whole, n);
        }
}

TEST(Slices, of_vtu_tell_fields_that_are_called_like_ids_from_these) {
  const auto file = test::output_folder() / "ids.vtu";
  Mesh mesh = test::sliceable(5, true, {6, 5, 4});
  mesh.fields.push_back({"node_id", Field::On::node, 1, std::vector<double>(mesh.points.size(), 7)});
  mesh.fields.push_back({"hex_id", Field::On::hex, 1, std::vector<double>(mesh.hexes.size(), 8)});
  write_mesh(file, mesh, nullptr);
  const Mesh whole = read_mesh(file).mesh;
  EXPECT_EQ(whole.node_ids, mesh.node_ids);
  expect_slices_make(file, whole, 3);
  EXPECT_EQ(in_slices(file)->highest_node, mesh.node_ids.back());
}

/// What VTK writes in all its ways, and with blocks as others give them.
TEST(Slices, of_vtu_as_vtk_writes_it_are_what_is_read_at_once) {
  const auto folder = test::output_folder();
  write_mesh(folder / "ours.vtu", test::sliceable(3, true, {6, 5, 4}), nullptr);
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
    EXPECT_EQ(whole.blocks.size(), name.starts_with("ours") ? test::sliceable(3, true, {6, 5, 4}).blocks.size() : 3u);
    for (const int n : {1, 3, 8}) expect_slices_make(entry.path(), whole, n);
  }
  EXPECT_EQ(n_sliced, 64);
}

/// Files that others made, and those of the shipped models, which have curves, surfaces and two volumes.
TEST(Slices, of_real_files_are_what_is_read_at_once) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& folder :
       {std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models", std::filesystem::path(HEXTWIST_TEST_DATA)})
    if (std::filesystem::exists(folder))
      for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".msh" || entry.path().extension() == ".vtu") files.push_back(entry.path());
  int n_sliced = 0;
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    std::optional<SlicedFile> sliced;
    Mesh whole;
    try {
      sliced = in_slices(file);
      whole = read_mesh(file).mesh;
    } catch (const Error&) {
      EXPECT_FALSE(sliced);
      continue;
    }
    if (!sliced) continue;
    ++n_sliced;
    EXPECT_EQ(sliced->n_nodes, whole.n_nodes());
    EXPECT_EQ(sliced->n_hexes, whole.n_hexes());
    for (const int n : {2, 5}) expect_slices_make(file, without_loose_nodes(whole), n);
  }
  EXPECT_GT(n_sliced, 10);
}

/// Both ways round, between two volumes, in all orders of hexes: a side of the hex that it turns outwards from.
TEST(Slices, of_msh_have_quads_between_hexes_on_the_right_side) {
  const auto folder = test::output_folder();
  const unsigned seed = test::random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (int i = 0; i < 30; ++i) {
    Mesh mesh = test::grid(4, 3, 3);
    std::vector<Side> all;
    for (Index h = 0; h < mesh.n_hexes(); ++h)
      for (int f = 0; f < n_hex_faces; ++f) all.push_back({h, f});
    for (int id = 1; id < 4; ++id) {
      SideSet set{id, "", {}};
      for (const Side& side : all)
        if (random() % 5 == 0) set.sides.push_back(side);
      mesh.side_sets.push_back(set);
      NodeSet nodes{id, "", {}};
      for (Index n = 0; n < mesh.n_nodes(); ++n)
        if (random() % 5 == 0) nodes.nodes.push_back(n);
      mesh.node_sets.push_back(nodes);
    }
    write_mesh(folder / "sides.msh", mesh, nullptr, {.binary = i % 2 == 0, .gmsh_version = i % 4 < 2 ? 41 : 22});
    const Mesh whole = read_mesh(folder / "sides.msh").mesh;
    for (const int n : {2, 3, 9}) expect_slices_make(folder / "sides.msh", whole, n);
  }
}

TEST(Slices, of_msh_are_not_made_of_what_they_would_lose) {
  const auto folder = test::output_folder();
  const std::string head =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 1 1 1\n1 0 0 0 1 1 1 1 7 0\n1 0 0 0 1 1 1 1 8 0\n"
      "1 0 0 0 1 1 1 1 9 0\n$EndEntities\n$Nodes\n1 13 1 13\n3 1 0 13\n";
  std::string nodes;
  for (int i = 1; i <= 13; ++i) nodes += std::to_string(i) + "\n";
  for (int i = 0; i < 12; ++i)
    nodes += std::to_string(i % 2) + " " + std::to_string(i / 2 % 2) + " " + std::to_string(i / 4) + "\n";
  nodes += "9 9 9\n$EndNodes\n";
  const auto file_of = [&](const std::string& elements, const std::string& more = "") {
    return test::write_text(folder / "a.msh", head + nodes + "$Elements\n" + elements + "$EndElements\n" + more);
  };
  const std::string hexes = "3 1 5 2\n1 1 2 4 3 5 6 8 7\n2 5 6 8 7 9 10 12 11\n";
  const auto is_sliced = [&](const std::filesystem::path& file) {
    const bool sliced = in_slices(file).has_value();
    if (sliced)
      for (const int n : {1, 2}) expect_slices_make(file, without_loose_nodes(read_mesh(file).mesh), n);
    return sliced;
  };
  EXPECT_TRUE(is_sliced(file_of("1 2 1 2\n" + hexes)));
  EXPECT_TRUE(is_sliced(file_of("2 3 1 3\n2 1 3 1\n3 5 6 8 7\n" + hexes))) << "a quad between both";
  EXPECT_TRUE(is_sliced(file_of("2 3 1 3\n2 1 3 1\n3 7 8 6 5\n" + hexes))) << "the other way round";
  EXPECT_TRUE(is_sliced(file_of("2 4 1 4\n1 1 1 2\n3 1 5\n4 5 9\n" + hexes))) << "lines with a node in common";
  EXPECT_FALSE(is_sliced(file_of("2 3 1 3\n2 1 3 1\n3 1 2 8 7\n" + hexes))) << "a quad that is no side";
  EXPECT_FALSE(is_sliced(file_of("2 3 1 3\n1 1 1 1\n3 1 4\n" + hexes))) << "a line that is no edge";
  EXPECT_FALSE(is_sliced(file_of("2 3 1 3\n2 1 2 1\n3 1 2 3\n" + hexes))) << "a triangle";
  EXPECT_FALSE(is_sliced(file_of("1 2 1 2000000000\n3 1 5 2\n1 1 2 4 3 5 6 8 7\n2000000000 5 6 8 7 9 10 12 11\n")))
      << "tags far apart";
  const auto data = [](const std::string& kind, const std::string& tags) {
    return "$" + kind + "\n1\n\"v\"\n1\n0\n3\n0\n1\n" + tags + "\n$End" + kind + "\n";
  };
  const std::string with_quad = "2 3 1 3\n2 1 3 1\n3 1 2 4 3\n" + hexes;
  EXPECT_TRUE(is_sliced(file_of(with_quad, data("ElementData", "2\n2 1.5\n1 4"))));
  std::string of_nodes = "13";
  for (int i = 13; i > 0; --i) of_nodes += "\n" + std::to_string(i) + " " + std::to_string(i * i);
  EXPECT_TRUE(is_sliced(file_of(with_quad, data("NodeData", of_nodes))));
  EXPECT_FALSE(is_sliced(file_of(with_quad, data("ElementData", "1\n3 1.5")))) << "values of a quad";
  // Damage is found by the slice that has it.
  const auto damaged = file_of("1 2 1 2\n3 1 5 2\n1 1 2 4 3 5 6 8 7\n2 5 6 8 7 9 10 12 77\n");
  const std::optional<SlicedFile> sliced = in_slices(damaged);
  ASSERT_TRUE(sliced);
  const std::string at_once = test::error_of([&] { read_mesh(damaged); });
  EXPECT_NE(at_once.find("names node 77"), std::string::npos) << at_once;
  EXPECT_EQ(test::error_of([&] { read_slice(*sliced, 1, 2); }), at_once);
  EXPECT_EQ(test::error_of([&] { read_slice(*sliced, 0, 2); }), "no error") << "not its business";
}

TEST(Slices, of_old_msh_are_not_made_of_what_they_would_lose) {
  const auto folder = test::output_folder();
  std::string coordinates;
  for (int i = 0; i < 12; ++i)
    coordinates += std::to_string(i + 1) + " " + std::to_string(i % 2) + " " + std::to_string(i / 2 % 2) + " " +
                   std::to_string(i / 4) + "\n";
  coordinates += "13 9 9 9\n";
  const std::string lower = " 1 2 4 3 5 6 8 7\n", upper = " 5 6 8 7 9 10 12 11\n";
  const auto is_sliced = [&](const std::string& text) {
    const auto file = test::write_text(folder / "a.msh", text);
    const bool sliced = in_slices(file).has_value();
    if (sliced)
      for (const int n : {1, 2}) expect_slices_make(file, without_loose_nodes(read_mesh(file).mesh), n);
    return sliced;
  };
  const auto two = [&](const std::string& elements) {
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n13\n" + coordinates + "$EndNodes\n$Elements\n" + elements +
           "$EndElements\n";
  };
  EXPECT_TRUE(is_sliced(two("2\n1 5 2 1 1" + lower + "2 5 2 2 2" + upper)));
  EXPECT_TRUE(is_sliced(two("4\n1 5 2 1 1" + lower + "2 5 2 1 1" + upper + "3 3 2 -7 4 5 6 8 7\n4 15 2 3 1 5\n")));
  EXPECT_TRUE(is_sliced(two("4\n3 3 2 7 4 1 2 4 3\n4 3 2 8 4 1 2 4 3\n1 5 2 1 1" + lower + "2 5 2 1 1" + upper)))
      << "a quad in two groups";
  EXPECT_FALSE(is_sliced(two("3\n1 5 2 1 1" + lower + "2 5 2 1 1" + upper + "3 5 2 2 1" + lower)))
      << "a hex in two groups";
  EXPECT_FALSE(is_sliced(two("3\n1 5 2 1 1" + lower + "2 5 2 1 1" + upper + "3 2 2 7 4 1 2 4\n"))) << "a triangle";
  EXPECT_FALSE(is_sliced(two("3\n1 5 2 1 1" + lower + "2 5 2 1 1" + upper + "3 3 2 7 4 1 2 8 7\n"))) << "no side";
  const auto one = [&](const std::string& elements) {
    return "$NOD\n13\n" + coordinates + "$ENDNOD\n$ELM\n" + elements + "$ENDELM\n";
  };
  EXPECT_TRUE(is_sliced(one("3\n1 5 1 1 8" + lower + "2 5 1 1 8" + upper + "3 3 7 4 4 1 2 4 3\n")));
  EXPECT_FALSE(is_sliced(one("3\n1 5 1 1 8" + lower + "2 5 1 1 8" + upper + "3 2 7 4 3 1 2 4\n")));
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
  const std::size_t at = text.find("Name=\"connectivity\""), offset_at = text.find("offset=\"", at) + 8;
  const std::size_t data = text.find('_', text.find("<AppendedData")) + 1 + std::stoul(text.substr(offset_at));
  const std::int32_t wrong = 77;
  std::memcpy(&text[data + 8 + 4 * (8 * 23 + 3)], &wrong, sizeof wrong);
  test::write_text(folder / "damaged.vtu", text);
  const std::string at_once = test::error_of([&] { read_mesh(folder / "damaged.vtu"); });
  EXPECT_EQ(at_once, (folder / "damaged.vtu").string() + ": cell 24 names point 77 of 60 (counted from 0)");
  const std::optional<SlicedFile> sliced = in_slices(folder / "damaged.vtu");
  ASSERT_TRUE(sliced);
  EXPECT_EQ(test::error_of([&] { read_slice(*sliced, 1, 2); }), at_once);
  EXPECT_EQ(test::error_of([&] { read_slice(*sliced, 0, 2); }), "no error") << "not its business";
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
  write_mesh(folder / "grid.bdf", test::grid(4, 3, 2), nullptr);
  EXPECT_FALSE(in_slices(folder / "grid.bdf"));
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
  const std::optional<SlicedFile> sliced = in_slices(folder / "damaged.e");
  ASSERT_TRUE(sliced);
  const std::string at_once = test::error_of([&] { read_mesh(folder / "damaged.e"); });
  EXPECT_EQ(at_once, (folder / "damaged.e").string() + ": element 24 names node 61 of 60");
  EXPECT_EQ(test::error_of([&] { read_slice(*sliced, 1, 2); }), at_once);
  EXPECT_EQ(test::error_of([&] { read_slice(*sliced, 0, 2); }), "no error") << "not its business";
}

TEST(Slices, a_file_is_divided_as_in_memory) {
  const auto folder = test::output_folder();
  for (const bool gaps : {false, true})
    for (const PartitionBy by : {PartitionBy::boxes, PartitionBy::slabs, PartitionBy::ids, PartitionBy::random}) {
      const Mesh mesh = test::sliceable(5, gaps, {7, 5, 4});
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
  const std::string commands = "refine surface 2 depth 1; refine surface 3";
  OnDiskOptions options;
  for (const std::string extension : {".e", ".vtu", ".msh"}) {
    SCOPED_TRACE(extension);
    const auto whole = folder / ("whole" + extension);
    write_mesh(whole, session.meshed().mesh, nullptr);
    Session again;
    again.import_mesh(whole);
    again.run(commands);
    again.export_mesh(folder / "serial.e");
    options.n_parts = 3;
    options.by = PartitionBy::ids;
    refine_on_disk(whole, PartCommands(std::vector{commands}), folder / "fine.e", options, [](const std::string&) {});
    EXPECT_EQ(faults_text(folder / "fine.e", 3), "");
    join_files(part_name(folder / "fine.e", 3, 0), folder / "joined.e");
    EXPECT_TRUE(test::text_of(folder / "joined.e") == test::text_of(folder / "serial.e"));
  }
  options.n_parts = 500;
  try {
    refine_on_disk(folder / "whole.e", PartCommands(std::vector{commands}), folder / "no.e", options,
                   [](const std::string&) {});
    ADD_FAILURE() << "more parts than hexes";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "a mesh of 360 hexes has no 500 parts");
  }
}

}  // namespace
}  // namespace hextwist
