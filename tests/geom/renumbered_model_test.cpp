// A model under other ids answers as the model does, and a skin is divided as its labels say.
#include "hextwist/geom/renumbered_model.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hextwist/geom/curvature.h"
#include "hextwist/geom/facet/model.h"
#include "hextwist/geom/primitives.h"
#include "support/grids.h"
#include "support/skins.h"

namespace hextwist::test {
namespace {

/// Every id turned around: i becomes n + 1 - i.
Renumbering reversed(const Model& model) {
  Renumbering result;
  for (int dim = 0; dim < 4; ++dim)
    for (int id = model.count(dim); id >= 1; --id) result.id[dim].push_back(id);
  return result;
}

TEST(RenumberedModel, answers_for_the_new_ids_as_the_model_does_for_its_own) {
  const auto model = cad_cylinder({.radius = 2, .height = 3}).model;
  Renumbering ids = reversed(*model);
  ids.name[1] = {"rim", "", ""};
  const auto other = renumbered(model, ids);
  EXPECT_EQ(other->name({1, model->count(1)}), "rim");
  EXPECT_EQ(other->name({1, 1}), model->name({1, model->count(1)}));
  const Vec3 p(1.5, 0.4, 0.7);
  for (int dim = 0; dim < 4; ++dim) {
    ASSERT_EQ(other->count(dim), model->count(dim));
    std::vector<int> near = model->near(std::min(dim, 2), p, 1);
    for (int& id : near) id = model->count(std::min(dim, 2)) + 1 - id;
    std::ranges::sort(near);
    EXPECT_EQ(other->near(std::min(dim, 2), p, 1), near);
    for (int id = 1; id <= model->count(dim); ++id) {
      const Owner own{dim, id}, fresh = ids.of(own);
      EXPECT_EQ(fresh.id, model->count(dim) + 1 - id);
      EXPECT_EQ(other->type(fresh), model->type(own));
      EXPECT_EQ(other->measure(fresh), model->measure(own));
      EXPECT_EQ(other->tolerance(fresh), model->tolerance(own));
      EXPECT_EQ(other->box(fresh).min, model->box(own).min);
      for (int to = 0; to < 4; ++to) {
        if (to == dim) continue;
        std::vector<int> adjacent = model->adjacent(own, to);
        for (int& each : adjacent) each = model->count(to) + 1 - each;
        std::ranges::sort(adjacent);
        EXPECT_EQ(other->adjacent(fresh, to), adjacent);
      }
      if (dim == 3) continue;
      EXPECT_EQ(other->project(fresh, p).point, model->project(own, p).point);
      const Parameters at = model->project(own, p).parameters;
      EXPECT_EQ(other->point(fresh, at), model->point(own, at));
      if (dim == 1) {
        EXPECT_EQ(other->range(fresh.id).last, model->range(own.id).last);
        EXPECT_EQ(other->tangent(fresh.id, at.u), model->tangent(own.id, at.u));
      }
      if (dim == 2) {
        EXPECT_EQ(other->normal(fresh.id, at), model->normal(own.id, at));
        ASSERT_TRUE(curvature_of(*other));
        EXPECT_EQ(curvature_of(*other)->curvature(fresh, at), curvature_of(*model)->curvature(own, at));
      }
    }
  }
  EXPECT_TRUE(other->contains(1, p));
  EXPECT_EQ(other->box().max, model->box().max);
  EXPECT_THROW((void)other->measure({2, 99}), Error);
}

TEST(RenumberedModel, normals_look_out_of_the_volume_that_is_lower_now) {
  const Mesh mesh = grid(2, 1, 1);
  const std::vector<int> volume = {1, 2};
  const auto model = facet_model_of(mesh, volume, 35).model;
  const auto other = renumbered(model, reversed(*model));
  int n_shared = 0;
  for (int id = 1; id <= model->count(2); ++id) {
    const Parameters at = model->project({2, id}, Vec3(1, 0.5, 0.5)).parameters;
    const int fresh = model->count(2) + 1 - id;
    const bool shared = model->adjacent({2, id}, 3).size() == 2;
    n_shared += shared;
    const Vec3 expected = shared ? Vec3(-model->normal(id, at)) : model->normal(id, at);
    EXPECT_EQ(other->normal(fresh, at), expected);
  }
  EXPECT_EQ(n_shared, 1);
}

TEST(RenumberedModel, refuses_ids_that_are_no_permutation) {
  const auto model = cad_brick({}).model;
  for (const int wrong : {0, 2, 7}) {
    Renumbering ids = reversed(*model);
    ids.id[2][5] = wrong;
    try {
      (void)renumbered(model, ids);
      ADD_FAILURE() << wrong;
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), "the new ids of each surface are not a permutation");
    }
  }
}

TEST(FacetModel, labels_divide_the_skin_instead_of_angles) {
  const Mesh mesh = grid(4, 4, 4);
  const std::vector<int> volume(mesh.hexes.size(), 1);
  const Skin outside = skin(mesh, volume);
  // One label on each side of x + y + ... = the diagonal plane of centres, whatever the angles of the cube are.
  std::vector<int> label;
  for (const auto& quad : outside.quads) {
    double sum = 0;
    for (const auto node : quad) sum += mesh.points[node].z() / 4;
    label.push_back(sum > 2 ? 7 : 3);
  }
  FacetLabels labels{label, {}, {}, {}};
  const FacetImport two = facet_model(mesh.points, outside.quads, outside.volumes, {.labels = &labels});
  EXPECT_EQ(two.model->count(2), 2);  // an upper and a lower half: no edge of the cube counts
  EXPECT_EQ(two.model->count(1), 1);  // the closed line between
  EXPECT_EQ(two.model->count(0), 0);
  EXPECT_NEAR(two.model->measure({1, 1}), 16, 1e-12);
  EXPECT_NEAR(two.model->measure({2, 1}), 16 + 4 * 8, 1e-12);

  // A labelled edge in the middle of a side is a curve, and a labelled node on the line a vertex.
  const std::vector<std::array<std::int32_t, 2>> edges = {{6, 7}, {7, 8}};  // on the side z = 0
  const std::vector<int> edge_labels = {1, 2};
  const std::vector<std::int32_t> vertices = {50};
  labels.edges = edges;
  labels.edge_labels = edge_labels;
  labels.vertices = vertices;
  const FacetImport more = facet_model(mesh.points, outside.quads, outside.volumes, {.labels = &labels});
  EXPECT_EQ(more.classification.vertex_nodes, (std::vector<std::int32_t>{6, 7, 8, 50}));
  EXPECT_EQ(more.model->count(1), 3);
  EXPECT_EQ(more.model->count(2), 2);
}

}  // namespace
}  // namespace hextwist::test
