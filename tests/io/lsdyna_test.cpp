// LS-DYNA keyword files as others write them.
#include "hextwist/mesh/second_order/second_order.h"
#include "io/io_support.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

constexpr const char* dyna_cube =
    "$ a comment\n*KEYWORD\n*TITLE\na cube\n*NODE\n"
    "       1              0.             0.0             0.0       0       0\n"
    "       2           1.0E0             0.0             0.0\n"
    "3, 1, 1.0, 0\n"
    "$ another\n"
    "       4                           10.-1\n"
    "*NODE %\n"
    "         5             0.0             0.0             1.0\n"
    "         6           1.0D0             0.0             1.0\n"
    "*NODE +\n"
    "                   7                 1.0                 1.0                 1.0\n"
    "*NODE\n"
    "8,0,1,1\n";

TEST(lsdyna_files, cards_of_all_widths_and_layouts_are_understood) {
  const auto folder = test::output_folder();
  for (const std::string element :
       {"*ELEMENT_SOLID\n      10       7       1       2       3       4       5       6       7       8\n",
        "*ELEMENT_SOLID\n      10       7\n       1       2       3       4       5       6       7       8\n",
        "*ELEMENT_SOLID\n      10       7\n       1       2       3       4       5       6       7       8       0    "
        "   0\n",
        "*element_solid\n10,7\n1,2,3,4,5,6,7,8\n", "*ELEMENT_SOLID_ORTHO\n10,7,1,2,3,4,5,6,7,8\n1.,0.,0.\n0.,1.,0.\n",
        "*ELEMENT_SOLID+\n                  10                   7                   1                   2"
        "                   3                   4                   5                   6"
        "                   7                   8\n"}) {
    SCOPED_TRACE(element);
    const MeshFile read = read_mesh(test::write_text(
        folder / "a.k",
        dyna_cube + element +
            "*PART\nthe cube, of steel\n         7         1         1\n\n*MAT_ELASTIC\n1,7.8e-9,2.1e5,.3\n"
            "*SET_NODE_LIST_TITLE\nsome nodes\n         3\n         1         2         3         4\n         8\n"
            "*SET_NODE_LIST_GENERATE\n4\n5,7\n*SET_NODE_COLUMN\n5\n6,1.0\n"
            "*SET_SEGMENT_TITLE\nbelow\n2\n4,3,2,1,0.0\n*SET_SEGMENT\n6\n5,6,7,8\n"
            "*ELEMENT_SHELL\n1,9,1,2,6,5\n2,9,1,2,6,6\n*ELEMENT_BEAM\n1,4,1,2\n*END\nnothing of this\n"));
    EXPECT_EQ(read.mesh.hexes, (std::vector<Hex>{{0, 1, 3, 2, 4, 5, 7, 6}}));
    EXPECT_DOUBLE_EQ(volume(read.mesh), 1);
    EXPECT_EQ(read.mesh.hex_ids, (std::vector<std::int64_t>{10}));
    EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{7, "the cube, of steel", {0}}}));
    EXPECT_EQ(read.mesh.node_sets,
              (std::vector<NodeSet>{{3, "some nodes", {0, 1, 2, 3, 7}}, {4, "", {4, 5, 6}}, {5, "", {5}}}));
    EXPECT_EQ(read.mesh.side_sets,
              (std::vector<SideSet>{{2, "below", {{0, 4}}}, {6, "", {{0, 5}}}, {9, "", {{0, 2}}}}));
    EXPECT_TRUE(test::told(read.notices, "2 other keywords left out: *MAT_ELASTIC, *ELEMENT_BEAM"));
    EXPECT_TRUE(test::told(read.notices, "dropped 1 element of type *ELEMENT_SHELL with three corners"));
    EXPECT_TRUE(test::told(read.notices, "attributes (A1 to A4, DA1 to DA4) of 1 set left out; the first is 5"));
    EXPECT_EQ(read.notices.size(), element.find("ORTHO") == std::string::npos ? 3U : 4U);
  }
}

TEST(lsdyna_files, long_files_and_ten_columns_are_said_once) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::tidy_mesh(2, true);
  write_mesh(folder / "a.k", mesh, nullptr);
  std::istringstream lines(test::text_of(folder / "a.k"));
  std::string wide, ten, keyword;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("*")) keyword = line;
    std::string widened = line, tenned = line;
    if (!line.starts_with("*") && !line.starts_with("$") && (keyword == "*NODE" || keyword == "*ELEMENT_SOLID")) {
      widened.clear(), tenned.clear();
      for (std::size_t at = 0, width = 8; at < line.size(); at += width, width = keyword == "*NODE" ? 16 : 8) {
        const std::string field = line.substr(at, width);
        widened += std::string(20 - field.size(), ' ') + field;
        tenned += std::string(width == 8 ? 10 - field.size() : 0, ' ') + field;
      }
    } else if (keyword.starts_with("*SET") && line.find_first_not_of("0123456789 ") == std::string::npos) {
      widened.clear();
      for (std::size_t at = 0; at < line.size(); at += 10) widened += std::string(10, ' ') + line.substr(at, 10);
    } else if (keyword == "*PART" && line.find_first_not_of("0123456789 ") == std::string::npos) {
      widened = std::string(10, ' ') + line.substr(0, 10);
    }
    wide += widened + "\n", ten += tenned + "\n";
  }
  wide.replace(0, 8, "*KEYWORD LONG=Y"), ten.replace(0, 8, "*KEYWORD I10=Y");
  const Mesh back = read_mesh(folder / "a.k").mesh;
  EXPECT_TRUE(test::same_mesh(back, read_mesh(test::write_text(folder / "wide.k", wide)).mesh));
  EXPECT_TRUE(test::same_mesh(back, read_mesh(test::write_text(folder / "ten.key", ten)).mesh));
}

TEST(lsdyna_files, constraints_attributes_and_materials_are_told) {
  const auto folder = test::output_folder();
  const auto notices = [&](const std::string& text, const std::string& nodes = dyna_cube) {
    const MeshFile read =
        read_mesh(test::write_text(folder / "a.k", nodes + "*ELEMENT_SOLID\n10,7,1,2,3,4,5,6,7,8\n" + text + "*END\n"));
    EXPECT_DOUBLE_EQ(volume(read.mesh), 1);
    return read.notices;
  };
  using Lines = std::vector<std::string>;
  EXPECT_EQ(notices("*PART\np\n7,1,1\n*PART\nq\n8\n"), Lines());
  EXPECT_EQ(
      notices("*PART\np\n         7         4         9\n*PART\nq\n3,1,1,0,0,0,1\n*PART_INERTIA\nr\n8,1,1\n0,0,0\n"),
      (Lines{"sections, materials and the like (SECID 1 and MID 1 are written) of 3 parts left out; the first is "
             "3"}));
  EXPECT_EQ(notices("*SET_SEGMENT\n3\n         1         2         3         4       5.0       6.0\n"
                    "*SET_SEGMENT\n2,0,0,0,0,MECH\n5,6,7,8\n*SET_NODE_LIST\n4,0.,2.5\n1,2\n*SET_SOLID\n9,MECH\n10\n"),
            (Lines{"attributes (A1 to A4, DA1 to DA4) of 2 sets left out; the first is 3",
                   "1 side of set 3 turns into the hex: here it is the other way, outwards"}));
  // Of nodes in fields of all widths.
  std::string small = "*KEYWORD\n*NODE\n", ten = "*KEYWORD I10=Y\n*NODE\n", wide = "*KEYWORD LONG=Y\n*NODE\n",
              free = "*KEYWORD\n*NODE\n", none = small;
  const auto field = [](const std::string& text, std::size_t width) {
    return std::string(width - text.size(), ' ') + text;
  };
  constexpr std::array<const char*, 8> points = {"0,0,0", "1,0,0", "1,1,0", "0,1,0",
                                                 "0,0,1", "1,0,1", "1,1,1", "0,1,1"};
  for (std::size_t n = 0; n < 8; ++n) {
    const std::string id = std::to_string(n + 1), tc = n == 2 ? "7" : "0", rc = n == 5 ? "3" : "0", p = points[n];
    const auto line = [&](std::size_t a, std::size_t b, const std::string& t, const std::string& r) {
      return field(id, a) + field(p.substr(0, 1), b) + field(p.substr(2, 1), b) + field(p.substr(4, 1), b) +
             field(t, a) + field(r, a) + "\n";
    };
    small += line(8, 16, tc, rc), ten += line(10, 16, tc, rc), wide += line(20, 20, tc, rc);
    free += id + "," + p + "," + tc + "," + rc + "\n", none += line(8, 16, "0", "");
  }
  for (const std::string& nodes : {small, free})
    EXPECT_EQ(notices("", nodes), (Lines{"constraints (TC, RC) of 2 nodes left out; the first is 3"}));
  EXPECT_EQ(notices("", none), Lines());
  for (const std::string& nodes : {ten, wide}) {
    const MeshFile read =
        read_mesh(test::write_text(folder / "b.k", nodes + "*ELEMENT_SOLID\n10,7,1,2,3,4,5,6,7,8\n*END\n"));
    EXPECT_EQ(read.notices, (Lines{"constraints (TC, RC) of 2 nodes left out; the first is 3"}));
  }
}

TEST(lsdyna_files, what_is_wrong_is_said_with_its_line) {
  const auto folder = test::output_folder();
  const auto says = [&](const std::string& text, const std::string& expected) {
    const auto file = test::write_text(folder / "a.k", dyna_cube + text);
    EXPECT_EQ(test::refusal(file), file.string() + expected);
  };
  const std::string only = "; only hexes of 8, 20 or 27 nodes are accepted";
  says("*ELEMENT_SOLID\n3,1,1,2,3,5,5,5,5,5\n", ":19: element 3 is a tetrahedron (a hex with repeated nodes)" + only);
  says("*ELEMENT_SOLID\n3,1,1,2,3,4,5,6,7,7\n", ":19: element 3 is a hex with repeated nodes" + only);
  says("*ELEMENT_SOLID\n3,1,1,2,6,5,4,4,8,8\n", ":19: element 3 is a wedge (a hex with repeated nodes)" + only);
  says("*ELEMENT_SOLID\n3,1,1,2,3,4,5,5,5,5\n", ":19: element 3 is a pyramid (a hex with repeated nodes)" + only);
  says("*ELEMENT_SOLID\n3,1\n1,2,3,4,5,6,7,8,9,10\n", ":19: element 3 is a tetrahedron of 10 nodes" + only);
  says("*ELEMENT_SOLID\n3,1\n1,2,3,4\n", ":19: element 3 is a tetrahedron" + only);
  says("*ELEMENT_SOLID\n3,1\n", ":19: element 3 has 0 of 8 nodes");
  says("*ELEMENT_SOLID\n3,1\n1,2,3,4,5,6,7\n", ":19: element 3 has 7 of 8 corners");
  says("*ELEMENT_SOLID\n3,1,1,2,3,4,5,6,7,9\n", ":19: element 3 names node 9, which is not there");
  says("*ELEMENT_SOLID\n3,1,1,2,3,4,5,6,7,&a\n", ":19: *ELEMENT_SOLID has '&a' where a node should stand");
  says("*ELEMENT_SOLID_H27\n",
       ":18: *ELEMENT_SOLID_H27 is not read: in which order its middle nodes are is not known here");
  says("*ELEMENT_SOLID_H20\n3,1\n1,2,3,4,5,6,7,8,9,10\n", ":19: element 3 has 10 of 20 nodes");
  says("*ELEMENT_SOLID_T15\n3,1\n", ":19: element 3 is a *ELEMENT_SOLID_T15" + only);
  says("*ELEMENT_TSHELL\n3,1,1,2,3,4,5,6,7,8\n", ":19: element 3 is a thick shell" + only);
  says("*NODE\n8,0,1,1\n*ELEMENT_SOLID\n3,1,1,2,3,4,5,6,7,8\n", ":19: node id 8 occurs twice");
  says("*NODE\n9,0,x,1\n", ":19: *NODE has 'x' where a coordinate should stand");
  says("*NODE\n9,0,1e999,1\n", ":19: *NODE has '1e999' where a coordinate should stand");
  says("*INCLUDE\nparts.k\n", ":18: *INCLUDE of 'parts.k' is not followed: nodes or elements would be missing");
  says("*NODE_TRANSFORM\n1,1\n", ":18: *NODE_TRANSFORM changes the nodes and is not read: the mesh would be another");
  says("*END\n", ":19: there is no hex in the file");
  says("*PART\nx\n-1\n", ":20: a part -1 is not between 0 and 2147483647");
  says("*\n", ":18: a '*' without a keyword");
}

TEST(lsdyna_files, no_number_touches_its_neighbour_nor_leaves_its_field) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(1, 1, 1);
  const std::array<double, 8> odd = {
      1, -1e-300, -1.2345678901234567e-7, -9.8765432109876543e12, 0.1, -123456.78901234567, 1e22, 3};
  for (std::size_t n = 0; n < 8; ++n) mesh.points[n].y() = odd[n];
  mesh.node_ids = {1, 22, 333, 4444, 55555, 666666, 7777777, 99999999};
  mesh.hex_ids = {99999999};
  mesh.blocks = {{99999999, "*not a keyword", {0}}};
  mesh.node_sets = {{1, "$ " + std::string(90, 'x'), {0}}};
  const auto notices = write_mesh(folder / "a.k", mesh, nullptr);
  EXPECT_TRUE(test::told(notices, "block 99999999 '*not a keyword' is called '_not a keyword' in the file"));
  EXPECT_TRUE(test::told(notices, "nodeset 1 '$ xxx"));
  std::istringstream lines(test::text_of(folder / "a.k"));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
  const Mesh back = read_mesh(folder / "a.k").mesh;
  EXPECT_EQ(back.node_ids, mesh.node_ids);
  test::expect_points_near(back.points, mesh.points, 1e-8);
  mesh.node_ids.back() = 100'000'000;
  EXPECT_TRUE(test::told(write_mesh(folder / "a.k", mesh, nullptr),
                         "node id 100000000 has more than eight digits: nodes are counted from 1 in the file"));
}

/// Gmsh writes .key too, by its own hand.
TEST(lsdyna_files, of_gmsh_have_the_volume_that_gmsh_has_in_them) {
  if (std::system("/usr/bin/python3 -c 'import gmsh' > /dev/null 2>&1") != 0) GTEST_SKIP() << "no python3 with Gmsh";
  const auto folder = test::output_folder();
  const MeshedModel meshed = test::shipped("cylinder");
  for (const int order : {1, 2}) {
    WriteOptions options;
    options.order = order;
    options.model = meshed.model.get();
    write_mesh(folder / "a.msh", meshed.mesh, &meshed.association, options);
    const std::string script =
        "import gmsh\ngmsh.initialize()\ngmsh.option.setNumber('General.Terminal', 0)\ngmsh.open('" +
        (folder / "a.msh").string() + "')\ngmsh.write('" + (folder / "gmsh.key").string() + "')\n";
    ASSERT_EQ(std::system(("/usr/bin/python3 " + test::write_text(folder / "script.py", script).string() + " > " +
                           (folder / "log.txt").string() + " 2>&1")
                              .c_str()),
              0);
    const MeshFile read = read_mesh(folder / "gmsh.key");
    EXPECT_EQ(read.mesh.n_hexes(), meshed.mesh.n_hexes());
    EXPECT_NEAR(volume(read.mesh), volume(meshed.mesh), 1e-5 * volume(meshed.mesh));
    EXPECT_EQ(read.middles.nodes_per_hex, order == 1 ? 8 : 20);
    if (order == 1) continue;
    // Every middle is where ours was, so the order of nodes is the same.
    const MiddleNodes expected = middle_nodes(second_order(meshed.mesh, meshed.association, meshed.model.get(), 20));
    ASSERT_EQ(read.middles.edges.size(), expected.edges.size());
    std::vector<double> found, wanted;
    for (std::size_t e = 0; e < expected.edges.size(); ++e) {
      const auto off = [](const Mesh& mesh, const MiddleNodes& middles, std::size_t i) {
        return (middles.edge_points[i] - (mesh.points[middles.edges[i][0]] + mesh.points[middles.edges[i][1]]) / 2)
            .norm();
      };
      found.push_back(off(read.mesh, read.middles, e)), wanted.push_back(off(meshed.mesh, expected, e));
    }
    std::ranges::sort(found), std::ranges::sort(wanted);
    for (std::size_t e = 0; e < found.size(); ++e) EXPECT_NEAR(found[e], wanted[e], 1e-5);
  }
}

/// Both are numbered each for itself, and a hex of a part in a set stays in its part.
TEST(lsdyna_files, sets_of_solids_are_behind_the_parts) {
  const auto folder = test::output_folder();
  const MeshFile read = read_mesh(test::write_text(
      folder / "a.k", std::string(dyna_cube) +
                          "*ELEMENT_SOLID\n10,7,1,2,3,4,5,6,7,8\n*PART\nsteel\n7,1,1\n*PART\nalu\n5,1,1\n"
                          "*SET_SOLID_TITLE\noutput\n7\n10\n*SET_SOLID\n2\n10\n*SET_SOLID\n9\n10\n*END\n"));
  EXPECT_EQ(read.notices,
            (std::vector<std::string>{"sets of solids are blocks behind those of parts: 2 is 10, 7 is 11"}));
  std::map<int, std::string> names;
  for (const Block& block : read.mesh.blocks) names[block.id] = block.name;
  EXPECT_EQ(names.at(7), "steel");
  EXPECT_EQ(names.at(11), "output");
  write_mesh(folder / "b.k", read.mesh, nullptr, {.extras = &read.extras});
  EXPECT_NE(test::text_of(folder / "b.k").find("*ELEMENT_SOLID\n      10       7"), std::string::npos) << "its part";
  // Files of ours have the same number for both.
  EXPECT_TRUE(test::same_mesh(read.mesh, read_mesh(folder / "b.k").mesh));
}

}  // namespace
}  // namespace hextwist
