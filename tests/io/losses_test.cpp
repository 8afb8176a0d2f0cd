// What has no place in a mesh or in a format is told, and does not hinder the rest.
#include "hextwist/mesh/others.h"
#include "io/hdf_support.h"

namespace hextwist {
namespace {

const std::string& points_of_two_hexes() {
  static const std::string text =
      "POINTS 12 double\n0 0 0 1 0 0 2 0 0\n0 1 0 1 1 0 2 1 0\n0 0 1 1 0 1 2 0 1\n0 1 1 1 1 1 2 1 1\n";
  return text;
}
const std::string& cells_of_two_hexes() {
  static const std::string text = "CELLS 2 18\n8 0 1 4 3 6 7 10 9\n8 1 2 5 4 7 8 11 10\nCELL_TYPES 2\n12\n12\n";
  return text;
}

TEST(losses, texts_and_field_data_of_vtk_are_left_out_and_told) {
  const auto folder = test::output_folder();
  const auto file =
      test::write_text(folder / "a.vtk",
                       "# vtk DataFile Version 5.1\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nFIELD FieldData 3\n"
                       "info 1 1 string\nhello,%20world\n\nTIME 1 1 double\n0.5\nwords 1 2 string\nPOINTS\n\n\n" +
                           points_of_two_hexes() + "METADATA\nINFORMATION 0\n\n" + cells_of_two_hexes() +
                           "CELL_DATA 2\nFIELD FieldData 2\nnames 1 2 string\none\ntwo\nT 1 2 double\n3 4\n");
  const MeshFile read = read_mesh(file);
  EXPECT_EQ(read.mesh.hexes, test::grid(2, 1, 1).hexes);
  EXPECT_EQ(read.mesh.fields, (std::vector<Field>{{"T", Field::On::hex, 1, {3, 4}}}));
  for (const char* name : {"info", "words", "names"})
    EXPECT_TRUE(test::told(read.notices, std::string("left out array '") + name + "' of texts")) << name;
  EXPECT_TRUE(test::told(read.notices, "left out 1 array of field data, which is of the whole file: 'TIME'"));
  EXPECT_EQ(read.notices.size(), 4U);

  Mesh mesh = read.mesh;
  write_mesh(folder / "a.vtu", mesh, nullptr);
  EXPECT_TRUE(read_mesh(folder / "a.vtu").notices.empty());
  std::string text = test::text_of(folder / "a.vtu");
  const std::string start = "<FieldData>\n";
  text.insert(text.find(start) + start.size(),
              "<DataArray type=\"String\" Name=\"info\" NumberOfTuples=\"1\" format=\"ascii\">\n104 105 0\n"
              "</DataArray>\n<DataArray type=\"Float64\" Name=\"TIME\" NumberOfTuples=\"1\" format=\"ascii\">0.5"
              "</DataArray>\n<DataArray type=\"Int32\" Name=\"step\" NumberOfTuples=\"1\" format=\"ascii\">5"
              "</DataArray>\n");
  const auto notices = read_mesh(test::write_text(folder / "b.vtu", text)).notices;
  EXPECT_EQ(notices,
            (std::vector<std::string>{"left out array 'info' of texts",
                                      "left out 2 arrays of field data, which are of the whole file: 'TIME', 'step'"}));
}

/// Lengths of one, two and four bytes.
TEST(losses, binary_texts_of_legacy_vtk_are_passed_over) {
  const auto folder = test::output_folder();
  const std::string script = "folder = '" + folder.string() + R"('
import vtk
grid = vtk.vtkUnstructuredGrid()
points = vtk.vtkPoints()
for z in range(2):
    for y in range(2):
        for x in range(2): points.InsertNextPoint(x, y, z)
grid.SetPoints(points)
ids = vtk.vtkIdList()
for n in (0, 1, 3, 2, 4, 5, 7, 6): ids.InsertNextId(n)
grid.InsertNextCell(12, ids)
words = vtk.vtkStringArray()
words.SetName('words')
for n in (0, 5, 63, 64, 1000, 20000): words.InsertNextValue('w' * n)
grid.GetFieldData().AddArray(words)
for binary in (True, False):
    writer = vtk.vtkUnstructuredGridWriter()
    writer.SetFileName(folder + '/' + ('binary' if binary else 'text') + '.vtk')
    if binary: writer.SetFileTypeToBinary()
    writer.SetInputData(grid)
    assert writer.Write() == 1
)";
  if (std::system("/usr/bin/python3 -c 'import vtk' > /dev/null 2>&1") != 0) GTEST_SKIP() << "no VTK";
  ASSERT_EQ(std::system(("/usr/bin/python3 '" + test::write_text(folder / "script.py", script).string() + "'").c_str()),
            0);
  for (const char* name : {"binary.vtk", "text.vtk"}) {
    const MeshFile read = read_mesh(folder / name);
    EXPECT_EQ(read.mesh.hexes, test::grid(1, 1, 1).hexes) << name;
    EXPECT_TRUE(test::told(read.notices, "left out array 'words' of texts")) << name;
  }
  const std::string whole = test::text_of(folder / "binary.vtk");
  EXPECT_NE(test::refusal(test::write_text(folder / "cut.vtk", whole.substr(0, whole.find("wwwwwww") + 3000)))
                .find("the texts of 'words'"),
            std::string::npos);
}

TEST(losses, views_that_gmsh_appends_are_read_and_earlier_steps_told) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::grid(2, 1, 1);
  const std::string element_nodes =
      "$ElementNodeData\n1\n\"flux\"\n1\n0\n3\n0\n1\n1\n1 8 1 2 3 4 5 6 7 8\n$EndElementNodeData\n";
  const auto node_data = [](int step, int value) {
    std::string text = "$NodeData\n1\n\"T\"\n1\n0.5\n3\n" + std::to_string(step) + "\n1\n12\n";
    for (int n = 1; n <= 12; ++n) text += std::to_string(n) + " " + std::to_string(value) + "\n";
    return text + "$EndNodeData\n";
  };
  for (const char* version : {"4.1", "2.2"})
    for (const bool binary : {false, true}) {
      SCOPED_TRACE(std::string(version) + (binary ? " binary" : ""));
      WriteOptions options;
      options.binary = binary;
      options.gmsh_version = version == std::string("2.2") ? 22 : 41;
      write_mesh(folder / "a.msh", mesh, nullptr, options);
      const std::string text = test::text_of(folder / "a.msh");
      const std::string end = "$EndMeshFormat\n", head = text.substr(0, text.find(end) + end.size());
      if (binary) {  // the mesh again
        EXPECT_EQ(read_mesh(test::write_text(folder / "b.msh", text + text)).mesh.hexes, mesh.hexes);
        continue;
      }
      const std::string views = element_nodes + node_data(0, 1) + node_data(1, 2);
      for (const std::string& again : {head, text, std::string()}) {
        const MeshFile read = read_mesh(test::write_text(folder / "b.msh", text + again + views));
        EXPECT_EQ(read.mesh.hexes, mesh.hexes);
        EXPECT_EQ(read.mesh.fields, (std::vector<Field>{{"T", Field::On::node, 1, std::vector<double>(12, 2)}}));
        EXPECT_EQ(read.notices, (std::vector<std::string>{
                                    "left out $ElementNodeData, values per element and node, of 1 field, 'flux'",
                                    "field 'T' has 2 steps: the last is read"}));
      }
      std::string other = text;
      other.replace(other.find(version), 3, version == std::string("2.2") ? "4.1" : "2.2");
      EXPECT_NE(test::refusal(test::write_text(folder / "b.msh", text + other)).find("a second $MeshFormat"),
                std::string::npos);
      other = text;
      other.replace(other.find("$Nodes") + 7, 1, "9");
      EXPECT_NE(test::refusal(test::write_text(folder / "b.msh", text + other)).find("a second $Nodes"),
                std::string::npos);
    }
}

TEST(losses, values_of_gmsh_on_elements_that_are_no_hexes_are_told) {
  const auto folder = test::output_folder();
  WriteOptions options;
  options.binary = false;
  write_mesh(folder / "a.msh", test::grid(2, 1, 1), nullptr, options);
  const auto read = read_mesh(test::write_text(
      folder / "b.msh",
      test::text_of(folder / "a.msh") + "$ElementData\n1\n\"s\"\n1\n0\n3\n0\n1\n3\n1 5\n2 6\n77 7\n$EndElementData\n"));
  EXPECT_EQ(read.mesh.fields, (std::vector<Field>{{"s", Field::On::hex, 1, {5, 6}}}));
  EXPECT_TRUE(test::told(read.notices, "field 's': 1 value left out, which is not of a hex"));
}

TEST(losses, values_on_other_elements_are_told_where_a_format_has_none) {
  const auto folder = test::output_folder();
  const auto file =
      test::write_text(folder / "a.vtk",
                       "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 10 double\n"
                       "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1 2 0.5 0 2 0.5 1\n"
                       "CELLS 2 16\n8 0 1 2 3 4 5 6 7\n6 1 8 2 5 9 6\nCELL_TYPES 2\n12\n13\nCELL_DATA 2\n"
                       "SCALARS T double 1\nLOOKUP_TABLE default\n1 2\n");
  const Mesh mesh = read_mesh(file).mesh;
  ASSERT_TRUE(mesh.others);
  for (const std::string extension : {".e", ".msh", ".med"}) {
    if (!test::has_format(extension)) continue;
    EXPECT_TRUE(test::told(write_mesh(folder / ("a" + extension), mesh, nullptr),
                           "values of 1 field on other elements are left out"))
        << extension;
  }
  EXPECT_FALSE(test::told(write_mesh(folder / "a.vtu", mesh, nullptr), "left out"));
  EXPECT_EQ(read_mesh(folder / "a.vtu").mesh.others->heads->fields.at(0).values, (std::vector<double>{2}));
}

TEST(losses, values_of_med_on_quads_are_told) {
  if (!test::has_format(".med") || std::system("/usr/bin/python3 -c 'import h5py' > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "built without MED, or no python3 with h5py";
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(2, 1, 1);
  mesh.side_sets = {{1, "s", {{0, 0}, {1, 1}}}};
  mesh.fields = {{"T", Field::On::hex, 1, {1, 2}}};
  write_mesh(folder / "a.med", mesh, nullptr);
  EXPECT_TRUE(read_mesh(folder / "a.med").notices.empty());
  const auto script =
      test::write_text(folder / "script.py", "import h5py\nfile = h5py.File('" + (folder / "a.med").string() +
                                                 "', 'a')\nfor step in file['CHA/T'].values(): step.copy('MAI.HE8', "
                                                 "'MAI.QU4')\nfile.close()\n");
  ASSERT_EQ(std::system(("/usr/bin/python3 '" + script.string() + "'").c_str()), 0);
  const MeshFile read = read_mesh(folder / "a.med");
  EXPECT_EQ(read.mesh.fields, mesh.fields);
  EXPECT_TRUE(test::told(read.notices, "field 'T': 2 values left out, which are not of a node or hex"));
}

TEST(losses, whole_numbers_of_med_stay_whole) {
  if (!test::has_format(".med") || std::system("/usr/bin/python3 -c 'import h5py' > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "built without MED, or no python3 with h5py";
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(2, 1, 1);
  mesh.fields = {{"part", Field::On::hex, 1, {7, -3}, true},
                 {"large", Field::On::hex, 2, {0x1p40, 1, 2, 3}, true},
                 {"T", Field::On::node, 1, std::vector<double>(mesh.points.size(), 0.5)}};
  EXPECT_TRUE(write_mesh(folder / "a.med", mesh, nullptr).empty());
  MeshFile read = read_mesh(folder / "a.med");
  std::ranges::sort(read.mesh.fields, std::ranges::greater{}, &Field::name);
  std::ranges::sort(mesh.fields, std::ranges::greater{}, &Field::name);
  EXPECT_EQ(read.mesh.fields, mesh.fields);
  EXPECT_TRUE(read.notices.empty());
  // Another hand: what is there is integers in HDF5, and components have names.
  const auto script = test::write_text(
      folder / "script.py",
      "import h5py\nimport numpy\nfile = h5py.File('" + (folder / "a.med").string() +
          "', 'a')\nfor name, size in (('part', 4), ('large', 8)):\n  for step in file['CHA/' + name].values():\n    "
          "values = [x for x in step['MAI.HE8'].values()][0]['CO']\n    assert values.dtype.kind == 'i', "
          "values.dtype\n    "
          "assert values.dtype.itemsize == size\nfile['CHA/T'].attrs['NOM'] = numpy.bytes_('TEMP            "
          "')\nfile.close()\n");
  ASSERT_EQ(std::system(("/usr/bin/python3 '" + script.string() + "'").c_str()), 0);
  EXPECT_TRUE(test::told(read_mesh(folder / "a.med").notices,
                         "names and units of the components of 1 field are left out: 'T'"));
}

TEST(losses, normals_and_tangents_of_medit_are_told) {
  const auto folder = test::output_folder();
  const auto read = read_mesh(
      test::write_text(folder / "a.mesh",
                       "MeshVersionFormatted 2\nDimension 3\nVertices\n8\n0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 0 0\n0 0 1 "
                       "0\n1 0 1 0\n1 1 1 0\n0 1 1 0\nHexahedra\n1\n1 2 3 4 5 6 7 8 0\nNormals\n2\n1 0 0\n0 1 "
                       "0\nNormalAtVertices\n1\n1 1\nTangents\n0\nEnd\n"));
  EXPECT_EQ(read.notices,
            (std::vector<std::string>{"left out 2 entries of Normals", "left out 1 entry of NormalAtVertices"}));
}

/// The library warns, and leaves what it was given.
TEST(losses, variables_of_exodus_that_are_named_only_are_told) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(2, 1, 1);
  mesh.fields = {{"T", Field::On::node, 1, std::vector<double>(12, 4)},
                 {"p", Field::On::node, 1, std::vector<double>(12, 5)}};
  write_mesh(folder / "a.e", mesh, nullptr);
  std::string bytes = test::text_of(folder / "a.e");
  const auto at = bytes.find("vals_nod_var1");
  ASSERT_NE(at, std::string::npos);
  bytes[at] = 'w';
  const MeshFile read = read_mesh(test::write_text(folder / "b.e", bytes));
  ASSERT_EQ(read.mesh.fields.size(), 1U);
  EXPECT_EQ(read.mesh.fields[0].name, "p");
  EXPECT_TRUE(test::told(read.notices, "field 'T' is named in the file, which has no values of it: left out"));
}

}  // namespace
}  // namespace hextwist
