#include "hextwist/geom/facet/model.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "hextwist/geom/facet/bilinear.h"
#include "support/grids.h"
#include "support/model_checks.h"
#include "support/skins.h"

namespace hextwist {
namespace {

constexpr double pi = std::numbers::pi;

std::array<int, 4> counts(const Model& model) {
  return {model.count(0), model.count(1), model.count(2), model.count(3)};
}

Vec3 random_point(const Box& box, std::mt19937& random) {
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = std::uniform_real_distribution(box.min[axis] - 0.2, box.max[axis] + 0.2)(random);
  return p;
}

Vec3 trilinear(const Mesh& mesh, Index hex, const Vec3& at) {
  Vec3 p = Vec3::Zero();
  for (int c = 0; c < 8; ++c) {
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) weight *= c >> axis & 1 ? at[axis] : 1 - at[axis];
    p += weight * mesh.points[mesh.hexes[hex][c]];
  }
  return p;
}

Mesh perturbed(Mesh mesh, double noise, std::mt19937& random) {
  std::uniform_real_distribution move(-noise, noise);
  for (Vec3& p : mesh.points) p += Vec3(move(random), move(random), move(random));
  return mesh;
}

/// How often the skin of a volume winds around a point, from solid angles of finely split quads: no ray, no tree.
double winding(const Mesh& mesh, const test::Skin& skin, int volume, const Vec3& p) {
  constexpr int n = 6;
  double sum = 0;
  const auto add = [&](Vec3 a, Vec3 b, Vec3 c) {
    a -= p, b -= p, c -= p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb) / (2 * pi);
  };
  for (std::size_t q = 0; q < skin.quads.size(); ++q) {
    if (skin.volumes[q][0] != volume && skin.volumes[q][1] != volume) continue;
    BilinearPatch x;
    for (int c = 0; c < 4; ++c) x[c] = mesh.points[skin.quads[q][c]];
    if (skin.volumes[q][0] != volume) std::swap(x[1], x[3]);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const auto at = [&](int a, int b) { return point(x, (i + a) / double{n}, (j + b) / double{n}); };
        add(at(0, 0), at(1, 0), at(1, 1));
        add(at(0, 0), at(1, 1), at(0, 1));
      }
  }
  return sum;
}

TEST(facet_model, the_skin_of_a_grid_is_a_box) {
  std::mt19937 random(1);
  for (const Mesh& mesh : {test::grid(3, 2, 4), test::shuffled(test::grid(3, 2, 4), random), test::grid(1, 1, 1)}) {
    const auto [model, classes] = test::facet_model_of(mesh);
    EXPECT_EQ(counts(*model), (std::array{8, 12, 6, 1}));
    test::expect_entities_consistent(*model);
    test::expect_projections_consistent(*model, random);
    EXPECT_NEAR(model->measure({3, 1}), volume(mesh), 1e-12);
    for (int s = 1; s <= 6; ++s) {
      EXPECT_EQ(model->adjacent({2, s}, 1).size(), 4u);
      EXPECT_EQ(model->adjacent({2, s}, 0).size(), 4u);
    }
    for (int c = 1; c <= 12; ++c) {
      EXPECT_EQ(model->adjacent({1, c}, 0).size(), 2u);
      EXPECT_EQ(model->adjacent({1, c}, 2).size(), 2u);
      EXPECT_EQ(model->range(c).period, 0);
      EXPECT_DOUBLE_EQ(model->range(c).last, model->measure({1, c}));
    }
  }
}

TEST(facet_model, entities_are_numbered_by_their_first_quad_edge_and_node) {
  const Mesh mesh = test::grid(2, 2, 2);
  const auto [model, classes] = test::facet_model_of(mesh);
  EXPECT_EQ(classes.vertex_nodes, (std::vector<std::int32_t>{0, 2, 6, 8, 18, 20, 24, 26}));
  for (int v = 1; v <= 8; ++v) EXPECT_EQ(model->point({0, v}, {}), mesh.points[classes.vertex_nodes[v - 1]]);
  int highest = 0;
  for (const int surface : classes.quad_surface) {
    EXPECT_LE(surface, highest + 1);
    highest = std::max(highest, surface);
  }
  ASSERT_EQ(classes.edges.size(), 24u);
  EXPECT_TRUE(std::ranges::is_sorted(classes.edges));
  highest = 0;
  for (std::size_t e = 0; e < classes.edges.size(); ++e) {
    EXPECT_LE(classes.edge_curve[e], highest + 1);
    highest = std::max(highest, classes.edge_curve[e]);
    for (const auto node : classes.edges[e])
      EXPECT_EQ(model->project({1, classes.edge_curve[e]}, mesh.points[node]).distance, 0);
  }
  // Curve 1 starts where its lowest edge, 0-1, does.
  EXPECT_EQ(model->point({1, 1}, {0, 0}), Vec3(0, 0, 0));
  EXPECT_EQ(model->tangent(1, 0.5), Vec3(1, 0, 0));
}

TEST(facet_model, a_round_bar_has_two_closed_curves_without_vertices) {
  std::mt19937 random(2);
  const Mesh mesh = test::shuffled(test::round_grid(8, 4, 3), random);
  const auto [model, classes] = test::facet_model_of(mesh);
  ASSERT_EQ(counts(*model), (std::array{0, 2, 3, 1}));
  test::expect_entities_consistent(*model);
  test::expect_projections_consistent(*model, random);
  for (int c = 1; c <= 2; ++c) {
    const CurveRange range = model->range(c);
    EXPECT_GT(range.period, 0);
    EXPECT_EQ(range.period, range.last - range.first);
    EXPECT_NEAR(range.period, 2 * pi, 0.01);
    EXPECT_LT(range.period, 2 * pi);
    // Going round once more changes nothing, and the ends meet.
    EXPECT_LT((model->point({1, c}, {1.0, 0}) - model->point({1, c}, {1.0 + range.period, 0})).norm(), 1e-14);
    EXPECT_EQ(model->point({1, c}, {0, 0}), model->point({1, c}, {range.period, 0}));
    EXPECT_LT((model->point({1, c}, {-0.5, 0}) - model->point({1, c}, {range.period - 0.5, 0})).norm(), 1e-14);
    EXPECT_LT(model->project({1, c}, model->point({1, c}, {0, 0})).parameters.u, range.period);
  }
  EXPECT_NEAR(model->measure({3, 1}), volume(mesh), 1e-12);
  double area = 0;
  for (int s = 1; s <= 3; ++s) area += model->measure({2, s});
  EXPECT_NEAR(area, 2 * pi + 6 * pi, 0.1);
}

TEST(facet_model, rings_have_as_many_curves_and_surfaces_as_their_twist_leaves) {
  std::mt19937 random(3);
  const auto check = [&](const Mesh& mesh, int n) {
    const auto [model, classes] = test::facet_model_of(mesh);
    EXPECT_EQ(counts(*model), (std::array{0, n, n, 1}));
    test::expect_entities_consistent(*model);
    test::expect_projections_consistent(*model, random, {.n_points = 30});
    for (int c = 1; c <= model->count(1); ++c) EXPECT_GT(model->range(c).period, 0);
    EXPECT_NEAR(model->measure({3, 1}), volume(mesh), 1e-11);
  };
  check(test::twisted_ring(40, 2, 2, 0), 4);
  check(test::twisted_ring(40, 2, 2, 1), 1);  // one edge that goes round four times
  check(test::twisted_ring(40, 2, 1, 2), 2);  // a thick Moebius strip
  check(test::shuffled(test::twisted_ring(48, 3, 3, 3), random), 1);
}

TEST(facet_model, two_volumes_share_their_interface) {
  const Mesh mesh = test::grid(4, 2, 2);
  std::vector<int> hex_volume;
  for (Index h = 0; h < mesh.n_hexes(); ++h) hex_volume.push_back(h % 4 < 2 ? 2 : 1);
  const auto [model, classes] = test::facet_model_of(mesh, hex_volume);
  // Flat sides are cut in two where the volume behind them changes.
  ASSERT_EQ(counts(*model), (std::array{12, 20, 11, 2}));
  test::expect_entities_consistent(*model);
  std::mt19937 random(4);
  test::expect_projections_consistent(*model, random, {.n_points = 20});
  EXPECT_NEAR(model->measure({3, 1}), 8, 1e-13);
  EXPECT_NEAR(model->measure({3, 2}), 8, 1e-13);
  const auto left = model->adjacent({3, 2}, 2), right = model->adjacent({3, 1}, 2);
  std::vector<int> shared;
  std::ranges::set_intersection(left, right, std::back_inserter(shared));
  ASSERT_EQ(shared.size(), 1u);
  const auto foot = model->project({2, shared[0]}, Vec3(2.5, 0.7, 0.7));
  EXPECT_EQ(foot.point, Vec3(2, 0.7, 0.7));
  EXPECT_EQ(model->normal(shared[0], foot.parameters), Vec3(-1, 0, 0));  // out of volume 1
  EXPECT_TRUE(model->contains(1, Vec3(3, 1, 1)) && !model->contains(2, Vec3(3, 1, 1)));
  EXPECT_TRUE(model->contains(1, Vec3(2, 1, 1)) && model->contains(2, Vec3(2, 1, 1)));
}

TEST(facet_model, normals_look_out_of_the_volume) {
  std::mt19937 random(5);
  for (const Mesh& mesh : {perturbed(test::round_grid(6, 3, 2), 0.02, random), test::twisted_ring(40, 2, 2, 1)}) {
    const auto [model, classes] = test::facet_model_of(mesh);
    for (int s = 1; s <= model->count(2); ++s)
      for (int i = 0; i < 50; ++i) {
        // Away from the rims: an edge of less than 90 degrees lets the normal of one side out through the other.
        auto at = model->project({2, s}, random_point(model->box({2, s}), random)).parameters;
        at.u = 2 * std::floor(at.u / 2) + std::uniform_real_distribution(0.05, 0.95)(random);
        at.v = std::uniform_real_distribution(0.05, 0.95)(random);
        const Vec3 p = model->point({2, s}, at), step = 1e-4 * model->normal(s, at);
        EXPECT_TRUE(model->contains(1, p));
        EXPECT_TRUE(model->contains(1, p - step));
        EXPECT_FALSE(model->contains(1, p + step));
      }
  }
}

TEST(facet_model, every_node_and_every_child_of_a_quad_lies_on_its_owner) {
  std::mt19937 random(6);
  const Mesh mesh = perturbed(test::grid(5, 4, 3), 0.15, random);  // every quad is bent
  std::vector<int> hex_volume(mesh.hexes.size(), 1);
  for (std::size_t h = 0; h < hex_volume.size() / 2; ++h) hex_volume[h] = 2;
  const test::Skin skin = test::skin(mesh, hex_volume);
  const auto [model, classes] = facet_model(mesh.points, skin.quads, skin.volumes, {60});
  const double size = model->box().diagonal();
  for (std::size_t q = 0; q < skin.quads.size(); ++q) {
    BilinearPatch x;
    for (int c = 0; c < 4; ++c) {
      x[c] = mesh.points[skin.quads[q][c]];
      const auto foot = model->project({2, classes.quad_surface[q]}, x[c]);
      EXPECT_EQ(foot.point, x[c]);
    }
    for (int i = 0; i <= 3; ++i)
      for (int j = 0; j <= 3; ++j) {
        const auto foot = model->project({2, classes.quad_surface[q]}, point(x, i / 3.0, j / 3.0));
        EXPECT_LT(foot.distance, 1e-15 * size);
      }
  }
  for (std::size_t e = 0; e < classes.edges.size(); ++e) {
    const auto [a, b] = classes.edges[e];
    for (const double s : {0.0, 1.0 / 3, 2.0 / 3, 1.0}) {
      const Vec3 p = (1 - s) * mesh.points[a] + s * mesh.points[b];
      const auto foot = model->project({1, classes.edge_curve[e]}, p);
      EXPECT_LT(foot.distance, 1e-15 * size);
    }
  }
  double sum = 0;
  for (int v = 1; v <= 2; ++v) sum += model->measure({3, v});
  EXPECT_NEAR(sum, volume(mesh), 1e-12);
}

TEST(facet_model, contains_agrees_with_winding_numbers_and_with_the_hexes) {
  std::mt19937 random(7);
  Mesh mesh = perturbed(test::grid(4, 4, 4, Vec3(0.5, 0.5, 0.5)), 0.1, random);
  // A checkerboard of two volumes: edges where four quads meet, parts that touch in edges and nodes alone.
  std::vector<int> hex_volume;
  for (Index h = 0; h < mesh.n_hexes(); ++h) hex_volume.push_back((h + h / 4 + h / 16) % 2 + 1);
  const test::Skin skin = test::skin(mesh, hex_volume);
  const auto [model, classes] = facet_model(mesh.points, skin.quads, skin.volumes);
  test::expect_entities_consistent(*model);
  std::uniform_real_distribution<double> inner(0.001, 0.999);
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (int i = 0; i < 20; ++i) {
      const Vec3 p = trilinear(mesh, h, Vec3(inner(random), inner(random), inner(random)));
      EXPECT_TRUE(model->contains(hex_volume[h], p)) << h;
      EXPECT_FALSE(model->contains(3 - hex_volume[h], p)) << h;
    }
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = random_point(model->box(), random);
    for (int v = 1; v <= 2; ++v) {
      const double w = winding(mesh, skin, v, p);
      if (std::abs(w - std::round(w)) > 1e-3) continue;
      EXPECT_EQ(model->contains(v, p), std::lround(w) == 1);
    }
  }
}

TEST(facet_model, contains_does_not_mind_points_in_line_with_edges_and_nodes) {
  const auto [model, classes] = test::facet_model_of(test::grid(4, 4, 4));
  for (double x = -0.5; x <= 4.5; x += 0.5)
    for (double y = -0.5; y <= 4.5; y += 0.5)
      for (double z = -0.5; z <= 4.5; z += 0.5) {
        const bool in = std::min({x, y, z}) >= 0 && std::max({x, y, z}) <= 4;
        EXPECT_EQ(model->contains(1, Vec3(x, y, z)), in);
      }
}

TEST(facet_model, an_edge_is_a_feature_exactly_above_the_angle) {
  Mesh roof = test::grid(2, 1, 1);
  for (Vec3& p : roof.points)
    if (p.z() == 1 && p.x() == 1) p.z() = 1 + std::tan(20 * pi / 180);  // two slopes that meet at 40 degrees
  EXPECT_EQ(test::facet_model_of(roof, {}, 39.999).model->count(2), 7);
  EXPECT_EQ(test::facet_model_of(roof, {}, 40.001).model->count(2), 6);
  // 0: everything that is not flat; 180: nothing at all.
  EXPECT_EQ(test::facet_model_of(test::grid(3, 3, 3), {}, 0).model->count(2), 6);
  const auto smooth = test::facet_model_of(test::grid(3, 3, 3), {}, 180);
  EXPECT_EQ(counts(*smooth.model), (std::array{0, 0, 1, 1}));
}

TEST(facet_model, curves_break_at_corners_and_where_their_surfaces_change) {
  // An L of three blocks: its flat sides are hexagons.
  Mesh mesh = test::grid(4, 4, 2);
  std::erase_if(mesh.hexes, [&](const Hex& hex) {
    const Vec3& p = mesh.points[hex[0]];
    return p.x() >= 2 && p.y() >= 2;
  });
  const auto [model, classes] = test::facet_model_of(mesh);
  EXPECT_EQ(counts(*model), (std::array{12, 18, 8, 1}));
}

TEST(facet_model, cone_tips_and_pinched_nodes_are_vertices) {
  Mesh cone = test::pinwheel(8, 3, 1);
  for (Vec3& p : cone.points)
    if (p.z() == 1) p.z() = 5 - std::hypot(p.x(), p.y());
  const auto tip = test::facet_model_of(cone, {}, 42);
  const auto nodes = tip.classification.vertex_nodes;
  const auto top = std::ranges::find_if(nodes, [&](auto n) { return cone.points[n] == Vec3(0, 0, 5); });
  ASSERT_NE(top, nodes.end());
  const int vertex = static_cast<int>(top - nodes.begin()) + 1;
  EXPECT_TRUE(tip.model->adjacent({0, vertex}, 1).empty());
  EXPECT_EQ(tip.model->adjacent({0, vertex}, 2).size(), 1u);
  test::expect_entities_consistent(*tip.model);

  // Two balls of hexes that touch in one node: without features, the node is the only vertex.
  Mesh pair = test::grid(4, 4, 4);
  std::erase_if(pair.hexes, [&](const Hex& hex) {
    const Vec3& p = pair.points[hex[0]];
    const bool low = p.x() < 2;
    return (p.y() < 2) != low || (p.z() < 2) != low;
  });
  const auto pinched = test::facet_model_of(pair, {}, 180);
  EXPECT_EQ(counts(*pinched.model), (std::array{1, 0, 2, 1}));
  EXPECT_EQ(pinched.model->point({0, 1}, {}), Vec3(2, 2, 2));
  EXPECT_NEAR(pinched.model->measure({3, 1}), 16, 1e-12);
}

TEST(facet_model, blocks_that_touch_along_an_edge_have_a_curve_there) {
  Mesh mesh = test::grid(2, 2, 3);
  std::erase_if(mesh.hexes, [&](const Hex& hex) {
    const Vec3& p = mesh.points[hex[0]];
    return (p.x() < 1) != (p.y() < 1);
  });
  const auto [model, classes] = test::facet_model_of(mesh);
  test::expect_entities_consistent(*model);
  const auto middle = model->near(1, Vec3(1, 1, 1.5), 1e-9);
  ASSERT_EQ(middle.size(), 1u);
  EXPECT_EQ(model->adjacent({1, middle[0]}, 2).size(), 4u);
  EXPECT_NEAR(model->measure({3, 1}), 6, 1e-12);
  EXPECT_TRUE(model->contains(1, Vec3(0.5, 0.5, 0.5)));
  EXPECT_FALSE(model->contains(1, Vec3(0.5, 1.5, 0.5)));
}

TEST(facet_model, a_projection_is_the_same_in_batches_with_any_seed_and_on_any_thread) {
  std::mt19937 random(8);
  const Mesh mesh = perturbed(test::round_grid(10, 10, 4), 0.01, random);
  const auto [model, classes] = test::facet_model_of(mesh);
  for (int dim = 1; dim <= 2; ++dim)
    for (int id = 1; id <= model->count(dim); ++id) {
      std::vector<Vec3> points;
      std::vector<Parameters> garbage, good;
      for (int i = 0; i < 2000; ++i) {
        points.push_back(random_point(model->box(), random));
        garbage.push_back({std::uniform_real_distribution(-1e3, 1e12)(random), 77});
      }
      std::vector<Projection> plain(points.size()), seeded(points.size()), single(points.size());
      model->project({dim, id}, points, {}, plain);
      model->project({dim, id}, points, garbage, seeded);
      tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        single[i] = model->project({dim, id}, points[i]);
      });
      for (const auto& foot : plain) good.push_back(foot.parameters);
      for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(plain[i].point, single[i].point);
        EXPECT_NEAR(plain[i].distance, seeded[i].distance, 1e-14);
      }
      model->project({dim, id}, points, good, seeded);
      for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(plain[i].point, seeded[i].point);
    }
}

TEST(facet_model, near_finds_what_meets_at_a_corner_and_nothing_else) {
  const auto [model, classes] = test::facet_model_of(test::grid(4, 4, 4));
  const Vec3 corner(4, 4, 0);
  EXPECT_EQ(model->near(0, corner, 0).size(), 1u);
  EXPECT_EQ(model->near(1, corner, 0).size(), 3u);
  EXPECT_EQ(model->near(2, corner, 0).size(), 3u);
  EXPECT_EQ(model->near(2, corner + Vec3(0.1, 0, 0), 0.099).size(), 0u);
  EXPECT_EQ(model->near(2, corner + Vec3(0.1, 0, 0), 0.1).size(), 3u);
  EXPECT_EQ(model->near(2, Vec3(2, 2, 2), 2).size(), 6u);
  EXPECT_EQ(model->near(1, Vec3(2, 2, 2), 2).size(), 0u);
}

TEST(facet_model, an_angle_that_is_no_angle_is_refused) {
  const Mesh mesh = test::grid(1, 1, 1);
  for (const double angle : {-1.0, 180.5, std::numeric_limits<double>::quiet_NaN()}) {
    try {
      test::facet_model_of(mesh, {}, angle);
      FAIL();
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("feature angle must lie between 0 and 180"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace hextwist
