#include "io/io_support.h"

namespace hextwist {
namespace {

/// What the format can hold: no ids, no fields.
Mesh without_ids_and_fields(Mesh mesh) {
  mesh.node_ids.clear();
  mesh.hex_ids.clear();
  mesh.fields.clear();
  return mesh;
}

TEST(medit_files, a_mesh_with_sets_comes_back_bit_for_bit) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    const Mesh mesh = without_ids_and_fields(test::rich_mesh(seed, true));
    const auto file = test::output_folder() / "mesh.mesh";
    write_mesh(file, mesh, nullptr);
    const auto back = read_mesh(file);
    EXPECT_TRUE(test::same_mesh(mesh, back.mesh));
    EXPECT_TRUE(back.tags.empty());
    EXPECT_TRUE(back.notices.empty());
    const auto tags = test::brick_association(mesh, Vec3(4, 3, 3));
    write_mesh(file, mesh, &tags);
    const auto owned = read_mesh(file);
    EXPECT_TRUE(test::same_mesh(mesh, owned.mesh));
    EXPECT_TRUE(test::same_owners(tags, owned.tags));
    Mesh bare = mesh;
    bare.blocks.clear();
    bare.side_sets.clear();
    bare.node_sets.clear();
    write_mesh(file, bare, &tags);
    EXPECT_TRUE(test::same_mesh(bare, read_mesh(file).mesh));
    EXPECT_TRUE(test::same_owners(tags, read_mesh(file).tags));
  }
}

TEST(medit_files, plain_groups_are_plain_references) {
  Mesh mesh = test::grid(2, 1, 1);
  mesh.blocks = {{3, "", {0}}, {5, "", {1}}};
  mesh.side_sets = {{7, "", {{0, 0}}}};
  const auto file = test::output_folder() / "mesh.mesh";
  write_mesh(file, mesh, nullptr);
  EXPECT_EQ(test::text_of(file),
            "MeshVersionFormatted 2\nDimension 3\n# hextwist mesh\nVertices\n12\n0 0 0 0\n1 0 0 0\n2 0 0 0\n0 1 0 0\n"
            "1 1 0 0\n2 1 0 0\n0 0 1 0\n1 0 1 0\n2 0 1 0\n0 1 1 0\n1 1 1 0\n2 1 1 0\nQuadrilaterals\n1\n1 7 10 4 7\n"
            "Hexahedra\n2\n1 2 5 4 7 8 11 10 3\n2 3 6 5 8 9 12 11 5\nEnd\n");
}

constexpr const char* cube =
    "MeshVersionFormatted 1\n\nDimension\n3\n# a comment\nVertices 8\n0 0 0 0\n1 0 0 4\n1 1 0 4\n0 1 0 0\n"
    "0 0 1 0\n1 0 1 0\n1 1 1 0\n0 1 1 0\n";

TEST(medit_files, other_peoples_files_are_understood) {
  const auto file = test::write_text(test::output_folder() / "a.mesh",
                                     std::string(cube) +
                                         "Edges 2\n1 2 9\n2 3 0\nQuadrilaterals\n1\n4 3 2 1 6\n"
                                         "Corners 1\n8\nRidges 1\n2\nRequiredVertices\n1\n3\n"
                                         "RequiredQuadrilaterals 1\n1\nTriangles 1\n1 2 3 1\n"
                                         "Wonders 2 1 2\n3 4\nHexahedra 1\n1 2 3 4 5 6 7 8 2\nEnd\n");
  const auto read = read_mesh(file);
  EXPECT_EQ(read.mesh.hexes[0], (Hex{0, 1, 3, 2, 4, 5, 7, 6}));
  EXPECT_DOUBLE_EQ(volume(read.mesh), 1);
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{2, "", {0}}}));
  EXPECT_EQ(read.mesh.side_sets, (std::vector<SideSet>{{6, "", {{0, 4}}}, {7, "RequiredQuadrilaterals", {{0, 4}}}}));
  EXPECT_EQ(read.mesh.node_sets, (std::vector<NodeSet>{{4, "", {1, 2}},
                                                       {9, "edges 9", {0, 1}},
                                                       {10, "Corners", {7}},
                                                       {11, "RequiredVertices", {2}},
                                                       {12, "Ridges", {1, 2}}}));
  EXPECT_EQ(read.notices, (std::vector<std::string>{"dropped 1 triangles", "skipped section Wonders"}));
  EXPECT_TRUE(read.tags.empty());
}

TEST(medit_files, what_is_wrong_is_said_with_its_line) {
  const auto folder = test::output_folder();
  const auto says = [&](const std::string& rest, const std::string& expected) {
    const auto file = test::write_text(folder / "bad.mesh", cube + rest);
    EXPECT_EQ(test::refusal(file), file.string() + expected);
  };
  says("Hexahedra 1\n1 2 3 4 5 6 7 9 2\nEnd\n", ":16: hex 1 names vertex 9 of 8");
  says("Tetrahedra 1\n1 2 3 4 0\n", ":16: element 1 of Tetrahedra is no 8-node hex; only those are accepted");
  says("HexahedraQ2 1\n1 2 3 4 0\n", ":16: element 1 of HexahedraQ2 is no 8-node hex; only those are accepted");
  says("End\n", ":16: there is no hex in the file");
  says("Hexahedra 1\n1 2 3 x 5 6 7 8 2\n", ":16: expected a vertex, found 'x'");
  says("Hexahedra 1\n1 2 3 4 5\n", ":15: the file is too short for 1 hexes");
  says("Vertices 0\n", ":15: a second section Vertices");
  says("Edges 0\nEdges 0\n", ":16: a second section Edges");
  const auto nan = test::write_text(folder / "nan.mesh", "MeshVersionFormatted 2 Dimension 3\nVertices 1\n0 nan 0 0\n");
  EXPECT_EQ(test::refusal(nan), nan.string() + ":3: a coordinate of vertex 1 is not finite");
  const auto flat = test::write_text(folder / "flat.mesh", "MeshVersionFormatted 2\nDimension 2\n");
  EXPECT_EQ(test::refusal(flat), flat.string() + ":2: dimension 2 instead of 3");
  const auto other = test::write_text(folder / "other.mesh", "solid\n");
  EXPECT_EQ(test::refusal(other), other.string() + ":1: not a MEDIT file: it does not begin with MeshVersionFormatted");
  const auto binary = test::write_text(folder / "binary.mesh", std::string("\1\0\0\0\2\0\0\0", 8));
  EXPECT_EQ(test::refusal(binary), binary.string() + ":1: a binary MEDIT file (.meshb), only text is read");
}

TEST(medit_files, what_may_be_missing_is_said) {
  const auto file =
      test::write_text(test::output_folder() / "a.mesh",
                       std::string(cube) + "Quadrilaterals\n1\n1 2 3 4 -5\nHexahedra\n1\n1 2 3 4 5 6 7 8 -2\n");
  EXPECT_EQ(read_mesh(file).notices,
            (std::vector<std::string>{file.string() + ":21: there is no End; the file may be cut short",
                                      "negative references (blocks) of 1 element left out",
                                      "negative references (sidesets) of 1 element left out"}));
  Mesh mesh = test::grid(1, 1, 1);
  mesh.node_ids = {2, 3, 4, 5, 6, 7, 8, 9};
  mesh.hex_ids = {4};
  mesh.fields = {{"t", Field::On::hex, 1, {1}}};
  EXPECT_EQ(write_mesh(file, mesh, nullptr),
            (std::vector<std::string>{"MEDIT has no ids: nodes are counted from 1 in the file",
                                      "MEDIT has no ids: hexes are counted from 1 in the file",
                                      "MEDIT has no fields: 't' left out"}));
}

TEST(medit_files, real_meshes_have_the_known_counts) {
  const auto data = test::data_folder();
  if (data.empty()) GTEST_SKIP() << "no folder of real meshes";
  for (const auto& [name, n] : {std::pair("mesh/teaport_14941.mesh", 14941), {"mesh/swivel2_7494.mesh", 7464}}) {
    const auto file = read_mesh(data / name);
    EXPECT_EQ(file.mesh.n_hexes(), n) << name;
    EXPECT_TRUE(test::conformal(file.mesh));
    EXPECT_TRUE(file.notices.empty());
    const auto copy = test::output_folder() / "copy.mesh";
    write_mesh(copy, file.mesh, nullptr);
    EXPECT_TRUE(test::same_mesh(file.mesh, read_mesh(copy).mesh));
  }
}

TEST(medit_files, what_names_and_references_have_become_is_said) {
  Mesh mesh = test::grid(2, 1, 1);
  mesh.blocks = {{3, "a\tb", {0}}, {4, "", {0, 1}}};
  const auto notices = write_mesh(test::output_folder() / "names.mesh", mesh, nullptr);
  EXPECT_EQ(notices,
            (std::vector<std::string>{
                "groups overlap, and MEDIT has one reference of each element, so that a block has others: 3 is "
                "5; 4 is 5 6",
                "MEDIT has no names: those of blocks are in comments",
                "block 3 'a\tb' is called 'a b' in the "
                "file"}));
}

}  // namespace
}  // namespace hextwist
