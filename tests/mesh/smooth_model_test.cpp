// Nodes slide on curves and surfaces and stay on them.
#include "hextwist/mesh/association/association.h"
#include "smooth_fixtures.h"
#include "support/analytic_model.h"
#include "support/association_checkers.h"
#include "support/checkers.h"
#include "support/skins.h"

namespace hextwist::test {
namespace {

/// Pushes every node along its owner by up to `size`.
void shake_on(Mesh& mesh, Association& association, const Model& model, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> offset(-size, size);
  for (Index i = 0; i < mesh.n_nodes(); ++i) {
    const Vec3 p = mesh.points[i] + Vec3(offset(random), offset(random), offset(random));
    const Owner owner = association.node_owner[i];
    if (owner.dim == 0) continue;
    if (owner.dim == 3) {
      mesh.points[i] = p;
      continue;
    }
    const Projection place = model.project(owner, p);
    mesh.points[i] = place.point;
    association.node_parameters[i] = place.parameters;
  }
}

void expect_kept(const Mesh& mesh, const Association& association, const Model& model) {
  EXPECT_LE(off_model(mesh, association, model).max_relative, 1e-12);
  EXPECT_TRUE(on_model(mesh, association, model, 1e-12));
  for (Index i = 0; i < mesh.n_nodes(); ++i) {
    const Owner owner = association.node_owner[i];
    if (owner.dim != 1 && owner.dim != 2) continue;
    EXPECT_LE((model.point(owner, association.node_parameters[i]) - mesh.points[i]).norm(), 1e-12);
  }
}

TEST(SmoothOnModel, brings_a_shaken_brick_back_to_cubes) {
  std::mt19937 random(4);
  Mesh mesh = grid(5, 4, 3);
  const auto model = analytic_brick(5, 4, 3);
  Association association = associate(mesh, *model).association;
  const auto vertices = nodes_owned_by(association, {0, 1});
  shake_on(mesh, association, *model, 0.2, random);
  const Vec3 corner = mesh.points[vertices[0]];
  for (const bool forget : {false, true}) {
    Mesh moved = mesh;
    Association owners = association;
    if (forget) std::ranges::fill(owners.node_parameters, Parameters{});
    const SmoothReport report = smooth(moved, owners, model.get());
    EXPECT_EQ(report.n_nodes, 6 * 5 * 4 - 8);
    EXPECT_GT(min_shape(moved), 0.999);
    EXPECT_EQ(moved.points[vertices[0]], corner);
    expect_kept(moved, owners, *model);
  }
}

TEST(SmoothOnModel, keeps_nodes_on_a_cylinder_and_lifts_the_worst) {
  for (const SmoothScheme scheme :
       {SmoothScheme::mean_ratio, SmoothScheme::condition_number, SmoothScheme::laplacian}) {
    std::mt19937 random(6);
    Mesh mesh = round_grid(4, 5, 2);
    const auto model = analytic_cylinder(1, 2);
    Association association = associate(mesh, *model).association;
    shake_on(mesh, association, *model, 0.04, random);
    const Association before = association;
    SmoothOptions options;
    options.scheme = scheme;
    const SmoothReport report = smooth(mesh, association, model.get(), options);
    EXPECT_GE(report.shape_after.min, report.shape_before.min) << name(scheme);
    EXPECT_GT(report.shape_after.average, report.shape_before.average) << name(scheme);
    EXPECT_TRUE(uninverted(mesh));
    expect_kept(mesh, association, *model);
    EXPECT_EQ(association.node_owner, before.node_owner);
    EXPECT_EQ(association.curve_edges, before.curve_edges);
  }
}

TEST(SmoothOnModel, leaves_the_skin_when_told) {
  std::mt19937 random(4);
  Mesh mesh = grid(4, 4, 4);
  const auto model = analytic_brick(4, 4, 4);
  Association association = associate(mesh, *model).association;
  shake_on(mesh, association, *model, 0.15, random);
  const Mesh before = mesh;
  SmoothOptions options;
  options.fix_boundary = true;
  EXPECT_EQ(smooth(mesh, association, model.get(), options).n_nodes, 27);
  const auto skin = on_skin(mesh);
  for (Index i = 0; i < mesh.n_nodes(); ++i)
    if (skin[i]) {
      EXPECT_EQ(mesh.points[i], before.points[i]);
    }
}

TEST(SmoothOnModel, untangles_on_a_cylinder) {
  std::mt19937 random(8);
  Mesh mesh = round_grid(4, 5, 2);
  const auto model = analytic_cylinder(1, 2);
  Association association = associate(mesh, *model).association;
  shake_on(mesh, association, *model, 0.2, random);
  const SmoothReport report = smooth(mesh, association, model.get());
  EXPECT_GT(report.inverted_before, 20);
  EXPECT_TRUE(report.not_repaired.empty());
  EXPECT_TRUE(uninverted(mesh));
  expect_kept(mesh, association, *model);
}

}  // namespace
}  // namespace hextwist::test
