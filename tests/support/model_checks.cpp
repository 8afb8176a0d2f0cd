#include "support/model_checks.h"

#include <algorithm>

namespace hextwist::test {
namespace {

bool inside(const Box& box, const Vec3& p, double slack) {
  return ((p.array() >= box.min.array() - slack) && (p.array() <= box.max.array() + slack)).all();
}

Vec3 random_point(const Box& box, double margin, std::mt19937& random) {
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = std::uniform_real_distribution(box.min[axis] - margin, box.max[axis] + margin)(random);
  return p;
}

}  // namespace

void expect_entities_consistent(const Model& model) {
  const double slack = 1e-9 * model.box().diagonal();
  for (int dim = 0; dim < 4; ++dim)
    for (int id = 1; id <= model.count(dim); ++id) {
      const Owner entity{dim, id};
      SCOPED_TRACE(to_string(entity));
      const Box box = model.box(entity);
      ASSERT_FALSE(box.empty());
      EXPECT_TRUE(inside(model.box(), box.min, slack) && inside(model.box(), box.max, slack));
      EXPECT_EQ(model.measure(entity) > 0, dim > 0);
      EXPECT_FALSE(model.type(entity).empty());
      EXPECT_GE(model.tolerance(entity), 0);
      for (int other = 0; other < 4; ++other) {
        if (other == dim) continue;
        const auto ids = model.adjacent(entity, other);
        EXPECT_TRUE(std::ranges::adjacent_find(ids, std::ranges::greater_equal{}) == ids.end());
        for (const int k : ids) {
          ASSERT_GE(k, 1);
          ASSERT_LE(k, model.count(other));
          const auto back = model.adjacent({other, k}, dim);
          EXPECT_TRUE(std::ranges::binary_search(back, id));
          if (other < dim) {
            const Box part = model.box({other, k});
            const double loose = slack + model.tolerance(entity);
            EXPECT_TRUE(inside(box, part.min, loose) && inside(box, part.max, loose)) << dimension_name(other) << k;
          }
        }
      }
    }
}

void expect_projections_consistent(const Model& model, std::mt19937& random, const ProjectionChecks& checks) {
  const double size = model.box().diagonal();
  const double tolerance = checks.tolerance * size;
  for (int dim = 0; dim <= 2; ++dim)
    for (int id = 1; id <= model.count(dim); ++id) {
      const Owner entity{dim, id};
      SCOPED_TRACE(to_string(entity));
      const Box box = model.box(entity);
      std::vector<Vec3> points;
      for (int i = 0; i < checks.n_points; ++i) points.push_back(random_point(box, 0.1 * size, random));
      std::vector<Projection> feet(points.size()), again(points.size());
      model.project(entity, points, {}, feet);
      std::vector<Parameters> at;
      std::vector<Vec3> on;
      for (const Projection& foot : feet) {
        at.push_back(foot.parameters);
        on.push_back(foot.point);
      }

      for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(feet[i].distance, (points[i] - on[i]).norm(), tolerance);
        EXPECT_LE((model.point(entity, at[i]) - on[i]).norm(), 1e-12 * size);
        EXPECT_TRUE(inside(box, on[i], tolerance));
        const auto found = model.near(dim, points[i], feet[i].distance);
        EXPECT_TRUE(std::ranges::binary_search(found, id));
        if (dim == 1) {
          const CurveRange range = model.range(id);
          EXPECT_GE(at[i].u, range.first);
          EXPECT_LE(at[i].u, range.last);
          EXPECT_NEAR(model.tangent(id, at[i].u).norm(), 1, 1e-9);
        }
        if (dim == 2) {
          EXPECT_NEAR(model.normal(id, at[i]).norm(), 1, 1e-9);
        }
      }

      model.project(entity, on, {}, again);
      for (std::size_t i = 0; i < on.size(); ++i) EXPECT_LE(again[i].distance, tolerance);
      model.project(entity, points, at, again);
      for (std::size_t i = 0; i < on.size(); ++i) EXPECT_NEAR(again[i].distance, feet[i].distance, tolerance);
      const std::vector<Parameters> none(points.size());
      model.project(entity, points, none, again);
      for (std::size_t i = 0; i < on.size(); ++i) EXPECT_NEAR(again[i].distance, feet[i].distance, tolerance);

      // Rivals: other points of the entity, from its parameters on a curve and from other projections on a surface.
      std::vector<Vec3> rivals = on;
      if (dim == 1) {
        const CurveRange range = model.range(id);
        for (int i = 0; i < checks.n_rivals; ++i)
          rivals.push_back(model.point(entity, {std::uniform_real_distribution(range.first, range.last)(random), 0}));
      } else if (dim == 2) {
        for (int i = 0; i < checks.n_rivals; ++i)
          rivals.push_back(model.project(entity, random_point(box, 0.1 * size, random)).point);
      }
      for (std::size_t i = 0; i < points.size(); ++i)
        for (const Vec3& rival : rivals) ASSERT_LE(feet[i].distance, (points[i] - rival).norm() + tolerance);
    }
}

}  // namespace hextwist::test
