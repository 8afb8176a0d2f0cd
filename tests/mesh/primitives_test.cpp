#include "hextwist/mesh/primitives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/topology.h"
#include "support/analytic_model.h"
#include "support/checkers.h"
#include "support/skins.h"

namespace hextwist {
namespace {

constexpr double pi = std::numbers::pi;

std::set<Index> skin_nodes(const Mesh& mesh) {
  std::set<Index> nodes;
  for (const auto& quad : test::skin(mesh).quads) nodes.insert(quad.begin(), quad.end());
  return nodes;
}

void expect_good_mesh(const Mesh& mesh, const char* name) {
  EXPECT_TRUE(test::conformal(mesh));
  EXPECT_TRUE(test::uninverted(mesh));
  EXPECT_TRUE(test::sets_valid(mesh));
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].id, 1);
  EXPECT_EQ(mesh.blocks[0].name, name);
  EXPECT_EQ(mesh.blocks[0].hexes.size(), mesh.hexes.size());
}

double min_scaled_jacobian(const Mesh& mesh) {
  return summarize(quality(Metric::scaled_jacobian, mesh)).min;
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(primitives, a_brick_is_a_grid_around_the_origin) {
  const Mesh mesh = mesh_brick({10, 5, 2}, {5, 3, 1});
  expect_good_mesh(mesh, "brick");
  EXPECT_EQ(mesh.n_hexes(), 15);
  EXPECT_EQ(mesh.n_nodes(), 6 * 4 * 2);
  EXPECT_EQ(box(mesh).min, Vec3(-5, -2.5, -1));
  EXPECT_EQ(box(mesh).max, Vec3(5, 2.5, 1));
  EXPECT_NEAR(volume(mesh), 100, 1e-12);
  EXPECT_NEAR(min_scaled_jacobian(mesh), 1, 1e-12);
}

TEST(primitives, a_cylinder_lies_on_its_radius_and_ends) {
  for (const int n : {1, 2, 3, 4, 5, 8, 16, 32})
    for (const int m : {1, 2, 5}) {
      SCOPED_TRACE(std::to_string(n) + " " + std::to_string(m));
      const Mesh mesh = mesh_cylinder({3, 10}, {n, m, 2});
      expect_good_mesh(mesh, "cylinder");
      EXPECT_EQ(mesh.n_hexes(), 2 * (n * n + 4 * n * m));
      EXPECT_GT(min_scaled_jacobian(mesh), n == 1 ? 0.7 : 0.8);
      const auto model = analytic_cylinder(3, 10);
      int on_side = 0, on_seam = 0;
      for (const Index node : skin_nodes(mesh)) {
        const Vec3 p = mesh.points[node] + Vec3(0, 0, 5);
        double nearest = 1;
        for (int s = 1; s <= 3; ++s) nearest = std::min(nearest, model->project({2, s}, p).distance);
        EXPECT_LT(nearest, 1e-15);
        on_side += model->project({2, 1}, p).distance < 1e-15;
        on_seam += p.y() == 0 && std::abs(p.x() - 3) < 1e-15;
      }
      EXPECT_EQ(on_side, 3 * 4 * n);
      EXPECT_EQ(on_seam, 3);  // nodes on the seam of the CAD, its two vertices included
      // The prism over the regular 4n-gon that the rim must be.
      EXPECT_NEAR(volume(mesh), 10 * 0.5 * 4 * n * 9 * std::sin(2 * pi / (4 * n)), 1e-11);
    }
}

TEST(primitives, a_sphere_lies_on_its_radius) {
  double last_error = 1e9;
  for (const int n : {1, 2, 3, 4, 6, 8, 16})
    for (const int m : {1, 3}) {
      SCOPED_TRACE(std::to_string(n) + " " + std::to_string(m));
      const Mesh mesh = mesh_sphere({5}, {n, m});
      expect_good_mesh(mesh, "sphere");
      EXPECT_EQ(mesh.n_hexes(), 8 * n * n * n + 24 * n * n * m);
      EXPECT_GT(min_scaled_jacobian(mesh), 0.67);
      int poles = 0, on_seam = 0;
      for (const Index node : skin_nodes(mesh)) {
        const Vec3& p = mesh.points[node];
        EXPECT_NEAR(p.norm(), 5, 2e-15);
        poles += p == Vec3(0, 0, 5) || p == Vec3(0, 0, -5);
        on_seam += p.y() == 0 && p.x() > 0;
      }
      EXPECT_EQ(poles, 2);
      EXPECT_EQ(on_seam, 4 * n - 1);
      if (m == 1) {
        // An inscribed polyhedron that closes in on the ball with the square of the cell size.
        const double error = 4 * pi / 3 * 125 - volume(mesh);
        EXPECT_GT(error, 0);
        EXPECT_LT(error, last_error);
        EXPECT_NEAR(error * n * n, 230, 110);
        last_error = error;
      }
    }
}

TEST(primitives, the_mesh_is_associated_with_the_solid_from_geometry_alone) {
  struct Case {
    Mesh mesh;
    CadImport cad;
    std::array<int, 4> counts;
  };
  const std::array cases = {
      Case{mesh_brick({10, 5, 2}, {5, 3, 2}), cad_brick({10, 5, 2}), {8, 12, 6, 1}},
      Case{mesh_cylinder({3, 10}, {5, 2, 4}), cad_cylinder({3, 10}), {2, 3, 3, 1}},
      Case{mesh_cylinder({0.001, 0.02}, {1, 1, 1}), cad_cylinder({0.001, 0.02}), {2, 3, 3, 1}},
      Case{mesh_sphere({5}, {3, 2}), cad_sphere({5}), {2, 3, 1, 1}},
      Case{mesh_sphere({2000}, {1, 1}), cad_sphere({2000}), {2, 3, 1, 1}},
  };
  for (const auto& [mesh, cad, counts] : cases) {
    SCOPED_TRACE(mesh.blocks[0].name);
    const Model& model = *cad.model;
    for (int dim = 0; dim < 4; ++dim) EXPECT_EQ(model.count(dim), counts[dim]);
    const AssociateResult result = associate(mesh, model);
    EXPECT_TRUE(check_association(mesh, result.association, model).empty());
    EXPECT_LT(result.max_distance, 1e-12 * model.box().diagonal());
    EXPECT_LT((model.box().min - box(mesh).min).norm(), 1e-6 * model.box().diagonal());
    std::set<Owner> owners;
    for (const Owner owner : result.association.node_owner) owners.insert(owner);
    for (int v = 1; v <= counts[0]; ++v) EXPECT_TRUE(owners.contains({0, v})) << "vertex " << v;
    // Curves, the seams among them, are covered by mesh edges; the poles of a sphere are no curves to see.
    std::set<int> curves(result.association.edge_curve.begin(), result.association.edge_curve.end());
    for (int c = 1; c <= counts[1]; ++c)
      if (model.measure({1, c}) > 0) {
        EXPECT_TRUE(curves.contains(c)) << "curve " << c;
      }
  }
}

TEST(primitives, one_number_gives_cells_about_as_thick_as_wide) {
  for (int n = 1; n <= 6; ++n) {
    EXPECT_EQ(mesh_brick({1, 2, 3}, brick_intervals(n)).n_hexes(), n * n * n);
    for (const Mesh& mesh :
         {mesh_cylinder({1, pi / 2}, cylinder_intervals(n)), mesh_sphere({1}, sphere_intervals(n))}) {
      const Edges all = edges(mesh);
      double shortest = 1e9, longest = 0;
      for (const auto& [a, b] : all.nodes) {
        const double length = (mesh.points[a] - mesh.points[b]).norm();
        shortest = std::min(shortest, length);
        longest = std::max(longest, length);
      }
      EXPECT_LT(longest / shortest, 4.5) << n;
    }
  }
}

TEST(primitives, sizes_and_intervals_that_make_no_mesh_are_refused) {
  EXPECT_EQ(message_of([] { mesh_brick({1, 0, 1}); }), "depth of a brick must lie between 1e-06 and 1e+09, not 0");
  EXPECT_EQ(message_of([] { mesh_brick({-1, 1, 1}); }), "width of a brick must lie between 1e-06 and 1e+09, not -1");
  EXPECT_EQ(message_of([] { mesh_brick({1, 1, NAN}); }), "height of a brick must lie between 1e-06 and 1e+09, not nan");
  EXPECT_EQ(message_of([] { mesh_cylinder({0, 1}); }), "radius of a cylinder must lie between 1e-06 and 1e+09, not 0");
  EXPECT_EQ(message_of([] {
              mesh_cylinder({1, INFINITY});
            }),
            "height of a cylinder must lie between 1e-06 and 1e+09, not inf");
  EXPECT_EQ(message_of([] { mesh_sphere({-2}); }), "radius of a sphere must lie between 1e-06 and 1e+09, not -2");
  EXPECT_EQ(message_of([] { mesh_brick({}, {1, 1, 0}); }), "interval height of a brick must be positive, not 0");
  EXPECT_EQ(message_of([] { mesh_cylinder({}, {0, 1, 1}); }), "interval quarter of a cylinder must be positive, not 0");
  EXPECT_EQ(message_of([] { mesh_cylinder({}, {1, -3, 1}); }), "interval ring of a cylinder must be positive, not -3");
  EXPECT_EQ(message_of([] { mesh_sphere({}, {1, 0}); }), "interval shell of a sphere must be positive, not 0");
  constexpr int huge = std::numeric_limits<int>::max();
  EXPECT_EQ(message_of([] { mesh_brick({}, brick_intervals(1000)); }),
            "these intervals would make a brick of 1000000000 hexes; at most 100000000 are made");
  for (const int n : {2000, 100000, huge}) {
    EXPECT_NE(message_of([n] { mesh_brick({}, brick_intervals(n)); }).find("at most 100000000"), std::string::npos);
    EXPECT_NE(message_of([n] { mesh_cylinder({}, cylinder_intervals(n)); }).find("at most 100000000"),
              std::string::npos);
    EXPECT_NE(message_of([n] { mesh_sphere({}, sphere_intervals(n)); }).find("at most 100000000"), std::string::npos);
  }
}

}  // namespace
}  // namespace hextwist
