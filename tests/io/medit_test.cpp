#include <algorithm>
#include <random>

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
  says("HexahedraQ3 1\n1 2 3 4 0\n", ":16: element 1 of HexahedraQ3 is no 8-node hex; only those are accepted");
  const std::string quadratic = "HexahedraQ2 1\n1 2 3 4 5 6 7 8 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 0\n";
  says(quadratic + "End\n",
       ":15: in which order the 27 nodes of a hex are is not said: HexahedraQ2Ordering is missing");
  says("HexahedraQ2Ordering 26\n0 0 0\n" + quadratic + quadratic + quadratic,
       ":15: an order of 26 nodes instead of 27");
  says("HexahedraQ2Ordering 27\n0 0 0\n0 0 3\n" + quadratic + quadratic + quadratic,
       ":17: the place 3 of a node is not 0, 1 or 2");
  says("HexahedraQ2Ordering 27\n0 0 0\n0 0 0\n" + quadratic + quadratic + quadratic, ":17: two nodes at one place");
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

/// A file says in which order the nodes of its hexes are, before them or behind; any order will do.
TEST(medit_files, of_second_order_say_the_order_of_their_nodes) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<std::array<int, 3>> order;
    for (int i = 0; i < 27; ++i) order.push_back({i % 3, i / 3 % 3, i / 9});
    std::ranges::shuffle(order, random);
    std::string nodes, element, places;
    for (int i = 0; i < 27; ++i) {
      const auto [x, y, z] = order[static_cast<std::size_t>(i)];
      // A bulge in the middle of one edge and one face.
      const double off = (x == 1 && y == 0 && z == 0) || (x == 2 && y == 1 && z == 1) ? 0.125 : 0;
      nodes += std::to_string(x + off) + " " + std::to_string(y - off) + " " + std::to_string(z) + " 0\n";
      element += std::to_string(i + 1) + " ";
      places += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    }
    const std::string own = "HexahedraQ2Ordering\n27\n" + places, hexes = "HexahedraQ2\n1\n" + element + "5\n";
    const auto file = test::write_text(test::output_folder() / "a.mesh",
                                       "MeshVersionFormatted 2\nDimension 3\nVertices\n27\n" + nodes +
                                           (trial % 2 ? own + hexes : hexes + own) + "End\n");
    const MeshFile read = read_mesh(file);
    EXPECT_EQ(read.mesh.n_nodes(), 8);
    EXPECT_DOUBLE_EQ(volume(read.mesh), 8);
    EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{5, "", {0}}}));
    EXPECT_EQ(read.middles.nodes_per_hex, 27);
    ASSERT_EQ(read.middles.edges.size(), 12U);
    ASSERT_EQ(read.middles.faces.size(), 6U);
    int n_off = 0;
    for (std::size_t e = 0; e < 12; ++e) {
      const auto [a, b] = read.middles.edges[e];
      const Vec3 off = read.middles.edge_points[e] - (read.mesh.points[a] + read.mesh.points[b]) / 2;
      if (off.norm() == 0) continue;
      ++n_off;
      EXPECT_EQ(off, Vec3(0.125, -0.125, 0));
      EXPECT_EQ(read.middles.edge_points[e], Vec3(1.125, -0.125, 0));
    }
    for (std::size_t f = 0; f < 6; ++f) {
      Vec3 sum = Vec3::Zero();
      for (const Index n : read.middles.faces[f]) sum += read.mesh.points[n] / 4;
      if (read.middles.face_points[f] == sum) continue;
      ++n_off;
      EXPECT_EQ(read.middles.face_points[f], Vec3(2.125, 0.875, 1));
    }
    EXPECT_EQ(n_off, 2);
  }
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
