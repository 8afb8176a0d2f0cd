// Where targets meet: no growth along faces, every target edge cut in three, nothing inverted.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "hextwist/geom/occ/model.h"
#include "hextwist/io/io.h"
#include "hextwist/patch/refine.h"
#include "support/analytic_model.h"
#include "support/association_checkers.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

using test::brick;
using test::shipped;

std::vector<Index> all(const MeshedModel& input, int dim) {
  std::vector<Index> ids;
  for (int id = 1; id <= input.model->count(dim); ++id)
    if (!nodes_on(input.association, *input.model, {dim, id}).empty()) ids.push_back(id);
  return ids;
}

RefineResult checked(const MeshedModel& input, const Request& request) {
  RefineResult result = refine(input, request);
  const MeshedModel& fine = result.refined;
  EXPECT_TRUE(test::conformal(fine.mesh));
  EXPECT_TRUE(test::uninverted(fine.mesh));
  EXPECT_TRUE(result.report.off_nodes.empty());
  const auto broken = check_association(fine.mesh, fine.association, *fine.model);
  EXPECT_TRUE(broken.empty()) << broken.front();
  return result;
}

bool says(const Report& report, const std::string& text) {
  return std::ranges::find(report.notices, text) != report.notices.end();
}

/// Per curve the number of mesh edges on it.
std::vector<int> edges_per_curve(const MeshedModel& meshed) {
  std::vector<int> count(meshed.model->count(1) + 1, 0);
  for (const int curve : meshed.association.edge_curve) ++count[curve];
  return count;
}

TEST(junctions, all_curves_of_a_brick_are_cut_in_three_and_nothing_beside_them) {
  const MeshedModel input = brick(6, 5, 7);
  const RefineResult result = checked(input, {.target = {.kind = EntityKind::curve, .ids = all(input, 1)}});
  EXPECT_TRUE(says(result.report, "8 nodes where targets meet were refined before the others"));
  const auto before = edges_per_curve(input), after = edges_per_curve(result.refined);
  for (std::size_t curve = 1; curve < before.size(); ++curve) EXPECT_EQ(after[curve], 3 * before[curve]) << curve;
  EXPECT_GE(result.report.shape_after.min, 0.4);
  // Hexes that touch no curve are as they were.
  for (Index h = 0; h < input.mesh.n_hexes(); ++h) {
    bool touches = false;
    for (const Index n : input.mesh.hexes[h]) touches |= input.association.node_owner[n].dim <= 1;
    EXPECT_EQ(find_hex(result.refined.mesh, h + 1) < 0, touches);
  }
}

TEST(junctions, three_edges_at_a_node_inside_are_cut_in_three) {
  const MeshedModel input = brick(5, 5, 5);
  const Edges all_edges = edges(input.mesh);
  const auto node = [](int i, int j, int k) { return i + 6 * (j + 6 * k); };
  Request request{.target = {.kind = EntityKind::edge}};
  for (const Index end : {node(3, 2, 2), node(2, 3, 2), node(2, 2, 3)})
    request.target.ids.push_back(find_edge(all_edges, node(2, 2, 2), end));
  std::ranges::sort(request.target.ids);
  const RefineResult result = checked(input, request);
  EXPECT_TRUE(says(result.report, "1 node where targets meet were refined before the others"));
  // Cut at a third from the node in the middle, then what is left of the edge at a third from its other end.
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> at;
    for (const Vec3& p : result.refined.mesh.points) {
      Vec3 off = p - Vec3(2, 2, 2);
      const double along = off[axis];
      off[axis] = 0;
      if (off.norm() < 1e-12 && along > -1e-12 && along < 1 + 1e-12) at.push_back(along);
    }
    std::ranges::sort(at);
    ASSERT_EQ(at.size(), 4u);
    EXPECT_NEAR(at[1], 1.0 / 3, 1e-12);
    EXPECT_NEAR(at[2], 7.0 / 9, 1e-12);
  }
}

TEST(junctions, a_turn_in_a_flat_side_takes_one_node_along) {
  const MeshedModel input = brick(6, 6, 3);
  const Edges all_edges = edges(input.mesh);
  const auto node = [](int i, int j) { return i + 7 * j; };
  Request request{
      .target = {.kind = EntityKind::edge,
                 .ids = {find_edge(all_edges, node(2, 2), node(3, 2)), find_edge(all_edges, node(3, 2), node(3, 3))}}};
  std::ranges::sort(request.target.ids);
  const RefineResult result = checked(input, request);
  EXPECT_TRUE(says(result.report, "1 node beside the target enclosed with it"));
}

TEST(junctions, two_curves_in_one_hex_that_do_not_meet_are_enclosed_one_after_the_other) {
  const MeshedModel input = brick(4, 1, 1);
  // Diagonally opposite edges along x.
  Request request{.target = {.kind = EntityKind::curve}};
  for (int id = 1; id <= 12; ++id) {
    const Box box = input.model->box(Owner{1, id});
    if (box.max.x() - box.min.x() < 1) continue;
    if (box.min.y() == box.min.z()) request.target.ids.push_back(id);
  }
  ASSERT_EQ(request.target.ids.size(), 2u);
  const RefineResult result = checked(input, request);
  for (const Index curve : request.target.ids) EXPECT_EQ(edges_per_curve(result.refined)[curve], 12);
}

TEST(junctions, targets_that_meet_can_be_refined_twice_and_in_parallel) {
  const MeshedModel input = brick(3, 4, 3);
  const RefineResult twice =
      checked(input, {.target = {.kind = EntityKind::curve, .ids = all(input, 1)}, .how = Cuts{2}});
  for (std::size_t curve = 1; curve <= 12; ++curve)
    EXPECT_EQ(edges_per_curve(twice.refined)[curve], 9 * edges_per_curve(input)[curve]);
  checked(input, {.target = {.kind = EntityKind::curve, .ids = all(input, 1)}, .method = Method::parallel});
}

class shipped_model : public testing::TestWithParam<const char*> {};

TEST_P(shipped_model, all_curves_all_vertices_and_all_surfaces) {
  const MeshedModel input = shipped(GetParam());
  for (const EntityKind kind : {EntityKind::vertex, EntityKind::curve, EntityKind::surface}) {
    const int dim = static_cast<int>(kind) - static_cast<int>(EntityKind::vertex);
    const RefineResult result = checked(input, {.target = {.kind = kind, .ids = all(input, dim)}});
    EXPECT_LE(result.report.off_cad.max_relative, 1e-9);
    if (kind != EntityKind::vertex) {
      const auto before = edges_per_curve(input), after = edges_per_curve(result.refined);
      for (std::size_t curve = 1; curve < before.size(); ++curve) EXPECT_EQ(after[curve], 3 * before[curve]) << curve;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(junctions, shipped_model,
                         testing::Values("bracket", "bracket_fillet", "plate_hole", "cylinder", "inclusion", "pipe_tee",
                                         "ring_twist", "curved_plate", "cam", "l_block", "notched_cube"),
                         [](const auto& param) { return std::string(param.param); });

TEST(junctions, thin_hexes_at_a_curved_surface_are_smoothed_between_two_rounds) {
  const auto folder = test::data_folder();
  if (folder.empty()) GTEST_SKIP() << "the folder of real CAD and meshes is not here";
  MeshFile file = read_mesh(folder / "cad/bracket_fillet_1k.msh");
  MeshedModel input;
  input.model = read_cad(folder / "cad/bracket_fillet.brep", {}).model;
  input.association = associate(file.mesh, *input.model, &file.tags).association;
  input.mesh = std::move(file.mesh);
  const RefineResult result = checked(input, {.target = {.kind = EntityKind::surface, .ids = {10}}, .how = Cuts{2}});
  EXPECT_TRUE(std::ranges::any_of(
      result.report.notices, [](const std::string& notice) { return notice.starts_with("smoothed between passes"); }));
}

// On refined models of our own both the smallest shape and the average rise, and the smallest never falls.
TEST(junctions, smoothing_a_refined_model_raises_the_smallest_shape_and_the_average) {
  for (const auto& [name, kind, dim] :
       {std::tuple{"bracket", EntityKind::curve, 1}, std::tuple{"cam", EntityKind::curve, 1},
        std::tuple{"plate_quarter", EntityKind::curve, 1}, std::tuple{"notched_cube", EntityKind::surface, 2}}) {
    SCOPED_TRACE(name);
    const MeshedModel input = shipped(name);
    Request request{.target = {.kind = kind, .ids = all(input, dim)}};
    const RefineResult plain = refine(input, request);
    request.finish.smooth = true;
    const RefineResult smoothed = checked(input, request);
    EXPECT_EQ(smoothed.report.hexes_after, plain.report.hexes_after);
    EXPECT_GT(smoothed.report.shape_after.min, plain.report.shape_after.min);
    EXPECT_GT(smoothed.report.shape_after.average, plain.report.shape_after.average);
  }
}

}  // namespace
}  // namespace hextwist
