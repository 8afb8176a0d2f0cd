// Sizes: what `size`, `bias` and `radius` mean for every kind of target, and how near the result comes to the wish.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hextwist/geom/occ/model.h"
#include "hextwist/io/io.h"
#include "hextwist/sizing/fields/growing.h"
#include "support/analytic_model.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

using test::brick;
using test::centroid;
using test::refusal;
using test::shipped;

constexpr double root3 = std::numbers::sqrt3;

RefineResult checked(const MeshedModel& input, const Request& request) {
  RefineResult result = refine(input, request);
  test::expect_sound(result);
  EXPECT_TRUE(result.report.sizes);
  return result;
}

double size_of(const Mesh& mesh, Index hex) {
  return std::cbrt(volume(mesh, hex));
}

struct KindCase {
  EntityKind kind;
  Index target;
};

// A grid of unit cubes: node, edge, face and hex in its middle, the CAD at its corner x = y = z = 0.
std::vector<KindCase> every_kind(const MeshedModel& input) {
  const auto node = [](int i, int j, int k) { return i + 6 * (j + 6 * k); };
  const Edges all = edges(input.mesh);
  const Faces quads = faces(input.mesh);
  return {{EntityKind::node, node(2, 2, 2)},
          {EntityKind::edge, find_edge(all, node(2, 2, 2), node(3, 2, 2))},
          {EntityKind::face, find_face(quads, {node(2, 2, 2), node(3, 2, 2), node(2, 3, 2), node(3, 3, 2)})},
          {EntityKind::hex, 2 + 5 * (2 + 5 * 2)},
          {EntityKind::vertex, 1},
          {EntityKind::curve, 1},
          {EntityKind::surface, 5},
          {EntityKind::volume, 1}};
}

TEST(size, without_bias_is_met_in_the_hexes_that_the_same_request_by_numsplit_would_cut) {
  const MeshedModel input = brick(5, 5, 5);
  for (const auto& [kind, target] : every_kind(input)) {
    SCOPED_TRACE(name(kind));
    const RefineResult by_size = checked(input, {.target = {.kind = kind, .ids = {target}}, .how = Sizes{.size = 0.4}});
    EXPECT_EQ(by_size.report.sizes->n_passes, 1);
    EXPECT_TRUE(by_size.report.sizes->unmet.empty());
    EXPECT_EQ(by_size.report.sizes->met(), 1);
    for (const double ratio : by_size.report.sizes->ratio) EXPECT_NEAR(ratio, 1 / 3.0 / 0.4, 1e-9);
    if (kind == EntityKind::volume) continue;  // numsplit would be uniform: halves
    const int depth = kind == EntityKind::hex ? 0 : 1;
    const RefineResult by_count = refine(input, {.target = {.kind = kind, .ids = {target}, .depth = depth}});
    EXPECT_TRUE(by_size.refined.mesh == by_count.refined.mesh);
  }
}

TEST(size, with_a_bias_grows_with_the_distance_from_every_kind_of_target) {
  const MeshedModel input = brick(5, 5, 5);
  for (const auto& [kind, target] : every_kind(input)) {
    SCOPED_TRACE(name(kind));
    const double size = kind == EntityKind::volume ? 0.4 : 0.1;  // the whole mesh at 0.1 is no test of bias
    const RefineResult result =
        checked(input, {.target = {.kind = kind, .ids = {target}}, .how = Sizes{.size = size, .bias = 1.5}});
    const TargetDistance distance(input, kind, std::array{target});
    const Mesh& mesh = result.refined.mesh;
    // No hex anywhere is larger than it should be.
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      const Vec3 at = centroid(mesh, h);
      double d = 0;
      distance.evaluate({&at, 1}, {&d, 1});
      EXPECT_LE(size_of(mesh, h), root3 * (size + 0.5 * d) * (1 + 1e-9)) << h;
    }
    EXPECT_TRUE(result.report.sizes->unmet.empty());
    EXPECT_EQ(result.report.sizes->n_coarser, 0);
  }
}

TEST(size, that_is_met_already_changes_nothing) {
  const MeshedModel input = brick(3, 3, 3);
  for (const double size : {1.0, 0.6, 5.0}) {
    const RefineResult result =
        checked(input, {.target = {.kind = EntityKind::curve, .ids = {1}}, .how = Sizes{.size = size}});
    EXPECT_TRUE(result.refined.mesh == input.mesh);
    EXPECT_EQ(result.report.sizes->n_passes, 0);
  }
}

TEST(size, that_no_memory_could_hold_is_refused_before_anything_is_cut) {
  const MeshedModel input = brick(3, 3, 3);
  for (const auto& [kind, size] : {std::pair(EntityKind::hex, 1e-4), std::pair(EntityKind::surface, 1e-6),
                                   std::pair(EntityKind::curve, 1e-3)}) {  // where all of its hexes get that size
    Request request{.target = {.kind = kind, .ids = {1}}, .how = Sizes{.size = size}};
    int n_passes = 0;
    const auto count = [&](std::string_view stage, double) {
      n_passes += stage == "split";
      return true;
    };
    try {
      refine(input, request, count);
      ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).rfind("the refined mesh would have at least ", 0), 0u) << error.what();
    }
    EXPECT_EQ(n_passes, 0);
  }
}

TEST(size, stops_at_the_limit_of_passes_and_names_what_is_too_large) {
  const MeshedModel input = brick(3, 3, 3);
  const RefineResult result =
      checked(input, {.target = {.kind = EntityKind::hex, .ids = {13}}, .how = Sizes{.size = 0.01, .max_passes = 1}});
  EXPECT_EQ(result.report.sizes->n_passes, 1);
  EXPECT_EQ(result.report.sizes->unmet.size(), 27u);
  for (const Index h : result.report.sizes->unmet) EXPECT_GT(size_of(result.refined.mesh, h), root3 * 0.01);
}

TEST(size, reaches_no_further_than_the_depth) {
  const MeshedModel input = brick(7, 7, 7);
  const Index centre = 3 + 7 * (3 + 7 * 3);
  const auto finest_at = [&](const Mesh& mesh, const Vec3& low, const Vec3& high) {
    Index n = 0;
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      const Vec3 at = centroid(mesh, h);
      n += (at - low).minCoeff() > 0 && (high - at).minCoeff() > 0 && std::abs(size_of(mesh, h) - 1 / 3.0) < 1e-9;
    }
    return n;
  };
  for (const int depth : {0, 1, 2}) {
    const Request request{.target = {.kind = EntityKind::hex, .ids = {centre}, .depth = depth},
                          .how = Sizes{.size = 0.4}};
    const Vec3 low = Vec3::Constant(3 - depth), high = Vec3::Constant(4 + depth);
    EXPECT_EQ(finest_at(checked(input, request).refined.mesh, low, high), 27 * std::pow(1 + 2 * depth, 3));
  }
  const Request biased{.target = {.kind = EntityKind::hex, .ids = {centre}, .depth = 1},
                       .how = Sizes{.size = 0.1, .bias = 1.2}};
  const Mesh mesh = checked(input, biased).refined.mesh;
  for (Index h = 0; h < input.mesh.n_hexes(); ++h) {
    const Vec3 away = (centroid(input.mesh, h) - Vec3::Constant(3.5)).cwiseAbs();
    if (away.maxCoeff() > 2.1) {
      EXPECT_GE(find_hex(mesh, h + 1), 0) << "hexes beyond the transition are as they were";
    }
  }
}

TEST(radius, takes_the_hexes_whose_centroids_are_that_near_to_the_entity_itself) {
  const MeshedModel input = brick(6, 6, 6);
  // Curve 1 runs along x at y = z = 0; centroids lie at half-integers.
  for (const double radius : {0.75, 1.6, 2.2}) {
    Index n = 0;
    std::vector<Index> expected;
    for (Index h = 0; h < input.mesh.n_hexes(); ++h) {
      const Vec3 at = centroid(input.mesh, h);
      if (std::hypot(at.y(), at.z()) <= radius) expected.push_back(h);
    }
    ASSERT_FALSE(expected.empty()) << n;
    const Mesh by_radius =
        refine(input, {.target = {.kind = EntityKind::curve, .ids = {1}, .radius = radius}}).refined.mesh;
    const Mesh by_hex = refine(input, {.target = {.kind = EntityKind::hex, .ids = expected}}).refined.mesh;
    EXPECT_TRUE(by_radius == by_hex);
  }
}

TEST(radius, works_for_every_kind_of_target) {
  const MeshedModel input = brick(5, 5, 5);
  for (const auto& [kind, target] : every_kind(input)) {
    SCOPED_TRACE(name(kind));
    const TargetDistance distance(input, kind, std::array{target});
    std::vector<Index> expected;
    for (Index h = 0; h < input.mesh.n_hexes(); ++h) {
      const Vec3 at = centroid(input.mesh, h);
      double d = 0;
      distance.evaluate({&at, 1}, {&d, 1});
      if (d <= 1.2) expected.push_back(h);
    }
    const RefineResult by_radius =
        checked(input, {.target = {.kind = kind, .ids = {target}, .radius = 1.2}, .how = Sizes{.size = 0.4}});
    EXPECT_EQ(by_radius.report.sizes->met(), 1);
    const Mesh by_hex = refine(input, {.target = {.kind = EntityKind::hex, .ids = expected}}).refined.mesh;
    EXPECT_TRUE(by_radius.refined.mesh == by_hex);
  }
}

TEST(size, options_that_make_no_sense_together_are_refused) {
  const MeshedModel input = brick(2, 2, 2);
  const auto with = [&](auto change) {
    Request request{.target = {.kind = EntityKind::curve, .ids = {1}}};
    change(request);
    return refusal(input, request);
  };
  EXPECT_EQ(with([](Request& r) { r.how = Sizes{.size = 0.0}; }), "size must be a positive number");
  EXPECT_EQ(with([](Request& r) { r.how = Sizes{.size = std::nan("")}; }), "size must be a positive number");
  EXPECT_EQ(with([](Request& r) { r.how = Sizes{.bias = 1.5}; }),
            "a bias other than 1 needs a size or a sizing function to grow from");
  EXPECT_EQ(with([](Request& r) { r.how = Sizes{.size = 1, .bias = 0.5}; }), "bias must be a number of at least 1");
  EXPECT_EQ(with([](Request& r) { r.target.radius = -1; }), "radius must be a number of at least 0");
  EXPECT_EQ(with([](Request& r) { r.target.radius = 1, r.target.depth = 1; }), "give a depth or a radius, not both");
  EXPECT_EQ(with([](Request& r) { r.target.radius = 1, r.method = Method::combination; }),
            "a radius chooses whole hexes, the combination technique refines around nodes, edges and faces");
  EXPECT_EQ(with([](Request& r) { r.how = Sizes{.size = 1}, r.target.depth = 0, r.method = Method::parallel; }),
            "sizes by one into eight need whole hexes to be cut: depth 1 or more");
  EXPECT_EQ(with([](Request& r) { r.how = Sizes{.size = 1}, r.target.depth = 0, r.method = Method::single; }),
            "the single sheet technique refines whole hexes: it needs depth 1 or more");
  EXPECT_EQ(with([](Request& r) { r.how = Sizes{.size = 1}, r.target.depth = 1, r.method = Method::combination; }),
            "the combination technique has depth 0");
  EXPECT_EQ(with([](Request& r) { r.how = Sizes{.size = 1, .coarsen = true}, r.transition = Transition::nested; }),
            "sizes become coarser by levels only: not with a nested transition or filled regions");
  EXPECT_EQ(with([](Request& r) {
              r.target.kind = EntityKind::volume, r.how = Sizes{.size = 1}, r.method = Method::combination;
            }),
            "the combination technique refines around nodes, edges and faces, not a volume");
  EXPECT_EQ(with([](Request& r) { r.how = Sizes{.size = 1, .max_passes = 0}; }), "max_passes must be from 1 to 30");
  EXPECT_EQ(with([](Request& r) { r.target.radius = 0.1; }),
            "no hex has its centroid within 0.100000 of the target: the nearest is 0.707107 away");
}

struct Part {
  const char* name;
  Index curve;
  double size;
};

void PrintTo(const Part& part, std::ostream* out) {
  *out << part.name << " curve " << part.curve << " size " << part.size;
}

TEST(size, is_met_by_the_hexes_at_every_curve_of_the_plate_and_the_bracket) {
  for (const char* part : {"plate_hole", "bracket_fillet"}) {
    const MeshedModel input = shipped(part);
    for (Index curve = 1; curve <= input.model->count(1); ++curve)
      for (const double size : {2.0, 1.0, 0.5}) {
        SCOPED_TRACE(std::string(part) + " curve " + std::to_string(curve) + " size " + std::to_string(size));
        const Request request{.target = {.kind = EntityKind::curve, .ids = {curve}},
                              .how = Sizes{.size = size, .bias = 1.5}};
        const MeshedModel fine = std::move(refine(input, request).refined);
        EXPECT_TRUE(test::uninverted(fine.mesh));
        std::vector<char> on_curve(fine.mesh.points.size(), 0);
        for (std::size_t i = 0; i < fine.association.curve_edges.size(); ++i)
          if (fine.association.edge_curve[i] == curve)
            for (const Index n : fine.association.curve_edges[i]) on_curve[n] = 1;
        int n_at_curve = 0, n_met = 0;
        for (Index h = 0; h < fine.mesh.n_hexes(); ++h) {
          if (std::ranges::none_of(fine.mesh.hexes[h], [&](Index n) { return on_curve[n] != 0; })) continue;
          const double away = fine.model->project({1, curve}, centroid(fine.mesh, h)).distance;
          const double ratio = size_of(fine.mesh, h) / (size + 0.5 * away);
          ++n_at_curve;
          n_met += ratio <= root3 * (1 + 1e-9) && ratio >= 1 / root3;
          EXPECT_GE(ratio, 1 / 3.0) << "hex " << h;
        }
        EXPECT_GT(n_at_curve, 0);
        EXPECT_GE(n_met, 0.9 * n_at_curve) << n_met << " of " << n_at_curve;
      }
  }
}

class size_on_cad : public testing::TestWithParam<Part> {};

TEST_P(size_on_cad, is_met_by_nine_tenths_and_no_hex_is_finer_by_more_than_three) {
  const auto [part, curve, size] = GetParam();
  const MeshedModel input = shipped(part);
  const RefineResult result =
      checked(input, {.target = {.kind = EntityKind::curve, .ids = {curve}}, .how = Sizes{.size = size, .bias = 1.5}});
  const SizeReport& sizes = *result.report.sizes;
  EXPECT_GE(sizes.met(), 0.9);
  EXPECT_EQ(sizes.n_coarser, 0);
  EXPECT_EQ(sizes.n_much_finer, 0);
  EXPECT_TRUE(sizes.unmet.empty());
  // The edges on the curve itself are as wished.
  const Association& association = result.refined.association;
  for (std::size_t i = 0; i < association.curve_edges.size(); ++i)
    if (association.edge_curve[i] == curve) {
      const auto [a, b] = association.curve_edges[i];
      EXPECT_LE((result.refined.mesh.points[a] - result.refined.mesh.points[b]).norm(), root3 * size * (1 + 1e-9));
    }
}

INSTANTIATE_TEST_SUITE_P(parts, size_on_cad,
                         testing::Values(Part{"plate_hole", 10, 1}, Part{"plate_hole", 10, 0.6},
                                         Part{"plate_hole", 14, 0.35}, Part{"plate_hole", 5, 2},
                                         Part{"plate_hole", 5, 0.6}, Part{"bracket_fillet", 1, 0.35},
                                         Part{"bracket_fillet", 1, 0.2}, Part{"bracket_fillet", 5, 0.2},
                                         Part{"bracket_fillet", 22, 0.2}, Part{"bracket_fillet", 30, 0.2}));

}  // namespace
}  // namespace hextwist
