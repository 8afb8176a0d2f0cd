// One test per message of the Gmsh reader.
#include "io/io_support.h"

namespace hextwist {
namespace {

const std::string head4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
const std::string head2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string nodes4 =
    "$Nodes\n1 8 1 8\n3 1 0 8\n1\n2\n3\n4\n5\n6\n7\n8\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 "
    "1\n$EndNodes\n";
const std::string nodes2 =
    "$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n$EndNodes\n";

void says(const std::string& text, const std::string& expected) {
  const auto file = test::write_text(test::output_folder() / "bad.msh", text);
  EXPECT_EQ(test::refusal(file), file.string() + expected);
}

TEST(bad_gmsh_files, formats_and_sections) {
  says("solid\n", ":1: not a Gmsh file: it does not begin with $MeshFormat");
  says("$Nodes\n", ":1: $Nodes before $MeshFormat");
  says("$MeshFormat\n4 0 8\n$EndMeshFormat\n",
       ":2: version '4' of Gmsh's format is not known here, 1, 2.2 and 4.1 are");
  says("$MeshFormat\n4.1 2 8\n$EndMeshFormat\n", ":2: file type 2 is neither 0 nor 1");
  says("$MeshFormat\n4.1 1 4\n$EndMeshFormat\n", ":2: data size 4 instead of 8");
  says("$MeshFormat\n4.1 1 8\nabcd\n$EndMeshFormat\n",
       ", byte 24: the number one is 1684234849: not a binary Gmsh file");
  says(head4 + head4, ":4: a second $MeshFormat");
  says(head4, ":4: the file ends without nodes");
  says(head4 + nodes4, ":24: the file ends without elements");
  says(head4 + nodes4 + nodes4, ":24: a second $Nodes");
  says(head4 + "$Elements\n", ":4: elements before nodes");
  says(head4 + "hello\n", ":4: expected a section ($...), found 'hello'");
  says(head4 + "$Odd\n1\n", ":4: the file ends before $EndOdd");
  says(head4 + "$PhysicalNames\n0\n$EndNodes\n", ":6: expected $EndPhysicalNames, found '$EndNodes'");
  says(head4 + "$PhysicalNames\n0\n", ":6: the file ends before $EndPhysicalNames");
  says(head4 + "$PhysicalNames\n1\n4 1 \"a\"\n", ":6: dimension 4 of a physical group");
}

TEST(bad_gmsh_files, nodes_and_elements_of_version_4) {
  const auto nodes = [](const std::string& text) { return head4 + "$Nodes\n" + text; };
  says(nodes("1 2 1 2\n3 1 0 2\n1\n1\n0 0 0\n1 0 0\n$EndNodes\n"), ":8: node id 1 occurs twice");
  says(nodes("1 1 0 0\n3 1 0 1\n0\n0 0 0\n$EndNodes\n"), ":7: node id 0 is not positive");
  says(nodes("1 1 1 1\n3 1 0 1\n1\n0 inf 0\n$EndNodes\n"), ":8: a coordinate is not finite");
  says(nodes("1 1 1 1\n3 1 0 1\n1\n0 x 0\n$EndNodes\n"), ":8: expected a coordinate, found 'x'");
  says(nodes("1 1 1 1\n3 1 0 2\n1\n2\n0 0 0\n0 0 0\n$EndNodes\n"), ":6: more nodes than the header says");
  says(nodes("1 2 1 1\n3 1 0 1\n1\n0 0 0\n$EndNodes\n"), ":8: the header says 2 nodes, there are 1");
  says(nodes("1 1 1 1\n4 1 0 1\n1\n0 0 0\n$EndNodes\n"), ":6: nodes on an entity of dimension 4");
  says(nodes("1 999999 1 1\n3 1 0 1\n"), ":5: the file is too short for 999999 nodes");
  says(nodes("1 -1 1 1\n"), ":5: negative number of nodes: -1");
  says(nodes("1 99999999999 1 1\n"), ":5: too many nodes: 99999999999");
  const auto elements = [](const std::string& text) { return head4 + nodes4 + "$Elements\n" + text; };
  says(elements("1 1 1 1\n3 1 5 1\n1 1 2 3 4 5 6 7 9\n$EndElements\n"),
       ":27: element 1 names node 9, which is not there");
  says(elements("1 1 1 1\n3 1 4 1\n7 1 2 3 5\n$EndElements\n"), ":29: there is no hex in the file, but 1 tetrahedron");
  says(elements("1 1 1 1\n3 1 6 1\n7 1 2 3 5 6 7\n$EndElements\n"), ":29: there is no hex in the file, but 1 wedge");
  says(elements("1 1 1 1\n3 1 7 1\n7 1 2 3 4 5\n$EndElements\n"), ":29: there is no hex in the file, but 1 pyramid");
  says(elements("1 1 1 1\n3 1 12 1\n7 1 2 3 4 5\n$EndElements\n"), ":28: expected a node, found '$EndElements'");
  says(elements("1 1 1 1\n3 1 99 1\n7 1 2 3 4 5\n$EndElements\n"),
       ":27: element 7 has type 99, which is not a hex, quad, line or point");
  says(elements("1 2 1 2\n3 1 5 2\n1 1 2 3 4 5 6 7 8\n1 1 2 3 4 5 6 7 8\n$EndElements\n"),
       ":28: element id 1 occurs twice");
  says(elements("1 2 1 1\n3 1 5 1\n1 1 2 3 4 5 6 7 8\n$EndElements\n"), ":27: the header says 2 elements, there are 1");
  says(elements("1 1 1 1\n3 1 5 2\n1 1 2 3 4 5 6 7 8\n$EndElements\n"), ":26: more elements than the header says");
  says(elements("1 1 1 1\n3 1 5 1\n1 1 2 3 4 5 6 7"), ":27: the file ends where a node should stand");
  says(elements("1 1 1 1\n2 1 3 1\n1 1 2 3 4\n$EndElements\n"), ":29: there is no hex in the file");
}

TEST(bad_gmsh_files, nodes_and_elements_of_versions_1_and_2) {
  says(head2 + "$Nodes\n2\n1 0 0 0\n1 0 0 1\n$EndNodes\n", ":7: node id 1 occurs twice");
  says(head2 + "$Nodes\n1\n1 0 0 nan\n$EndNodes\n", ":6: a coordinate is not finite");
  const auto elements = [](const std::string& text) { return head2 + nodes2 + "$Elements\n" + text; };
  says(elements("1\n4 5 2 1 1 1 2 3 4 5 6 7 9\n$EndElements\n"), ":17: element 4 names node 9, which is not there");
  says(elements("1\n4 4 2 1 1 1 2 3 4\n$EndElements\n"), ":19: there is no hex in the file, but 1 tetrahedron");
  says(elements("1\n4 17 2 1 1 1 2 3 4\n$EndElements\n"), ":18: expected a node, found '$EndElements'");
  says(elements("1\n4 5 -2 1 1 1 2 3 4\n$EndElements\n"), ":17: a broken element header");
  says(elements("2\n4 5 2 1 1 1 2 3 4 5 6 7 8\n4 5 2 1 1 1 2 3 4 5 6 8 7\n$EndElements\n"),
       ":18: element id 4 occurs twice");
  const std::string nodes1 = "$NOD\n" + nodes2.substr(7, nodes2.size() - 17) + "$ENDNOD\n";
  says(nodes1 + "$ELM\n1\n1 5 1 1 7 1 2 3 4 5 6 7\n$ENDELM\n", ":14: element 1 has 7 nodes, a hex has 8");
  says(nodes1 + "$ELM\n1\n1 5 1 1 8 1 2 3 4 5 6 7 8\n$EndElements\n", ":15: expected $ENDELM, found '$EndElements'");
}

TEST(gmsh_files, an_element_in_two_groups_is_one_element) {
  // Formats 1 and 2 repeat an element for each physical group.
  const auto file =
      test::write_text(test::output_folder() / "a.msh",
                       head2 + nodes2 +
                           "$Elements\n3\n1 5 2 7 1 1 2 3 4 5 6 7 8\n2 5 2 8 1 1 2 3 4 5 6 7 8\n3 3 2 5 4 1 2 3 4\n"
                           "$EndElements\n");
  const auto read = read_mesh(file);
  EXPECT_EQ(read.mesh.n_hexes(), 1);
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{7, "", {0}}, {8, "", {0}}}));
  EXPECT_EQ(read.mesh.side_sets, (std::vector<SideSet>{{5, "", {{0, 4}}}}));
  EXPECT_EQ(read.tags.face_surface, (std::vector<int>{4}));
  EXPECT_EQ(read.tags.node_owner[0], (Owner{2, 4}));
  EXPECT_EQ(read.tags.node_owner[6], (Owner{3, 1}));
}

TEST(gmsh_files, parameters_partitions_curve_groups_and_time_steps_are_understood) {
  const auto file = test::write_text(
      test::output_folder() / "a.msh",
      head4 +
          "$PhysicalNames\n3\n1 2 \"rim\"\n0 2 \"tip\"\n3 6 \"nothing\"\n$EndPhysicalNames\n"
          "$Entities\n1 1 0 1\n5 0 0 0 1 2 \n9 0 0 0 1 0 0 1 2 0\n1 0 0 0 1 1 1 0 0\n$EndEntities\n"
          "$PartitionedEntities\n2\n0\n0 0 0 1\n31 3 1 1 1 0 0 0 1 1 1 0 0\n$EndPartitionedEntities\n"
          "$Nodes\n3 8 1 8\n0 5 0 1\n1\n0 0 0\n1 9 1 1\n2\n1 0 0 0.25\n3 31 0 6\n3\n4\n5\n6\n7\n8\n1 1 0\n0 1 0\n"
          "0 0 1\n1 0 1\n1 1 1\n0 1 1\n$EndNodes\n"
          "$Elements\n4 4 1 4\n0 5 15 1\n1 1\n1 9 1 1\n2 1 2\n1 9 8 1\n3 1 2 3\n3 31 5 1\n4 1 2 3 4 5 6 7 8\n"
          "$EndElements\n"
          "$NodeData\n1\n\"T\"\n1\n0.5\n3\n1\n1\n2\n1 10\n2 20\n$EndNodeData\n"
          "$NodeData\n1\n\"T\"\n1\n0\n3\n0\n1\n2\n1 1\n2 2\n$EndNodeData\n");
  const auto read = read_mesh(file);
  EXPECT_EQ(read.tags.node_owner[0], (Owner{0, 5}));
  EXPECT_EQ(read.tags.node_owner[1], (Owner{1, 9}));
  EXPECT_EQ(read.tags.node_owner[2], (Owner{3, 1}));
  EXPECT_EQ(read.tags.hex_volume, (std::vector<int>{1}));
  EXPECT_EQ(read.tags.node_parameters[1].u, 0.25);
  EXPECT_TRUE(std::isnan(read.tags.node_parameters[0].u));
  EXPECT_EQ(read.tags.curve_edges, (std::vector<Edge>{{0, 1}}));
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{6, "nothing", {}}}));
  EXPECT_EQ(read.mesh.node_sets, (std::vector<NodeSet>{{2, "tip", {0}}, {3, "rim", {0, 1}}}));
  ASSERT_EQ(read.mesh.fields.size(), 1u);
  EXPECT_EQ(read.mesh.fields[0].values[1], 20);
  EXPECT_TRUE(std::isnan(read.mesh.fields[0].values[2]));
  EXPECT_EQ(read.notices,
            (std::vector<std::string>{"physical curve group 2 is node set 3: a physical point group has its id",
                                      "field 'T' has 2 steps: the last is read"}));
}

TEST(bad_gmsh_files, sections_that_a_file_has_once) {
  const std::string names = "$PhysicalNames\n0\n$EndPhysicalNames\n";
  says(head2 + names + names, ":7: a second $PhysicalNames");
  const std::string periodic = "$Periodic\n0\n$EndPeriodic\n";
  says(head4 + periodic + periodic, ":7: a second $Periodic");
  says(head4 + "$Periodic\n1\n7 1 1\n", ":6: a periodic entity of dimension 7");
}

}  // namespace
}  // namespace hextwist
