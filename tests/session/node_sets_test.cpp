// Node sets through refinement: as they are meant, where parts are one hex thick.
#include <gtest/gtest.h>

#include <algorithm>

#include "session/session_fixture.h"

namespace hextwist {

using test::Fixture, test::folder;

namespace {

/// The only node set is just the nodes for which f(point) holds.
template <class F>
testing::AssertionResult set_is(const Mesh& mesh, F f) {
  const std::vector<Index>& nodes = mesh.node_sets.at(0).nodes;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (f(mesh.points[n]) != std::ranges::binary_search(nodes, n))
      return testing::AssertionFailure() << "node at " << mesh.points[n].transpose();
  return testing::AssertionSuccess();
}
bool is_near(double a, double b) {
  return std::abs(a - b) < 1e-9;
}
/// A plate 4 x 4 x 1, its id of the face at z = side / 2.
std::string face(const Fixture& f, int axis, int side) {
  const MeshedModel& meshed = f.session.meshed();
  for (int id = 1; id <= 6; ++id) {
    const Box box = meshed.model->box({2, id});
    if (is_near(box.min[axis], box.max[axis]) && (box.min[axis] > 0) == (side > 0)) return std::to_string(id);
  }
  return "";
}
constexpr const char* plate = "create brick x 4 y 4 z 1 interval 4 4 1; ";

TEST(NodeSets, on_both_faces_of_a_plate_gain_nothing_between) {
  const auto on_faces = [](const Vec3& p) { return is_near(std::abs(p.z()), 0.5); };
  for (const char* refine :
       {"refine volume all numsplit 2", "refine hex 6 7; refine hex in vertex 1", "refine vertex 1 depth 1 smooth"}) {
    SCOPED_TRACE(refine);
    Fixture f;
    f.session.run(plate);
    f.session.run("nodeset 1 surface " + face(f, 2, -1) + " " + face(f, 2, 1));
    f.session.run(refine);
    EXPECT_TRUE(set_is(f.session.meshed().mesh, on_faces));
    // The same nodes without a word on what is meant.
    Fixture g;
    g.session.run(std::string(plate) + "nodeset 1 node all");
    ASSERT_EQ(g.notices.size(), 1u);
    EXPECT_NE(g.notices[0].find("not as volume 1"), std::string::npos);
    g.session.run(refine);
    EXPECT_TRUE(set_is(g.session.meshed().mesh, on_faces));
    // And with one.
    Fixture h;
    h.session.run(std::string(plate) + "nodeset 1 node all; nodeset 1 add volume 1");
    h.session.run(refine);
    EXPECT_TRUE(set_is(h.session.meshed().mesh, [](const Vec3&) { return true; }));
  }
}

TEST(NodeSets, on_a_part_of_both_faces_gain_nothing_between) {
  Fixture f;
  f.session.run(std::string(plate) + "nodeset 1 hex 6 7 10 11; refine hex all");
  EXPECT_TRUE(set_is(f.session.meshed().mesh, [](const Vec3& p) {
    return is_near(std::abs(p.z()), 0.5) && std::abs(p.x()) < 1 + 1e-9 && std::abs(p.y()) < 1 + 1e-9;
  }));
}

TEST(NodeSets, on_the_side_of_a_plate_are_filled) {
  Fixture f;
  f.session.run(plate);
  // By nodes: a strip with ends is meant as the surface that it is.
  f.session.run("nodeset 1 node in surface " + face(f, 0, 1));
  EXPECT_TRUE(f.notices.empty());
  f.session.run("refine volume all numsplit 2");
  EXPECT_TRUE(set_is(f.session.meshed().mesh, [](const Vec3& p) { return is_near(p.x(), 2); }));
}

TEST(NodeSets, that_fill_volumes_go_on_doing_so) {
  for (const char* set : {"nodeset 1 volume 1", "nodeset 1 node all", "nodeset 1 hex all"}) {
    Fixture f;
    f.session.run("create brick x 3 interval 3; " + std::string(set) + "; refine hex 14 13; refine vertex 3");
    EXPECT_TRUE(set_is(f.session.meshed().mesh, [](const Vec3&) { return true; })) << set;
  }
  // One hex.
  Fixture f;
  f.session.run("create brick x 1 interval 1; nodeset 1 node all; refine hex 1");
  EXPECT_TRUE(set_is(f.session.meshed().mesh, [](const Vec3&) { return true; }));
  Fixture g;
  g.session.run("create brick x 1 interval 1; nodeset 1 surface 1; refine hex 1");
  EXPECT_EQ(g.session.meshed().mesh.node_sets[0].nodes.size(), 16u);
}

TEST(NodeSets, along_curves_and_layers_inside_go_on_and_a_node_beside_a_surface_stays_one) {
  const auto run = [](const char* set) {
    Fixture f;
    f.session.run("create brick x 4 interval 4; nodeset 1 " + std::string(set) + "; refine hex all");
    return *f.session.share();
  };
  EXPECT_TRUE(
      set_is(run("node with x_coord > -0.1 and x_coord < 0.1").mesh, [](const Vec3& p) { return is_near(p.x(), 0); }));
  EXPECT_TRUE(set_is(run("node with x_coord > -0.1 and x_coord < 0.1 and y_coord > -0.1 and y_coord < 0.1").mesh,
                     [](const Vec3& p) { return is_near(p.x(), 0) && is_near(p.y(), 0); }));
  EXPECT_TRUE(set_is(run("curve all").mesh, [](const Vec3& p) {
    return is_near(std::abs(p.x()), 2) + is_near(std::abs(p.y()), 2) + is_near(std::abs(p.z()), 2) >= 2;
  }));
  // A probe one hex below a face that is in the set: no way leads to it.
  EXPECT_TRUE(set_is(run("node with z_coord > 1.9 node (at 0 0 1)").mesh, [](const Vec3& p) {
    return is_near(p.z(), 2) || (is_near(p.x(), 0) && is_near(p.y(), 0) && is_near(p.z(), 1));
  }));
}

TEST(NodeSets, on_two_rims_of_a_ring_gain_nothing_between) {
  const Mesh ring = test::ring(1, 12, 0);
  Fixture f;
  f.session.take_mesh(ring);
  f.session.run("nodeset 1 curve 1 2; refine hex all");
  const MeshedModel& meshed = f.session.meshed();
  for (const Index n : meshed.mesh.node_sets[0].nodes) EXPECT_EQ(meshed.association.node_owner[n].dim, 1);
  EXPECT_EQ(meshed.mesh.node_sets[0].nodes.size(), 2u * 36);
  // The nodes alone.
  Fixture g;
  Mesh given = ring;
  g.session.take_mesh(given);
  given.node_sets = {{1, "rims", {}}};
  for (const Index n : nodes_owned_by(g.session.meshed().association, {1, 1})) given.node_sets[0].nodes.push_back(n);
  for (const Index n : nodes_owned_by(g.session.meshed().association, {1, 2})) given.node_sets[0].nodes.push_back(n);
  std::ranges::sort(given.node_sets[0].nodes);
  g.notices.clear();
  g.session.take_mesh(given);
  g.session.run("refine hex all");
  EXPECT_EQ(g.session.meshed().mesh.node_sets[0].nodes, meshed.mesh.node_sets[0].nodes);
}

TEST(NodeSets, on_two_rims_of_a_hole_with_corners_gain_nothing_between) {
  // A ring of square section whose inner wall is four faces that meet at right angles.
  Mesh mesh = test::grid(3, 3, 1);
  std::erase_if(mesh.hexes, [](const Hex& hex) { return hex[0] == 5; });
  mesh.node_sets = {{1, "rims", {5, 6, 9, 10, 21, 22, 25, 26}}};
  Fixture f;
  f.session.take_mesh(mesh);
  EXPECT_EQ(f.notices.size(), 1u);
  f.session.run("refine hex all");
  EXPECT_TRUE(set_is(f.session.meshed().mesh, [](const Vec3& p) {
    const bool on_wall = p.x() > 1 - 1e-9 && p.x() < 2 + 1e-9 && p.y() > 1 - 1e-9 && p.y() < 2 + 1e-9;
    return on_wall && (is_near(p.z(), 0) || is_near(p.z(), 1));
  }));
}

TEST(NodeSets, a_patch_and_undo_give_the_same) {
  Fixture f;
  f.session.run("create brick x 40 y 40 z 1 interval 160 160 1; nodeset 1 node all");
  const Mesh before = f.session.meshed().mesh;
  f.session.run("refine hex 12345");
  const Mesh& mesh = f.session.meshed().mesh;
  EXPECT_TRUE(set_is(mesh, [](const Vec3& p) { return is_near(std::abs(p.z()), 0.5); }));
  f.session.run("undo");
  EXPECT_TRUE(f.session.meshed().mesh == before);
}

}  // namespace
}  // namespace hextwist
