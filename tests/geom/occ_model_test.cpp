// Topology, measures, boxes, normals and point location of OpenCASCADE models against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "geom/occ_shapes.h"
#include "hextwist/geom/occ/model.h"
#include "support/grids.h"

namespace hextwist {
namespace {

using std::numbers::pi;
using test::OccShape;

struct Truth {
  const char* name;
  OccShape shape;
  double volume;
  double area;
};

std::vector<Truth> closed_forms() {
  const double hole_area = 2 * (60 - pi * 2.25) + 2 * pi * 1.5 * 2 + 2 * (20 + 12);
  return {{"brick", OccShape::brick(1, 2, 3), 6, 22},
          {"cylinder", OccShape::cylinder(2, 5), 20 * pi, 28 * pi},
          {"sphere", OccShape::sphere(3), 36 * pi, 36 * pi},
          {"cone", OccShape::cone(3, 0, 4), 12 * pi, 24 * pi},
          {"torus", OccShape::torus(5, 1.5), 2 * pi * pi * 5 * 2.25, 4 * pi * pi * 7.5},
          {"sector", OccShape::cylinder_sector(3, 4, 2.5, 6), 3.5 / 2 * 9 * 4, 3.5 * 9 + 3.5 * 3 * 4 + 2 * 12},
          {"plate with hole", OccShape::brick_with_hole(10, 6, 2, 1.5), 2 * (60 - pi * 2.25), hole_area}};
}

double total(const Model& model, int dim) {
  double sum = 0;
  for (int id = 1; id <= model.count(dim); ++id) sum += model.measure({dim, id});
  return sum;
}

TEST(occ_model, areas_and_volumes_are_those_of_the_closed_forms) {
  for (const auto& [name, shape, volume, area] : closed_forms()) {
    SCOPED_TRACE(name);
    for (const OccShape& variant : {shape, shape.moved({30, -4, 5}, 2.2), shape.as_nurbs(), shape.reversed()}) {
      const auto model = variant.import().model;
      EXPECT_NEAR(total(*model, 3) / volume, 1, 1e-12);
      EXPECT_NEAR(total(*model, 2) / area, 1, 1e-12);
    }
  }
}

TEST(occ_model, lengths_are_those_of_the_closed_forms) {
  const auto brick = OccShape::brick(1, 2, 3).import().model;
  EXPECT_NEAR(total(*brick, 1), 24, 1e-12);
  // Two circles and the seam; a sphere's poles are degenerate and its seam is a meridian.
  EXPECT_NEAR(total(*OccShape::cylinder(2, 5).import().model, 1), 8 * pi + 5, 1e-12);
  EXPECT_NEAR(total(*OccShape::cylinder(2, 5).as_nurbs().import().model, 1), 8 * pi + 5, 1e-12);
  EXPECT_NEAR(total(*OccShape::sphere(3).import().model, 1), 3 * pi, 1e-12);
}

TEST(occ_model, entities_are_counted_like_the_topology_map_degenerate_edges_included) {
  for (const auto& [name, shape, volume, area] : closed_forms()) {
    SCOPED_TRACE(name);
    const auto model = shape.import().model;
    for (int dim = 0; dim <= 3; ++dim) EXPECT_EQ(model->count(dim), shape.count(dim));
    for (int id = 1; id <= model->count(0); ++id) EXPECT_LT(shape.distance({0, id}, model->point({0, id}, {})), 1e-12);
  }
  const auto sphere = OccShape::sphere(3).import().model;
  ASSERT_EQ(sphere->count(1), 3);
  std::map<std::string, int> types;
  for (int id = 1; id <= 3; ++id) ++types[sphere->type({1, id})];
  EXPECT_EQ(types["degenerate"], 2);
  EXPECT_EQ(types["circle"], 1);
  for (int id = 1; id <= 3; ++id) {
    if (sphere->type({1, id}) != "degenerate") continue;
    EXPECT_EQ(sphere->measure({1, id}), 0);
    EXPECT_EQ(sphere->tangent(id, 0.5), Vec3::Zero());
    const Projection pole = sphere->project({1, id}, Vec3(1, 1, 1));
    EXPECT_NEAR(std::abs(pole.point.z()), 3, 1e-12);
    EXPECT_EQ(sphere->point({1, id}, pole.parameters), pole.point);
    EXPECT_EQ(sphere->box({1, id}).diagonal(), 0);
  }
}

TEST(occ_model, adjacency_goes_both_ways_through_any_number_of_steps) {
  const auto brick = OccShape::brick(1, 2, 3).import().model;
  for (int id = 1; id <= 12; ++id) {
    EXPECT_EQ(brick->adjacent({1, id}, 0).size(), 2u);
    EXPECT_EQ(brick->adjacent({1, id}, 2).size(), 2u);
    EXPECT_EQ(brick->adjacent({1, id}, 3), std::vector<int>{1});
  }
  for (int id = 1; id <= 8; ++id) EXPECT_EQ(brick->adjacent({0, id}, 2).size(), 3u);
  for (int id = 1; id <= 6; ++id) EXPECT_EQ(brick->adjacent({2, id}, 0).size(), 4u);
  EXPECT_EQ(brick->adjacent({3, 1}, 1).size(), 12u);
  EXPECT_TRUE(brick->adjacent({2, 1}, 2).empty());
  for (const auto& [name, shape, volume, area] : closed_forms()) {
    const auto model = shape.import().model;
    for (int dim = 0; dim <= 3; ++dim) {
      for (int other = 0; other <= 3; ++other) {
        for (int id = 1; id <= model->count(dim); ++id) {
          const auto list = model->adjacent({dim, id}, other);
          EXPECT_TRUE(std::is_sorted(list.begin(), list.end()));
          for (const int neighbour : list) {
            const auto back = model->adjacent({other, neighbour}, dim);
            EXPECT_TRUE(std::binary_search(back.begin(), back.end(), id)) << name;
          }
        }
      }
    }
  }
}

TEST(occ_model, types_are_named_in_the_usual_words) {
  const auto types = [](const OccShape& shape) {
    const auto model = shape.import().model;
    std::map<std::string, int> result;
    for (int dim = 0; dim <= 3; ++dim) {
      for (int id = 1; id <= model->count(dim); ++id) ++result[model->type({dim, id})];
    }
    return result;
  };
  using Types = std::map<std::string, int>;
  EXPECT_EQ(types(OccShape::cylinder(1, 2)),
            (Types{{"point", 2}, {"line", 1}, {"circle", 2}, {"cylinder", 1}, {"plane", 2}, {"solid", 1}}));
  EXPECT_EQ(types(OccShape::torus(3, 1)), (Types{{"point", 1}, {"circle", 2}, {"torus", 1}, {"solid", 1}}));
  EXPECT_EQ(types(OccShape::cone(3, 1, 2))["cone"], 1);
  EXPECT_EQ(types(OccShape::sphere(1).as_nurbs())["bspline surface"], 1);
  EXPECT_EQ(types(OccShape::vase())["surface of revolution"], 1);
}

TEST(occ_model, boxes_are_tight) {
  // A turned cylinder reaches h/2 |a| + r sqrt(1 - a^2) from its middle, a being the axis' component.
  const double r = 2, h = 5, angle = 0.9;
  const OccShape shape = OccShape::cylinder(r, h).moved({10, 20, 30}, angle);
  const auto model = shape.import().model;
  const Vec3 n = Vec3(1, 2, 3).normalized(), z = Vec3::UnitZ();
  const Vec3 n_cross_z(n.y(), -n.x(), 0);
  const Vec3 axis = z * std::cos(angle) + n_cross_z * std::sin(angle) + n * n.z() * (1 - std::cos(angle));
  const Vec3 middle = Vec3(10, 20, 30) + axis * h / 2;
  const Vec3 reach = h / 2 * axis.cwiseAbs() + r * (Vec3::Ones() - axis.cwiseAbs2()).cwiseSqrt();
  for (const auto& m : {model, shape.as_nurbs().import().model}) {
    EXPECT_LT((m->box().min - (middle - reach)).norm(), 1e-9);
    EXPECT_LT((m->box().max - (middle + reach)).norm(), 1e-9);
    EXPECT_LT((m->box({3, 1}).max - (middle + reach)).norm(), 1e-9);
  }
  for (const OccShape& ball : {OccShape::sphere(3), OccShape::sphere(3).as_nurbs()}) {
    EXPECT_LT((ball.moved({1, 2, 3}, 0.7).import().model->box().max - Vec3(4, 5, 6)).norm(), 1e-9);
  }
  // Half a torus' tube is not reached by the box of its parameters.
  const auto patch = OccShape::sphere_patch(3, 0, 0.5, 1).import().model;
  EXPECT_NEAR(patch->box().max.z(), 3 * std::sin(0.5), 1e-12);
  const auto torus = OccShape::torus(5, 1.5).as_nurbs().import().model;
  EXPECT_LT((torus->box().max - Vec3(6.5, 6.5, 1.5)).norm(), 1e-9);
  EXPECT_LT((torus->box().min + Vec3(6.5, 6.5, 1.5)).norm(), 1e-9);
}

TEST(occ_model, boxes_hold_every_point_of_their_entity_and_touch_it) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const OccShape& shape : {OccShape::loft().moved({1, 2, 3}, 1), OccShape::vase().moved({1, 2, 3}, 2),
                                OccShape::torus(5, 1.5).moved({0, 0, 0}, 0.5)}) {
    const auto model = shape.import().model;
    for (int dim = 1; dim <= 2; ++dim) {
      for (int id = 1; id <= model->count(dim); ++id) {
        const Box box = model->box({dim, id});
        for (int i = 0; i < 200; ++i) {
          const Vec3 p = 12 * Vec3(unit(random), unit(random), unit(random));
          const Vec3 q = model->project({dim, id}, p).point;
          EXPECT_TRUE(((q - box.min).array() >= -1e-9).all() && ((box.max - q).array() >= -1e-9).all());
        }
        for (int axis = 0; axis < 3; ++axis) {
          for (const double side : {box.min[axis], box.max[axis]}) {
            // A far point on that side is closest to the extreme point up to size^2 / distance.
            const double far = 1e7 * (side == box.max[axis] ? 1 : -1);
            const Vec3 p = (box.min + box.max) / 2 + far * Vec3::Unit(axis);
            EXPECT_NEAR(model->project({dim, id}, p).point[axis], side, 1e-5 * (1 + box.diagonal()));
          }
        }
      }
    }
  }
}

TEST(occ_model, normals_point_out_of_the_volume_even_of_one_that_is_inside_out) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const auto& [name, shape, volume, area] : closed_forms()) {
    SCOPED_TRACE(name);
    for (const OccShape& variant : {shape, shape.reversed(), shape.as_nurbs(), shape.moved({3, 3, 3}, 1)}) {
      const auto model = variant.import().model;
      const double step = 1e-4 * model->box().diagonal();
      const Vec3 middle = (model->box().min + model->box().max) / 2;
      for (int id = 1; id <= model->count(2); ++id) {
        for (int i = 0; i < 20; ++i) {
          const Projection foot = model->project({2, id}, middle + 4 * Vec3(unit(random), unit(random), unit(random)));
          bool at_edge = false;
          for (const int curve : model->adjacent({2, id}, 1)) {
            at_edge |=
                model->adjacent({1, curve}, 2).size() > 1 && model->project({1, curve}, foot.point).distance < 5 * step;
          }
          const Vec3 n = model->normal(id, foot.parameters);
          if (at_edge || n == Vec3::Zero()) continue;
          EXPECT_NEAR(n.norm(), 1, 1e-12);
          EXPECT_FALSE(model->contains(1, foot.point + step * n)) << "surface " << id;
          EXPECT_TRUE(model->contains(1, foot.point - step * n)) << "surface " << id;
          EXPECT_TRUE(model->contains(1, foot.point));
        }
      }
    }
  }
}

TEST(occ_model, the_normal_exists_at_a_pole_and_not_at_the_tip_of_a_cone) {
  for (const OccShape& shape : {OccShape::sphere(3), OccShape::sphere(3).as_nurbs()}) {
    const auto ball = shape.import().model;
    for (const double z : {-5.0, 5.0}) {
      const Projection foot = ball->project({2, 1}, Vec3(0, 0, z));
      EXPECT_LT((ball->normal(1, foot.parameters) - Vec3(0, 0, z / 5)).norm(), 1e-5);
    }
  }
  const auto cone = OccShape::cone(3, 0, 4).import().model;
  for (int id = 1; id <= cone->count(2); ++id) {
    if (cone->type({2, id}) != "cone") continue;
    const Projection foot = cone->project({2, id}, Vec3(0, 0, 9));
    EXPECT_LT((foot.point - Vec3(0, 0, 4)).norm(), 1e-12);
    EXPECT_EQ(cone->normal(id, foot.parameters), Vec3::Zero());
  }
}

TEST(occ_model, the_normal_between_two_volumes_points_out_of_the_lower_one) {
  CadOptions glue;
  glue.glue = true;
  const auto model = OccShape::two_bricks().import(glue).model;
  int n_shared = 0;
  for (int id = 1; id <= model->count(2); ++id) {
    if (model->adjacent({2, id}, 3) != std::vector<int>{1, 2}) continue;
    ++n_shared;
    const Projection foot = model->project({2, id}, Vec3(2, 1, 1));
    const double lower = model->contains(1, Vec3(1, 1, 1)) ? 1 : -1;
    EXPECT_LT((model->normal(id, foot.parameters) - lower * Vec3::UnitX()).norm(), 1e-12);
  }
  EXPECT_EQ(n_shared, 1);
}

TEST(occ_model, contains_agrees_with_closed_forms) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto torus = OccShape::torus(5, 1.5).import().model;
  const auto plate = OccShape::brick_with_hole(10, 6, 2, 1.5).import().model;
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = 7 * Vec3(unit(random), unit(random), unit(random) / 3);
    const double d = std::hypot(std::hypot(p.x(), p.y()) - 5, p.z()) - 1.5;
    if (std::abs(d) > 1e-5) {
      EXPECT_EQ(torus->contains(1, p), d < 0) << p.transpose();
    }
    const Vec3 q = Vec3(5, 3, 1) + p;
    const bool in_plate = q.x() > 0 && q.x() < 10 && q.y() > 0 && q.y() < 6 && q.z() > 0 && q.z() < 2 &&
                          std::hypot(q.x() - 5, q.y() - 3) > 1.5;
    EXPECT_EQ(plate->contains(1, q), in_plate) << q.transpose();
  }
}

TEST(occ_model, near_never_misses_an_entity) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const OccShape& shape : {OccShape::brick_with_hole(10, 6, 2, 1.5), OccShape::loft(), OccShape::vase()}) {
    const auto model = shape.import().model;
    int n_found = 0, n_all = 0;
    for (int i = 0; i < 40; ++i) {
      const Vec3 p = Vec3(5, 3, 1) + 8 * Vec3(unit(random), unit(random), unit(random));
      const double distance = std::abs(3 * unit(random));
      for (int dim = 0; dim <= 2; ++dim) {
        const auto near = model->near(dim, p, distance);
        EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
        n_found += static_cast<int>(near.size());
        n_all += model->count(dim);
        for (int id = 1; id <= model->count(dim); ++id) {
          if (shape.distance({dim, id}, p) > distance) continue;
          EXPECT_TRUE(std::binary_search(near.begin(), near.end(), id)) << to_string(Owner{dim, id});
        }
      }
    }
    EXPECT_LT(n_found, n_all) << "a filter that passes everything";
  }
}

TEST(occ_model, closed_curves_have_a_period_and_tangents_are_derivatives) {
  for (const OccShape& shape : {OccShape::cylinder(2, 5), OccShape::brick(1, 2, 3), OccShape::loft(),
                                OccShape::cylinder_sector(3, 4, 0.4, 1.9)}) {
    const auto model = shape.import().model;
    for (int id = 1; id <= model->count(1); ++id) {
      const CurveRange range = model->range(id);
      const Vec3 first = model->point({1, id}, {range.first, 0}), last = model->point({1, id}, {range.last, 0});
      const bool closed = (first - last).norm() < 1e-7;
      EXPECT_EQ(range.period, closed ? range.last - range.first : 0);
      EXPECT_EQ(model->adjacent({1, id}, 0).size(), closed ? 1u : 2u);
      for (const double s : {0.2, 0.55, 0.9}) {
        const double t = range.first + s * (range.last - range.first), step = 1e-5 * (range.last - range.first);
        const Vec3 chord = model->point({1, id}, {t + step, 0}) - model->point({1, id}, {t - step, 0});
        EXPECT_LT((model->tangent(id, t) - chord.normalized()).norm(), 1e-6);
      }
    }
  }
}

TEST(occ_model, glueing_merges_what_touches_and_says_how_much) {
  CadOptions glue;
  glue.glue = true;
  const CadImport apart = OccShape::two_bricks().import(), glued = OccShape::two_bricks().import(glue);
  EXPECT_EQ(apart.model->count(2), 12);
  EXPECT_EQ(glued.model->count(2), 11);
  EXPECT_EQ(glued.model->count(1), 20);
  EXPECT_EQ(glued.model->count(0), 12);
  EXPECT_EQ(glued.model->count(3), 2);
  EXPECT_NEAR(glued.model->measure({3, 1}), 24, 1e-10);
  EXPECT_NEAR(glued.model->measure({3, 2}), 36, 1e-10);
  ASSERT_EQ(glued.notices.size(), 1u);
  EXPECT_EQ(glued.notices[0], "glued 2 solids: 12 -> 11 faces, 24 -> 20 edges, 16 -> 12 vertices");
  const CadImport later = hextwist::glued(*apart.model);
  EXPECT_EQ(later.notices, glued.notices);
  EXPECT_EQ(later.model->count(2), 11);
  EXPECT_EQ(later.model->adjacent({3, 1}, 2), glued.model->adjacent({3, 1}, 2));
  EXPECT_EQ(OccShape::brick(1, 1, 1).import(glue).notices[0], "nothing to glue: the model has one solid");
}

TEST(occ_model, glueing_keeps_faces_beside_the_solids) {
  const OccShape both = OccShape::together({OccShape::two_bricks(), OccShape::open_shell().moved({10, 0, 0}, 0)});
  const CadImport glued = both.import({.glue = true});
  EXPECT_EQ(glued.model->count(3), 2);
  EXPECT_EQ(glued.model->count(2), 11 + 5);
  EXPECT_EQ(glued.model->count(1), 20 + 12);
  for (const std::string& line : glued.notices) EXPECT_EQ(line.find("changed the volume"), std::string::npos) << line;
}

TEST(occ_model, loose_faces_are_sewed_into_a_solid_with_its_cavity) {
  const CadImport part = OccShape::loose_faces_with_cavity().import();
  ASSERT_EQ(part.model->count(3), 1);
  EXPECT_NEAR(part.model->measure({3, 1}), 124, 1e-10);
  EXPECT_EQ(part.model->count(2), 12);
  EXPECT_FALSE(part.model->contains(1, Vec3(2.5, 2.5, 2.5)));
  EXPECT_TRUE(part.model->contains(1, Vec3(1, 1, 1)));
  ASSERT_EQ(part.notices.size(), 1u);
  EXPECT_EQ(part.notices[0].substr(0, 39), "no solids: sewed 12 faces into 1 solid ");
  for (int id = 1; id <= 12; ++id) {
    const Projection foot = part.model->project({2, id}, Vec3(2.5, 2.5, 2.5));
    const Vec3 n = part.model->normal(id, foot.parameters);
    const bool cavity = foot.distance < 1;
    EXPECT_EQ(n.dot(foot.point - Vec3(2.5, 2.5, 2.5)) > 0, !cavity) << id;
  }
}

TEST(occ_model, loose_faces_of_solids_that_touch_are_these_solids) {
  for (const bool turned : {false, true}) {
    const CadImport part = OccShape::loose_faces_that_touch(turned).import();
    ASSERT_EQ(part.model->count(3), 2);
    EXPECT_EQ(part.model->count(2), 11);
    EXPECT_EQ(part.model->count(1), 20);
    for (const int v : {1, 2}) EXPECT_NEAR(part.model->measure({3, v}), 8, 1e-9);
    ASSERT_EQ(part.notices.size(), 1U);
    EXPECT_EQ(part.notices[0].substr(0, 54), "no solids: sewed 12 faces into 2 solids, which touch (");
  }
}

TEST(occ_model, an_open_shell_and_an_unknown_entity_are_errors) {
  const auto message = [](const auto& f) -> std::string {
    try {
      f();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message([] { OccShape::open_shell().import(); }),
            "shape: no solid (sewed 5 faces, but they do not close: 4 edges bound one face only)");
  const auto model = OccShape::brick(1, 1, 1).import().model;
  EXPECT_EQ(message([&] { model->type({2, 7}); }), "the model has no surface 7");
  EXPECT_EQ(message([&] { model->range(0); }), "the model has no curve 0");
  EXPECT_EQ(message([&] { model->project({3, 1}, Vec3::Zero()); }), "cannot project onto volume 1");
  EXPECT_EQ(message([&] { model->point({3, 1}, {}); }), "a volume has no parameters");
}

TEST(occ_model, contains_every_point_of_a_thin_shell_between_its_spline_faces) {
  // An extrusion along z by 2.5, so a point of the lower face moved up by less than that is inside.
  const auto model = read_cad(std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models/curved_plate.brep", {}).model;
  int lower = 0;
  for (int s = 1; s <= model->count(2); ++s)
    if (model->type({2, s}).starts_with("bspline") &&
        (!lower || model->box({2, s}).min.z() < model->box({2, lower}).min.z()))
      lower = s;
  ASSERT_GT(lower, 0);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x(0.5, 59.5), y(0.5, 39.5), up(0.01, 2.49);
  for (int i = 0; i < 300; ++i) {
    const Vec3 somewhere(x(random), y(random), 5);
    const Vec3 foot = model->project({2, lower}, somewhere).point;
    if (foot.x() < 0.1 || foot.x() > 59.9 || foot.y() < 0.1 || foot.y() > 39.9) continue;
    const double w = up(random);
    EXPECT_TRUE(model->contains(1, foot + Vec3(0, 0, w))) << foot.transpose() << " up by " << w;
    EXPECT_FALSE(model->contains(1, foot - Vec3(0, 0, w))) << foot.transpose() << " down by " << w;
    EXPECT_FALSE(model->contains(1, foot + Vec3(0, 0, w + 2.5))) << foot.transpose() << " beyond, by " << w;
  }
}

TEST(occ_model, both_sides_of_a_face_inside_a_solid_are_inside) {
  const auto model = test::OccShape::brick_with_face_inside(4, 4, 2, 2).import().model;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-0.25, 1.25);
  for (int i = 0; i < 3000; ++i) {
    Vec3 p(4 * at(random), 4 * at(random), 2 * at(random));
    if (i % 3 == 0) p.x() = 2 + 0.1 * at(random);  // near it, and nearest to its rim
    const bool inside = (p.array() >= 0).all() && (p.array() <= Vec3(4, 4, 2).array()).all();
    EXPECT_EQ(model->contains(1, p), inside) << p.transpose();
  }
}

}  // namespace
}  // namespace hextwist
