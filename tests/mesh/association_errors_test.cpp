// Meshes that do not lie on their model: every error, by its text.
#include <gtest/gtest.h>

#include <cmath>

#include "hextwist/mesh/association/association.h"
#include "support/analytic_model.h"
#include "support/grids.h"

namespace hextwist {
namespace {

std::string error_of(const Mesh& mesh, const Model& model, const AssociateOptions& options = {}) {
  try {
    associate(mesh, model, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// A model that denies having entities of one dimension.
class Without : public Model {
 public:
  Without(std::shared_ptr<const Model> model, int dim) : model_(std::move(model)), dim_(dim) {}
  int count(int dim) const override { return dim == dim_ ? 0 : model_->count(dim); }
  std::string name(Owner entity) const override { return model_->name(entity); }
  std::string type(Owner entity) const override { return model_->type(entity); }
  Box box(Owner entity) const override { return model_->box(entity); }
  Box box() const override { return model_->box(); }
  double measure(Owner entity) const override { return model_->measure(entity); }
  std::vector<int> adjacent(Owner entity, int dim) const override {
    return dim == dim_ ? std::vector<int>{} : model_->adjacent(entity, dim);
  }
  double tolerance(Owner entity) const override { return model_->tolerance(entity); }
  CurveRange range(int curve) const override { return model_->range(curve); }
  Vec3 point(Owner entity, Parameters at) const override { return model_->point(entity, at); }
  Vec3 tangent(int curve, double t) const override { return model_->tangent(curve, t); }
  Vec3 normal(int surface, Parameters at) const override { return model_->normal(surface, at); }
  void project(Owner entity, std::span<const Vec3> points, std::span<const Parameters> seeds,
               std::span<Projection> out) const override {
    model_->project(entity, points, seeds, out);
  }
  bool contains(int volume, const Vec3& point) const override { return model_->contains(volume, point); }
  std::vector<int> near(int dim, const Vec3& p, double distance) const override {
    return dim == dim_ ? std::vector<int>{} : model_->near(dim, p, distance);
  }

 private:
  std::shared_ptr<const Model> model_;
  int dim_;
};

TEST(association_errors, empty_meshes_and_models_without_volumes_are_refused) {
  EXPECT_EQ(error_of(Mesh{}, *analytic_brick(1, 1, 1)), "the mesh has no hexes to associate");
  EXPECT_EQ(error_of(test::grid(1, 1, 1), Without(analytic_brick(1, 1, 1), 3)), "the model has no volume");
}

TEST(association_errors, the_worst_node_is_named_with_its_distance_and_the_nearest_surface) {
  Mesh mesh = test::grid(3, 3, 3);
  mesh.node_ids.resize(mesh.points.size());
  for (std::size_t n = 0; n < mesh.points.size(); ++n) mesh.node_ids[n] = static_cast<std::int64_t>(100 + n);
  mesh.points[1 + 4 * 1].z() -= 0.125;  // in the bottom face
  mesh.points[2 + 4 * 1].z() -= 0.25;
  EXPECT_EQ(error_of(mesh, *analytic_brick(3, 3, 3)),
            "the mesh does not lie on the model: node 106 at (2, 1, -0.25) is 0.25 from the nearest surface, 5 "
            "(tolerance 5.19615e-05); of 56 boundary nodes 2 are off");
  mesh.points[1 + 4 * 1].z() += 0.125;
  EXPECT_NE(error_of(mesh, *analytic_brick(3, 3, 3)).find("of 56 boundary nodes 1 is off"), std::string::npos);
}

TEST(association_errors, mixed_up_units_and_moved_meshes_are_explained) {
  const auto model = analytic_brick(3, 2, 1);
  const auto hint = [&](double scale, const Vec3& move) {
    Mesh mesh = test::grid(3, 2, 1, Vec3::Constant(scale));
    for (Vec3& p : mesh.points) p += move;
    const std::string text = error_of(mesh, *model);
    EXPECT_NE(text.find("the mesh does not lie on the model: node "), std::string::npos) << text;
    return text.substr(std::min(text.size(), text.find(" off;") + 6));
  };
  EXPECT_EQ(hint(1000, Vec3::Zero()),
            "the mesh is 1000 times larger than the model: millimetres and metres mixed up? 'import mesh ... scale "
            "0.001' mends that");
  EXPECT_EQ(hint(1 / 25.4, Vec3::Zero()),
            "the mesh is 25.4 times smaller than the model: millimetres and inches mixed up? 'import mesh ... scale "
            "25.4' mends that");
  EXPECT_EQ(hint(0.1, Vec3::Zero()),
            "the mesh is 10 times smaller than the model: millimetres and centimetres mixed up? 'import mesh ... scale "
            "10' mends that");
  EXPECT_EQ(hint(304.8, Vec3::Zero()),
            "the mesh is 304.8 times larger than the model: millimetres and feet mixed up? 'import mesh ... scale "
            "0.00328084' mends that");
  EXPECT_EQ(hint(1 / 0.0254, Vec3::Zero()),
            "the mesh is 39.3701 times larger than the model: metres and inches mixed up? 'import mesh ... scale "
            "0.0254' mends that");
  EXPECT_EQ(hint(1, Vec3(7, 0, 0)),
            "the mesh is as large as the model, but its centre is at (8.5, 1, 0.5) instead of (1.5, 1, 0.5): read the "
            "mesh before the CAD and 'move -7 0 0' it");
  EXPECT_EQ(hint(2, Vec3::Zero()), "the boxes of mesh and model are 7.48331 and 3.74166 across: another model?");
}

TEST(association_errors, faces_across_a_curve_name_the_surfaces_of_their_corners) {
  Mesh mesh = test::grid(2, 2, 2);
  mesh.points[0] = Vec3(0.3, 0.3, 0);
  EXPECT_EQ(error_of(mesh, *analytic_brick(2, 2, 2)),
            "the mesh does not follow the curves of the model: face of hex 1 lies across surfaces, node 1 on surface "
            "5, node 10 on surface 1, node 13 on surface 1, node 4 on surface 1");
}

TEST(association_errors, edges_between_surfaces_must_be_on_a_curve) {
  Mesh mesh = test::grid(2, 2, 2);
  mesh.points[1] = Vec3(1, 0.45, 0.45);  // within the tolerance of both surfaces, not of their curve
  EXPECT_EQ(error_of(mesh, *analytic_brick(2, 2, 2), {.relative_tolerance = 0.5 / std::sqrt(12.0)}),
            "the mesh edge between nodes 1 and 2 parts surfaces 3 and 5, but node 2 lies 0.636396 from their curve 1: "
            "the mesh does not follow the curves of the model");
  EXPECT_EQ(error_of(test::grid(2, 2, 2), Without(analytic_brick(2, 2, 2), 1)),
            "the mesh edge between nodes 1 and 2 parts surfaces 3 and 5, which share no curve");
}

TEST(association_errors, nodes_between_curves_must_be_at_a_vertex) {
  EXPECT_EQ(error_of(test::grid(2, 2, 2), Without(analytic_brick(2, 2, 2), 0)),
            "node 1 joins curves 1, 5 and 9 but is at no vertex of the model");
}

TEST(association_errors, a_mesh_that_does_not_part_the_volumes_is_refused) {
  Mesh mesh = test::grid(4, 2, 2);
  mesh.blocks = {{1, "", {}}, {2, "", {}}};
  for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.blocks[h % 4 / 2].hexes.push_back(h);
  const auto own = associate_with_own_skin(mesh);
  mesh.points[2 + 5 * (1 + 3 * 1)].x() += 0.3;  // inside, on the surface between the volumes
  const std::string text = error_of(mesh, *own.model);
  EXPECT_EQ(text.find("hexes 1 and 3 are joined, but lie on surface "), 0) << text;
  EXPECT_NE(text.find(" of volume 2: the mesh does not follow the surfaces between the volumes"), std::string::npos)
      << text;
  const auto with_tags = [&] { associate(mesh, *own.model, &own.association); };
  EXPECT_THROW(with_tags(), Error);
}

TEST(association_notices, what_the_mesh_misses_is_said) {
  // A cube with a smaller one inside, met by one hex that knows nothing of it.
  Mesh mesh = test::grid(3, 3, 3);
  mesh.blocks = {{1, "", {}}, {2, "", {13}}};
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (h != 13) mesh.blocks[0].hexes.push_back(h);
  const auto own = associate_with_own_skin(mesh);
  ASSERT_EQ(own.model->count(2), 12);
  const auto result = associate(test::grid(1, 1, 1, Vec3::Constant(3)), *own.model);
  ASSERT_EQ(result.notices.size(), 4);
  EXPECT_EQ(result.notices[0], "1 volume has no hex: 2");
  EXPECT_NE(result.notices[1].find("6 surfaces have no face of the mesh: "), std::string::npos);
  EXPECT_NE(result.notices[1].find("... (6 in all)"), std::string::npos);
  EXPECT_NE(result.notices[2].find("12 curves have no edge of the mesh: "), std::string::npos);
  EXPECT_NE(result.notices[3].find("8 vertices have no node of the mesh: "), std::string::npos);
}

TEST(association_notices, a_volume_much_larger_than_its_hexes_is_said) {
  // A square in a circle.
  Mesh mesh = test::grid(1, 1, 1);
  for (Vec3& p : mesh.points) p.head(2) = Eigen::Vector2d(p.x() + p.y() - 1, p.y() - p.x());
  const auto result = associate(mesh, *analytic_cylinder(1, 1));
  EXPECT_EQ(result.notices, std::vector<std::string>{"volume 1 of the model is 3.14159, its hexes are 2"});
}

}  // namespace
}  // namespace hextwist
