// Formats in HDF5: CGNS, XDMF, VTKHDF. What only CGNS has is in cgns_test.cpp.
#include <set>

#include "hextwist/mesh/second_order/second_order.h"
#include "io/hdf_support.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

std::vector<std::string> files() {
  std::vector<std::string> result;
  for (const char* extension : {".cgns", ".xdmf", ".vtkhdf"})
    if (test::has_format(extension)) result.push_back(std::string("a") + extension);
  return result;
}

TEST(hdf_files, a_mesh_with_sets_and_fields_comes_back_bit_for_bit) {
  const auto folder = test::output_folder();
  for (unsigned seed = 1; seed < 5; ++seed)
    for (const std::string& name : files()) {
      SCOPED_TRACE(name + " " + std::to_string(seed));
      Mesh mesh = test::rich_mesh(seed, seed % 2);
      mesh.fields.push_back({"part", Field::On::hex, 1, std::vector<double>(mesh.hexes.size(), 3), true});
      mesh.fields[3].values[1] = -1e-310;
      mesh.blocks.push_back({71, "", {}});
      for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.blocks.back().hexes.push_back(h);
      write_mesh(folder / name, mesh, nullptr);
      const MeshFile read = read_mesh(folder / name);
      EXPECT_TRUE(test::same_mesh(mesh, read.mesh));
      EXPECT_TRUE(test::sets_valid(read.mesh));
      EXPECT_TRUE(read.notices.empty()) << read.notices[0];
      if (name == "a.cgns") continue;  // has no place for owners
      const auto tags = test::brick_association(test::grid(4, 3, 3), Vec3(4, 3, 3));
      const Mesh plain = test::grid(4, 3, 3);
      write_mesh(folder / name, plain, &tags);
      EXPECT_TRUE(test::same_owners(tags, read_mesh(folder / name).tags));
    }
}

/// Also in .vtu, whose arrays are the same.
TEST(hdf_files, fields_named_like_ids_and_owners_displace_nothing) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(4, 3, 3);
  const Association tags = test::brick_association(mesh, Vec3(4, 3, 3));
  for (std::size_t i = 0; i < mesh.points.size(); ++i) mesh.node_ids.push_back(10 + 2 * static_cast<std::int64_t>(i));
  for (std::size_t i = 0; i < mesh.hexes.size(); ++i) mesh.hex_ids.push_back(8 + static_cast<std::int64_t>(i));
  mesh.blocks = {{3, "b", {0, 1}}};
  // On what our own arrays of these names are, and on the other.
  for (const char* name : {"node_id", "hex_id", "hextwist_hex_id", "owner_dim", "owner_id", "volume", "block", "shape"})
    for (const Field::On on : {Field::On::node, Field::On::hex}) {
      const std::size_t n = on == Field::On::node ? mesh.points.size() : mesh.hexes.size();
      mesh.fields.push_back({name, on, 1, std::vector<double>(n, static_cast<double>(mesh.fields.size())), true});
    }
  std::vector<std::string> names = {"a.vtu"};
  for (const std::string& name : files())
    if (name != "a.cgns") names.push_back(name);
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    write_mesh(folder / name, mesh, &tags);
    const MeshFile read = read_mesh(folder / name);
    EXPECT_TRUE(test::same_owners(tags, read.tags));
    EXPECT_EQ(read.mesh.node_ids, mesh.node_ids);
    EXPECT_EQ(read.mesh.hex_ids, mesh.hex_ids);
    EXPECT_EQ(read.mesh.blocks, mesh.blocks);
    EXPECT_EQ(read.mesh.fields.size(), mesh.fields.size());
    for (const Field& field : mesh.fields)
      EXPECT_NE(std::ranges::find(read.mesh.fields, field), read.mesh.fields.end()) << field.name;
  }
}

TEST(hdf_files, integers_that_fields_can_not_hold_are_told) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(2, 1, 1);
  // The next number, which is no double, is put where the first stands.
  const std::int64_t good = (std::int64_t{1} << 54) + 4 * 123456789, bad = good + 1;
  const auto value = static_cast<double>(good);
  mesh.fields = {{"numbers", Field::On::hex, 1, {value, -value}, true}};
  const std::string from(reinterpret_cast<const char*>(&good), 8), to(reinterpret_cast<const char*>(&bad), 8);
  std::vector<std::string> names = files();
  names.emplace_back("a.vtu");
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    write_mesh(folder / name, mesh, nullptr);
    const MeshFile exact = read_mesh(folder / name);
    EXPECT_EQ(exact.mesh.fields, mesh.fields);
    EXPECT_FALSE(test::told(exact.notices, "rounded"));
    const auto data = std::filesystem::path(folder / name)
                          .replace_extension(name == "a.xdmf"  ? ".h5"
                                             : name == "a.vtu" ? ".vtu"
                                                               : name.substr(1));
    std::string bytes = test::text_of(data);
    std::size_t n = 0;
    for (auto at = bytes.find(from); at != std::string::npos; at = bytes.find(from, at + 8), ++n)
      bytes.replace(at, 8, to);
    ASSERT_EQ(n, 1U);
    test::write_text(data, bytes);
    EXPECT_TRUE(test::told(read_mesh(folder / name).notices,
                           "field 'numbers': 1 integer is rounded, because fields have 53 bits of a number"));
  }
}

/// What no integer of 64 bits is stays what it is.
TEST(hdf_files, numbers_too_large_for_integers_are_written_as_others) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(2, 1, 1);
  mesh.fields = {{"large", Field::On::hex, 1, {0x1p63, 1}, true}};
  std::vector<std::string> names = files();
  names.emplace_back("a.vtu");
  for (const std::string& name : names) {
    write_mesh(folder / name, mesh, nullptr);
    EXPECT_EQ(read_mesh(folder / name).mesh.fields.at(0).values, mesh.fields[0].values) << name;
  }
}

TEST(hdf_files, every_shipped_model_comes_back) {
  const auto folder = test::output_folder();
  int n = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models")) {
    if (entry.path().extension() != ".msh") continue;
    ++n;
    const Mesh mesh = read_mesh(entry.path()).mesh;
    for (const std::string& name : files()) {
      SCOPED_TRACE(entry.path().string() + " " + name);
      write_mesh(folder / name, mesh, nullptr);
      const MeshFile read = read_mesh(folder / name);
      EXPECT_TRUE(test::same_mesh(mesh, read.mesh));
      EXPECT_TRUE(read.notices.empty()) << read.notices[0];
    }
  }
  EXPECT_GE(n, 15);
}

TEST(hdf_files, the_same_mesh_gives_the_same_bytes) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::rich_mesh(1, true);
  for (const std::string& name : files()) {
    if (name == "a.cgns") continue;  // its library keeps the time
    write_mesh(folder / name, mesh, nullptr);
    const auto data = std::filesystem::path(folder / name).replace_extension(name == "a.xdmf" ? ".h5" : ".vtkhdf");
    const std::string once = test::text_of(data);
    write_mesh(folder / name, mesh, nullptr);
    EXPECT_EQ(once, test::text_of(data)) << name;
  }
}

TEST(hdf_files, middle_nodes_come_back) {
  const auto folder = test::output_folder();
  const MeshedModel meshed = test::shipped("bracket");
  for (const std::string& name : files())
    for (const int n : {20, 27}) {
      SCOPED_TRACE(name + " " + std::to_string(n));
      WriteOptions options;
      options.order = 2, options.nodes_per_hex = n, options.model = meshed.model.get();
      write_mesh(folder / name, meshed.mesh, &meshed.association, options);
      const MeshFile read = read_mesh(folder / name);
      const MiddleNodes expected = middle_nodes(second_order(meshed.mesh, meshed.association, meshed.model.get(), n));
      EXPECT_EQ(read.middles.nodes_per_hex, n);
      EXPECT_EQ(read.middles.edges, expected.edges);
      EXPECT_EQ(read.middles.edge_points, expected.edge_points);
      EXPECT_EQ(read.middles.faces, expected.faces);
      EXPECT_EQ(read.middles.face_points, expected.face_points);
      EXPECT_EQ(read.mesh.hexes, meshed.mesh.hexes);
      EXPECT_EQ(read.mesh.points, meshed.mesh.points);
      EXPECT_EQ(read.mesh.side_sets, meshed.mesh.side_sets);
    }
}

TEST(hdf_files, others_find_the_volume_that_is_in_them) {
  const auto folder = test::output_folder();
  MeshedModel meshed = test::shipped("cylinder");
  meshed.mesh.blocks = {{3, "lower", {}}, {8, "upper", {}}};
  for (Index h = 0; h < meshed.mesh.n_hexes(); ++h)
    meshed.mesh.blocks[static_cast<std::size_t>(h % 3 == 0)].hexes.push_back(h);
  std::vector<double> x;
  for (const Vec3& p : meshed.mesh.points) x.push_back(p.x());
  meshed.mesh.fields = {{"warm", Field::On::node, 1, x}};
  int n_judged = 0;
  const std::vector<std::pair<std::string, std::string>> judges = {
      {".vtkhdf", "vtkhdf"}, {".cgns", "vtkcgns"}, {".cgns", "h5cgns"}, {".xdmf", "meshio"}};
  for (const auto& [extension, judge] : judges)
    for (const int n : {8, 20, 27}) {
      SCOPED_TRACE(judge + " " + std::to_string(n));
      if (!test::has_format(extension) || !test::has_judge(judge)) continue;
      WriteOptions options;
      options.order = n == 8 ? 1 : 2;
      options.nodes_per_hex = n == 8 ? 0 : n;
      options.model = meshed.model.get();
      const auto file = folder / (judge + std::to_string(n) + extension);
      write_mesh(file, meshed.mesh, &meshed.association, options);
      const std::multimap<std::string, std::string> said = test::judged(judge, file);
      const double expected =
          n == 8 ? volume(meshed.mesh)
                 : test::exact_volume(second_order(meshed.mesh, meshed.association, meshed.model.get(), n));
      ASSERT_EQ(said.count("volume"), 1U);
      EXPECT_NEAR(std::stod(said.find("volume")->second), expected, 1e-9 * expected);
      EXPECT_EQ(said.find("hexes")->second, std::to_string(meshed.mesh.n_hexes()) + " " + std::to_string(n));
      if (judge == "vtkhdf" || judge == "meshio") {
        EXPECT_TRUE(test::said(said, "block", "3 " + std::to_string(meshed.mesh.blocks[0].hexes.size())));
        EXPECT_TRUE(test::said(said, "block", "8 " + std::to_string(meshed.mesh.blocks[1].hexes.size())));
      }
      if (judge != "h5cgns") {
        bool warm = false;
        for (const auto& [key, text] : said) {
          std::istringstream words(text);
          std::string name;
          double first = 0;
          if (key == "field" && words >> name >> first && name == "warm") warm = first == meshed.mesh.points[0].x();
        }
        EXPECT_TRUE(warm);
      }
      ++n_judged;
    }
  if (n_judged == 0) GTEST_SKIP() << "no python3 with VTK, h5py or meshio";
}

TEST(hdf_files, sides_of_xdmf_are_a_grid_of_tags_of_their_own) {
  if (!test::has_format(".xdmf") || !test::has_judge("meshio")) GTEST_SKIP() << "no XDMF, or no python3 with meshio";
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(3, 2, 2);
  mesh.side_sets = {{4, "left", {{0, 0}, {3, 0}}}, {7, "", {{0, 0}, {0, 1}, {1, 0}, {11, 5}}}};
  write_mesh(folder / "a.xdmf", mesh, nullptr);
  const auto said = test::judged("meshio", folder / "a_sidesets.xdmf");
  EXPECT_TRUE(test::said(said, "cells", "quad 4"));
  EXPECT_TRUE(test::said(said, "sideset", "4 2"));
  EXPECT_TRUE(test::said(said, "sideset", "7 2"));  // one of its faces twice, one in the other set first
  EXPECT_TRUE(test::same_mesh(mesh, read_mesh(folder / "a.xdmf").mesh));
}

TEST(hdf_files, xdmf_of_others_is_understood) {
  if (!test::has_format(".xdmf")) GTEST_SKIP() << "built without HDF5";
  const auto folder = test::output_folder();
  const std::string points =
      "<Geometry GeometryType=\"XYZ\"><DataItem Dimensions=\"12 3\" Format=\"XML\">"
      "0 0 0 1 0 0 2 0 0  0 1 0 1 1 0 2 1 0  0 0 1 1 0 1 2 0 1  0 1 1 1 1 1 2 1 1</DataItem></Geometry>";
  const std::string hexes =
      "<DataItem Dimensions=\"2 8\" NumberType=\"Int\" Format=\"XML\">0 1 4 3 6 7 10 9 1 2 5 4 7 8 11 10</DataItem>";
  const auto read = [&](const std::string& grids) {
    return read_mesh(test::write_text(folder / "a.xdmf",
                                      "<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n"
                                      "<Xdmf Version=\"3.0\"><Domain>" +
                                          grids + "</Domain></Xdmf>\n"));
  };
  const std::string grid = "<Grid Name=\"m\"><Topology TopologyType=\"Hexahedron\">" + hexes + "</Topology>" + points;
  const MeshFile plain = read(
      grid +
      "<Attribute Name=\"u\" Center=\"Node\"><DataItem Dimensions=\"12\">1 2 3 4 5 6 7 8 9 10 11 "
      "12</DataItem></Attribute>"
      "<Attribute Name=\"v\" Center=\"Cell\" AttributeType=\"Vector\"><DataItem Dimensions=\"2 3\">1 2 3 4 5 "
      "6</DataItem>"
      "</Attribute><Attribute Name=\"g\" Center=\"Grid\"><DataItem Dimensions=\"1\">1</DataItem></Attribute>"
      "<Set Name=\"some\" SetType=\"Node\"><DataItem Dimensions=\"2\" NumberType=\"Int\">3 1</DataItem></Set>"
      "<Set Name=\"one\" SetType=\"Cell\"><DataItem Dimensions=\"1\" NumberType=\"Int\">1</DataItem></Set>"
      "<Set Name=\"f\" SetType=\"Face\"><DataItem Dimensions=\"1\" NumberType=\"Int\">1</DataItem></Set></Grid>"
      // As DOLFINx writes tags.
      "<Grid Name=\"facets\"><Topology TopologyType=\"Quadrilateral\"><DataItem Dimensions=\"2 4\" NumberType=\"Int\" "
      "Format=\"XML\">0 3 9 6 2 8 11 5</DataItem></Topology><Attribute Name=\"facets\" Center=\"Cell\">"
      "<DataItem Dimensions=\"2 1\" NumberType=\"Int\">5 6</DataItem></Attribute></Grid>"
      "<Grid Name=\"cells\"><Topology TopologyType=\"Hexahedron\"><DataItem Dimensions=\"1 8\" NumberType=\"Int\" "
      "Format=\"XML\">4 1 2 5 10 7 8 11</DataItem></Topology><Attribute Name=\"cells\" Center=\"Cell\">"
      "<DataItem Dimensions=\"1\" NumberType=\"Int\">9</DataItem></Attribute></Grid>");
  EXPECT_EQ(plain.mesh.hexes, test::grid(2, 1, 1).hexes);
  EXPECT_EQ(plain.mesh.points, test::grid(2, 1, 1).points);
  EXPECT_EQ(plain.mesh.node_sets, (std::vector<NodeSet>{{1, "some", {1, 3}}}));
  EXPECT_EQ(plain.mesh.blocks, (std::vector<Block>{{1, "one", {1}}, {9, "", {1}}}));
  EXPECT_EQ(plain.mesh.side_sets, (std::vector<SideSet>{{5, "", {{0, 0}}}, {6, "", {{1, 1}}}}));
  EXPECT_EQ(plain.mesh.fields, (std::vector<Field>{{"u", Field::On::node, 1, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}},
                                                   {"v", Field::On::hex, 3, {1, 2, 3, 4, 5, 6}}}));
  EXPECT_EQ(plain.notices, (std::vector<std::string>{"attribute 'g' is neither of nodes nor of cells: left out",
                                                     "set 'f' of type 'Face' is left out"}));
  const MeshFile mixed = read(
      "<Grid><Topology Type=\"Mixed\"><DataItem Dimensions=\"27\" DataType=\"Int\">9 0 1 4 3 6 7 10 9 "
      "5 0 3 9 6 2 2 0 1 9 1 2 5 4 7 8 11 10</DataItem></Topology>" +
      points +
      "<Attribute Name=\"gmsh:physical\" Center=\"Cell\"><DataItem Dimensions=\"4\" NumberType=\"Int\">1 7 0 2"
      "</DataItem></Attribute></Grid>");
  EXPECT_EQ(mixed.mesh.hexes, plain.mesh.hexes);
  EXPECT_EQ(mixed.mesh.blocks, (std::vector<Block>{{1, "", {0}}, {2, "", {1}}}));
  EXPECT_EQ(mixed.mesh.side_sets, (std::vector<SideSet>{{7, "", {{0, 0}}}}));
  // Times, the mesh with the first of them and by reference.
  const std::string u0 = "<Attribute Name=\"u\" Center=\"Cell\"><DataItem Dimensions=\"2\">",
                    u1 = "</DataItem></Attribute>";
  const MeshFile times =
      read("<Grid GridType=\"Collection\" CollectionType=\"Temporal\">" + grid + "<Time Value=\"0\"/>" + u0 + "1 2" +
           u1 + "</Grid><Grid><xi:include xpointer=\"...\"/><Time Value=\"1\"/>" + u0 + "3 4" + u1 + "</Grid></Grid>");
  EXPECT_EQ(times.mesh.fields, (std::vector<Field>{{"u", Field::On::hex, 1, {3, 4}}}));
  EXPECT_EQ(times.notices, (std::vector<std::string>{"has 2 time steps: the last is read"}));
  // Or with another grid, which may come later (meshio).
  const std::string named = "<Grid Name=\"m\"><Topology TopologyType=\"Hexahedron\">" + hexes + "</Topology>" + points;
  const auto step = [&](const std::string& pointer) {
    return "<Grid GridType=\"Collection\" CollectionType=\"Temporal\"><Grid><ns0:include xpointer=\"" + pointer +
           "\"/>" + u0 + "1 2" + u1 + "</Grid></Grid>";
  };
  for (const std::string pointer :
       {"xpointer(//Grid[@Name=&quot;m&quot;]/*[self::Topology or self::Geometry])",
        "xpointer(/Xdmf/Domain/Grid[2]/*[self::Geometry or self::Topology])", "//Domain/Grid[@Name='m']/*"}) {
    SCOPED_TRACE(pointer);
    const MeshFile later = read(step(pointer) + named + "</Grid>");
    EXPECT_EQ(later.mesh.hexes, plain.mesh.hexes);
    EXPECT_EQ(later.mesh.points, plain.mesh.points);
    EXPECT_EQ(later.mesh.fields, (std::vector<Field>{{"u", Field::On::hex, 1, {1, 2}}}));
    EXPECT_TRUE(later.notices.empty()) << later.notices[0];
  }
  for (const auto& [pointer, message] : std::map<std::string, std::string>{
           {"xpointer(//Grid[@Name=&quot;n&quot;]/*)", "leads to nothing"}, {"element(/1/1/2)", "is not understood"}}) {
    std::string said = "no error";
    try {
      read(step(pointer) + named + "</Grid>");
    } catch (const Error& error) {
      said = error.what();
    }
    EXPECT_NE(said.find(message), std::string::npos) << said;
  }
  const MeshFile referred = read(grid + "</Grid>" +
                                 "<Grid GridType=\"Collection\" CollectionType=\"Temporal\"><Grid><Topology "
                                 "TopologyType=\"Hexahedron\"><DataItem "
                                 "Reference=\"XML\">/Xdmf/Domain/Grid[@Name='m']/Topology/DataItem</DataItem>"
                                 "</Topology><Geometry GeometryType=\"XYZ\"><DataItem "
                                 "Reference=\"/Xdmf/Domain/Grid[1]/Geometry/DataItem\"/></Geometry>"
                                 "</Grid></Grid>");
  EXPECT_EQ(referred.mesh.hexes, plain.mesh.hexes);
}

TEST(hdf_files, what_is_wrong_with_xdmf_is_said_with_its_line) {
  if (!test::has_format(".xdmf")) GTEST_SKIP() << "built without HDF5";
  const auto file = test::output_folder() / "a.xdmf";
  const auto says = [&](const std::string& text, const std::string& expected) {
    test::write_text(file, text);
    EXPECT_EQ(test::refusal(file), file.string() + expected);
  };
  const std::string head = "<Xdmf Version=\"3.0\">\n<Domain>\n<Grid>\n", tail = "</Grid>\n</Domain>\n</Xdmf>\n";
  says("<Html/>\n", ":1: not an XDMF file: it begins with 'Html'");
  says("hello\n", ":1: not an XDMF file");
  says(head, ":4: the file ends where the end of 'Grid' should stand");
  says("<Xdmf>\n<Domain>\n</Grid>\n", ":3: expected the end of 'Domain', found that of 'Grid'");
  says("<Xdmf>\n</Xdmf>\n", ":1: there is no Domain");
  says(head + tail, ":2: there is no grid of hexes");
  says(head + "<Topology TopologyType=\"3DSMesh\"/>\n" + tail,
       ":4: a topology of type '3DSMesh'; only unstructured grids of hexes with 8, 20 or 27 nodes are read");
  says(head + "<Topology TopologyType=\"Hexahedron\"/>\n" + tail, ":4: Topology without a DataItem");
  const auto item = [&](const std::string& what) {
    return head + "<Topology TopologyType=\"Hexahedron\">\n" + what + "</Topology>\n" + tail;
  };
  says(item("<DataItem/>\n"), ":5: a DataItem has no sizes");
  says(item("<DataItem Dimensions=\"99999999999 99999999999\"/>\n"), ":5: a DataItem has impossible sizes");
  says(item("<DataItem Dimensions=\"1 8\" NumberType=\"Int\">1 2 3</DataItem>\n"),
       ":5: the file ends where the values of 'DataItem' should stand");
  says(item("<DataItem Dimensions=\"1 8\" Format=\"Binary\">a.bin</DataItem>\n"),
       ":5: a DataItem of format 'Binary' is not read, but HDF and XML");
  says(item("<DataItem Dimensions=\"1 8\" ItemType=\"HyperSlab\"/>\n"),
       ":5: a DataItem of type 'HyperSlab' is not read");
  says(item("<DataItem Dimensions=\"1 8\" Format=\"HDF\">none</DataItem>\n"), ":5: 'none' names no dataset of a file");
  says(item("<DataItem Reference=\"/Xdmf/Domain/Grid/Topology/DataItem\"/>\n"), ":5: references go in a circle");
  test::write_text(file, item("<DataItem Dimensions=\"1 8\" Format=\"HDF\">none.h5:/a</DataItem>\n"));
  EXPECT_NE(test::refusal(file).find("the file with its data, "), std::string::npos);
  says(head +
           "<Topology TopologyType=\"Tetrahedron\"><DataItem Dimensions=\"4\" NumberType=\"Int\">0 1 2 3</DataItem>"
           "</Topology>\n" +
           tail,
       ":2: there is no grid of hexes");
}

TEST(hdf_files, of_another_content_are_refused) {
  const auto folder = test::output_folder();
  for (const std::string& name : files()) {
    if (name == "a.xdmf") continue;
    const auto file = test::write_text(folder / name, "something else\n");
    const std::string said = test::refusal(file);
    EXPECT_TRUE(said.starts_with(file.string() + ": cannot be opened as ")) << said;
  }
  // One of the formats is no other one.
  const Mesh mesh = test::grid(2, 1, 1);
  if (files().size() < 3) return;
  write_mesh(folder / "a.vtkhdf", mesh, nullptr);
  write_mesh(folder / "b.cgns", mesh, nullptr);
  std::filesystem::copy_file(folder / "a.vtkhdf", folder / "c.cgns", std::filesystem::copy_options::overwrite_existing);
  std::filesystem::copy_file(folder / "b.cgns", folder / "c.vtkhdf", std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(test::refusal(folder / "c.vtkhdf"),
            (folder / "c.vtkhdf").string() + ": not a VTKHDF file: there is no group VTKHDF");
  EXPECT_NE(test::refusal(folder / "c.cgns"), "no error");
}

TEST(hdf_files, names_that_a_format_can_not_have_are_kept_or_told) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(2, 1, 1);
  mesh.blocks = {
      {1, "a/b: <steel> & \"more\"", {0}}, {2, std::string(60, 'x'), {1}}, {3, std::string(60, 'x'), {0, 1}}};
  mesh.node_sets = {{1, "GridCoordinates", {0}}, {2, "ZoneBC", {1}}};
  mesh.side_sets = {{1, "GridCoordinates", {{0, 0}}}, {2, ".", {{1, 1}}}};
  mesh.fields = {{"p/q", Field::On::node, 1, std::vector<double>(12, 1)},
                 {"p:q", Field::On::node, 1, std::vector<double>(12, 2)}};
  for (const std::string& name : files()) {
    SCOPED_TRACE(name);
    const auto notices = write_mesh(folder / name, mesh, nullptr);
    const Mesh back = read_mesh(folder / name).mesh;
    EXPECT_EQ(back.blocks, mesh.blocks);
    EXPECT_EQ(back.node_sets, mesh.node_sets);
    EXPECT_EQ(back.side_sets, mesh.side_sets);
    ASSERT_EQ(back.fields.size(), 2U);
    if (name == "a.cgns") {
      const auto told = [&](const std::string& line) { return std::ranges::find(notices, line) != notices.end(); };
      EXPECT_TRUE(told("field 'p/q' is called 'p_q' in the file"));
      EXPECT_TRUE(told("block 2 '" + std::string(60, 'x') + "' is called '" + std::string(32, 'x') + "' in the file"));
    } else {
      EXPECT_EQ(back.fields, mesh.fields);
      EXPECT_TRUE(notices.empty());
    }
  }
}

}  // namespace
}  // namespace hextwist
