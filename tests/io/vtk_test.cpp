#include "hextwist/mesh/others.h"
#include "io/io_support.h"
#include "support/seed.h"

namespace hextwist {
namespace {

TEST(vtk_files, a_mesh_with_everything_comes_back_bit_for_bit) {
  for (const bool binary : {false, true})
    for (unsigned seed = 1; seed < 5; ++seed) {
      SCOPED_TRACE(testing::Message() << binary << " " << seed);
      const Mesh mesh = test::rich_mesh(seed, seed % 2);
      const auto tags = test::brick_association(mesh, Vec3(4, 3, 3));
      const auto file = test::output_folder() / "mesh.vtu";
      WriteOptions options;
      options.binary = binary;
      write_mesh(file, mesh, &tags, options);
      // Fields come back in the order point data, cell data.
      const auto back = read_mesh(file);
      EXPECT_TRUE(test::same_mesh(mesh, back.mesh));
      EXPECT_TRUE(test::same_owners(tags, back.tags));
      write_mesh(file, mesh, nullptr, options);
      EXPECT_TRUE(test::same_mesh(mesh, read_mesh(file).mesh));
      EXPECT_TRUE(read_mesh(file).tags.empty());
    }
}

TEST(vtk_files, a_field_named_like_one_of_ours_stays_a_field) {
  Mesh mesh = test::grid(2, 1, 1);
  mesh.fields = {{"shape", Field::On::hex, 1, {4, 5}}, {"a<b & \"c\"", Field::On::hex, 2, {1, 2, 3, 4}}};
  mesh.node_sets = {{1, "x < y & \"z\"", {0}}};
  const auto file = test::output_folder() / "mesh.vtu";
  write_mesh(file, mesh, nullptr);
  EXPECT_TRUE(test::same_mesh(mesh, read_mesh(file).mesh));
}

TEST(vtk_files, vtk_reads_what_we_write_and_we_read_what_vtk_writes) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::rich_mesh(3, true);
  const auto tags = test::brick_association(mesh, Vec3(4, 3, 3));
  WriteOptions options;
  write_mesh(folder / "binary.vtu", mesh, &tags, options);
  options.binary = false;
  write_mesh(folder / "text.vtu", mesh, &tags, options);
  const bool there = test::vtk_python(folder, "folder = '" + folder.string() + R"('
import vtk
for name in ('binary', 'text'):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(folder + '/' + name + '.vtu')
    reader.Update()
    grid = reader.GetOutput()
    assert grid.GetNumberOfPoints() == 80 and grid.GetNumberOfCells() == 36
    assert grid.GetCellType(35) == 12
    assert grid.GetPointData().GetArray('velocity').GetNumberOfComponents() == 3
    assert grid.GetPointData().GetArray('owner_dim') and grid.GetCellData().GetArray('block')
    low, high = grid.GetCellData().GetArray('shape').GetRange()
    assert 0.5 < low <= high <= 1
    low, high = grid.GetCellData().GetArray('scaled_jacobian').GetRange()
    assert 0.5 < low <= high <= 1
write_all_ways(grid, folder + '/')
for version in (42, 51):
    for binary in (1, 2):
        writer = vtk.vtkUnstructuredGridWriter()
        writer.SetInputData(grid)
        writer.SetFileVersion(version)
        writer.SetFileType(binary)
        writer.SetFileName('%s/legacy_%d_%d.vtk' % (folder, version, binary))
        assert writer.Write()
)");
  if (!there) GTEST_SKIP() << "no python3 with VTK";
  int n_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const auto name = entry.path().filename().string();
    if (entry.path().extension() == ".py") continue;
    ++n_files;
    SCOPED_TRACE(name);
    const auto back = read_mesh(entry.path());
    if (name.find("legacy") == std::string::npos && name.find("Ascii") == std::string::npos) {
      EXPECT_TRUE(test::same_mesh(mesh, back.mesh));
      EXPECT_TRUE(test::same_owners(tags, back.tags));
    } else {
      // VTK's own text has fewer digits; all else is there.
      EXPECT_EQ(back.mesh.hexes, mesh.hexes);
      EXPECT_EQ(back.mesh.blocks, mesh.blocks);
      EXPECT_EQ(back.mesh.side_sets, mesh.side_sets);
      EXPECT_EQ(back.mesh.node_ids, mesh.node_ids);
      ASSERT_EQ(back.mesh.fields.size(), mesh.fields.size());
      for (const Field& field : mesh.fields) {
        const auto same = std::ranges::find(back.mesh.fields, field.name, &Field::name);
        ASSERT_NE(same, back.mesh.fields.end()) << field.name;
        for (std::size_t i = 0; i < field.values.size(); ++i) EXPECT_NEAR(same->values[i], field.values[i], 1e-6);
      }
      for (std::size_t n = 0; n < mesh.points.size(); ++n)
        EXPECT_NEAR((back.mesh.points[n] - mesh.points[n]).norm(), 0, 1e-5);
    }
  }
  EXPECT_EQ(n_files, 2 + 48 + 4);
  // Every encoding, with bytes that are wrong.
  const unsigned seed = test::random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (const std::string name : {"Binary_0_32_0_0", "Binary_1_64_0_1", "Appended_0_64_0_1", "Appended_1_32_0_0",
                                 "Appended_1_64_1_1", "Appended_0_32_1_0"}) {
    SCOPED_TRACE(name);
    const std::string text = test::text_of(folder / (name + ".vtu"));
    const std::size_t data = text.find("<AppendedData");
    for (int i = 0; i < 100; ++i) {
      std::string wrong = text;
      for (unsigned k = 0; k <= random() % 4; ++k) {
        const std::size_t at =
            i % 2 || data == std::string::npos ? random() % text.size() : data + random() % (text.size() - data);
        wrong[at] = static_cast<char>(i % 3 ? "0123456789=A/z\" >"[random() % 17] : static_cast<char>(random()));
      }
      if (i % 5 == 0) wrong.resize(random() % wrong.size() + 1);
      test::read_or_refuse(test::write_text(folder / "wrong.vtu", wrong));
    }
  }
}

constexpr const char* legacy =
    "# vtk DataFile Version 2.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n0 0 0 1 0 0 0 1 0 1 1 0\n"
    "0 0 1 1 0 1 0 1 1 1 1 1\n";

TEST(vtk_files, legacy_files_with_voxels_quads_and_arrays_are_understood) {
  const auto file =
      test::write_text(test::output_folder() / "a.vtk",
                       std::string(legacy) +
                           "CELLS 3 17\n8 0 1 2 3 4 5 6 7\n4 0 1 3 2\n2 0 1\nCELL_TYPES 3\n11 9 3\n"
                           "CELL_DATA 3\nSCALARS MaterialID int 1\nLOOKUP_TABLE default\n7 3 2\nVECTORS v double\n"
                           "1 2 3 0 0 0 0 0 0\nPOINT_DATA 8\nSCALARS t double\nLOOKUP_TABLE default\n"
                           "0 1 2 3 4 5 6 7\nFIELD FieldData 1\nspeed%20up 2 8 float\n"
                           "0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15\n");
  const auto read = read_mesh(file);
  EXPECT_EQ(read.mesh.hexes[0], (Hex{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{2, "", {}}, {7, "", {0}}}));
  EXPECT_EQ(read.mesh.side_sets, (std::vector<SideSet>{{3, "", {{0, 4}}}}));
  EXPECT_EQ(others_text(read.mesh), "1 line");
  EXPECT_EQ(
      read.mesh.fields,
      (std::vector<Field>{{"MaterialID", Field::On::hex, 1, {7}, true},
                          {"v", Field::On::hex, 3, {1, 2, 3}},
                          {"t", Field::On::node, 1, {0, 1, 2, 3, 4, 5, 6, 7}},
                          {"speed up", Field::On::node, 2, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}}}));
}

TEST(vtk_files, blank_lines_after_the_title_and_a_last_line_without_end_are_taken) {
  std::string text = std::string(legacy) + "CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n11";
  text.replace(text.find("title\n"), 6, "\n\n\n");
  const auto file = test::write_text(test::output_folder() / "blank.vtk", text);
  const auto read = read_mesh(file);
  EXPECT_EQ(read.mesh.n_hexes(), 1);
  EXPECT_EQ(read.notices,
            (std::vector<std::string>{file.string() + ":13: the last line has no end; the file may be cut short"}));
}

TEST(vtk_files, material_ids_that_are_no_ids_of_blocks_are_named) {
  const auto file =
      test::write_text(test::output_folder() / "ids.vtk",
                       std::string(legacy) +
                           "CELLS 2 18\n8 0 1 2 3 4 5 6 7\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 2\n11 11\nCELL_DATA 2\n"
                           "SCALARS MaterialID double 1\nLOOKUP_TABLE default\n0 3000000000\n");
  const auto read = read_mesh(file);
  EXPECT_TRUE(read.mesh.blocks.empty());
  EXPECT_EQ(read.mesh.fields[0].values, (std::vector<double>{0, 3e9}));
  EXPECT_EQ(read.notices,
            (std::vector<std::string>{"MaterialID of 2 hexes is not an id of a block (1 to 2147483646): they are in "
                                      "none, the values are a field"}));
}

TEST(vtk_files, global_ids_are_the_ids) {
  const auto file = test::output_folder() / "ids.vtk";
  const std::string cells = std::string(legacy) + "CELLS 2 14\n4 0 1 3 2\n8 0 1 3 2 4 5 7 6\nCELL_TYPES 2\n9 12\n";
  const auto good = read_mesh(test::write_text(
      file,
      cells + "CELL_DATA 2\nGLOBAL_IDS e vtkIdType\n3 17\nPOINT_DATA 8\nGLOBAL_IDS n int\n2 3 5 7 11 13 17 19\n"));
  EXPECT_EQ(good.mesh.hex_ids, std::vector<std::int64_t>{17});
  EXPECT_EQ(good.mesh.node_ids, (std::vector<std::int64_t>{2, 3, 5, 7, 11, 13, 17, 19}));
  EXPECT_TRUE(good.mesh.fields.empty());
  EXPECT_TRUE(good.notices.empty());
  const auto bad = read_mesh(test::write_text(file, cells + "POINT_DATA 8\nGLOBAL_IDS n int\n0 1 2 3 4 5 6 7\n"));
  EXPECT_TRUE(bad.mesh.node_ids.empty());
  EXPECT_EQ(bad.mesh.fields.size(), 1u);
  EXPECT_EQ(bad.notices, (std::vector<std::string>{"array 'n' of ids is kept as a field: it is not positive and "
                                                   "ascending; nodes are counted from 1"}));
  const auto vtu = test::write_text(
      file.parent_path() / "ids.vtu",
      "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece NumberOfPoints=\"8\" "
      "NumberOfCells=\"1\"><PointData GlobalIds=\"n\"><DataArray type=\"Int64\" Name=\"n\" format=\"ascii\">4 5 6 7 8 "
      "9 "
      "10 11</DataArray></PointData><CellData GlobalIds=\"e\"><DataArray type=\"Int64\" Name=\"e\" format=\"ascii\">8"
      "</DataArray></CellData><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 "
      "0 "
      "1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1</DataArray></Points><Cells><DataArray type=\"Int64\" Name=\"connectivity\" "
      "format=\"ascii\">0 1 2 3 4 5 6 7</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">8"
      "</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">12</DataArray></Cells></Piece>"
      "</UnstructuredGrid></VTKFile>");
  EXPECT_EQ(read_mesh(vtu).mesh.node_ids, (std::vector<std::int64_t>{4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(read_mesh(vtu).mesh.hex_ids, std::vector<std::int64_t>{8});
}

TEST(vtk_files, ids_are_at_most_2_to_the_62) {
  const auto file = test::output_folder() / "ids.inp";
  const auto inp = [&](const std::string& node, const std::string& hex) {
    return test::write_text(file, "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n" + node +
                                      ",0,1,1\n*ELEMENT,TYPE=C3D8\n" + hex + ",1,2,3,4,5,6,7," + node + "\n");
  };
  EXPECT_EQ(read_mesh(inp("4611686018427387904", "4611686018427387904")).mesh.node_ids.back(), std::int64_t{1} << 62);
  EXPECT_EQ(test::refusal(inp("4611686018427387905", "1")),
            file.string() + ":9: node id 4611686018427387905 is too large");
  EXPECT_EQ(test::refusal(inp("8", "9223372036854775807")),
            file.string() + ":11: element id 9223372036854775807 is too large");
  EXPECT_EQ(test::refusal(inp("9223372036854775808", "1")),
            file.string() + ":9: expected a node id, found '9223372036854775808,0,1,1'");
}

TEST(vtk_files, what_is_wrong_is_said) {
  const auto folder = test::output_folder();
  const auto says = [&](const std::string& text, const std::string& expected) {
    const auto file = test::write_text(folder / "bad.vtk", text);
    EXPECT_EQ(test::refusal(file), file.string() + expected);
  };
  const std::string good = legacy;
  says(good + "CELLS 1 5\n4 0 1 2 4\nCELL_TYPES 1\n10\n", ":12: there is no hex in the file, but 1 tetrahedron");
  says(good + "CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n25\n", ": cell 1 has 8 nodes instead of 20");
  says(good + "CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n29\n", ": cell 1 has 8 nodes instead of 27");
  says(good + "CELLS 1 9\n8 0 1 2 3 4 5 6 8\nCELL_TYPES 1\n12\n", ": cell 1 names point 8 of 8 (counted from 0)");
  says(good + "CELLS 1 8\n7 0 1 2 3 4 5 6\nCELL_TYPES 1\n12\n", ": cell 1 has 7 nodes instead of 8");
  says(good + "CELLS 1 9\n9 0 1 2 3 4 5 6 8\nCELL_TYPES 1\n12\n", ":8: cell 1 does not fit in the list of cells");
  const std::string cells = good + "CELLS 2 8\nOFFSETS ";
  const std::string nodes = "CONNECTIVITY vtktypeint64\n0 1 2 3 4 5 6 7\nCELL_TYPES 1\n12\n";
  says(cells + "vtktypeint64\n0 9\n" + nodes, ":8: the offsets of cells do not fit");
  says(cells + "double\n0 8\n" + nodes, ":8: the numbers of cells are not integers");
  says(good +
           "CELLS 3 8\nOFFSETS vtktypeint64\n0 9 8\nCONNECTIVITY vtktypeint64\n0 1 2 3 4 5 6 7\nCELL_TYPES 2\n12 12\n",
       ": the nodes of cell 1 do not fit: they end at 9 of 8");
  says(good + "CELLS 1 9\n8 0 1 2 3 4 5 6 7\n", ":10: the file ends without cells");
  says(good + "CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 2\n12 12\n", ":12: 2 cell types for 1 cells");
  says(good + "CELLS 1 2\n1 0\nCELL_TYPES 1\n1\n", ":12: there is no hex in the file, but 1 point");
  says(good + "WONDERS 1\n", ":8: expected a section, found 'WONDERS'");
  says("# vtk DataFile Version 2.0\n\nASCII\nDATASET POLYDATA\n",
       ":4: data set 'POLYDATA'; only UNSTRUCTURED_GRID is read");
  says("# vtk DataFile Version 2.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 double\n0 nan 0\n",
       ": a coordinate of point 0 (counted from 0) is not finite");
  const std::string cell = "CELLS 1 9\n8 0 1 2 3 4 5 6 7\n", type = "CELL_TYPES 1\n12\n";
  says(good + cell + cell, ":10: a second CELLS");
  says(good + cell + type + type, ":12: a second CELL_TYPES");
  says(good + "POINTS 0 float\n", ":8: a second POINTS");
  // The type 12 cut short.
  says(good + cell + "CELL_TYPES 1\n1", ": cell 1 has 8 nodes instead of 1, which cells of type 1 have");
  says("# vtk DataFile Version 9.0\n", ":1: version '9.0' is not known, 1.0 to 5.1 are");
  says("solid\n", ":1: not a VTK file: it does not begin with '# vtk DataFile'");
}

TEST(vtk_files, real_meshes_have_the_known_counts) {
  const auto data = test::data_folder();
  if (data.empty()) GTEST_SKIP() << "no folder of real meshes";
  const auto ball = read_mesh(data / "mesh/hyper_ball_balanced_r1.vtk");
  const auto moebius = read_mesh(data / "mesh/moebius_rot1_r1.vtk");
  EXPECT_EQ(ball.mesh.n_nodes(), 321);
  EXPECT_EQ(ball.mesh.n_hexes(), 256);
  EXPECT_EQ(moebius.mesh.n_nodes(), 216);
  EXPECT_EQ(moebius.mesh.n_hexes(), 96);
  for (const auto* file : {&ball, &moebius}) {
    EXPECT_TRUE(test::conformal(file->mesh));
    EXPECT_TRUE(test::sets_valid(file->mesh));
  }
}

}  // namespace
}  // namespace hextwist
