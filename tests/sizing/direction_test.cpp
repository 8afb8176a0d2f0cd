// Refinement in some directions only: across sheets, through the thickness, in layers along a surface.
#include <gtest/gtest.h>

#include <cmath>

#include "hextwist/geom/occ/model.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/sheets.h"
#include "hextwist/patch/refine.h"
#include "hextwist/patch/refine_known.h"
#include "support/analytic_model.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

using test::brick;
using test::refusal;
using test::shipped;

Mesh checked(const MeshedModel& input, const Request& request) {
  const RefineResult result = refine(input, request);
  const MeshedModel& fine = result.refined;
  test::expect_sound(result);
  return fine.mesh;
}

Index edge_between(const Mesh& mesh, const Vec3& p, const Vec3& q) {
  const auto node = [&](const Vec3& at) {
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      if ((mesh.points[n] - at).norm() < 1e-9) return n;
    return Index{-1};
  };
  return find_edge(edges(mesh), node(p), node(q));
}

/// How many hexes have these sides, in any place.
Index count_boxes(const Mesh& mesh, const Vec3& size) {
  Index n = 0;
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    Box box;
    for (const Index node : mesh.hexes[h]) box.add(mesh.points[node]);
    n += (box.max - box.min - size).norm() < 1e-9 && std::abs(volume(mesh, h) - size.prod()) < 1e-9;
  }
  return n;
}

TEST(sheet, is_cut_in_three_across_its_own_direction_only) {
  const MeshedModel input = brick(4, 3, 2);
  const Index along_x = edge_between(input.mesh, {1, 0, 0}, {2, 0, 0});
  const Mesh mesh = checked(input, {.how = AcrossSheets{.edges = {along_x}}});
  EXPECT_EQ(mesh.n_hexes(), 24 + 2 * 6);
  EXPECT_EQ(count_boxes(mesh, {1.0 / 3, 1, 1}), 18);
  EXPECT_EQ(count_boxes(mesh, {1, 1, 1}), 18);
}

TEST(sheet, several_edges_choose_several_sheets) {
  const MeshedModel input = brick(4, 3, 2);
  const Index x = edge_between(input.mesh, {1, 0, 0}, {2, 0, 0}), z = edge_between(input.mesh, {0, 0, 1}, {0, 0, 2});
  const Mesh mesh = checked(input, {.how = AcrossSheets{.edges = {std::min(x, z), std::max(x, z)}}});
  EXPECT_EQ(count_boxes(mesh, {1.0 / 3, 1, 1.0 / 3}), 3 * 9);
  EXPECT_EQ(mesh.n_hexes(), 3 * 9 + 3 * 3 + 9 * 3 + 9);
}

TEST(sheet, crossing_ones_are_those_across_the_other_directions_around_the_edge) {
  const MeshedModel input = brick(4, 3, 2);
  const Index x = edge_between(input.mesh, {1, 0, 0}, {2, 0, 0});  // one hex around it
  const Mesh mesh = checked(input, {.how = AcrossSheets{.edges = {x}, .crossing = true}});
  EXPECT_EQ(mesh.n_hexes(), 4 * (9 + 3 + 3 * 2 + 2));
  EXPECT_EQ(count_boxes(mesh, {1, 1.0 / 3, 1.0 / 3}), 4 * 9);
}

TEST(sheet, greater_than_and_factor_leave_short_edges_alone) {
  MeshedModel input{test::grid(2, 6, 2), nullptr, {}};
  for (Vec3& p : input.mesh.points) p.x() *= 1 + p.y() / 3;  // edges along x from 1 to 3
  FacetResult skin = associate_with_own_skin(input.mesh);
  input.model = skin.model;
  input.association = skin.association;
  const Edges all = edges(input.mesh);
  const Index chosen = find_edge(all, 0, 1);
  const Sheets of = sheets(input.mesh, all);
  const auto pieces = [&](const AcrossSheets& request, double above) {
    const RefineResult result = refine(input, {.how = request});
    EXPECT_TRUE(test::conformal(result.refined.mesh));
    EXPECT_TRUE(test::uninverted(result.refined.mesh));
    const Edges after = edges(result.refined.mesh);
    for (const Index e : of.edges[of.of_edge[chosen]]) {
      const auto [a, b] = all.nodes[e];
      const bool kept = find_edge(after, a, b) >= 0;
      EXPECT_EQ(kept, (input.mesh.points[a] - input.mesh.points[b]).norm() <= above);
    }
    return result.refined.mesh.n_hexes();
  };
  const Index n_all = pieces({.edges = {chosen}}, 0);
  const Index n_some = pieces({.edges = {chosen}, .greater_than = 2.1}, 2.1);
  EXPECT_EQ(pieces({.edges = {chosen}, .factor = 2.1}, 2.1), n_some);
  EXPECT_EQ(n_all, 24 + 2 * 12);
  EXPECT_LT(n_some, n_all + 24);
  EXPECT_EQ(pieces({.edges = {chosen}, .greater_than = 9.0}, 9.0), 24);
}

TEST(sheet, of_shipped_models_can_each_be_cut_alone) {
  for (const char* name : {"ring_twist", "bracket_fillet", "cam"}) {
    SCOPED_TRACE(name);
    const MeshedModel input = shipped(name);
    const Edges all = edges(input.mesh);
    const Sheets of = sheets(input.mesh, all);
    for (Index s = 0; s < of.size(); s += std::max(1, of.size() / 4)) {
      const Mesh mesh = checked(input, {.how = AcrossSheets{.edges = {of.edges[s][0]}}});
      if (of.n_self_crossings[s] == 0) {
        EXPECT_EQ(mesh.n_hexes(), input.mesh.n_hexes() + 2 * static_cast<Index>(of.hexes[s].size())) << s;
      } else {
        EXPECT_GT(mesh.n_hexes(), input.mesh.n_hexes() + 2 * static_cast<Index>(of.hexes[s].size())) << s;
      }
    }
  }
}

TEST(thickness, cuts_the_columns_behind_a_surface_to_the_other_side) {
  const MeshedModel input = brick(3, 3, 2);
  const Mesh mesh = checked(input, {.target = {.kind = EntityKind::surface, .ids = {5}}, .how = Thickness{}});
  EXPECT_EQ(mesh.n_hexes(), 54);
  EXPECT_EQ(count_boxes(mesh, {1, 1, 1.0 / 3}), 54);
  const Mesh twice = checked(input, {.target = {.kind = EntityKind::surface, .ids = {5}}, .how = Thickness{2}});
  EXPECT_EQ(count_boxes(twice, {1, 1, 1.0 / 9}), 162);
}

TEST(thickness, of_one_face_is_its_column_with_a_transition_around) {
  const MeshedModel input = brick(3, 3, 2);
  const Faces all = faces(input.mesh);
  const Index face = find_face(all, {1 + 4, 2 + 4, 1 + 8, 2 + 8});
  const Mesh mesh = checked(input, {.target = {.kind = EntityKind::face, .ids = {face}}, .how = Thickness{}});
  EXPECT_EQ(count_boxes(mesh, {1, 1, 1.0 / 3}), 6);
}

TEST(layers, one_layer_is_what_there_is) {
  const MeshedModel input = brick(3, 3, 3);
  for (const bool smooth : {false, true}) {
    const Request request{.target = {.kind = EntityKind::surface, .ids = {5}},
                          .how = Layers{.n_layers = 1},
                          .finish = {.smooth = smooth}};
    EXPECT_EQ(refine(input, request).refined.mesh, input.mesh);
    EXPECT_EQ(refine(input, measured(input), request).refined.mesh, input.mesh);
  }
}

TEST(layers, grow_from_the_surface_by_the_ratio_within_the_first_element) {
  const MeshedModel input = brick(3, 3, 3);
  for (const double growth : {1.0, 1.5, 3.0}) {
    SCOPED_TRACE(growth);
    const int n = 4;
    const Mesh mesh = checked(input, {.target = {.kind = EntityKind::surface, .ids = {5}}, .how = Layers{n, growth}});
    EXPECT_EQ(mesh.n_hexes(), 27 + 9 * (n - 1));
    double total = 0;
    for (int i = 0; i < n; ++i) total += std::pow(growth, i);
    for (int i = 0; i < n; ++i)
      EXPECT_EQ(count_boxes(mesh, {1, 1, std::pow(growth, i) / total}), growth == 1 ? 36 : 9) << i;
  }
}

TEST(layers, along_curved_and_adjacent_surfaces_of_shipped_models) {
  const MeshedModel plate = shipped("plate_hole");
  const Mesh mesh = checked(plate, {.target = {.kind = EntityKind::surface, .ids = {7}}, .how = Layers{3, 1.4}});
  EXPECT_EQ(mesh.n_hexes(), 672 + 2 * 32 * 3);
  const MeshedModel cylinder = shipped("cylinder");
  checked(cylinder, {.target = {.kind = EntityKind::surface, .ids = {1, 2}}, .how = Layers{3, 1.4}});
}

TEST(direction, options_that_make_no_sense_are_refused) {
  const MeshedModel input = brick(2, 2, 2);
  EXPECT_EQ(refusal(input, {.how = AcrossSheets{}}), "no edge to choose a sheet by");
  EXPECT_EQ(refusal(input, {.how = AcrossSheets{.edges = {54}}}), "there is no edge 55: edge ids go from 1 to 54");
  EXPECT_EQ(refusal(input, {.how = AcrossSheets{.edges = {0}, .greater_than = 1, .factor = 2}}),
            "give greater_than or a factor, not both");
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::curve, .ids = {1}}, .how = Thickness{}}),
            "through the thickness means away from surfaces or faces, not from a curve");
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::hex, .ids = {1}}, .how = Layers{3, 1.5}}),
            "layers lie along nodes, edges and faces, not a hex");
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::surface, .ids = {1}}, .how = Layers{0, 1.5}}),
            "the number of layers must be from 1 to 50");
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::surface, .ids = {1}}, .how = Layers{3, 0}}),
            "the growth of layers must be from 0.1 to 10");
  EXPECT_EQ(refusal(input, {.target = {.kind = EntityKind::surface, .ids = {1}, .depth = 1}, .how = Layers{3, 1.5}}),
            "a direction goes with numsplit, not with sizes, depth, radius or a method");
}

TEST(through_the_thickness, from_the_whole_skin_there_is_no_transition) {
  // A ball of seven blocks: all sheets begin at the skin, so all hexes become 27.
  const MeshedModel input = shipped("sphere");
  const Mesh mesh = checked(input, {.target = {EntityKind::surface, {1}}, .how = Thickness{}});
  EXPECT_EQ(mesh.n_hexes(), 27 * input.mesh.n_hexes());
  const MeshedModel part = brick(4, 3, 2);
  EXPECT_EQ(checked(part, {.target = {EntityKind::surface, {1, 2, 3, 4, 5, 6}}, .how = Thickness{}}).n_hexes(),
            27 * part.mesh.n_hexes());
}

}  // namespace
}  // namespace hextwist
