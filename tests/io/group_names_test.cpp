// Names and ids of groups that a format can't have as they are: each group comes back by itself, and what is changed of
// it is told.
#include "hextwist/io/group_names.h"

#include "hextwist/mesh/topology.h"
#include "io/hdf_support.h"
#include "support/others.h"

namespace hextwist {
namespace {

/// Of the boundary, x-, x+ and so on, and one inside from either hex.
std::vector<std::vector<Side>> walls(const Mesh& mesh) {
  std::vector<std::vector<Side>> result(8);
  const Faces all = faces(mesh);
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (int f = 0; f < n_hex_faces; ++f)
      if (all.sides[all.of_hex[h][f]][1].hex < 0) result[static_cast<std::size_t>(f)].push_back({h, f});
  for (std::size_t f = 0; f < all.nodes.size(); ++f)
    if (all.sides[f][1].hex >= 0) {
      result[6].push_back(all.sides[f][0]);
      result[7].push_back(all.sides[f][1]);
    }
  for (std::vector<Side>& sides : result) std::ranges::sort(sides);
  return result;
}

/// Names twice, names that unnamed groups of other ids get, names that differ by what formats take away, and one that
/// OpenFOAM gives the rest of the boundary.
Mesh awkward() {
  Mesh mesh = test::grid(4, 3, 2);
  const std::vector<std::pair<int, std::string>> blocks = {
      {2, "x"},      {3, "block_5"}, {5, "Steel"},    {7, "Steel"},      {9, ""},    {11, "Steel "},
      {12, "steel"}, {13, "a,b"},    {14, "block_9"}, {15, "block_9_1"}, {16, "a;b"}};
  for (const auto& [id, name] : blocks) mesh.blocks.push_back({id, name, {}});
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    mesh.blocks[static_cast<std::size_t>(h) % mesh.blocks.size()].hexes.push_back(h);
  const auto sides = walls(mesh);
  mesh.side_sets = {{1, "w", sides[0]}, {2, "", sides[1]},
                    {4, "w", sides[2]}, {6, "sideset_2", sides[3]},
                    {8, "", sides[7]},  {9, "defaultFaces", sides[4]},
                    {20, "", sides[6]}, {31, std::string(90, 'n') + "1", sides[5]}};
  mesh.node_sets = {{1, "in", {0, 1}}, {3, "", {2, 5}}, {5, "in", {3}}, {8, "nodeset_3", {4, 9}}, {9, "x", {7}}};
  return mesh;
}

using Members = std::vector<std::vector<Index>>;
Members members(const Mesh&, const Block& block) {
  return {block.hexes};
}
Members members(const Mesh&, const NodeSet& set) {
  return {set.nodes};
}
/// A side by its hex and nodes: readers may turn hexes.
Members members(const Mesh& mesh, const SideSet& set) {
  Members result;
  for (const Side& side : set.sides) {
    const Quad q = ascending(face_nodes(mesh.hexes[side.hex], side.face));
    result.push_back({side.hex, q[0], q[1], q[2], q[3]});
  }
  std::ranges::sort(result);
  return result;
}

template <class Group>
void expect_kept_or_told(const char* kind, const Mesh& before, const std::vector<Group>& groups, const Mesh& after,
                         const std::vector<Group>& read, const std::vector<std::string>& notices) {
  std::set<int> ids;
  for (const Group& group : read) EXPECT_TRUE(ids.insert(group.id).second) << kind << " " << group.id << " twice";
  for (const Group& group : groups) {
    const std::string what = std::string(kind) + " " + std::to_string(group.id);
    const auto same =
        std::ranges::find_if(read, [&](const Group& other) { return members(after, other) == members(before, group); });
    if (same == read.end()) {
      ADD_FAILURE() << what << " is lost";
      continue;
    }
    if (same->id == group.id && same->name == group.name) continue;
    const std::string text = what + (group.name.empty() ? "" : " '" + group.name + "'");
    EXPECT_TRUE(test::told(notices, text + (same->id != group.id ? " becomes " + std::to_string(same->id) : "")) ||
                test::told(notices, what + " is "))  // another number in the file
        << text << " is " << same->id << " '" << same->name << "' and nobody told";
    if (same->name != group.name) {
      EXPECT_TRUE(test::told(notices, text + " is called '" + same->name + "' in the file"))
          << text << " is called '" << same->name << "' and nobody told";
    }
  }
}

TEST(group_names, every_group_comes_back_and_what_changed_is_told) {
  const Mesh mesh = awkward();
  const auto folder = test::output_folder();
  for (const std::string extension : {".msh", ".e", ".inp", ".mesh", ".med", ".cgns", ".bdf", ".unv", ".foam", ".k",
                                      ".cdb", ".vtu", ".vtkhdf", ".xdmf"}) {
    if (!test::has_format(extension)) continue;
    SCOPED_TRACE(extension);
    std::vector<std::string> notices = write_mesh(folder / ("a" + extension), mesh, nullptr);
    const MeshFile read = read_mesh(folder / ("a" + extension));
    notices.insert(notices.end(), read.notices.begin(), read.notices.end());
    expect_kept_or_told("block", mesh, mesh.blocks, read.mesh, read.mesh.blocks, notices);
    expect_kept_or_told("sideset", mesh, mesh.side_sets, read.mesh, read.mesh.side_sets, notices);
    expect_kept_or_told("nodeset", mesh, mesh.node_sets, read.mesh, read.mesh.node_sets, notices);
  }
}

TEST(group_names, empty_groups_come_back_or_are_told) {
  Mesh mesh = test::grid(1, 1, 1);
  mesh.blocks = {{1, "all", {0}}, {2, "no hexes", {}}, {3, "", {}}};
  mesh.side_sets = {{4, "no sides", {}}, {5, "", {}}};
  mesh.node_sets = {{6, "no nodes", {}}, {7, "", {}}};
  const auto folder = test::output_folder();
  for (const std::string extension : {".msh", ".e", ".inp", ".mesh", ".med", ".cgns", ".bdf", ".unv", ".foam", ".k",
                                      ".cdb", ".vtu", ".vtkhdf", ".xdmf"}) {
    if (!test::has_format(extension)) continue;
    SCOPED_TRACE(extension);
    const auto notices = write_mesh(folder / ("a" + extension), mesh, nullptr);
    const Mesh read = read_mesh(folder / ("a" + extension)).mesh;
    const auto expect = [&](const char* kind, const auto& groups, const auto& found) {
      for (const auto& group : groups)
        EXPECT_TRUE(std::ranges::find(found, group.id, [](const auto& g) { return g.id; }) != found.end() ||
                    test::told(notices, std::string(kind) + " " + std::to_string(group.id)))
            << kind << " " << group.id;
    };
    expect("block", mesh.blocks, read.blocks);
    expect("sideset", mesh.side_sets, read.side_sets);
    expect("nodeset", mesh.node_sets, read.node_sets);
  }
}

TEST(group_names, both_sides_of_a_face_are_kept_or_told) {
  Mesh mesh = test::grid(2, 1, 1);
  mesh.side_sets = {{7, "crack", {{0, 1}, {1, 0}}}};
  const auto folder = test::output_folder();
  for (const std::string extension : {".msh", ".e", ".inp", ".mesh", ".mfem", ".med", ".cgns", ".bdf", ".unv", ".foam",
                                      ".k", ".cdb", ".re2", ".vtu", ".vtkhdf", ".xdmf"}) {
    if (!test::has_format(extension)) continue;
    SCOPED_TRACE(extension);
    const auto notices = write_mesh(folder / ("a" + extension), mesh, nullptr);
    const Mesh read = read_mesh(folder / ("a" + extension)).mesh;
    const std::size_t n = read.side_sets.empty() ? 0 : read.side_sets[0].sides.size();
    if (n < 2) {
      EXPECT_TRUE(test::told(notices, "both sides of 1 face") || test::told(notices, "2 sides of side sets left out"));
    } else {
      EXPECT_EQ(read.side_sets[0].sides.size(), 2U);
    }
  }
}

/// Masses have no property in Nastran, elements of one block any.
TEST(group_names, blocks_of_other_elements_come_back_or_are_told) {
  const auto folder = test::output_folder();
  const auto inp = test::write_text(folder / "a.inp",
                                    "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
                                    "*ELEMENT, TYPE=C3D8, ELSET=EHEX\n1,1,2,3,4,5,6,7,8\n"
                                    "*ELEMENT, TYPE=MASS, ELSET=MA\n11,7\n12,8\n13,1\n14,2\n15,3\n16,4\n17,5\n"
                                    "*ELEMENT, TYPE=MASS, ELSET=MB\n21,6\n");
  const Mesh mesh = read_mesh(inp).mesh;
  ASSERT_EQ(mesh.blocks.size(), 3U);
  const auto sizes = [](const Mesh& of) {
    std::map<std::string, std::size_t> result;
    for (const Block& block : of.blocks) {
      result[block.name] = block.hexes.size();
      if (of.others)
        for (const OtherSet& set : of.others->heads->sets)
          if (set.id == block.id) result[block.name] += set.elements.size();
    }
    return result;
  };
  const std::map<std::string, std::size_t> expected = {{"EHEX", 1}, {"MA", 7}, {"MB", 1}};
  ASSERT_EQ(sizes(mesh), expected);
  for (const std::string extension : {".inp", ".bdf", ".unv", ".med", ".vtu", ".e", ".k", ".cdb", ".cgns", ".foam"}) {
    if (!test::has_format(extension)) continue;
    SCOPED_TRACE(extension);
    const auto notices = write_mesh(folder / ("b" + extension), mesh, nullptr);
    const Mesh read = read_mesh(folder / ("b" + extension)).mesh;
    if (read.others)
      EXPECT_EQ(sizes(read), expected);
    else
      EXPECT_TRUE(test::told(notices, "8 points") || test::told(notices, "8 other elements"));
  }
  // They are named with their line where they are not understood.
  std::string text = test::text_of(folder / "b.bdf");
  const auto at = text.find("$ hextwist others 2 11");
  ASSERT_NE(at, std::string::npos);
  test::write_text(folder / "c.bdf", text.replace(at + 20, 2, "x "));
  EXPECT_NE(test::refusal(folder / "c.bdf").find(": expected an element id, found 'x  12"), std::string::npos)
      << test::refusal(folder / "c.bdf");
}

TEST(group_names, flips_of_openfoam_say_the_side) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(2, 1, 1);
  mesh.side_sets = {{1, "back", {{1, 0}}}};
  write_mesh(folder / "a.foam", mesh, nullptr);
  const auto side = [&] { return read_mesh(folder / "a.foam").mesh.side_sets.at(0).sides.at(0).hex; };
  EXPECT_EQ(side(), 1);
  const auto zones = folder / "constant/polyMesh/faceZones";
  const std::string text = test::text_of(zones);
  const std::string flips = "flipMap List<bool> 1\n(\n1\n)";
  ASSERT_NE(text.find(flips), std::string::npos) << text;
  for (const auto& [now, hex] : std::map<std::string, Index>{{"flipMap List<bool> 1\n(\nfalse\n)", 0},
                                                             {"flipMap List<bool> 1(true)", 1},
                                                             {"flipMap List<bool> 1{0}", 0},
                                                             {"flipMap List<bool> 1{yes}", 1}}) {
    std::string changed = text;
    test::write_text(zones, changed.replace(text.find(flips), flips.size(), now));
    EXPECT_EQ(side(), hex) << now;
  }
  std::string changed = text;
  test::write_text(zones, changed.replace(text.find(flips), flips.size(), "flipMap List<bool> 2{0}"));
  EXPECT_NE(test::refusal(folder / "a.foam").find("face zone back has 2 flips for 1 face"), std::string::npos);
}

TEST(group_names, ids_by_name_give_each_its_own) {
  const std::vector<std::string> names = {"a", "block_1", "b", "block_7", "block_1", "c"};
  EXPECT_EQ(io::ids_by_name("block", names, std::vector{1, 2, 3, 4, 5, -1}), (std::vector{8, 1, 3, 7, 5, 9}));
  EXPECT_EQ(io::ids_by_name("block", std::vector<std::string>{"a", "block_2147483647"}, std::vector{-1, 2}),
            (std::vector{1, 2147483647}));
}

}  // namespace
}  // namespace hextwist
