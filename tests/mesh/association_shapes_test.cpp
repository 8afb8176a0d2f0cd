// Association by geometry alone with the analytic models: every owner is known beforehand.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/corners.h"
#include "support/analytic_model.h"
#include "support/association_checkers.h"
#include "support/grids.h"

namespace hextwist {
namespace {

using test::complete;
using test::on_model;
using test::same_owners;

/// Moves the square [-1,1]^2 (or cube) onto the disc (or ball): rings of the grid become circles.
Mesh rounded(Mesh mesh, int dims, double r) {
  for (Vec3& p : mesh.points) {
    const auto head = p.head(dims);
    const double length = head.norm();
    if (length > 0) p.head(dims) *= r * head.cwiseAbs().maxCoeff() / length;
  }
  return mesh;
}

Mesh centred_grid(int n, int layers, const Vec3& size) {
  Mesh mesh = test::grid(n, n, layers, size);
  for (Vec3& p : mesh.points) p -= Vec3(1, 1, size.z() == 2.0 / layers ? 1 : 0);
  return mesh;
}

Mesh cylinder_mesh(int n, int layers, double r, double h) {
  return rounded(centred_grid(n, layers, Vec3(2.0 / n, 2.0 / n, h / layers)), 2, r);
}

Mesh ball_mesh(int n, double r) {
  return rounded(centred_grid(n, n, Vec3::Constant(2.0 / n)), 3, r);
}

/// Owner of a grid point of the analytic brick, from its indices.
Owner brick_owner(const std::array<int, 3>& at, const std::array<int, 3>& n) {
  int free = 0, axis = 0, corner = 0;
  for (int a = 0; a < 3; ++a) {
    if (at[a] != 0 && at[a] != n[a]) {
      ++free;
      axis = a;
    }
    corner |= (at[a] == n[a]) << a;
  }
  if (free == 0) return {0, 1 + corner};
  if (free == 1) return {1, 1 + 4 * axis + gather_bits(axis, corner)};
  if (free == 3) return {3, 1};
  for (int a = 0; a < 3; ++a)
    if (at[a] == 0 || at[a] == n[a]) return {2, 1 + 2 * a + (at[a] == n[a])};
  return {};
}

TEST(association, a_brick_gets_the_owners_that_its_grid_says) {
  const std::array<int, 3> n = {4, 3, 5};
  const Vec3 size(0.5, 1, 2);
  const Mesh mesh = test::grid(n[0], n[1], n[2], size);
  const auto model = analytic_brick(n[0] * size.x(), n[1] * size.y(), n[2] * size.z());
  const auto result = associate(mesh, *model);
  EXPECT_EQ(result.notices, std::vector<std::string>{});
  EXPECT_LT(result.max_distance, 1e-12);
  for (int k = 0, node = 0; k <= n[2]; ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i, ++node)
        EXPECT_EQ(result.association.node_owner[node], brick_owner({i, j, k}, n)) << node;
  EXPECT_TRUE(complete(mesh, result.association, *model));
  EXPECT_TRUE(on_model(mesh, result.association, *model, 1e-12));
  EXPECT_EQ(check_association(mesh, result.association, *model), std::vector<std::string>{});
}

TEST(association, one_hex_is_enough) {
  const Mesh mesh = test::grid(1, 1, 1);
  const auto model = analytic_brick(1, 1, 1);
  const auto result = associate(mesh, *model);
  EXPECT_TRUE(complete(mesh, result.association, *model));
  EXPECT_EQ(result.association.curve_edges.size(), 12);
  for (int c = 0; c < 8; ++c) EXPECT_EQ(result.association.node_owner[c], (Owner{0, 1 + c}));
}

TEST(association, numbering_and_turning_change_nothing) {
  std::mt19937 random(11);
  const Mesh plain = test::grid(3, 3, 2);
  const auto model = analytic_brick(3, 3, 2);
  const auto before = associate(plain, *model).association;
  for (int round = 0; round < 5; ++round) {
    const Mesh mesh = test::shuffled(plain, random);
    const auto after = associate(mesh, *model).association;
    EXPECT_TRUE(complete(mesh, after, *model));
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      for (Index m = 0; m < plain.n_nodes(); ++m)
        if (mesh.points[n] == plain.points[m]) {
          EXPECT_EQ(after.node_owner[n], before.node_owner[m]);
        }
  }
}

TEST(association, elements_smaller_than_the_tolerance_keep_their_owners) {
  // A brick graded towards its corner down to a thousandth of the tolerance.
  Mesh mesh = test::grid(12, 12, 12);
  const auto model = analytic_brick(1, 1, 1);
  for (Vec3& p : mesh.points)
    for (double& x : p.reshaped()) x = x == 0 ? 0 : std::pow(10, (x - 12) * 0.75);
  const auto association = associate(mesh, *model).association;
  EXPECT_TRUE(complete(mesh, association, *model));
  for (int k = 0, node = 0; k <= 12; ++k)
    for (int j = 0; j <= 12; ++j)
      for (int i = 0; i <= 12; ++i, ++node)
        EXPECT_EQ(association.node_owner[node], brick_owner({i, j, k}, {12, 12, 12})) << node;
}

TEST(association, sheets_nearer_than_the_tolerance_are_told_apart_by_their_normals) {
  const double thin = 1e-6;
  const Mesh mesh = test::grid(3, 3, 1, Vec3(1, 1, thin));
  const auto model = analytic_brick(3, 3, thin);
  const auto association = associate(mesh, *model).association;
  for (std::size_t i = 0; i < association.surface_faces.size(); ++i)
    EXPECT_EQ(association.face_surface[i], 1 + association.surface_faces[i].face);
}

TEST(association, a_cylinder_has_rims_and_a_ball_has_none) {
  for (const int n : {2, 4, 8}) {
    const Mesh mesh = cylinder_mesh(n, 3, 1.5, 4);
    const auto model = analytic_cylinder(1.5, 4);
    const auto result = associate(mesh, *model);
    EXPECT_TRUE(complete(mesh, result.association, *model));
    EXPECT_TRUE(on_model(mesh, result.association, *model, 1e-12));
    EXPECT_EQ(check_association(mesh, result.association, *model), std::vector<std::string>{});
    EXPECT_EQ(nodes_owned_by(result.association, {2, 2}).size(), (n - 1) * (n - 1));
    EXPECT_EQ(nodes_owned_by(result.association, {0, 1}).size(), 1);
    EXPECT_EQ(nodes_owned_by(result.association, {1, 1}).size(), 4 * n - 1);
    const Mesh ball = ball_mesh(n, 2);
    const auto sphere = analytic_sphere(2);
    const auto on_sphere = associate(ball, *sphere);
    EXPECT_TRUE(complete(ball, on_sphere.association, *sphere));
    EXPECT_TRUE(on_model(ball, on_sphere.association, *sphere, 1e-12));
    EXPECT_TRUE(on_sphere.association.curve_edges.empty());
  }
}

TEST(association, rims_without_a_node_at_their_vertex_stay_closed) {
  Mesh mesh = cylinder_mesh(4, 2, 1, 1);
  const Eigen::AngleAxisd turn(0.1, Vec3::UnitZ());
  for (Vec3& p : mesh.points) p = turn * p;
  const auto model = analytic_cylinder(1, 1);
  const auto result = associate(mesh, *model);
  EXPECT_TRUE(complete(mesh, result.association, *model));
  EXPECT_EQ(nodes_owned_by(result.association, {1, 1}).size(), 16);
  ASSERT_EQ(result.notices.size(), 1);
  EXPECT_EQ(result.notices[0], "2 vertices have no node of the mesh: 1 2");
}

TEST(association, right_tags_change_nothing_and_wrong_ones_are_replaced_with_a_notice) {
  const Mesh mesh = test::grid(3, 3, 3);
  const auto model = analytic_brick(3, 3, 3);
  const auto truth = associate(mesh, *model).association;
  const auto same = associate(mesh, *model, &truth);
  EXPECT_TRUE(same_owners(same.association, truth));
  EXPECT_EQ(same.notices, std::vector<std::string>{});

  Association wrong = truth;
  for (int& s : wrong.face_surface) s = s % 6 + 1;
  for (int& c : wrong.edge_curve) c = 13 - c;
  for (Owner& owner : wrong.node_owner)
    if (owner.dim == 0) owner.id = 9 - owner.id;
  const auto repaired = associate(mesh, *model, &wrong);
  EXPECT_TRUE(same_owners(repaired.association, truth));
  ASSERT_EQ(repaired.notices.size(), 3);
  EXPECT_EQ(repaired.notices[0],
            "54 surface tags of the file number the CAD in another way: matched by geometry (first: face of hex 1, tag "
            "6, on surface 5)");
  EXPECT_EQ(repaired.notices[1],
            "36 curve tags of the file number the CAD in another way: matched by geometry (first: edge between nodes 1 "
            "and 2, tag 12, on curve 1)");
  EXPECT_EQ(repaired.notices[2],
            "8 vertex tags of the file number the CAD in another way: matched by geometry (first: node 1, tag 8, on "
            "vertex 1)");
  EXPECT_TRUE(associate(mesh, *model, &wrong, {.use_tags = false}).notices.empty());
}

TEST(association, tags_of_entities_that_are_not_are_ignored_with_a_notice) {
  const Mesh mesh = test::grid(2, 2, 2);
  const auto model = analytic_brick(2, 2, 2);
  const auto truth = associate(mesh, *model).association;
  Association wrong = truth;
  wrong.face_surface[0] = 23;
  wrong.node_owner[0] = {0, 17};
  wrong.surface_faces[1] = {0, 1};  // inside
  wrong.face_surface[1] = 4;
  const auto result = associate(mesh, *model, &wrong);
  EXPECT_TRUE(same_owners(result.association, truth));
  ASSERT_EQ(result.notices.size(), 3);
  EXPECT_EQ(result.notices[0], "tags name vertex 17, the model has 8: ignored");
  EXPECT_EQ(result.notices[1], "tags name surface 23, the model has 6: ignored");
  EXPECT_EQ(result.notices[2],
            "1 surface tag of the file numbers the CAD in another way: matched by geometry (first: face of hex 1, tag "
            "4, on volume 1)");
}

}  // namespace
}  // namespace hextwist
