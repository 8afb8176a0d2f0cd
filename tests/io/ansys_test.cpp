// ANSYS archives as others write them.
#include <cstdio>

#include "io/io_support.h"

namespace hextwist {
namespace {

constexpr const char* ansys_cube =
    "/COM,ANSYS RELEASE 12.1\n/PREP7\nET,1,SOLID185\nET,2,154\n"
    "NBLOCK,6,SOLID\n(3i8,6e16.9)\n"
    "       1       0       0\n"
    "       2       0       0 1.000000000E+00\n"
    "       3       0       0 1.000000000E+00 1.000000000E+00\n"
    "       4       0       0 0.000000000E+00 1.000000000E+00\n"
    "       5       0       0 0.000000000E+00 0.000000000E+00 1.000000000E+00\n"
    "       6       0       0 1.000000000E+00 0.000000000E+00 1.000000000E+00 9.000000000E+01\n"
    "       7       0       0 1.000000000E+00 1.000000000E+00 1.000000000E+00\n"
    "       8       0       0 0.000000000E+00 1.000000000E+00 1.000000000E+00\n"
    "N,R5.3,LOC,       -1,\n";
constexpr const char* ansys_hex =
    "      3      1      1      1      0      0      0      0      8      0     10      1      2      3      4      5"
    "      6      7      8\n";

TEST(ansys_files, of_other_programs_are_understood) {
  const auto folder = test::output_folder();
  const MeshFile read = read_mesh(test::write_text(
      folder / "a.cdb",
      std::string(ansys_cube) + "EBLOCK,19,SOLID\n(19i7)\n" + ansys_hex +
          "      1      2      1      1      0      0      0      0      4      0     11      1      2      6      5\n"
          "     -1\nCMBLOCK,SOME_NODES,NODE,       4  ! users node component definition\n(8i10)\n"
          "         1        -3         7         8\nCMBLOCK,FRONT   ,ELEM,       1\n(8i10)\n        11\n"
          "MPTEMP,R5.0,1,1,0.00000\nMPDATA,R5.0,1,EX,1,1,210000.\n/GO\nFINISH\n"));
  EXPECT_EQ(read.mesh.hexes, (std::vector<Hex>{{0, 1, 3, 2, 4, 5, 7, 6}}));
  EXPECT_DOUBLE_EQ(volume(read.mesh), 1);
  EXPECT_EQ(read.mesh.hex_ids, (std::vector<std::int64_t>{10}));
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{3, "", {0}}}));
  EXPECT_EQ(read.mesh.node_sets, (std::vector<NodeSet>{{1, "SOME_NODES", {0, 1, 2, 6, 7}}}));
  EXPECT_EQ(read.mesh.side_sets, (std::vector<SideSet>{{2, "FRONT", {{0, 2}}}}));
  EXPECT_EQ(read.notices,
            (std::vector<std::string>{
                "2 other commands left out (the first: MPTEMP)",
                "directions of degrees of freedom (rotations in NBLOCK) of 1 node left out; the first is 6"}));
  // Types as a block, fields of ten characters, numbers of elements left out.
  std::string text = ansys_cube;
  text.replace(text.find("ET,1"), 23,
               "ETBLOCK,        2,        2\n(2i9,19a9)\n        1      185        0        0\n"
               "        2      154        0        0\n       -1\n");
  const MeshFile other = read_mesh(test::write_text(
      folder / "b.cdb", text +
                            "EBLOCK,19,SOLID,         1,         1\n(19i10)\n         1         1         1         1"
                            "         0         0         0         0         8         0         0         1         2"
                            "         3         4         5         6         7         8\n        -1\n"));
  EXPECT_EQ(other.mesh.hexes, read.mesh.hexes);
  EXPECT_EQ(other.mesh.blocks, (std::vector<Block>{{1, "", {0}}}));
}

TEST(ansys_files, what_is_wrong_is_said_with_its_line) {
  const auto folder = test::output_folder();
  const auto says = [&](const std::string& text, const std::string& expected) {
    const auto file = test::write_text(folder / "a.cdb", ansys_cube + text);
    EXPECT_EQ(test::refusal(file), file.string() + expected);
  };
  const std::string only = "; only hexes of 8, 20 or 27 nodes are accepted", block = "EBLOCK,19,SOLID\n(19i7)\n";
  const auto hex = [](const char* nodes, int n = 8, int type = 1) {
    std::array<char, 200> text{};
    std::snprintf(text.data(), text.size(), "      3%7d      1      1      0      0      0      0%7d      0     10%s\n",
                  type, n, nodes);
    return std::string(text.data());
  };
  says("", ":16: there is no EBLOCK in the file");
  says(block, ":18: the file ends inside of EBLOCK");
  says(block + "     -1\n", ":19: there is no hex in the file");
  says("EBLOCK,19,SOLID\n(19x7)\n", ":17: expected the format of EBLOCK, like (19i9), found '(19x7)'");
  says(block + hex("      1      2      3      4      5      6      7      9") + "-1\n",
       ":18: element 10 names node 9, which is not there");
  says(block + hex("      1      2      3      4      5      6      7      x") + "-1\n",
       ":18: expected a node, found '      x'");
  says(block + hex("      1      2      3      3      5      6      7      7") + "-1\n",
       ":18: element 10 is a wedge (a hex with repeated nodes)" + only);
  says(block + hex("      1      2      3      4", 4) + "-1\n", ":18: element 10 has 4 nodes, where a hex has 8 or 20");
  says(block + hex("      1      2      3      4", 99) + "-1\n", ":18: element 10 has 99 nodes");
  says(block + hex("      1      2      3      4      5      6      7      8", 10, 5) + "      1      2\n-1\n",
       ":18: element 10 is a tetrahedron" + only);
  says("CMBLOCK,A,NODE,       2\n(8i10)\n        -5         2\n",
       ":18: component A has the member -5, which ends no range");
  says("CMBLOCK,A,BODY,       2\n", ":16: component 'A' is neither of nodes nor of elements");
  says("CMBLOCK,A,NODE,  20000\n", ":17: the file is too short for 20000 members of component A");
  says("EN,R5.5,ATTR,8,1\n",
       ":16: nodes and elements are read from NBLOCK and EBLOCK only: write the file with CDWRITE and its option "
       "BLOCKED");
  says("NBLOCK,6,SOLID\n(3i8,6e16.9)\n       9       0       0 1.0000000x0E+00\n",
       ":18: node 9 has '1.0000000x0E+00' where a coordinate should stand");
  says("/INPUT,more,cdb\n", ":16: /INPUT is not followed: nodes or elements would be missing");
}

TEST(ansys_files, names_that_cm_does_not_permit_are_not_written) {
  const auto file = test::output_folder() / "a.cdb";
  Mesh mesh = test::grid(1, 1, 1);
  mesh.blocks = {{1, "all", {0}}, {2, "ALL_1", {0}}};
  mesh.node_sets = {{3, "Stat", {0}}, {4, "DEFA", {1}}, {5, "DEFAULT", {2}}};
  const auto notices = write_mesh(file, mesh, nullptr);
  EXPECT_TRUE(test::told(notices, "block 1 'all' is called 'ALL_1' in the file"));
  EXPECT_TRUE(test::told(notices, "nodeset 3 'Stat' is called 'STAT_3' in the file"));
  EXPECT_TRUE(test::told(notices, "nodeset 4 'DEFA' is called 'DEFA_4' in the file"));
  std::set<std::string> names;
  std::istringstream lines(test::text_of(file));
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("CMBLOCK,")) {
      EXPECT_TRUE(names.insert(line.substr(8, line.find(',', 8) - 8)).second) << line;
    }
  EXPECT_EQ(names, (std::set<std::string>{"ALL_1", "ALL_1_2", "STAT_3", "DEFA_4", "DEFAULT"}));
  EXPECT_TRUE(test::same_mesh(read_mesh(file).mesh, mesh));
}

TEST(ansys_files, types_and_key_options_that_become_others_are_told) {
  const auto folder = test::output_folder();
  const auto notices = [&](const std::string& types, const std::string& second = "") {
    std::string text = ansys_cube;
    text.replace(text.find("ET,1"), 23, types);
    return read_mesh(test::write_text(folder / "a.cdb",
                                      text + "EBLOCK,19,SOLID\n(19i7)\n" + ansys_hex + second + "     -1\n"))
        .notices;
  };
  const std::string turned =
      "directions of degrees of freedom (rotations in NBLOCK) of 1 node left out; the first is 6";
  using Lines = std::vector<std::string>;
  EXPECT_EQ(notices("ET,1,186\nKEYOP,1,2,0\nET,2,154\nKEYOPT,2,4,1\n"), (Lines{turned}));
  EXPECT_EQ(notices("ET,1,45\nKEYOP, 1, 2, 1\nKEYOP,1,3,1\n"),
            (Lines{"hexes of type SOLID45 are SOLID185 or SOLID186 when they are written",
                   "key options of 1 type of hexes left out (the first: KEYOP, 1, 2, 1)", turned}));
  std::string second = ansys_hex;
  second.replace(second.find("      1      1"), 7, "      2").replace(second.find("     10"), 7, "     11");
  EXPECT_EQ(notices("ET,1,185\nET,2,185\n", second),
            (Lines{"hexes of 2 types are of one when they are written", turned}));
}

TEST(ansys_files, empty_components_are_told) {
  const MeshFile read = read_mesh(test::write_text(
      test::output_folder() / "a.cdb", std::string(ansys_cube) + "EBLOCK,19,SOLID\n(19i7)\n" + ansys_hex +
                                           "     -1\nCMBLOCK,CEM,ELEM,       0\n(8i10)\nCMBLOCK,CN,NODE,       1\n"
                                           "(8i10)\n         1\nCMBLOCK,B,NODE,       0\n(8i10)\nFINISH\n"));
  EXPECT_TRUE(test::told(read.notices, "2 empty components left out (the first: CEM)"));
  EXPECT_EQ(test::names_and_members(read.mesh.node_sets), (std::set<std::string>{"CN:0"}));
}

TEST(ansys_files, what_can_not_be_kept_is_told) {
  const auto folder = test::output_folder();
  Mesh mesh = test::rich_mesh(2, true);
  mesh.node_sets.push_back({100, "empty", {}});
  const auto notices = write_mesh(folder / "a.cdb", mesh, nullptr);
  EXPECT_TRUE(test::told(notices, "fields"));
  EXPECT_TRUE(test::told(notices, "block 2 'steel (hot)' is called 'STEEL__HOT_' in the file"));
  EXPECT_TRUE(test::told(notices, "nodeset 100 is empty and left out: components have members"));
  EXPECT_TRUE(test::told(notices, "hexes in no block, or in block 0, are of material 71"));
  std::istringstream lines(test::text_of(folder / "a.cdb"));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 171U) << line;
}

TEST(ansys_files, components_of_a_model_are_left_out_with_a_note) {
  const std::string hex =
      "EBLOCK,19,SOLID\n(19i7)\n      1      1      1      1      0      0      0      0      8      0      3      1   "
      "   2"
      "      3      4      5      6      7      8\n     -1\n";
  const MeshFile read = read_mesh(test::write_text(
      test::output_folder() / "a.cdb",
      ansys_cube + hex +
          "CMBLOCK,KPS,KP  ,       3  ! of points\n(2i7)\n      1      2\n      3\n"
          "CMBLOCK,WALL,AREA,       1\n(8i7)\n      9\nCMBLOCK,N,NODE,       2\n(8i7)\n      1     -3\n"));
  EXPECT_EQ(read.mesh.node_sets.size(), 1u);
  EXPECT_EQ(read.mesh.node_sets.at(0).nodes.size(), 3u);
  EXPECT_EQ(read.notices.back(),
            "2 components of points, lines, areas or volumes of a model left out (the first: KPS)");
}

}  // namespace
}  // namespace hextwist
