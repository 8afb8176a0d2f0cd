// block, nodeset, sideset, delete, reset.
#include <gtest/gtest.h>

#include <algorithm>

#include "hextwist/base/sorted.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/corners.h"
#include "session/session_fixture.h"
#include "support/checkers.h"

namespace hextwist {

using test::Fixture, test::folder;

namespace {

/// Nodes at which f(point) holds.
template <class F>
std::vector<Index> nodes_where(const Mesh& mesh, F f) {
  std::vector<Index> result;
  for (Index i = 0; i < mesh.n_nodes(); ++i)
    if (f(mesh.points[i])) result.push_back(i);
  return result;
}
std::vector<Index> nodes_of(const Mesh& mesh, const SideSet& set) {
  std::vector<Index> result;
  for (const auto [hex, face] : set.sides)
    for (const Index node : face_nodes(mesh.hexes[hex], face)) result.push_back(node);
  sort_unique(result);
  return result;
}

TEST(Sets, a_nodeset_of_a_surface_has_its_rim_and_a_sideset_its_faces) {
  Fixture f;
  f.session.run("create brick x 4 interval 4");
  for (int surface = 1; surface <= 6; ++surface) {
    const std::string id = std::to_string(surface);
    f.session.run("nodeset " + id + " surface " + id + "; sideset " + id + " surface " + id);
  }
  const Mesh& mesh = f.session.meshed().mesh;
  std::vector<std::vector<Index>> found, expected;
  for (int i = 0; i < 6; ++i) {
    found.push_back(mesh.node_sets.at(i).nodes);
    EXPECT_EQ(nodes_of(mesh, mesh.side_sets.at(i)), found.back());
    EXPECT_EQ(mesh.side_sets[i].sides.size(), 16u);
    expected.push_back(nodes_where(mesh, [&](const Vec3& p) { return std::abs(p[i / 2] - (i % 2 ? 2 : -2)) < 1e-9; }));
  }
  std::ranges::sort(found);
  std::ranges::sort(expected);
  EXPECT_EQ(found, expected);
}

TEST(Sets, every_kind_of_entity_gives_its_nodes) {
  Fixture f;
  f.session.run(
      "create brick x 2 interval 2; nodeset 1 vertex 1; nodeset 2 curve 1; nodeset 3 volume 1; nodeset 4 hex 1;"
      "nodeset 5 face 1; nodeset 6 edge 1; nodeset 7 node 5 7; nodeset 8 block 1; nodeset 9 nodeset 2 7;"
      "sideset 1 face 1 2; nodeset 10 sideset 1");
  const auto& sets = f.session.meshed().mesh.node_sets;
  std::vector<std::size_t> sizes;
  for (const NodeSet& set : sets) sizes.push_back(set.nodes.size());
  EXPECT_EQ(sizes[0], 1u);
  EXPECT_EQ(sizes[1], 3u);
  EXPECT_EQ(sizes[2], 27u);
  EXPECT_EQ(sizes[3], 8u);
  EXPECT_EQ(sizes[4], 4u);
  EXPECT_EQ(sizes[5], 2u);
  EXPECT_EQ(sets[6].nodes, (std::vector<Index>{4, 6}));
  EXPECT_EQ(sizes[7], 27u);
  EXPECT_GE(sizes[8], 3u);
  EXPECT_GE(sizes[9], 6u);
  EXPECT_TRUE(test::sets_valid(f.session.meshed().mesh));
}

TEST(Sets, grow_shrink_get_names_and_go) {
  Fixture f;
  f.session.run(
      "create brick x 2 interval 2; reset block; block 4 hex 1 2; block 4 hex 2 3 name 'a b'; block 9 volume 1");
  const Mesh& mesh = f.session.meshed().mesh;
  ASSERT_EQ(mesh.blocks.size(), 2u);
  EXPECT_EQ(mesh.blocks[0].hexes, (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(mesh.blocks[0].name, "a b");
  EXPECT_EQ(f.notices.back(), "3 hexes of block 9 are in block 4 too");
  f.session.run("block 4 name \"steel\"; block 4 remove hex 1 8");
  EXPECT_EQ(mesh.blocks[0].hexes, (std::vector<Index>{1, 2}));
  EXPECT_EQ(mesh.blocks[0].name, "steel");
  f.session.run("refine hex in block steel");  // a name where an id may stand
  f.session.run("block 4 remove hex in block 4");
  EXPECT_EQ(f.session.meshed().mesh.blocks.size(), 1u);
  f.session.run("nodeset 1 node 1; nodeset 2 node 2; nodeset 3 node 3; delete nodeset 1 3");
  ASSERT_EQ(f.session.meshed().mesh.node_sets.size(), 1u);
  EXPECT_EQ(f.session.meshed().mesh.node_sets[0].id, 2);
  f.session.run("reset nodeset; block all element type hex8");
  EXPECT_TRUE(f.session.meshed().mesh.node_sets.empty());
}

TEST(Sets, several_kinds_in_one_command_are_one) {
  Fixture f;
  f.session.run(
      "create brick x 3 interval 3; reset block; group few add hex 2 curve 1 hex 4;"
      "block 1 add hex 5 to 9 group few hex 20; block 2 hex 5 to 9; block 2 hex 2 4; block 2 hex 20;"
      "sideset 3 surface 1 2 face 7 surface 3; sideset 4 surface 1 to 3; sideset 4 face 7;"
      "nodeset 2 curve 1 to 4 vertex 3 node 8 9 vert 8 name 'n'");
  const Mesh& mesh = f.session.meshed().mesh;
  EXPECT_EQ(mesh.blocks.at(0).hexes, mesh.blocks.at(1).hexes);
  EXPECT_EQ(mesh.blocks[0].hexes, (std::vector<Index>{1, 3, 4, 5, 6, 7, 8, 19}));
  EXPECT_EQ(mesh.side_sets.at(0).sides, mesh.side_sets.at(1).sides);
  f.session.run("nodeset 5 curve 1 to 4; nodeset 5 vertex 3; nodeset 5 node 8; nodeset 5 node 9; nodeset 5 vertex 8");
  EXPECT_EQ(mesh.node_sets.at(0).nodes, mesh.node_sets.at(1).nodes);
  EXPECT_EQ(mesh.node_sets[0].name, "n");
  f.session.run("sideset 3 remove surface 2 3 face 7; sideset 4 remove face 7; sideset 4 remove surface 2 to 3");
  EXPECT_EQ(mesh.side_sets[0].sides, mesh.side_sets[1].sides);
  EXPECT_TRUE(test::sets_valid(mesh));
}

TEST(Sets, several_kinds_are_undone_together_and_all_or_nothing) {
  Fixture f;
  f.session.run("create brick x 2 interval 2; reset block; block 1 hex 1 volume 1; undo");
  EXPECT_TRUE(f.session.meshed().mesh.blocks.empty());
  EXPECT_EQ(f.error("block 1 hex 1 volume 7"), "volume 7 does not exist; the only one is 1");
  EXPECT_EQ(f.last().column, 22);
  EXPECT_EQ(f.error("nodeset 1 curve 1 node 99"), "node 99 does not exist; nodes are 1 to 27");
  EXPECT_EQ(f.error("sideset 1 surface 1 face 5 reverse"), "there is nothing for a sideset there");
  EXPECT_EQ(f.last().column, 19);
  EXPECT_EQ(f.error("sideset 1 surface 1 both surface 2"),
            "expected wrt, name or the end of the command, found 'surface'");
  EXPECT_TRUE(f.session.meshed().mesh.blocks.empty());
  EXPECT_TRUE(f.session.meshed().mesh.side_sets.empty());
}

TEST(Sets, mistakes_are_pointed_at) {
  Fixture f;
  EXPECT_TRUE(f.error("block 1 volume 1").starts_with("there is no mesh to make sets of"));
  f.session.run("create brick x 2 interval 2");
  EXPECT_EQ(f.error("block 5 name 'x'"), "there is no block 5");
  EXPECT_EQ(f.last().column, 7);
  EXPECT_EQ(f.error("nodeset 5 remove node 1"), "there is no nodeset 5");
  EXPECT_EQ(f.error("nodeset 5 node 1 name ''"), "this name is empty");
  EXPECT_EQ(f.error("block all element type tet4"), "'tet4' elements are not written: files have hex8, hex20 or hex27");
  EXPECT_EQ(f.error("sideset 1 surface 1 reverse"), "there is nothing for a sideset there");
  EXPECT_EQ(f.error("delete sideset 1"), "there are no sidesets");
  EXPECT_TRUE(f.session.meshed().mesh.node_sets.empty());
}

TEST(Sets, a_face_between_volumes_has_two_sides) {
  // Two volumes: a box of two blocks without CAD.
  Mesh mesh = test::grid(4, 2, 2);
  for (int i = 0; i < 2; ++i) {
    mesh.blocks.push_back({i + 1, "", {}});
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      double x = 0;
      for (const Index node : mesh.hexes[h]) x += mesh.points[node].x() / 8;
      if ((x > 2) == (i == 1)) mesh.blocks.back().hexes.push_back(h);
    }
  }
  Fixture f;
  f.session.take(mesh, nullptr);
  const Model& model = *f.session.meshed().model;
  int shared = 0;
  for (int id = 1; id <= model.count(2); ++id)
    if (model.adjacent({2, id}, 3).size() == 2) shared = id;
  ASSERT_GT(shared, 0);
  const std::string surface = "surface " + std::to_string(shared);
  f.session.run("sideset 1 " + surface + "; sideset 2 " + surface + " reverse; sideset 3 " + surface +
                " both; sideset 4 " + surface + " wrt volume 2; sideset 5 " + surface + " wrt volume 1");
  const auto& sets = f.session.meshed().mesh.side_sets;
  const auto volumes = [&](int i) {
    std::vector<int> result;
    for (const Side side : sets.at(i).sides) result.push_back(f.session.meshed().association.hex_volume[side.hex]);
    return result;
  };
  EXPECT_EQ(volumes(0), (std::vector<int>{1, 1, 1, 1}));
  EXPECT_EQ(volumes(1), (std::vector<int>{2, 2, 2, 2}));
  EXPECT_EQ(volumes(2).size(), 8u);
  EXPECT_EQ(sets[3].sides, sets[1].sides);
  EXPECT_EQ(sets[4].sides, sets[0].sides);
  f.session.run("sideset 6 " + surface + " wrt volume 2 reverse; sideset 7 " + surface + " wrt volume 2 both");
  EXPECT_EQ(sets[5].sides, sets[0].sides);
  EXPECT_EQ(sets[6].sides, sets[2].sides);
  f.session.run("sideset 7 remove " + surface + " reverse; sideset 6 add " + surface + " both; sideset 6 remove " +
                surface + " wrt volume 2");
  EXPECT_EQ(sets[5].sides, sets[0].sides);
  EXPECT_EQ(sets[6].sides, sets[0].sides);
  f.session.run("sideset 3 remove " + surface);
  EXPECT_EQ(std::ranges::count(sets, 3, &SideSet::id), 0);
  EXPECT_EQ(sets.size(), 6u);
}

TEST(Sets, are_refined_with_the_mesh_and_written_in_every_format) {
  Fixture f;
  f.session.run(
      "create brick x 4 interval 4; block 1 hex 1 to 32 name 'lower'; block 2 hex 33 to 64; block 1 remove hex 33 to "
      "64;"
      "nodeset 3 curve 4 name 'rim'; sideset 5 surface 6 name 'wall'; refine surface 6 numsplit 1");
  const Mesh& mesh = f.session.meshed().mesh;
  EXPECT_TRUE(test::sets_valid(mesh));
  // A set of a surface is still that of the surface.
  f.session.run("sideset 6 surface 6; nodeset 4 curve 4");
  EXPECT_EQ(mesh.side_sets.at(0).sides, mesh.side_sets.at(1).sides);
  EXPECT_EQ(mesh.node_sets.at(0).nodes, mesh.node_sets.at(1).nodes);
  f.session.run("delete sideset 6; delete nodeset 4");
  EXPECT_GT(mesh.side_sets[0].sides.size(), 16u);
  for (const char* name : {"a.e", "a.msh", "a.inp", "a.mesh"}) {
    const auto file = folder() / name;
    f.session.run("export mesh '" + file.string() + "'");
    const Mesh back = read_mesh(file).mesh;
    ASSERT_EQ(back.blocks.size(), mesh.blocks.size()) << name;
    for (std::size_t i = 0; i < mesh.blocks.size(); ++i) {
      EXPECT_EQ(back.blocks[i].name, mesh.blocks[i].name) << name;
      EXPECT_EQ(back.blocks[i].hexes.size(), mesh.blocks[i].hexes.size()) << name;
    }
    ASSERT_EQ(back.node_sets.size(), 1u) << name;
    EXPECT_EQ(back.node_sets[0].name, "rim") << name;
    EXPECT_EQ(back.node_sets[0].nodes.size(), mesh.node_sets[0].nodes.size()) << name;
    ASSERT_EQ(back.side_sets.size(), 1u) << name;
    EXPECT_EQ(back.side_sets[0].name, "wall") << name;
    EXPECT_EQ(back.side_sets[0].sides.size(), mesh.side_sets[0].sides.size()) << name;
  }
}

TEST(Sets, all_blocks_at_once_have_an_element_type_only) {
  Fixture f;
  f.session.run("create brick x 1 interval 2");
  EXPECT_EQ(f.error("block all add hex 1"), "one block at a time; 'all' goes with 'element type' only");
  EXPECT_EQ(f.error("block all name \"a\""), "one block at a time; 'all' goes with 'element type' only");
  f.session.run("block all element type hex8");
}

}  // namespace
}  // namespace hextwist
