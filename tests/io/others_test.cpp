// Elements beside hexes in files: in and out again, from one format to another, and what other programs make of them.
#include "support/others.h"

#include <map>
#include <set>

#include "hextwist/io/others.h"
#include "hextwist/mesh/others.h"
#include "io/io_support.h"

namespace hextwist {
namespace {

struct Element {
  OtherShape shape;
  std::string type;
  std::vector<Vec3> places;
  std::vector<std::string> blocks, sides;
  auto key() const { return std::pair(shape, places.size()); }
  bool operator==(const Element&) const = default;
};

/// By id. Names of blocks that they are in, and of side sets with the side.
std::map<std::int64_t, Element> elements(const Mesh& mesh, bool types) {
  std::map<std::int64_t, Element> result;
  if (!mesh.others) return result;
  const OtherElements& others = *mesh.others;
  for (Index e = 0; e < others.size(); ++e) {
    EXPECT_TRUE(others.is_whole(e));
    Element element{others.type_of(e).shape, types ? others.type_of(e).name : "", {}, {}, {}};
    for (const Index n : others.nodes_of(e)) element.places.push_back(mesh.points[n]);
    for (const OtherSet& set : others.heads->sets)
      if (std::ranges::binary_search(set.elements, others.of[e]))
        element.blocks.push_back(std::ranges::find(mesh.blocks, set.id, &Block::id)->name);
    for (const OtherSides& sides : others.heads->sides)
      for (std::size_t i = 0; i < sides.elements.size(); ++i)
        if (sides.elements[i] == others.of[e])
          element.sides.push_back(std::ranges::find(mesh.side_sets, sides.id, &SideSet::id)->name + sides.sides[i]);
    result[others.id(e)] = element;
  }
  return result;
}

/// In shape and places; points and connectors, which not all formats have, left out.
std::multiset<std::pair<OtherShape, std::vector<std::array<double, 3>>>> shapes(const Mesh& mesh, bool third_nodes,
                                                                                bool connectors_are_lines = false) {
  std::multiset<std::pair<OtherShape, std::vector<std::array<double, 3>>>> result;
  for (auto [id, element] : elements(mesh, false)) {
    if (connectors_are_lines && element.shape == OtherShape::connector) element.shape = OtherShape::line;
    if (element.shape == OtherShape::point || element.shape == OtherShape::connector) continue;
    std::vector<std::array<double, 3>> places;
    for (const Vec3& p : element.places) {
      places.emplace_back();
      for (int axis = 0; axis < 3; ++axis) places.back()[axis] = std::round(1e9 * p[axis]) / 1e9;  // .inp has 14 digits
    }
    if (!third_nodes && element.shape == OtherShape::line) places.resize(2);
    result.insert({element.shape, places});
  }
  return result;
}

Mesh mixed(unsigned seed) {
  std::mt19937 random(seed);
  return test::with_others(test::shuffled(test::grid(3, 2, 2), random), random);
}

class OthersInFiles : public testing::TestWithParam<const char*> {};

TEST_P(OthersInFiles, come_back_and_are_the_same_when_written_again) {
  const std::string extension = GetParam();
  for (unsigned seed = 1; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    const Mesh mesh = mixed(seed);
    const auto file = test::output_folder() / ("a" + extension), again = test::output_folder() / ("b" + extension);
    const bool med = extension == ".med", exodus = extension == ".e";
    const bool skins = extension == ".msh" || extension == ".unv" || med;
    try {
      write_mesh(file, mesh, nullptr);
    } catch (const Error& error) {
      if (std::string(error.what()).find("built without") != std::string::npos) GTEST_SKIP() << error.what();
      throw;
    }
    const MeshFile first = read_mesh(file);
    EXPECT_EQ(first.mesh.hexes, mesh.hexes);
    EXPECT_EQ(first.mesh.hex_ids, mesh.hex_ids);
    if (skins) {
      // Quads on hexes are sides there, in .msh lines are edges of curves and points node sets.
      const auto before = shapes(mesh, false, true), after = shapes(first.mesh, false);
      EXPECT_TRUE(std::ranges::includes(before, after));
      for (const OtherShape shape :
           {OtherShape::tetrahedron, OtherShape::pyramid, OtherShape::wedge, OtherShape::triangle})
        if (extension != ".unv" || shape != OtherShape::pyramid) {  // which .unv has not
          const auto of_shape = [&](const auto& all) {
            return std::ranges::count(all, shape, [](const auto& one) { return one.first; });
          };
          EXPECT_EQ(of_shape(before), of_shape(after));
        }
    } else {
      EXPECT_EQ(shapes(mesh, !exodus, exodus), shapes(first.mesh, !exodus));
    }
    for (const auto& [id, element] : elements(first.mesh, false)) {
      if (med) break;  // numbers are per kind there
      const auto before = elements(mesh, false);
      const auto same = before.find(id);
      ASSERT_NE(same, before.end()) << id;
      EXPECT_EQ(same->second.shape == OtherShape::connector ? OtherShape::line : same->second.shape,
                element.shape == OtherShape::connector ? OtherShape::line : element.shape)
          << id;
    }
    WriteOptions options;
    options.extras = &first.extras;
    write_mesh(again, first.mesh, &first.tags, options);
    const MeshFile second = read_mesh(again);
    if (med) {
      EXPECT_EQ(shapes(first.mesh, false), shapes(second.mesh, false));
      EXPECT_EQ(others_text(first.mesh), others_text(second.mesh));
    } else {
      EXPECT_EQ(elements(first.mesh, true), elements(second.mesh, true));
    }
    EXPECT_EQ(first.mesh.points, second.mesh.points);
    EXPECT_EQ(first.mesh.blocks, second.mesh.blocks);
    if (extension != ".unv") {  // groups share numbers there
      EXPECT_EQ(first.mesh.side_sets, second.mesh.side_sets);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(formats, OthersInFiles, testing::Values(".inp", ".e", ".vtu", ".msh", ".bdf", ".unv", ".med"),
                         [](const auto& of) { return std::string(of.param).substr(1); });

constexpr const char* mixed_inp =
    "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n9,2,.5,.5\n10,3,0,0\n11,3,1,0\n"
    "12,0,0,5\n13,2,2,2\n14,2.5,.5,.25\n15,3,.5,0\n"
    "*ELEMENT, TYPE=C3D8R, ELSET=solid\n1,1,2,3,4,5,6,7,8\n"
    "*ELEMENT, TYPE=S4R, ELSET=lid\n7, 5,6,7,8\n*ELEMENT, TYPE=B31, ELSET=beams\n9, 1, 2, 12\n10, 10, 11\n"
    "*ELEMENT, TYPE=MASS, ELSET=lump\n20, 7\n*ELEMENT, TYPE=C3D5, ELSET=glue\n30, 2,3,7,6,9\n"
    "*ELEMENT, TYPE=B32\n40, 10, 15, 11\n*ELEMENT, TYPE=SPRINGA, ELSET=spring\n50, 1, 7\n"
    "*ELEMENT, TYPE=CONN3D2\n60, 1,\n*ELSET, ELSET=both\nsolid, lid\n"
    "*SURFACE, NAME=top\nlid, SPOS\n*SURFACE, NAME=side\nglue, S3\nsolid, S1\n"
    "*SHELL SECTION, ELSET=lid, MATERIAL=m\n0.1\n*MASS, ELSET=lump\n2.5\n*DLOAD\n7, P, 1.\n";

TEST(others_in_gmsh, lines_on_no_hex_stay_with_their_group) {
  const std::string nodes =
      "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n14,3,0,0\n16,4,0,0\n";
  const auto inp = test::write_text(test::output_folder() / "truss.inp",
                                    nodes +
                                        "*ELEMENT, TYPE=C3D8, ELSET=solid\n1,1,2,3,4,5,6,7,8\n"
                                        "*ELEMENT, TYPE=T3D2, ELSET=truss\n33,14,16\n34,2,14\n");
  const MeshFile read = read_mesh(inp);
  for (const int version : {41, 22}) {
    SCOPED_TRACE(version);
    const auto file = test::output_folder() / ("truss" + std::to_string(version) + ".msh");
    write_mesh(file, read.mesh, nullptr, {.gmsh_version = version});
    const MeshFile back = read_mesh(file);
    EXPECT_EQ(back.mesh.blocks, read.mesh.blocks);
    EXPECT_TRUE(back.mesh.node_sets.empty());
    ASSERT_TRUE(back.mesh.others);
    EXPECT_EQ(back.mesh.others->size(), 2);
    EXPECT_EQ(io::others_of_block(back.mesh, 2).size(), 2U);
  }
  // A group of lines of which some are edges of hexes and some are not.
  const auto rail = test::write_text(
      test::output_folder() / "rail.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 2 \"rail\"\n3 1 \"solid\"\n$EndPhysicalNames\n"
      "$Nodes\n10\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n9 2 0 0\n10 3 0 0\n"
      "$EndNodes\n$Elements\n4\n1 5 2 1 1 1 2 3 4 5 6 7 8\n2 1 2 2 20 1 2\n3 1 2 2 21 2 9\n4 1 2 2 21 9 10\n"
      "$EndElements\n");
  const MeshFile first = read_mesh(rail);
  const auto out = test::output_folder() / "rail_out.msh";
  write_mesh(out, first.mesh, &first.tags, {.binary = false, .gmsh_version = 22, .extras = &first.extras});
  const std::string text = test::text_of(out);
  EXPECT_NE(text.find("1 2 \"rail\""), std::string::npos);
  EXPECT_EQ(text.find("0 2 \"rail\""), std::string::npos);
  const MeshFile second = read_mesh(out);
  EXPECT_EQ(second.mesh.node_sets, first.mesh.node_sets);
  EXPECT_EQ(second.mesh.others->size(), 2);
  EXPECT_EQ(second.mesh.others->heads->rest, first.mesh.others->heads->rest);
}

TEST(others_in_abaqus, elements_and_the_cards_about_them_stay) {
  const auto file = test::write_text(test::output_folder() / "a.inp", mixed_inp);
  const MeshFile read = read_mesh(file);
  EXPECT_EQ(others_text(read.mesh),
            "1 quad (S4R), 2 lines (B31), 1 point (MASS), 1 pyramid (C3D5), 1 line (B32), 1 connector (SPRINGA)");
  EXPECT_EQ(read.notices,
            (std::vector<std::string>{"dropped 1 element of type CONN3D2, which leaves a node out",
                                      "cards name nodes or elements by number, 1 times, first at " + file.string() +
                                          ":45: what a refinement adds is not among them"}));
  const auto now = elements(read.mesh, true);
  EXPECT_EQ(now.at(7).blocks, (std::vector<std::string>{"lid", "both"}));
  EXPECT_EQ(now.at(7).sides, std::vector<std::string>{"topSPOS"});
  EXPECT_EQ(now.at(9).places, (std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 5)}));
  EXPECT_EQ(now.at(40).places, (std::vector<Vec3>{Vec3(3, 0, 0), Vec3(3, 1, 0), Vec3(3, .5, 0)}));  // ends first
  EXPECT_EQ(now.at(30).sides, std::vector<std::string>{"sideS3"});
  WriteOptions options;
  options.extras = &read.extras;
  const auto out = test::output_folder() / "b.inp";
  EXPECT_EQ(write_mesh(out, read.mesh, nullptr, options), std::vector<std::string>{});
  const std::string text = test::text_of(out);
  for (const char* lines :
       {"*ELEMENT, TYPE=S4R\n7, 5, 6, 7, 8\n", "*ELEMENT, TYPE=B31\n9, 1, 2, 12\n10, 10, 11\n",
        "*ELEMENT, TYPE=B32\n40, 10, 15, 11\n", "*ELEMENT, TYPE=MASS\n20, 7\n",
        "*ELEMENT, TYPE=C3D5\n30, 2, 3, 7, 6, 9\n", "*ELSET, ELSET=lid\n7\n", "*ELSET, ELSET=both\n1\n7\n",
        "NAME=top\n7, SPOS\n", "NAME=side\n1, S1\n30, S3\n", "*SHELL SECTION, ELSET=lid, MATERIAL=m\n0.1\n",
        "*MASS, ELSET=lump\n2.5\n", "*DLOAD\n7, P, 1.\n"})
    EXPECT_NE(text.find(lines), std::string::npos) << lines;
  EXPECT_EQ(elements(read_mesh(out).mesh, true), now);
}

/// As docs/formats has it.
TEST(others_in_files, wedges_are_kept_or_told) {
  const auto folder = test::output_folder();
  const auto inp = test::write_text(folder / "a.inp",
                                    "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
                                    "9,2,0,0\n10,2,0,1\n*ELEMENT, TYPE=C3D8\n1,1,2,3,4,5,6,7,8\n"
                                    "*ELEMENT, TYPE=C3D6, ELSET=GLUE\n2,2,9,3,6,10,7\n");
  const Mesh mesh = read_mesh(inp).mesh;
  for (const std::string name : {"b.inp", "b.e", "b.msh", "b.vtu"}) {
    write_mesh(folder / name, mesh, nullptr);
    const MeshFile read = read_mesh(folder / name);
    EXPECT_TRUE(others_text(read.mesh).starts_with("1 wedge")) << name;
    EXPECT_EQ(shapes(read.mesh, true), shapes(mesh, true)) << name;
  }
  for (const std::string name : {"b.vtkhdf", "b.xdmf", "b.cgns"}) try {
      EXPECT_TRUE(test::told(write_mesh(folder / name, mesh, nullptr), "1 wedge")) << name;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("built without"), std::string::npos) << error.what();
    }
}

TEST(others_in_abaqus, mistakes_are_named_with_their_line) {
  const auto says = [&](const std::string& more, const std::string& what) {
    const auto file = test::write_text(test::output_folder() / "a.inp", mixed_inp + more);
    EXPECT_EQ(test::refusal(file), file.string() + what);
  };
  says("*ELEMENT, TYPE=S4\n7, 1,2,3,4\n", ":48: element id 7 occurs twice");
  says("*ELEMENT, TYPE=S4\n1, 1,2,3,4\n", ":48: element id 1 occurs twice");
  says("*ELEMENT, TYPE=S4\n70, 1,2,3\n", ":48: element 70 has 3 of 4 nodes");
  says("*ELEMENT, TYPE=S4\n70, 1,2,3,4,5\n", ":48: element 70 has more nodes than a S4");
  says("*ELEMENT, TYPE=B31\n70, 1,99\n", ":48: element 70 names node 99, which is not there");
  says("*ELEMENT, TYPE=C3D7\n70, 1,2,3,4,5,6,7\n",
       ":48: element 70 is of type C3D7; of solids, hexes of 8, 20 or 27 nodes and tetrahedra, pyramids and wedges of "
       "usual numbers of nodes are accepted");
  const auto none = test::write_text(test::output_folder() / "none.inp",
                                     "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n*ELEMENT, TYPE=S3\n1,1,2,3\n2,1,3,2\n");
  EXPECT_EQ(test::refusal(none), none.string() + ": there is no hex in the file, but 2 elements S3");
}

TEST(others_in_files, formats_without_them_say_what_they_leave_out) {
  const Mesh mesh = mixed(3);
  const auto notices = write_mesh(test::output_folder() / "a.mesh", mesh, nullptr);
  EXPECT_EQ(std::ranges::count(
                notices, "other elements are left out, which .mesh files have no place for here: " + others_text(mesh)),
            1);
}

}  // namespace
}  // namespace hextwist
