// Owner queries, distances from owners, and whether check_association() sees each promise broken.
#include <gtest/gtest.h>

#include <algorithm>

#include "hextwist/mesh/association/association.h"
#include "support/analytic_model.h"
#include "support/association_checkers.h"
#include "support/grids.h"

namespace hextwist {
namespace {

/// A grid of 3 x 3 x 3 on a brick: the middle node of nothing, face and edge numbers as topology has them.
struct Case {
  Mesh mesh = test::grid(3, 3, 3);
  std::shared_ptr<const Model> model = analytic_brick(3, 3, 3);
  Association association = associate(mesh, *model).association;
  Edges mesh_edges = edges(mesh);
  Faces mesh_faces = faces(mesh);

  Index node(int i, int j, int k) const { return i + 4 * (j + 4 * k); }
  Owner edge_owner(Index a, Index b) const {
    return owner_of_edge(association, mesh, mesh_edges, mesh_faces, find_edge(mesh_edges, a, b));
  }
  Owner face_owner(const Quad& nodes) const {
    return owner_of_face(association, mesh_faces, find_face(mesh_faces, nodes));
  }
  std::vector<std::string> check() const { return check_association(mesh, association, *model); }
};

TEST(owner_queries, nodes_edges_and_faces_know_their_owners) {
  const Case c;
  EXPECT_EQ(owner_of_node(c.association, c.node(3, 0, 0)), (Owner{0, 2}));
  EXPECT_EQ(owner_of_node(c.association, c.node(1, 0, 0)), (Owner{1, 1}));
  EXPECT_EQ(owner_of_node(c.association, c.node(1, 1, 0)), (Owner{2, 5}));
  EXPECT_EQ(owner_of_node(c.association, c.node(1, 1, 1)), (Owner{3, 1}));
  EXPECT_EQ(owner_of_node(c.association, -1), Owner{});
  EXPECT_EQ(owner_of_node(c.association, c.mesh.n_nodes()), Owner{});
  EXPECT_EQ(c.edge_owner(c.node(0, 0, 0), c.node(1, 0, 0)), (Owner{1, 1}));
  EXPECT_EQ(c.edge_owner(c.node(1, 0, 0), c.node(1, 1, 0)), (Owner{2, 5}));
  EXPECT_EQ(c.edge_owner(c.node(1, 1, 0), c.node(1, 1, 1)), (Owner{3, 1}));
  EXPECT_EQ(c.face_owner({c.node(1, 1, 0), c.node(2, 1, 0), c.node(1, 2, 0), c.node(2, 2, 0)}), (Owner{2, 5}));
  EXPECT_EQ(c.face_owner({c.node(1, 1, 1), c.node(2, 1, 1), c.node(1, 2, 1), c.node(2, 2, 1)}), (Owner{3, 1}));
}

TEST(owner_queries, an_edge_through_the_inside_between_boundary_nodes_is_the_volumes) {
  const Mesh mesh = test::grid(2, 1, 2);
  const auto model = analytic_brick(2, 1, 2);
  const Association association = associate(mesh, *model).association;
  const Edges all = edges(mesh);
  // The middle line from the middle of one side to that of the other: both ends are on surfaces.
  const Index edge = find_edge(all, 1 + 3 * (0 + 2 * 1), 1 + 3 * (1 + 2 * 1));
  EXPECT_EQ(owner_of_edge(association, mesh, all, faces(mesh), edge), (Owner{3, 1}));
}

TEST(owner_queries, an_empty_association_owns_nothing) {
  const Case c;
  const Association nothing;
  EXPECT_EQ(owner_of_node(nothing, 0), Owner{});
  EXPECT_EQ(owner_of_edge(nothing, c.mesh, c.mesh_edges, c.mesh_faces, 0), Owner{});
  EXPECT_EQ(owner_of_face(nothing, c.mesh_faces, 0), Owner{});
  EXPECT_TRUE(nodes_owned_by(nothing, {2, 1}).empty());
  EXPECT_EQ(off_model(c.mesh, nothing, *c.model).node, -1);
}

TEST(owner_queries, entities_know_their_nodes_with_and_without_their_rim) {
  const Case c;
  EXPECT_EQ(nodes_owned_by(c.association, {0, 1}), std::vector<Index>{0});
  EXPECT_EQ(nodes_owned_by(c.association, {1, 1}), (std::vector<Index>{1, 2}));
  EXPECT_EQ(nodes_on(c.association, *c.model, {1, 1}), (std::vector<Index>{0, 1, 2, 3}));
  EXPECT_EQ(nodes_owned_by(c.association, {2, 5}).size(), 4);
  EXPECT_EQ(nodes_on(c.association, *c.model, {2, 5}).size(), 16);
  EXPECT_EQ(nodes_owned_by(c.association, {3, 1}).size(), 8);
  EXPECT_EQ(nodes_on(c.association, *c.model, {3, 1}).size(), 64);
}

TEST(off_model, the_worst_node_is_found_whatever_its_parameters_say) {
  Case c;
  EXPECT_LT(off_model(c.mesh, c.association, *c.model).max, 1e-15);
  c.mesh.points[c.node(1, 1, 0)].z() -= 0.25;
  c.mesh.points[c.node(2, 0, 0)].z() -= 0.125;
  c.mesh.points[c.node(1, 1, 1)] += Vec3(9, 9, 9);  // inside: no matter
  for (const bool parameters : {true, false}) {
    if (!parameters) c.association.node_parameters.assign(c.mesh.points.size(), {0.1, 0.1});
    const OffModel off = off_model(c.mesh, c.association, *c.model);
    EXPECT_DOUBLE_EQ(off.max, 0.25);
    EXPECT_DOUBLE_EQ(off.max_relative, 0.25 / std::sqrt(27));
    EXPECT_EQ(off.node, c.node(1, 1, 0));
    EXPECT_EQ(off.owner, (Owner{2, 5}));
  }
}

/// The only lines are those expected, each found by a part of it; and the independent checkers agree that it is broken.
void expect_broken(const Case& c, const std::string& part, bool adjacency = true) {
  const auto lines = c.check();
  EXPECT_TRUE(std::ranges::any_of(lines, [&](const std::string& line) { return line.find(part) != line.npos; }))
      << part << "\n"
      << testing::PrintToString(lines);
  if (adjacency)
    EXPECT_FALSE(test::complete(c.mesh, c.association, *c.model)) << part;
  else
    EXPECT_FALSE(test::on_model(c.mesh, c.association, *c.model, 1e-5)) << part;
}

TEST(check_association, every_broken_promise_is_seen) {
  const Case good;
  ASSERT_EQ(good.check(), std::vector<std::string>{});
  const auto broken = [&](auto&& damage) {
    Case c;
    damage(c.association);
    return c;
  };
  const Index inner = good.node(1, 1, 1), on_surface = good.node(1, 1, 0), on_curve = good.node(1, 0, 0);
  EXPECT_EQ(broken([](Association& a) { a.hex_volume.pop_back(); }).check()[0], "26 hex volumes instead of 27");
  EXPECT_EQ(broken([](Association& a) { a.node_owner.clear(); }).check()[0], "0 node owners instead of 64");
  EXPECT_EQ(broken([](Association& a) { a.node_parameters.clear(); }).check()[0], "0 node parameters instead of 64");
  EXPECT_EQ(broken([](Association& a) { a.edge_curve.pop_back(); }).check()[0],
            "35 curves of curve edges instead of 36");
  EXPECT_EQ(broken([](Association& a) { a.face_surface.pop_back(); }).check()[0],
            "53 surfaces of surface faces instead of 54");
  EXPECT_EQ(broken([](Association& a) { a.hex_volume[3] = 2; }).check()[0], "hex 4 is in volume 2, which is not");
  EXPECT_EQ(broken([](Association& a) { a.node_owner[0] = {}; }).check()[0],
            "node 1 is owned by nothing, which is not");
  EXPECT_EQ(broken([](Association& a) { a.face_surface[0] = 7; }).check()[0],
            "side 1 of hex 1 is on surface 7, which is not");
  EXPECT_EQ(broken([](Association& a) { a.edge_curve[0] = 0; }).check()[0], "curve edge 0 is on curve 0, which is not");
  EXPECT_EQ(broken([](Association& a) { a.surface_faces.back().face = 6; }).check()[0],
            "surface face 53 is not a side of a hex");
  EXPECT_EQ(broken([](Association& a) { std::swap(a.surface_faces[0], a.surface_faces[1]); }).check()[0],
            "surface faces are not ascending");
  EXPECT_EQ(broken([](Association& a) { std::swap(a.curve_edges[0], a.curve_edges[1]); }).check()[0],
            "curve edges are not ascending");
  expect_broken(broken([&](Association& a) {
                  a.node_owner[inner] = {2, 5};
                }),
                "node 22 inside volume 1 is owned by surface 5");
  expect_broken(broken([&](Association& a) {
                  a.node_owner[on_surface] = {3, 1};
                }),
                "on surface 5 is owned by volume 1");
  expect_broken(broken([&](Association& a) {
                  a.node_owner[on_curve] = {2, 5};
                }),
                "of edge 1 2 on curve 1 is owned by surface 5");
  expect_broken(broken([&](Association& a) {
                  a.node_owner[on_surface] = {1, 1};
                }),
                "node 6 is owned by curve 1 but is on no edge of it", false);
  expect_broken(broken([](Association& a) {
                  a.surface_faces.pop_back();
                  a.face_surface.pop_back();
                }),
                "side 6 of hex 27 is on the boundary, but on no surface");
  expect_broken(broken([](Association& a) {
                  a.surface_faces.push_back({26, 5});
                  a.surface_faces[a.surface_faces.size() - 2] = {26, 4};
                  a.face_surface.push_back(6);
                }),
                "side 5 of hex 27 is not named by its first hex");
  expect_broken(broken([](Association& a) {
                  a.curve_edges.erase(a.curve_edges.begin());
                  a.edge_curve.erase(a.edge_curve.begin());
                }),
                "edge 1 2 is between surfaces 5 and 3 but on no curve");
  expect_broken(broken([](Association& a) { a.edge_curve[0] = 12; }),
                "edge 1 2 is on curve 12, which does not bound surface");
  expect_broken(broken([&](Association& a) {
                  a.curve_edges.insert(a.curve_edges.begin() + 1, Edge{0, 9});
                  a.edge_curve.insert(a.edge_curve.begin(), 1);
                }),
                "is not an edge of the mesh, lower node first");
  expect_broken(broken([&](Association& a) { a.node_parameters[on_curve].u += 0.01; }),
                "node 2 is 0.010000 from its place on curve 1", false);
  expect_broken(broken([&](Association& a) { a.node_parameters[on_surface] = {}; }), "from its place on surface 5",
                false);
  Case moved;
  moved.mesh.points[on_surface].z() += 0.125;
  expect_broken(moved, "node 6 is 0.125000 from its place on surface 5", false);
  Case extra;
  extra.mesh.points.emplace_back(1, 1, 1);
  extra.association.node_owner.push_back({3, 1});
  extra.association.node_parameters.emplace_back();
  EXPECT_EQ(extra.check(), std::vector<std::string>{"node 65 is of no hex, but owned by volume 1"});
}

TEST(check_association, surfaces_inside_a_volume_and_beside_another_are_seen) {
  Mesh mesh = test::grid(4, 2, 2);
  mesh.blocks = {{1, "", {}}, {2, "", {}}};
  for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.blocks[h % 4 / 2].hexes.push_back(h);
  const auto own = associate_with_own_skin(mesh);
  auto wrong = own.association;
  wrong.hex_volume.assign(mesh.hexes.size(), 1);
  const auto lines = check_association(mesh, wrong, *own.model);
  const auto has = [&](const std::string& part) {
    return std::ranges::any_of(lines, [&](const std::string& line) { return line.find(part) != line.npos; });
  };
  EXPECT_TRUE(has(" inside volume 1")) << testing::PrintToString(lines);
  EXPECT_TRUE(has(", which does not bound volume 1"));
  EXPECT_FALSE(test::complete(mesh, wrong, *own.model));
}

}  // namespace
}  // namespace hextwist
