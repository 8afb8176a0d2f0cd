// Size fields against closed forms and brute force.
#include "hextwist/sizing/fields/growing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <queue>
#include <random>

#include "hextwist/geom/facet/model.h"
#include "hextwist/mesh/topology.h"
#include "hextwist/sizing/fields/gradation.h"
#include "hextwist/sizing/targets.h"
#include "support/analytic_model.h"
#include "support/grids.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

template <class Make>
std::string refusal(Make make) {
  try {
    make();
  } catch (const Error& error) {
    return error.what();
  }
  return "not refused";
}

std::vector<Vec3> random_points(int n, std::mt19937& random, double low, double high) {
  std::uniform_real_distribution<double> coordinate(low, high);
  std::vector<Vec3> points(static_cast<std::size_t>(n));
  for (Vec3& p : points) p = {coordinate(random), coordinate(random), coordinate(random)};
  return points;
}

std::vector<double> evaluated(const SizeField& field, const std::vector<Vec3>& points) {
  std::vector<double> result(points.size());
  field.evaluate(points, result);
  return result;
}

TEST(size_field, constant_and_smallest) {
  EXPECT_EQ(constant_size(0.5)->at({1, 2, 3}), 0.5);
  EXPECT_EQ(constant_size(0.5)->least(), 0.5);
  const auto field = smallest_of({expression_size("1 + x"), expression_size("2 - x"), constant_size(1.4)});
  EXPECT_DOUBLE_EQ(field->at({0.1, 0, 0}), 1.1);
  EXPECT_DOUBLE_EQ(field->at({0.5, 0, 0}), 1.4);
  EXPECT_DOUBLE_EQ(field->at({0.9, 0, 0}), 1.1);
  EXPECT_EQ(refusal([] { constant_size(0); }), "a wished size must be positive and finite, not 0.000000");
  EXPECT_EQ(refusal([] { smallest_of({}); }), "the smallest of no sizing functions is asked for");
}

TEST(size_field, expression_in_x_y_z_has_the_value_of_the_formula_on_many_points) {
  std::mt19937 random(7);
  const auto points = random_points(20000, random, -3, 3);
  const auto sizes = evaluated(*expression_size("0.1 + 0.2*abs(x) + min(y^2, 1)*sin(pi/2) + exp(z)"), points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    EXPECT_NEAR(sizes[i], 0.1 + 0.2 * std::abs(p.x()) + std::min(p.y() * p.y(), 1.0) + std::exp(p.z()), 1e-12);
  }
}

TEST(size_field, a_wrong_expression_is_refused_with_the_position) {
  const auto position = [](const std::string& text) {
    try {
      expression_size(text);
    } catch (const SizeExpressionError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("sizing function \"" + text + "\": ")) << error.what();
      return static_cast<int>(error.position);
    }
    return -1;
  };
  EXPECT_EQ(position("1 + foo(x)"), 4);
  EXPECT_EQ(position("1 + w"), 4);
  EXPECT_GE(position("1 + "), 3);
  EXPECT_GE(position("(1 + x"), 5);
  EXPECT_GE(position(""), 0);
}

TEST(size_field, an_expression_that_is_not_positive_names_the_place) {
  const auto field = expression_size("x - 1");
  EXPECT_EQ(field->at({3, 0, 0}), 2);
  EXPECT_EQ(refusal([&] {
              field->at({0.5, 2, -3});
            }),
            "sizing function \"x - 1\" is -0.5 at (0.5, 2, -3): sizes must be positive");
  EXPECT_NE(refusal([] { expression_size("sqrt(x)")->at({-1, 0, 0}); }), "not refused");
}

TEST(size_field, grows_with_the_distance_from_the_cad_entity) {
  MeshedModel cylinder{{}, analytic_cylinder(2, 5), {}};
  const auto field =
      growing_size(0.1, 1.5, std::make_shared<TargetDistance>(cylinder, EntityKind::curve, std::array{1}));
  std::mt19937 random(8);
  for (const Vec3& p : random_points(500, random, -4, 4))
    EXPECT_NEAR(field->at(p), 0.1 + 0.5 * std::hypot(std::hypot(p.x(), p.y()) - 2, p.z()), 1e-12);
  EXPECT_EQ(field->least(), 0.1);
}

TEST(size_field, distance_from_several_entities_is_that_of_the_nearest) {
  MeshedModel brick{test::grid(3, 3, 3), analytic_brick(3, 3, 3), {}};
  std::mt19937 random(9);
  const auto points = random_points(400, random, -2, 5);
  const auto brute = [&](EntityKind kind, const std::vector<Index>& targets) {
    std::vector<double> all(points.size()), best(points.size(), 1e300);
    TargetDistance(brick, kind, targets).evaluate(points, all);
    for (const Index t : targets) {
      std::vector<double> one(points.size());
      TargetDistance(brick, kind, std::array{t}).evaluate(points, one);
      for (std::size_t i = 0; i < one.size(); ++i) best[i] = std::min(best[i], one[i]);
    }
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(all[i], best[i], 1e-9) << name(kind);
  };
  brute(EntityKind::node, {0, 5, 33, 63});
  brute(EntityKind::edge, {0, 11, 70, 100});
  brute(EntityKind::face, {0, 17, 40, 90});
  brute(EntityKind::hex, {0, 13, 26});
  brute(EntityKind::vertex, {1, 4, 8});
  brute(EntityKind::curve, {1, 2, 12});
  brute(EntityKind::surface, {1, 4, 6});
  // Inside of a hex and of a volume it is zero, outside that of the box.
  for (const auto kind : {EntityKind::hex, EntityKind::volume}) {
    std::vector<double> distance(points.size());
    TargetDistance(brick, kind, std::array{kind == EntityKind::hex ? 13 : 1}).evaluate(points, distance);
    const double low = kind == EntityKind::hex ? 1 : 0, high = kind == EntityKind::hex ? 2 : 3;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 near = points[i].cwiseMax(low).cwiseMin(high);
      EXPECT_NEAR(distance[i], (points[i] - near).norm(), 1e-9);
    }
  }
}

Mesh sheared(int n) {
  Mesh mesh = test::grid(n, n, n);
  for (Vec3& p : mesh.points) p = {p.x() + 0.3 * p.y() + 0.1 * p.y() * p.z() / n, p.y() - 0.2 * p.z(), p.z()};
  return mesh;
}

TEST(size_field, a_nodal_field_is_interpolated_and_linear_ones_are_exact) {
  auto mesh = std::make_shared<Mesh>(sheared(4));
  Field field{"h", Field::On::node, 1, {}};
  const auto linear = [](const Vec3& p) { return 20 + p.x() - 2 * p.y() + 0.5 * p.z(); };
  for (const Vec3& p : mesh->points) field.values.push_back(linear(p));
  mesh->fields.push_back(field);
  const auto size = field_size(mesh, "h");
  std::mt19937 random(10);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 500; ++i) {
    const Hex& hex = mesh->hexes[static_cast<std::size_t>(random() % mesh->hexes.size())];
    std::array<double, 3> at = {unit(random), unit(random), unit(random)};
    Vec3 p = Vec3::Zero();
    for (int c = 0; c < 8; ++c) {
      double weight = 1;
      for (int axis = 0; axis < 3; ++axis) weight *= c >> axis & 1 ? at[axis] : 1 - at[axis];
      p += weight * mesh->points[hex[c]];
    }
    EXPECT_NEAR(size->at(p), linear(p), 1e-9);
  }
  EXPECT_NEAR(size->at(mesh->points[0] - Vec3(5, 5, 5)), field.values[0], 1e-9) << "outside the nearest place counts";
}

TEST(size_field, a_hex_field_has_the_value_of_the_hex_that_holds_the_point) {
  auto mesh = std::make_shared<Mesh>(test::grid(3, 2, 2));
  Field field{"h", Field::On::hex, 1, {}};
  for (std::size_t h = 0; h < mesh->hexes.size(); ++h) field.values.push_back(1.0 + static_cast<double>(h));
  mesh->fields.push_back(field);
  const auto size = field_size(mesh, "h");
  EXPECT_EQ(size->least(), 1);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 2; ++k) EXPECT_EQ(size->at(Vec3(i + 0.3, j + 0.6, k + 0.9)), 1 + i + 3 * (j + 2 * k));
}

TEST(size_field, fields_that_are_no_sizes_are_refused) {
  auto mesh = std::make_shared<Mesh>(test::grid(1, 1, 1));
  EXPECT_EQ(refusal([&] { field_size(mesh, "h"); }), "the mesh has no field \"h\"; it has none");
  mesh->fields = {{"u", Field::On::node, 3, std::vector<double>(24, 1.0)},
                  {"h", Field::On::node, 1, {1, 1, 1, -2, 1, 1, 1, 1}}};
  EXPECT_EQ(refusal([&] { field_size(mesh, "g"); }), "the mesh has no field \"g\"; it has u, h");
  EXPECT_EQ(refusal([&] { field_size(mesh, "u"); }), "field \"u\" has 3 components: a size is a single number");
  EXPECT_EQ(refusal([&] { field_size(mesh, "h"); }), "field \"h\" is -2.000000 at node 4: sizes must be positive");
}

TEST(size_field, curvature_gives_so_many_elements_per_radian) {
  const std::shared_ptr<const Model> cylinder = analytic_cylinder(2, 5);
  const std::vector<Owner> all = {{1, 1}, {1, 2}, {2, 1}, {2, 2}, {2, 3}};
  const auto field = curvature_size(cylinder, all, 4, 1.5);
  std::mt19937 random(11);
  for (const Vec3& p : random_points(300, random, -4, 4)) {
    const double radius = std::hypot(p.x(), p.y());
    const double along = std::max({0.0, -p.z(), p.z() - 5});
    EXPECT_NEAR(field->at(p), 2.0 / 4 + 0.5 * std::hypot(radius - 2, along), 1e-9);
  }
  EXPECT_EQ(refusal([&] {
              curvature_size(cylinder, std::array{Owner{2, 2}}, 4, 1.5);
            }),
            "none of these curves and surfaces is curved");
  EXPECT_EQ(refusal([&] { curvature_size(cylinder, all, 0, 1.5); }), "elements per radian must be a positive number");
  EXPECT_EQ(refusal([&] { curvature_size(cylinder, all, 3, 0.5); }), "growth must be a number of at least 1");
  EXPECT_EQ(refusal([&] {
              curvature_size(associate_with_own_skin(test::grid(2, 2, 2)).model, std::array{Owner{2, 1}}, 4, 1.5);
            }),
            "none of these curves and surfaces is curved");
}

/// A shipped model twice: the mesh on its CAD, and on the model of its own skin.
struct WithAndWithoutCad {
  MeshedModel cad, skin;
  explicit WithAndWithoutCad(const std::string& name) : cad(test::shipped(name)) {
    FacetResult own = associate_with_own_skin(cad.mesh);
    skin = {cad.mesh, own.model, own.association};
  }
  static SizeFieldPtr bend(const MeshedModel& on, double per_radian, double growth) {
    std::vector<Owner> entities;
    for (int dim = 1; dim <= 2; ++dim)
      for (int id = 1; id <= on.model->count(dim); ++id) entities.push_back({dim, id});
    return curvature_size(on.model, entities, per_radian, growth);
  }
};

TEST(size_field, curvature_without_cad_is_that_of_the_cad_within_a_few_percent) {
  struct Row {
    const char* model;
    double within;  // of the wish, at every hex
  };
  // On faces that bend unevenly the CAD is asked at the nearest place only, so that the skin knows more than it.
  for (const auto& [name, within] : {Row{"cylinder", 0.01},
                                     {"plate_hole", 0.01},
                                     {"bent_bar", 0.01},
                                     {"bracket_fillet", 0.01},
                                     {"sphere", 0.1},
                                     {"pipe_tee", 0.1},
                                     {"ring_twist", 0.15}}) {
    const WithAndWithoutCad both(name);
    const auto at_cad = both.bend(both.cad, 4, 1.2), at_skin = both.bend(both.skin, 4, 1.2);
    for (const Vec3& p : centroids(both.cad.mesh)) {
      const double wish = at_cad->at(p);
      ASSERT_NEAR(at_skin->at(p), wish, within * wish) << name;
    }
  }
}

TEST(size_field, curvature_without_cad_refines_as_the_cad_does) {
  for (const auto& [name, per_radian] : {std::pair{"cylinder", 12.0}, {"sphere", 16.0}, {"bracket_fillet", 16.0}}) {
    const WithAndWithoutCad both(name);
    std::array<RefineResult, 2> results;
    for (int i = 0; i < 2; ++i) {
      const MeshedModel& on = i == 0 ? both.cad : both.skin;
      Request request;
      request.target.kind = EntityKind::volume;
      request.target.ids = {1};
      request.how = Sizes{.field = both.bend(on, per_radian, 1.5)};
      results[i] = refine(on, request);
      test::expect_sound(results[i]);
    }
    const auto n = [&](int i) { return static_cast<double>(results[i].refined.mesh.n_hexes()); };
    EXPECT_GT(n(0), 1.2 * static_cast<double>(both.cad.mesh.n_hexes())) << "nothing to compare";
    EXPECT_NEAR(n(1) / n(0), 1, 0.2) << name << ": a layer of a regular mesh is cut as a whole or not at all";
  }
}

TEST(size_field, curvature_of_a_skin_without_growth_is_the_least_size_everywhere) {
  const WithAndWithoutCad both("cylinder");
  const auto field = both.bend(both.skin, 4, 1);
  const double least = field->least();
  EXPECT_GT(least, 0);
  for (const Vec3& p : centroids(both.skin.mesh)) EXPECT_EQ(field->at(p), least);
}

TEST(size_field, intervals_divide_the_length_of_a_curve) {
  const MeshedModel brick{test::grid(1, 1, 1), analytic_brick(3, 2, 1), {}};
  const auto field = interval_size(brick, std::array{1, 5}, 10, 2);
  EXPECT_DOUBLE_EQ(field->at({1.5, 0, 0}), 0.3);
  EXPECT_DOUBLE_EQ(field->at({0, 1, 0}), 0.2);
  EXPECT_DOUBLE_EQ(field->at({3, 0, 0.1}), 0.4);
  EXPECT_EQ(refusal([&] { interval_size(brick, std::array{1}, 0, 2); }), "the number of intervals must be at least 1");
}

TEST(gradation, is_the_shortest_way_from_any_node_on_random_sizes) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> size(0.1, 10);
  const Mesh mesh = sheared(3);
  const Edges all = edges(mesh);
  for (const double slope : {0.0, 0.2, 1.0}) {
    std::vector<double> sizes(mesh.points.size());
    for (double& s : sizes) s = size(random);
    std::vector<double> expected = sizes;
    // Bellman and Ford: sweep until nothing changes.
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& [a, b] : all.nodes)
        for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
          const double limit = expected[from] + slope * (mesh.points[a] - mesh.points[b]).norm();
          if (limit < expected[to] - 1e-12) expected[to] = limit, changed = true;
        }
    }
    limit_gradation(all, mesh.points, slope, sizes);
    for (std::size_t n = 0; n < sizes.size(); ++n) EXPECT_NEAR(sizes[n], expected[n], 1e-9);
  }
}

TEST(gradation, of_a_field_that_jumps_makes_it_grow_slowly_and_keeps_small_sizes) {
  const Mesh mesh = test::grid(8, 1, 1);
  const auto jump = expression_size("x < 1 ? 0.1 : 10");
  const auto slow = smallest_of({jump, limited_growth(mesh, jump, 1.25)});
  EXPECT_DOUBLE_EQ(slow->at({0.5, 0.5, 0.5}), 0.1);
  for (double x = 1; x < 8; x += 0.25) EXPECT_LE(slow->at({x, 0.5, 0.5}), 0.1 + 0.25 * (x + 0.9)) << x;
  EXPECT_GT(slow->at({7, 0.5, 0.5}), 1.2) << "and no smaller than need be";
}

}  // namespace
}  // namespace hextwist
