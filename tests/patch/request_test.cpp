// What a request means: depth, numsplit, techniques, and what is refused.
#include "hextwist/patch/refine.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <numeric>

#include "support/analytic_model.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

using test::brick;
using test::refusal;

RefineResult checked(const MeshedModel& input, const Request& request) {
  RefineResult result = refine(input, request);
  const MeshedModel& fine = result.refined;
  test::expect_sound(result);
  EXPECT_NEAR(volume(fine.mesh), volume(input.mesh), 1e-9 * volume(input.mesh));
  EXPECT_EQ(result.report.hexes_after, fine.mesh.n_hexes());
  EXPECT_EQ(result.report.nodes_after, fine.mesh.n_nodes());
  return result;
}

Index growth(const MeshedModel& input, const Request& request) {
  return checked(input, request).refined.mesh.n_hexes() - input.mesh.n_hexes();
}

TEST(request, depth_counts_layers_of_hexes) {
  const MeshedModel input = brick(7, 7, 7);
  const Index centre = 3 + 7 * (3 + 7 * 3);
  const auto box_growth = [](int n) { return 26 * n * n * n + 12 * 6 * n * n + 4 * 12 * n; };
  EXPECT_EQ(growth(input, {.target = {.kind = EntityKind::hex, .ids = {centre}}}), box_growth(1));
  EXPECT_EQ(growth(input, {.target = {.kind = EntityKind::hex, .ids = {centre}, .depth = 1}}), box_growth(3));
  const Index node = 3 + 8 * (3 + 8 * 3);
  EXPECT_EQ(growth(input, {.target = {.kind = EntityKind::node, .ids = {node}, .depth = 1}}), box_growth(2));
  EXPECT_EQ(growth(input, {.target = {.kind = EntityKind::node, .ids = {node}, .depth = 2}}), box_growth(4));
  EXPECT_EQ(growth(input, {.target = {.kind = EntityKind::hex, .ids = {centre}, .depth = 50}}), 26 * 343);
}

TEST(request, depth_one_of_a_curve_a_surface_and_a_vertex_means_the_hexes_that_touch_them) {
  const MeshedModel input = brick(4, 5, 6);
  // Curve 1 runs along x at y = z = 0: 4 hexes, free neighbours on two sides and one edge.
  EXPECT_EQ(growth(input, {.target = {.kind = EntityKind::curve, .ids = {1}, .depth = 1}}), 4 * (26 + 12 * 2 + 4));
  EXPECT_EQ(growth(input, {.target = {.kind = EntityKind::surface, .ids = {5}, .depth = 1}}), 20 * (26 + 12));
  EXPECT_EQ(growth(input, {.target = {.kind = EntityKind::vertex, .ids = {8}}, .method = Method::single}),
            26 + 12 * 3 + 4 * 3);
}

TEST(request, all_volumes_are_refined_uniformly) {
  const MeshedModel input = brick(2, 3, 2);
  for (const int n : {1, 2, 3, 5}) {
    const RefineResult result = checked(input, {.target = {.kind = EntityKind::volume, .ids = {1}}, .how = Cuts{n}});
    EXPECT_EQ(result.refined.mesh.n_hexes(), 12 * (n + 1) * (n + 1) * (n + 1));
    EXPECT_DOUBLE_EQ(result.report.shape_after.min, result.report.shape_before.min);
  }
}

TEST(request, numsplit_cuts_each_target_edge_in_a_power_of_three) {
  const MeshedModel input = brick(3, 3, 3);
  const RefineResult result = checked(input, {.target = {.kind = EntityKind::hex, .ids = {13}}, .how = Cuts{2}});
  // The target's 729 grandchildren are cubes of side 1/9 in its place.
  Index n = 0;
  for (Index h = 0; h < result.refined.mesh.n_hexes(); ++h)
    n += std::abs(volume(result.refined.mesh, h) - 1.0 / 729) < 1e-12;
  EXPECT_GE(n, 729);
  EXPECT_EQ(n, 729) << "and nothing else is as fine and regular";
}

TEST(request, the_combination_technique_is_depth_zero_and_the_default) {
  const MeshedModel input = brick(6, 5, 4);
  EXPECT_EQ(growth(input, {.target = {.kind = EntityKind::curve, .ids = {1}}}), 10 * 6);
  EXPECT_EQ(growth(input, {.target = {.kind = EntityKind::surface, .ids = {5}, .depth = 0}}), 21 * 30);
  EXPECT_EQ(growth(input, {.target = {.kind = EntityKind::vertex, .ids = {1}, .depth = 0}}), 3);
  // It stays within one original element: hexes two layers away are as they were.
  const Mesh fine = refine(input, {.target = {.kind = EntityKind::surface, .ids = {5}, .depth = 0}}).refined.mesh;
  for (Index h = 0; h < input.mesh.n_hexes(); ++h)
    if (input.mesh.points[input.mesh.hexes[h][0]].z() >= 1) {
      EXPECT_GE(find_hex(fine, h + 1), 0);
    }
}

TEST(request, depth_zero_twice_refines_the_children_of_the_target) {
  const MeshedModel input = brick(4, 3, 3);
  const RefineResult result =
      checked(input, {.target = {.kind = EntityKind::curve, .ids = {1}, .depth = 0}, .how = Cuts{2}});
  Index n = 0;
  for (const int curve : result.refined.association.edge_curve) n += curve == 1;
  EXPECT_EQ(n, 4 * 9);
}

TEST(request, parallel_halves_the_elements_around_the_target) {
  const MeshedModel input = brick(4, 4, 4);
  EXPECT_EQ(
      growth(input, {.target = {.kind = EntityKind::node, .ids = {2 + 5 * (2 + 5 * 2)}}, .method = Method::parallel}),
      24);
  EXPECT_EQ(growth(input, {.target = {.kind = EntityKind::surface, .ids = {5}}, .method = Method::parallel}), 16);
}

TEST(request, smoothing_reaches_the_goals_of_unit_grids_and_moves_no_node_far_away) {
  // Smallest shape after smoothing (goals in the order: hex, node, edge, face, whole side, convex edge row, concave L).
  const MeshedModel input = brick(7, 7, 5);
  const auto node = [](int i, int j, int k) { return i + 8 * (j + 8 * k); };
  const auto hex = [](int i, int j, int k) { return i + 7 * (j + 7 * k); };
  const Edges all = edges(input.mesh);
  const Faces quads = faces(input.mesh);
  const Index edge = find_edge(all, node(3, 3, 2), node(4, 3, 2));
  const Index face = find_face(quads, {node(3, 3, 2), node(4, 3, 2), node(3, 4, 2), node(4, 4, 2)});
  struct Row {
    Request request;
    double goal;
  };
  const std::vector<Row> rows = {
      {{.target = {.kind = EntityKind::hex, .ids = {hex(3, 3, 2)}}}, 0.57},
      {{.target = {.kind = EntityKind::node, .ids = {node(3, 3, 2)}, .depth = 0}}, 0.73},
      {{.target = {.kind = EntityKind::edge, .ids = {edge}, .depth = 0}}, 0.60},
      {{.target = {.kind = EntityKind::face, .ids = {face}, .depth = 0}}, 0.52},
      {{.target = {.kind = EntityKind::surface, .ids = {5}, .depth = 0}}, 0.40},
      {{.target = {.kind = EntityKind::curve, .ids = {1}, .depth = 1}}, 0.42},
      {{.target = {.kind = EntityKind::hex,
                   .ids = {hex(2, 2, 2), hex(3, 2, 2), hex(4, 2, 2), hex(2, 3, 2), hex(2, 4, 2)}}},
       0.46}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(i);
    Request request = rows[i].request;
    request.finish.smooth = true;
    const RefineResult result = checked(input, request);
    EXPECT_GE(result.report.shape_after.min, rows[i].goal);
    if (request.target.kind == EntityKind::hex) {
      EXPECT_EQ(result.refined.mesh.points[node(0, 7, 0)], input.mesh.points[node(0, 7, 0)]);
    }
  }
}

TEST(request, a_dry_run_counts_and_changes_nothing) {
  const MeshedModel input = brick(4, 4, 4);
  const Request request{.target = {.kind = EntityKind::surface, .ids = {1}}, .how = Cuts{2}};
  Request dry = request;
  dry.finish.dry_run = true;
  const RefineResult result = refine(input, dry);
  EXPECT_TRUE(result.refined.mesh.hexes.empty());
  EXPECT_EQ(result.report.hexes_after, refine(input, request).refined.mesh.n_hexes());
}

TEST(request, filling_reports_how_many_hexes_joined) {
  const MeshedModel input = brick(7, 7, 5);
  const auto hex = [](int i, int j, int k) { return i + 7 * (j + 7 * k); };
  Request request{.target = {.kind = EntityKind::hex,
                             .ids = {hex(2, 2, 2), hex(3, 2, 2), hex(4, 2, 2), hex(2, 3, 2), hex(2, 4, 2)}},
                  .concave = Concave::fill};
  const RefineResult result = checked(input, request);
  EXPECT_EQ(result.report.filled_hexes, 4);
  EXPECT_EQ(result.report.hexes_after, 951);
}

TEST(request, what_does_not_exist_is_refused_by_name) {
  const MeshedModel input = brick(2, 2, 2);
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::curve, .ids = {13}}}),
            "there is no curve 13: curve ids go from 1 to 12");
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::hex, .ids = {8}}}),
            "there is no hex 9: hex ids go from 1 to 8");
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::edge, .ids = {999}}}),
            "there is no edge 1000: edge ids go from 1 to 54");
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::face, .ids = {36}}}),
            "there is no face 37: face ids go from 1 to 36");
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::node, .ids = {-1}}}),
            "there is no node 0: node ids go from 1 to 27");
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::hex}}), "no hex to refine");
  EXPECT_EQ(refusal({}, {.target = {.kind = EntityKind::hex, .ids = {0}}}), "there is no mesh to refine");
}

TEST(request, options_out_of_range_are_refused) {
  const MeshedModel input = brick(2, 2, 2);
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::hex, .ids = {0}}, .how = Cuts{0}}),
            "numsplit must be at least 1");
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::hex, .ids = {0}}, .how = Cuts{9}}),
            "numsplit must be at most 8 here");
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::volume, .ids = {1}}, .how = Cuts{30}}),
            "numsplit must be at most 29 here");
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::hex, .ids = {0}, .depth = -1}}),
            "depth must not be negative");
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::hex, .ids = {0}}, .method = Method::combination}),
            "the combination technique refines around nodes, edges and faces, not a hex");
}

TEST(request, a_cancelled_run_throws_and_leaves_the_input) {
  const MeshedModel input = brick(3, 3, 3);
  int n_calls = 0;
  const Progress stop = [&](const char*, double) { return ++n_calls < 3; };
  EXPECT_THROW(refine(input, {.target = {.kind = EntityKind::hex, .ids = {13}}}, stop), Cancelled);
  EXPECT_EQ(n_calls, 3);
}

TEST(request, the_whole_pipeline_gives_the_same_bytes_for_one_two_and_eight_threads) {
  MeshedModel input{test::grid(12, 12, 12), analytic_brick(12, 12, 12), {}};
  input.association = associate(input.mesh, *input.model).association;
  const auto run = [&](int threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return refine(input, {.target = {.kind = EntityKind::curve, .ids = {1, 6, 11}}, .how = Cuts{2}}).refined;
  };
  const MeshedModel one = run(1);
  for (const int threads : {2, 8}) {
    const MeshedModel other = run(threads);
    EXPECT_TRUE(one.mesh == other.mesh);
    EXPECT_EQ(one.association.node_owner, other.association.node_owner);
    EXPECT_EQ(one.association.surface_faces, other.association.surface_faces);
    EXPECT_EQ(one.association.curve_edges, other.association.curve_edges);
  }
}

}  // namespace
}  // namespace hextwist
