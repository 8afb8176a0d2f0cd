// Formats with groups that others work with: Nastran, I-deas universal, OpenFOAM, MED.
#include <Eigen/Geometry>

#include "hextwist/base/text.h"
#include "hextwist/mesh/others.h"
#include "hextwist/mesh/second_order/second_order.h"
#include "io/io_support.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

bool has_med() {
  return (" " + readable_extensions() + " ").find(" .med ") != std::string::npos &&
         test::refusal("nowhere.med").find("without MED") == std::string::npos;
}
std::vector<std::string> files() {
  std::vector<std::string> result = {"a.bdf", "a.unv", "a.foam"};
  if (has_med()) result.emplace_back("a.med");
  return result;
}

/// Sides of boundary faces are what patches have; a face inside may come back as the side of the other hex.
std::vector<SideSet> by_lower_hex(const Mesh& mesh) {
  std::vector<SideSet> result = mesh.side_sets;
  const Faces all = faces(mesh);
  for (SideSet& set : result) {
    for (Side& side : set.sides) side = all.sides[all.of_hex[side.hex][side.face]][0];
    std::ranges::sort(set.sides);
    set.sides.erase(std::ranges::unique(set.sides).begin(), set.sides.end());
  }
  return result;
}

TEST(listed_files, groups_names_and_ids_come_back) {
  const auto folder = test::output_folder();
  for (unsigned seed = 1; seed < 4; ++seed)
    for (const std::string& name : files()) {
      SCOPED_TRACE(name + " " + std::to_string(seed));
      const Mesh mesh = test::tidy_mesh(seed, seed % 2);
      const auto file = folder / name;
      write_mesh(file, mesh, nullptr);
      const MeshFile read = read_mesh(file);
      EXPECT_TRUE(test::sets_valid(read.mesh));
      ASSERT_EQ(read.mesh.points.size(), mesh.points.size());
      for (std::size_t n = 0; n < mesh.points.size(); ++n)
        for (int axis = 0; axis < 3; ++axis)
          // Sixteen characters of a Nastran number hold 12 digits or more.
          EXPECT_NEAR(read.mesh.points[n][axis], mesh.points[n][axis],
                      name == "a.bdf" ? 1e-11 * std::abs(mesh.points[n][axis]) + 1e-200 : 0);
      if (name == "a.foam") {
        // Cells are found from their faces: the same corners, turned. Sides are named by the hexes as they are.
        for (Index h = 0; h < mesh.n_hexes(); ++h) {
          Hex a = mesh.hexes[h], b = read.mesh.hexes[h];
          std::ranges::sort(a), std::ranges::sort(b);
          EXPECT_EQ(a, b);
        }
        EXPECT_EQ(test::names_and_members(read.mesh.blocks), test::names_and_members(mesh.blocks));
        EXPECT_EQ(test::names_and_members(read.mesh.node_sets), test::names_and_members(mesh.node_sets));
        continue;
      }
      EXPECT_EQ(read.mesh.hexes, mesh.hexes);
      EXPECT_EQ(read.mesh.node_ids, mesh.node_ids);
      EXPECT_EQ(read.mesh.hex_ids, mesh.hex_ids);
      EXPECT_EQ(test::names_and_members(read.mesh.blocks), test::names_and_members(mesh.blocks));
      EXPECT_EQ(test::names_and_members(read.mesh.node_sets), test::names_and_members(mesh.node_sets));
      if (name == "a.bdf") {  // sides are named by hex and corners
        EXPECT_EQ(test::names_and_members(read.mesh.side_sets), test::names_and_members(mesh.side_sets));
        EXPECT_EQ(read.mesh.blocks, mesh.blocks);
        EXPECT_EQ(read.mesh.node_sets, mesh.node_sets);
        EXPECT_EQ(read.mesh.side_sets, mesh.side_sets);
      } else {
        EXPECT_EQ(test::names_and_members(by_lower_hex(read.mesh)), test::names_and_members(by_lower_hex(mesh)));
      }
      EXPECT_TRUE(read.notices.empty()) << read.notices[0];
    }
}

TEST(listed_files, what_a_format_can_not_keep_is_told) {
  const auto folder = test::output_folder();
  Mesh mesh = test::rich_mesh(2, true);
  const auto told = [&](const char* name, const std::string& part) {
    const auto notices = write_mesh(folder / name, mesh, nullptr);
    return std::ranges::any_of(notices, [&](const std::string& line) { return line.find(part) != std::string::npos; });
  };
  EXPECT_TRUE(told("a.bdf", "blocks overlap, and a hex is in one only in Nastran"));
  EXPECT_TRUE(told("a.bdf", "hexes in no block, or in block 0, are of property"));
  EXPECT_TRUE(told("a.bdf", "fields"));
  EXPECT_TRUE(told("a.unv", "groups of all kinds are numbered together in .unv: nodeset 2 is "));
  EXPECT_TRUE(told("a.foam", "OpenFOAM has no ids"));
  EXPECT_TRUE(told("a.foam", "blocks overlap, and a hex is in one only in OpenFOAM"));
  mesh.node_ids.back() = 100'000'000;
  EXPECT_TRUE(told("a.bdf", "node id 100000000 has more than eight digits: nodes are counted from 1 in the file"));
  mesh.node_ids.back() = 1'000'000'000;
  EXPECT_TRUE(told("a.unv", "node id 1000000000 has more than nine digits: nodes are counted from 1 in the file"));
}

TEST(listed_files, quads_in_no_group_are_told_where_others_are_in_groups) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(2, 1, 1);
  mesh.side_sets = {{1, "kept", {{0, 4}}}, {2, "gone", {{0, 5}, {1, 5}}}};
  write_mesh(folder / "a.unv", mesh, nullptr);
  EXPECT_EQ(read_mesh(folder / "a.unv").notices, std::vector<std::string>());
  std::istringstream in(test::text_of(folder / "a.unv"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  const auto name = std::ranges::find(lines, "gone");
  ASSERT_NE(name, lines.end());
  lines.erase(name - 1, name + 2);  // what the group has, its name, and two members in a line
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  const MeshFile read = read_mesh(test::write_text(folder / "b.unv", text));
  EXPECT_EQ(read.notices, std::vector<std::string>{"2 quads in no group left out, as others are in groups"});
  EXPECT_EQ(read.mesh.side_sets.size(), 1u);
}

TEST(listed_files, fields_come_back_from_med) {
  if (!has_med()) GTEST_SKIP() << "built without MED";
  const auto file = test::output_folder() / "a.med";
  const Mesh mesh = test::rich_mesh(3, true);
  write_mesh(file, mesh, nullptr);
  const Mesh back = read_mesh(file).mesh;
  ASSERT_EQ(back.fields.size(), mesh.fields.size());
  for (const Field& field : mesh.fields) {
    const auto same = std::ranges::find(back.fields, field.name, &Field::name);
    ASSERT_NE(same, back.fields.end());
    EXPECT_EQ(*same, field);
  }
}

/// Fields of fixed width: no number may touch its neighbour, whatever it is.
TEST(listed_files, widths_of_nastran_and_universal_files_are_kept) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(1, 1, 1);
  const std::array<double, 8> odd = {
      1, -1e-300, 1.2345678901234567e-7, -9.8765432109876543e123, 0.1, -123456.78901234567, 1e22, 3};
  for (std::size_t n = 0; n < 8; ++n) mesh.points[n].y() += odd[n] * (n == 3 || n == 6 ? 0 : 1e-9);
  mesh.points[1].x() = 1.0000000000000002;
  mesh.points[3].z() = -1.2345678901234567e-7;
  mesh.node_ids = {1, 22, 333, 4444, 55555, 666666, 7777777, 99999999};
  mesh.hex_ids = {99999999};
  mesh.blocks = {{99999999, "b", {0}}};
  write_mesh(folder / "a.bdf", mesh, nullptr);
  std::istringstream lines(test::text_of(folder / "a.bdf"));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("$")) continue;
    EXPECT_LE(line.size(), 72U + 1U) << line;
    if (line.starts_with("GRID*") || line.starts_with("*  "))
      for (std::size_t at = 8; at < line.size(); at += 16) {
        const std::string field = line.substr(at, 16);
        if (field.find_first_not_of(' ') == std::string::npos || at < 40) continue;
        EXPECT_NE(field.find('.'), std::string::npos) << line;
      }
  }
  const Mesh back = read_mesh(folder / "a.bdf").mesh;
  EXPECT_EQ(back.node_ids, mesh.node_ids);
  for (std::size_t n = 0; n < 8; ++n)
    EXPECT_LE((back.points[n] - mesh.points[n]).norm(), 1e-11 * (1 + mesh.points[n].norm()));
}

constexpr const char* cube_grid =
    "GRID,1,,0.,0.,0.\n"
    "GRID    2               1.0     0.0     0.0\n"
    "GRID*                  3                1.0000000000    1.0\n"
    "*       0.0\n"
    "GRID,4,0,0.,1.\n"
    "GRID,5,,0.,0.,1.0E+0\n"
    "GRID,6,,10.-1,0.,1.\n"
    "GRID,7,,1.,1.,1.D0\n"
    "grid,8,,0.,.1+1,1.\n";

TEST(listed_files, nastran_is_understood_in_small_large_and_free_fields) {
  const auto folder = test::output_folder();
  std::string text = std::string("SOL 101\nCEND\nSUBCASE 1\nBEGIN BULK\n$ a comment\n") + cube_grid +
                     "CHEXA   10      7       1       2       3       4       5       6       +E1\n+E1     7       8\n"
                     "PSOLID,7,1\nMAT1,1,2.1E5,,.3\nCBAR,99,1,1,2\nSET1,3,1,THRU,4,6\nPLOAD4,5,10,2.,,,,1,3\n"
                     "CQUAD4,20,4,5,6,7,8\nENDDATA\nGRID,9,,0.,0.,0.\n";
  const MeshFile read = read_mesh(test::write_text(folder / "a.bdf", text));
  EXPECT_EQ(read.mesh.points[2], Vec3(1, 1, 0));
  EXPECT_EQ(read.mesh.points[5], Vec3(1, 0, 1));
  EXPECT_EQ(read.mesh.points[7], Vec3(0, 1, 1));
  EXPECT_EQ(read.mesh.hexes, (std::vector<Hex>{{0, 1, 3, 2, 4, 5, 7, 6}}));
  EXPECT_EQ(read.mesh.hex_ids, (std::vector<std::int64_t>{10}));
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{1, "", {}}, {4, "", {}}, {7, "", {0}}}));
  EXPECT_EQ(read.mesh.node_sets, (std::vector<NodeSet>{{3, "", {0, 1, 2, 3, 5}}}));
  EXPECT_EQ(read.mesh.side_sets, (std::vector<SideSet>{{5, "", {{0, 4}}}}));
  EXPECT_EQ(others_text(read.mesh), "1 line (CBAR), 1 quad (CQUAD4)");
  EXPECT_EQ(
      read.notices,
      (std::vector<std::string>{
          "3 lines of executive and case control left out (the first: 'SOL 101')",
          "1 PLOAD4 with another pressure than 1 all over: the sides are kept, not the pressure (the first: set 5, "
          "element 10, '2.')",
          "1 other card left out (the first: MAT1)"}));
}

TEST(listed_files, what_is_wrong_is_said_with_its_line) {
  const auto folder = test::output_folder();
  const auto says = [&](const char* name, const std::string& text, const std::string& expected) {
    const auto file = test::write_text(folder / name, text);
    EXPECT_EQ(test::refusal(file), file.string() + expected);
  };
  const std::string grid = cube_grid, hex = "CHEXA,1,1,1,2,3,4,5,6\n,7,8\n";
  says("a.bdf", grid + "CTETRA,3,1,1,2,3,5\n", ":11: there is no hex in the file, but 1 element CTETRA");
  says("a.bdf", grid + "CPENTA,3,1,1,2,3,5,6,7\n", ":11: there is no hex in the file, but 1 element CPENTA");
  says("a.bdf", grid + "CHEXA,1,1,1,2,3,4,5,6\n,7\n", ":10: element 1 has 7 of 8 corners");
  says("a.bdf", grid + "CHEXA,1,1,1,2,3,4,5,6\n,7,9\n", ":10: element 1 names node 9, which is not there");
  says("a.bdf", grid + hex + hex, ":12: element id 1 occurs twice");
  says("a.bdf", grid + "GRID,8,,0.,0.,0.\n" + hex, ":10: node id 8 occurs twice");
  says("a.bdf", grid + "GRID,9,,0.,x,0.\n" + hex, ":10: GRID has 'x' where a number should stand");
  says("a.bdf", grid + "GRID,9,2,0.,0.,0.\n" + hex,
       ":10: node 9 is in coordinate system 2; only the basic one (0) is read");
  says("a.bdf", grid + "INCLUDE 'b.bdf'\n", ":10: INCLUDE is not supported: nodes or elements would be missing");
  says("a.bdf", grid, ":10: there is no hex in the file");
  says("a.bdf", "BEGIN BULK\n" + grid + hex, ":13: the file ends before ENDDATA");
  says("a.bdf", grid + hex + "SET1,1,5,THRU,2\nENDDATA\n", ":12: SET1 has a range that cannot be");

  const std::string nodes =
      "    -1\n  2411\n         1         1         1        11\n   0.0D+00   0.0D+00   0.0D+00\n    -1\n";
  says("a.unv", "1 2 3\n", ":1: expected -1, the mark of a dataset");
  says("a.unv", "    -1\n  2411\n         1         1         1        11\n   0.0   0.0\n    -1\n",
       ":6: the file ends inside of a dataset");
  says("a.unv", "    -1\n  2411\n         1         1         1        11\n   0.0   0.0  0.0\n",
       ":5: the file ends inside of a dataset");
  says("a.unv",
       nodes + "    -1\n  2412\n         7       111         1         1         7         4\n 1 1 1 1\n    -1\n",
       ":11: there is no hex in the file, but 1 element 111");
  says("a.unv",
       nodes + "    -1\n  2412\n         7       115         1         1         7         4\n 1 1 1 1\n    -1\n",
       ":8: element 7 has 4 nodes instead of 8");
  says("a.unv",
       nodes +
           "    -1\n  2412\n         7       115         1         1         7         8\n 1 1 1 1 1 1 1 2\n    -1\n",
       ":8: element 7 names node 2, which is not there");
}

/// Gmsh writes these formats too: what it says is what we read.
TEST(listed_files, of_gmsh_have_the_volume_that_gmsh_has_in_them) {
  if (std::system("/usr/bin/python3 -c 'import gmsh' > /dev/null 2>&1") != 0) GTEST_SKIP() << "no python3 with Gmsh";
  const auto folder = test::output_folder();
  const MeshedModel meshed = test::shipped("cylinder");
  write_mesh(folder / "a.msh", meshed.mesh, &meshed.association);
  std::string script = "import gmsh\ngmsh.initialize()\ngmsh.option.setNumber('General.Terminal', 0)\ngmsh.open('" +
                       (folder / "a.msh").string() + "')\n";
  for (const std::string name : {"a.bdf", "a.unv"})  // Debian's Gmsh has no MED
    script += "gmsh.write('" + (folder / ("gmsh_" + name)).string() + "')\n";
  ASSERT_EQ(std::system(("/usr/bin/python3 " + test::write_text(folder / "script.py", script).string() + " > " +
                         (folder / "log.txt").string() + " 2>&1")
                            .c_str()),
            0);
  for (const std::string name : {"a.bdf", "a.unv"}) {
    const auto file = folder / ("gmsh_" + name);
    SCOPED_TRACE(name);
    const MeshFile read = read_mesh(file);
    EXPECT_EQ(read.mesh.n_hexes(), meshed.mesh.n_hexes());
    EXPECT_NEAR(volume(read.mesh), volume(meshed.mesh), 1e-5 * volume(meshed.mesh));
  }
}

TEST(listed_files, gmsh_finds_the_volume_in_ours_of_both_orders) {
  if (std::system("/usr/bin/python3 -c 'import gmsh' > /dev/null 2>&1") != 0) GTEST_SKIP() << "no python3 with Gmsh";
  const auto folder = test::output_folder();
  const MeshedModel meshed = test::shipped("bracket");
  struct Written {
    std::filesystem::path file;
    double volume;
    int n;
  };
  std::vector<Written> written;
  std::string command = "/usr/bin/python3 '" HEXTWIST_SOURCE_DIR "/tests/io/second_order_judge.py' gmsh";
  for (const std::string& name : files()) {
    if (name == "a.foam") continue;
    for (const int n : {8, 20, 27}) {
      if (n == 27 && name != "a.med") continue;
      WriteOptions options;
      options.order = n == 8 ? 1 : 2;
      options.nodes_per_hex = n == 8 ? 0 : n;
      options.model = meshed.model.get();
      const auto file = folder / (std::to_string(n) + name);
      write_mesh(file, meshed.mesh, &meshed.association, options);
      double expected = volume(meshed.mesh);
      if (n > 8) {
        expected = 0;
        const SecondOrder second = second_order(meshed.mesh, meshed.association, meshed.model.get(), n);
        for (Index h = 0; h < second.mesh.n_hexes(); ++h)
          for (int i = 0; i < 27; ++i) {
            constexpr std::array<double, 3> at = {0.1127016653792583, 0.5, 0.8872983346207417},
                                            weight = {5. / 18, 8. / 18, 5. / 18};
            const auto j = jacobian(quadratic_hex(second, h), Vec3(at[i % 3], at[i / 3 % 3], at[i / 9]));
            expected += weight[i % 3] * weight[i / 3 % 3] * weight[i / 9] * j[0].dot(j[1].cross(j[2]));
          }
        EXPECT_EQ(read_mesh(file).middles.edges.size(), second.edges.nodes.size());
      }
      if (name == "a.med") continue;  // Debian's Gmsh does not read it
      written.push_back({file, expected, n});
      command += " '" + file.string() + "'";
    }
  }
  const auto out = folder / "out.txt";
  ASSERT_EQ(std::system((command + " > '" + out.string() + "' 2> '" + (folder / "log.txt").string() + "'").c_str()), 0)
      << test::text_of(folder / "log.txt");
  std::istringstream words(test::text_of(out));
  for (const Written& one : written) {
    SCOPED_TRACE(one.file);
    double found = 0, least = 0;
    int nodes = 0;
    ASSERT_TRUE(words >> found >> least >> nodes);
    EXPECT_NEAR(found, one.volume, 1e-9 * one.volume);
    EXPECT_GT(least, 0);
    EXPECT_EQ(nodes, one.n);
  }
}

/// meshio reads MED's layout in HDF5 by itself, without the library.
TEST(listed_files, meshio_finds_hexes_and_groups_in_med) {
  if (!has_med() || std::system("/usr/bin/python3 -c 'import meshio, h5py' > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "built without MED, or no python3 with meshio and h5py";
  const auto folder = test::output_folder();
  MeshedModel meshed = test::shipped("bracket");
  meshed.mesh.node_sets.push_back({77, "tips", {0, 5, 9}});
  write_mesh(folder / "a.med", meshed.mesh, nullptr);
  std::string script = "import meshio\nmesh = meshio.read('" + (folder / "a.med").string() + "')\n";
  script += "assert len(mesh.points) == " + std::to_string(meshed.mesh.n_nodes()) + "\n";
  script += "assert len(mesh.cells_dict['hexahedron']) == " + std::to_string(meshed.mesh.n_hexes()) + "\n";
  const Index last = meshed.mesh.n_nodes() - 1;
  for (int axis = 0; axis < 3; ++axis)
    script += "assert abs(mesh.points[" + std::to_string(last) + "][" + std::to_string(axis) + "] - (" +
              std::to_string(meshed.mesh.points[last][axis]) + ")) < 1e-5\n";
  script +=
      "names = {n for names in mesh.cell_tags.values() for n in names} | "
      "{n for names in mesh.point_tags.values() for n in names}\n";
  for (const Block& block : meshed.mesh.blocks) script += "assert '" + block.name + "' in names, names\n";
  for (const SideSet& set : meshed.mesh.side_sets) script += "assert '" + set.name + "' in names, names\n";
  script +=
      "tips = [t for t, names in mesh.point_tags.items() if 'tips' in names]\n"
      "assert sum(list(mesh.point_data['point_tags']).count(t) for t in tips) == 3\n";
  EXPECT_EQ(std::system(("/usr/bin/python3 " + test::write_text(folder / "script.py", script).string() + " > " +
                         (folder / "log.txt").string() + " 2>&1")
                            .c_str()),
            0)
      << test::text_of(folder / "log.txt");
}

TEST(listed_files, patches_of_openfoam_keep_their_types) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(2, 1, 1);
  mesh.side_sets = {{1, "inlet", {{0, 0}}}, {2, "walls", {{0, 2}, {0, 3}, {1, 2}, {1, 3}}}};
  write_mesh(folder / "a.foam", mesh, nullptr);
  std::string boundary = test::text_of(folder / "constant" / "polyMesh" / "boundary");
  const auto at = boundary.find("type patch;", boundary.find("walls"));
  boundary.replace(at, 11, "type wall; inGroups 1(wall);");
  test::write_text(folder / "constant" / "polyMesh" / "boundary", boundary);
  const MeshFile read = read_mesh(folder / "a.foam");
  EXPECT_EQ(read.extras.patches.at(2), "type wall;inGroups 1 ( wall );");
  WriteOptions options;
  options.extras = &read.extras;
  write_mesh(folder / "a.foam", read.mesh, nullptr, options);
  EXPECT_NE(test::text_of(folder / "constant" / "polyMesh" / "boundary").find("type wall;"), std::string::npos);
  EXPECT_EQ(read_mesh(folder / "a.foam").extras.patches, read.extras.patches);
  // What is wrong in one of the files is said with its line.
  const auto points = folder / "constant" / "polyMesh" / "points";
  test::write_text(points, "FoamFile\n{\nformat ascii;\n}\n1\n(\n(0 0 x)\n");
  EXPECT_EQ(test::refusal(folder / "a.foam"), points.string() + ":7: expected a coordinate, found 'x'");
  test::write_text(points, "FoamFile\n{\nformat binary;\n}\n");
  EXPECT_NE(test::refusal(folder / "a.foam").find("is binary, and only text is read"), std::string::npos);
}

/// Never a crash: a message of one line, or a mesh whose parts fit together.
TEST(listed_files, that_are_cut_short_or_changed_are_refused_or_sound) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::tidy_mesh(5, true);
  std::mt19937 random(7);
  for (const char* name : {"a.bdf", "a.unv"}) {
    write_mesh(folder / name, mesh, nullptr);
    const std::string text = test::text_of(folder / name);
    for (int trial = 0; trial < 300; ++trial) {
      SCOPED_TRACE(testing::Message() << name << " " << trial);
      std::string changed = text;
      if (trial % 2 == 0)
        changed.resize(random() % text.size());
      else
        for (int k = 0; k < 3; ++k)
          changed[random() % text.size()] = static_cast<char>(" -+0123456789.,*$\n"[random() % 18]);
      try {
        EXPECT_TRUE(test::sets_valid(read_mesh(test::write_text(folder / (std::string("cut_") + name), changed)).mesh));
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
  write_mesh(folder / "a.foam", mesh, nullptr);
  for (const char* name : {"points", "faces", "owner", "neighbour", "boundary", "cellZones", "faceZones"}) {
    const auto file = folder / "constant" / "polyMesh" / name;
    const std::string text = test::text_of(file);
    for (int trial = 0; trial < 60; ++trial) {
      SCOPED_TRACE(testing::Message() << name << " " << trial);
      std::string changed = text;
      if (trial % 2 == 0)
        changed.resize(random() % text.size());
      else
        for (int k = 0; k < 2; ++k)
          changed[random() % text.size()] = static_cast<char>(" -(){};0123456789"[random() % 17]);
      test::write_text(file, changed);
      try {
        EXPECT_TRUE(test::sets_valid(read_mesh(folder / "a.foam").mesh));
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
    test::write_text(file, text);
  }
}

}  // namespace
}  // namespace hextwist
