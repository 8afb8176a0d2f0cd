#include "hextwist/mesh/second_order/second_order.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "hextwist/patch/refine.h"
#include "support/grids.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

double determinant(const QuadraticHex& hex, const Vec3& at) {
  const auto j = jacobian(hex, at);
  return j[0].dot(j[1].cross(j[2]));
}

/// By 4 x 4 x 4 Gauss points, more than the degree of the determinant needs.
double volume_of(const QuadraticHex& hex) {
  constexpr std::array<double, 4> at = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                        0.93056815579702629};
  constexpr std::array<double, 4> weight = {0.17392742256872692, 0.32607257743127307, 0.32607257743127307,
                                            0.17392742256872692};
  double sum = 0;
  for (int i = 0; i < 64; ++i)
    sum += weight[i % 4] * weight[i / 4 % 4] * weight[i / 16] *
           determinant(hex, Vec3(at[i % 4], at[i / 4 % 4], at[i / 16]));
  return sum;
}
double volume_of(const SecondOrder& mesh) {
  double sum = 0;
  for (Index h = 0; h < mesh.mesh.n_hexes(); ++h) sum += volume_of(quadratic_hex(mesh, h));
  return sum;
}

/// The smallest determinant on a lattice of so many steps.
double smallest(const QuadraticHex& hex, int n) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) least = std::min(least, determinant(hex, Vec3(i, j, k) / n));
  return least;
}

QuadraticHex cube() {
  QuadraticHex hex;
  for (int i = 0; i < 27; ++i) hex[i] = Vec3(i % 3, i / 3 % 3, i / 9) / 2;
  return hex;
}

MeshedModel refined_uniformly(const MeshedModel& meshed) {
  Request request;
  request.target = {.kind = EntityKind::volume, .ids = {}};
  for (int id = 1; id <= meshed.model->count(3); ++id) request.target.ids.push_back(id);
  request.how = Cuts{.numsplit = 1};
  return refine(meshed, request).refined;
}

TEST(second_order, positive_everywhere_is_what_dense_samples_say) {
  std::mt19937 random(17);
  int n_positive = 0, n_negative = 0;
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE(testing::Message() << "trial " << trial);
    std::normal_distribution<double> wobble(0, 0.01 + 0.12 * (trial % 10) / 10);
    QuadraticHex hex = cube();
    for (Vec3& p : hex) p += Vec3(wobble(random), wobble(random), wobble(random));
    if (trial % 2 == 0) blend_faces(hex);
    const double sampled = smallest(hex, 12);
    if (is_positive_everywhere(hex)) {
      EXPECT_GT(sampled, 0);
      ++n_positive;
    } else {
      // Between the samples it may dip a little below the smallest of them.
      EXPECT_LT(sampled, 0.02);
      ++n_negative;
    }
  }
  EXPECT_GT(n_positive, 50);
  EXPECT_GT(n_negative, 50);
}

TEST(second_order, a_dip_between_corners_and_gauss_points_is_found) {
  QuadraticHex hex = cube();
  blend_faces(hex);
  EXPECT_TRUE(is_positive_everywhere(hex));
  // The middle of one edge slides along it: the determinant at its end is 1 - 4 d, the corner's own nodes are in place.
  hex[1].x() += 0.249;
  blend_faces(hex);
  EXPECT_GT(determinant(hex, Vec3(1, 0, 0)), 0);
  EXPECT_TRUE(is_positive_everywhere(hex));
  hex[1].x() += 0.002;
  blend_faces(hex);
  EXPECT_LT(determinant(hex, Vec3(1, 0, 0)), 0);
  EXPECT_FALSE(is_positive_everywhere(hex));
  // The centre alone, far off: positive at all corners and on all edges, not inside.
  hex = cube();
  hex[quadratic_centre] += Vec3(0.3, 0.2, 0.25);
  for (int c = 0; c < 8; ++c) EXPECT_GT(determinant(hex, Vec3(c & 1, c >> 1 & 1, c >> 2)), 0);
  EXPECT_LT(smallest(hex, 20), 0);
  EXPECT_FALSE(is_positive_everywhere(hex));
}

TEST(second_order, a_straight_mesh_gets_exactly_the_straight_middles) {
  for (const int n : {20, 27})
    for (const char* name : {"l_block", "notched_cube"}) {
      const MeshedModel meshed = test::shipped(name);
      const SecondOrder second = second_order(meshed.mesh, meshed.association, meshed.model.get(), n);
      EXPECT_TRUE(second.straightened.empty());
      EXPECT_EQ(second.n_off, 0);
      for (std::size_t e = 0; e < second.edges.nodes.size(); ++e) {
        const auto [a, b] = second.edges.nodes[e];
        EXPECT_EQ(second.mesh.points[second.edge_middle(static_cast<Index>(e))],
                  Vec3((meshed.mesh.points[a] + meshed.mesh.points[b]) / 2));
      }
      EXPECT_NEAR(volume_of(second), volume(meshed.mesh), 1e-12 * volume(meshed.mesh));
    }
}

/// Quadratic hexes whose nodes are on the surface are off it by h^3, to both sides: the volume is off by h^4.
TEST(second_order, the_volume_error_falls_sixteenfold_when_edges_are_halved) {
  const std::map<std::string, double> exact = {
      {"cylinder", 75398.22368615503}, {"sphere", 33510.32163829113}, {"bracket", 33256.63706143592}};
  for (const auto& [name, volume] : exact)
    for (const int n : {20, 27}) {
      SCOPED_TRACE(name + " " + std::to_string(n));
      const MeshedModel coarse = test::shipped(name), fine = refined_uniformly(coarse);
      std::array<double, 2> error{};
      int k = 0;
      for (const MeshedModel* meshed : {&coarse, &fine}) {
        const SecondOrder second = second_order(meshed->mesh, meshed->association, meshed->model.get(), n);
        EXPECT_TRUE(second.straightened.empty());
        for (Index h = 0; h < second.mesh.n_hexes(); ++h) EXPECT_GT(smallest(quadratic_hex(second, h), 4), 0);
        error[k++] = std::abs(volume_of(second) - volume);
      }
      EXPECT_LT(error[0], 3e-4 * volume);
      EXPECT_GT(error[0] / error[1], 14);
      EXPECT_LT(error[0] / error[1], 18);
    }
}

TEST(second_order, middle_nodes_are_on_their_owners_and_known_by_parameters) {
  const MeshedModel meshed = test::shipped("bracket");
  const SecondOrder second = second_order(meshed.mesh, meshed.association, meshed.model.get(), 27);
  ASSERT_EQ(second.association.node_owner.size(), second.mesh.points.size());
  std::array<int, 4> n_of_dim{};
  for (Index n = second.n_corners; n < second.mesh.n_nodes(); ++n) {
    const Owner owner = second.association.node_owner[n];
    ASSERT_GE(owner.dim, 1);
    ++n_of_dim[owner.dim];
    if (owner.dim > 2) continue;
    EXPECT_LT(meshed.model->project(owner, second.mesh.points[n]).distance, 1e-9);
    EXPECT_LT((meshed.model->point(owner, second.association.node_parameters[n]) - second.mesh.points[n]).norm(), 1e-9);
  }
  for (const int dim : {1, 2, 3}) EXPECT_GT(n_of_dim[dim], 0);
}

TEST(second_order, sets_and_fields_go_on_to_middle_nodes) {
  MeshedModel meshed = test::brick(2, 1, 1);
  meshed.mesh.node_ids.clear();
  for (Index n = 0; n < meshed.mesh.n_nodes(); ++n) meshed.mesh.node_ids.push_back(10 * n + 3);
  NodeSet set{1, "left", {}};
  Field field{"f", Field::On::node, 2, {}}, classes{"c", Field::On::node, 1, {}, true};
  for (Index n = 0; n < meshed.mesh.n_nodes(); ++n) {
    const Vec3& p = meshed.mesh.points[n];
    if (p.x() < 0.5) set.nodes.push_back(n);
    field.values.push_back(p.x() + 2 * p.y() - p.z());
    field.values.push_back(n);
    classes.values.push_back(n);
  }
  meshed.mesh.node_sets = {set};
  meshed.mesh.fields = {field, classes};
  const SecondOrder second = second_order(meshed.mesh, meshed.association, meshed.model.get(), 27);
  EXPECT_EQ(second.mesh.node_ids[second.n_corners], meshed.mesh.node_ids.back() + 1);
  std::vector<Index> expected;
  for (Index n = 0; n < second.mesh.n_nodes(); ++n)
    if (second.mesh.points[n].x() < 0.1) expected.push_back(n);
  EXPECT_EQ(second.mesh.node_sets[0].nodes, expected);
  EXPECT_EQ(expected.size(), 9U);
  for (Index n = 0; n < second.mesh.n_nodes(); ++n) {
    const Vec3& p = second.mesh.points[n];
    EXPECT_NEAR(second.mesh.fields[0].values[2 * static_cast<std::size_t>(n)], p.x() + 2 * p.y() - p.z(), 1e-12);
    const double c = second.mesh.fields[1].values[n];
    EXPECT_EQ(c, std::round(c));
  }
}

/// A slab of one layer whose upper side dips through the lower one, halfway along its edges.
TEST(second_order, a_hex_that_would_turn_inside_out_is_straightened_and_told_of) {
  for (const double dip : {0.4, 1.5, 3.0}) {
    SCOPED_TRACE(dip);
    Mesh mesh = test::grid(3, 1, 1, Vec3(10, 10, 1));
    MiddleNodes middles;
    const Edges all = edges(mesh);
    for (const Edge& edge : all.nodes) {
      const Vec3 a = mesh.points[edge[0]], b = mesh.points[edge[1]];
      Vec3 middle = (a + b) / 2;
      // Edges along x on top of the middle hex.
      if (std::abs(a.z() - 1) < 0.1 && std::abs(b.z() - 1) < 0.1 && std::abs(middle.x() - 15) < 0.1 &&
          std::abs(a.x() - b.x()) > 1)
        middle.z() -= dip;
      middles.edges.push_back(edge);
      middles.edge_points.push_back(middle);
    }
    const FacetResult skin = associate_with_own_skin(mesh, {.middles = &middles});
    ASSERT_EQ(skin.model->type({2, 1}), "quadratic facets");
    const SecondOrder second = second_order(mesh, skin.association, skin.model.get(), 20);
    for (Index h = 0; h < 3; ++h) {
      EXPECT_TRUE(is_positive_everywhere(quadratic_hex(second, h)));
      EXPECT_GT(smallest(quadratic_hex(second, h), 8), 0);
    }
    if (dip < 1) {
      EXPECT_TRUE(second.straightened.empty());
      EXPECT_EQ(straightened_text(second), "");
      continue;
    }
    EXPECT_EQ(second.straightened, std::vector<Index>{1});
    EXPECT_EQ(second.n_off, 2);
    EXPECT_GT(second.farthest, 0.4 * dip);
    const std::string text = straightened_text(second);
    EXPECT_EQ(
        text.find("1 hex was straightened, as it would not have been positive everywhere with all middle nodes in "
                  "place (hex 2); 2 middle nodes are off the model, node "),
        0U)
        << text;
  }
}

TEST(second_order, a_curved_mesh_without_cad_is_refined_along_its_own_curves) {
  for (const int n : {20, 27}) {
    const MeshedModel on_cad = test::shipped("cylinder");
    const SecondOrder second = second_order(on_cad.mesh, on_cad.association, on_cad.model.get(), n);
    const MiddleNodes middles = middle_nodes(second);
    const FacetResult skin = associate_with_own_skin(on_cad.mesh, {.middles = &middles});
    // The whole mantle is one surface, its rims closed curves, however few facets there are.
    EXPECT_EQ(skin.model->count(2), 3);
    EXPECT_EQ(skin.model->count(1), 2);
    EXPECT_EQ(skin.model->count(0), 0);
    EXPECT_NEAR(skin.model->measure({3, 1}), volume_of(second), 1e-9 * volume_of(second));
    const MeshedModel fine = refined_uniformly({on_cad.mesh, skin.model, skin.association});
    double farthest = 0;
    for (Index i = 0; i < fine.mesh.n_nodes(); ++i) {
      const Owner owner = fine.association.node_owner[i];
      if (owner.dim > 2) continue;
      EXPECT_LT(skin.model->project(owner, fine.mesh.points[i]).distance, 1e-9);
      const Vec3& p = fine.mesh.points[i];
      if (p.z() > 1e-6 && p.z() < 60 - 1e-6) farthest = std::max(farthest, std::abs(p.head<2>().norm() - 20));
    }
    // Straight facets would be off by 0.17.
    EXPECT_LT(farthest, 1e-3);
    EXPECT_GT(volume(fine.mesh), volume(on_cad.mesh) + 0.7 * (skin.model->measure({3, 1}) - volume(on_cad.mesh)));
  }
}

TEST(second_order, a_curved_skin_contains_what_is_inside_of_it) {
  const MeshedModel on_cad = test::shipped("sphere");
  const MiddleNodes middles = middle_nodes(second_order(on_cad.mesh, on_cad.association, on_cad.model.get(), 27));
  const FacetResult skin = associate_with_own_skin(on_cad.mesh, {.middles = &middles});
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 direction = Vec3(normal(random), normal(random), normal(random)).normalized();
    EXPECT_TRUE(skin.model->contains(1, 19.98 * direction)) << direction.transpose();
    EXPECT_FALSE(skin.model->contains(1, 20.02 * direction)) << direction.transpose();
    const Projection foot = skin.model->project({2, 1}, 25 * direction);
    EXPECT_NEAR(foot.distance, 5, 0.01);
    EXPECT_GT(skin.model->normal(1, foot.parameters).dot(direction), 0.99);
    EXPECT_LT((skin.model->point({2, 1}, foot.parameters) - foot.point).norm(), 1e-12);
  }
}

TEST(second_order, middles_that_all_lie_halfway_leave_the_skin_straight) {
  const MeshedModel on_cad = test::shipped("l_block");
  const MiddleNodes middles = middle_nodes(second_order(on_cad.mesh, on_cad.association, on_cad.model.get(), 27));
  EXPECT_EQ(associate_with_own_skin(on_cad.mesh, {.middles = &middles}).model->type({2, 1}), "facets");
}

}  // namespace
}  // namespace hextwist
