// Refinement by levels: how many hexes, how good, and that nothing but regular cells is ever cut.
#include <random>

#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/refine/carry.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/place.h"
#include "hextwist/refine/templates/trisect.h"
#include "refine/levels_fixture.h"
#include "support/association_checkers.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/same_meshed.h"

namespace hextwist {
namespace {

using test::Grown;

double smallest_scaled_jacobian(const Mesh& mesh) {
  return summarize(quality(Metric::scaled_jacobian, mesh)).min;
}

std::vector<Index> hexes_where(const Mesh& mesh, const std::function<bool(const Vec3&)>& wanted) {
  std::vector<Index> hexes;
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (wanted(test::centroid(mesh, h))) hexes.push_back(h);
  return hexes;
}

/// No pass cut anything but regular cells of the level before, those of the pass before it with all corners marked.
testing::AssertionResult cut_regular_cells_only(const LevelStack& stack) {
  for (std::size_t k = 1; k < stack.size(); ++k) {
    const auto& parents = stack[k - 1]->lineage.hexes;
    for (const CutHex& cut : stack[k]->lineage.hexes) {
      const auto parent = std::ranges::upper_bound(parents, cut.hex, {}, &CutHex::first_child);
      if (parent == parents.begin() || std::prev(parent)->code != trisect_all)
        return testing::AssertionFailure()
               << "pass " << k + 1 << " cut hex " << cut.hex << ", which is no regular cell";
    }
  }
  return testing::AssertionSuccess();
}

testing::AssertionResult sound(const Grown& grown) {
  const Mesh& mesh = grown.mesh.mesh;
  for (const auto& result : {test::conformal(mesh), test::uninverted(mesh), test::sets_valid(mesh),
                             test::on_model(mesh, grown.mesh.association, *grown.mesh.model, 1e-6),
                             test::complete(mesh, grown.mesh.association, *grown.mesh.model),
                             cut_regular_cells_only(grown.forest.grown->stack)})
    if (!result) return result;
  return testing::AssertionSuccess();
}

/// Refines hexes n levels at once.
void expect_reached(MeshedModel base, const std::vector<Index>& hexes, int levels, double most_hexes,
                    double least_quality, bool check_all = true) {
  Grown grown(std::move(base));
  grown.refine(hexes, levels);
  const Mesh& mesh = grown.mesh.mesh;
  EXPECT_LE(mesh.n_hexes(), most_hexes);
  EXPECT_GE(smallest_scaled_jacobian(mesh), least_quality);
  EXPECT_TRUE(cut_regular_cells_only(grown.forest.grown->stack));
  if (check_all) {
    EXPECT_TRUE(sound(grown));
  }
}

TEST(Levels, children_of_a_whole_cell_are_numbered_by_their_layers_and_lie_as_their_parent_does) {
  const HexTemplate& whole = trisect_table()->hex(trisect_all);
  const std::vector<Vec3> places = trisect_table()->positions(trisect_all);
  for (int child = 0; child < n_cell_children; ++child)
    for (int c = 0; c < 8; ++c)
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(3 * places[whole.children[child][c]][axis], cell_layer(child, axis) + (c >> axis & 1), 1e-12);
}

/// Hexes that the same targets end with when each pass cuts all children of the last one's targets.
Index n_nested(const Mesh& base, std::vector<Index> targets, int levels) {
  std::vector<Hex> hexes = base.hexes;
  Index n_nodes = base.n_nodes();
  for (int level = 0; level < levels; ++level) {
    std::vector<std::uint8_t> marked(static_cast<std::size_t>(n_nodes), 0), is_target(hexes.size(), 0);
    mark_nodes(hexes, targets, marked);
    for (const Index h : targets) is_target[h] = 1;
    const Split parts = split(hexes, n_nodes, trisect_table(), trisect_codes(hexes, marked));
    targets.clear();
    for (Index h = parts.n_kept(); h < static_cast<Index>(parts.hexes.size()); ++h)
      if (is_target[parts.lineage.parent[h]]) targets.push_back(h);
    n_nodes = parts.n_nodes;
    hexes = parts.hexes;
  }
  return static_cast<Index>(hexes.size());
}

TEST(Levels, single_hex_keeps_its_quality) {
  expect_reached(test::brick(5, 5, 5), {62}, 1, 271, 0.477);
  expect_reached(test::brick(5, 5, 5), {62}, 2, 3113, 0.477);
  expect_reached(test::brick(5, 5, 5), {62}, 3, 32127, 0.477);
}
TEST(Levels, single_hex_keeps_its_quality_for_four_levels) {
  expect_reached(test::brick(5, 5, 5), {62}, 4, 616400, 0.477, false);
}
TEST(Levels, three_hexes_in_an_L_keep_their_quality) {
  expect_reached(test::brick(7, 7, 7), {171, 172, 178}, 2, 6767, 0.405);
  expect_reached(test::brick(7, 7, 7), {171, 172, 178}, 3, 85300 * 1.02, 0.405, false);
}
TEST(Levels, line_of_hexes_keeps_its_quality) {
  const MeshedModel brick = test::brick(7, 5, 5);
  const auto line = hexes_where(brick.mesh, [](const Vec3& p) { return p.y() == 2.5 && p.z() == 2.5; });
  ASSERT_EQ(line.size(), 7u);
  expect_reached(brick, line, 2, 11207, 0.477);
  expect_reached(brick, line, 3, 183000 * 1.02, 0.477, false);
}
TEST(Levels, surface_keeps_its_quality) {
  const MeshedModel brick = test::brick(8, 8, 4);
  const auto layer = hexes_where(brick.mesh, [](const Vec3& p) { return p.z() < 1; });
  expect_reached(brick, layer, 3, 1.347e6 * 1.02, 0.477, false);
}

/// Hexes of a brick of unit cubes that a sphere of radius 2.2 goes through.
std::vector<Index> front(const Mesh& brick, const Vec3& centre) {
  std::vector<Index> hexes;
  for (Index h = 0; h < brick.n_hexes(); ++h) {
    const Vec3 middle = test::centroid(brick, h);
    const Vec3 away = (middle - centre).cwiseAbs();
    const double nearest = (away.array() - 0.5).max(0).matrix().norm(), farthest = (away.array() + 0.5).matrix().norm();
    if (nearest < 2.2 && farthest > 2.2) hexes.push_back(h);
  }
  return hexes;
}

TEST(Levels, sphere_front_keeps_its_quality) {
  const MeshedModel brick = test::brick(10, 10, 10);
  const std::vector<Index> hexes = front(brick.mesh, {5, 5, 5});
  const double nested = n_nested(brick.mesh, hexes, 3);
  expect_reached(brick, hexes, 3, nested * 1.63 / 1.58 * 1.02, 0.405, false);
}

TEST(Levels, moving_front_has_what_a_fresh_refinement_has) {
  Grown grown(test::brick(10, 10, 10));
  const Mesh base = grown.mesh.mesh;
  for (int i = 0; i < 10; ++i) {
    const std::vector<Index> hexes = front(base, {2.75 + 0.5 * i, 5, 5});
    std::vector<std::uint8_t> wanted(base.hexes.size(), 0);
    for (const Index h : hexes) wanted[h] = 2;
    const std::vector<int> levels = grown.levels();
    const std::vector<Index> roots = grown.roots();
    grown.adapt([&](Index h) { return wanted[roots[h]] - levels[h]; });
    Grown fresh(test::brick(10, 10, 10));
    fresh.refine(hexes, 2);
    EXPECT_LE(grown.mesh.mesh.n_hexes(), fresh.mesh.mesh.n_hexes() * 1.05);
    EXPECT_GE(smallest_scaled_jacobian(grown.mesh.mesh), 0.405);
    EXPECT_TRUE(cut_regular_cells_only(grown.forest.grown->stack));
  }
  EXPECT_TRUE(sound(grown));
}

/// As a solver does it: pieces at the front become finer by one level up to two, all others may go.
void follow_front(Grown& grown, const Vec3& centre) {
  for (int pass = 0; pass < 2; ++pass) {
    const Mesh& mesh = grown.mesh.mesh;
    const std::vector<int> levels = grown.levels();
    std::vector<std::uint8_t> wanted(mesh.hexes.size(), 0);
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      double nearest = 1e9, farthest = 0;
      for (const Index n : mesh.hexes[h]) {
        nearest = std::min(nearest, (mesh.points[n] - centre).norm());
        farthest = std::max(farthest, (mesh.points[n] - centre).norm());
      }
      if (nearest < 2.2 && farthest > 2.2) wanted[h] = static_cast<std::uint8_t>(std::min(levels[h] + 1, 2));
    }
    grown.set(wanted);
  }
}

TEST(Levels, front_that_refines_and_coarsens_hex_by_hex_stays_as_small_as_a_fresh_one) {
  Grown grown(test::brick(10, 10, 10));
  for (int i = 0; i < 10; ++i) {
    follow_front(grown, {2.75 + 0.5 * i, 5, 5});
    Grown fresh(test::brick(10, 10, 10));
    follow_front(fresh, {2.75 + 0.5 * i, 5, 5});
    EXPECT_LE(grown.mesh.mesh.n_hexes(), fresh.mesh.mesh.n_hexes() * 1.05);
    EXPECT_GE(smallest_scaled_jacobian(grown.mesh.mesh), 0.405);
  }
  EXPECT_TRUE(sound(grown));
}

TEST(Levels, curve_on_cad_keeps_its_quality) {
  const MeshedModel cam = test::shipped("cam");
  std::vector<std::uint8_t> on_curve(cam.mesh.points.size(), 0);
  for (std::size_t i = 0; i < cam.association.curve_edges.size(); ++i)
    if (cam.association.edge_curve[i] == 1)
      for (const Index n : cam.association.curve_edges[i]) on_curve[n] = 1;
  const std::vector<Index> hexes = touching_hexes(cam.mesh.hexes, on_curve);
  expect_reached(cam, hexes, 1, n_nested(cam.mesh, hexes, 1), 0.37);
  expect_reached(cam, hexes, 3, n_nested(cam.mesh, hexes, 3) * 1.04, 0.35, false);
}

TEST(Levels, one_level_is_one_trisecting_pass) {
  for (const char* name : {"cam", "inclusion", "bracket"}) {
    const MeshedModel base = test::shipped(name);
    std::mt19937 random(3);
    std::vector<Index> hexes;
    for (Index h = 0; h < base.mesh.n_hexes(); ++h)
      if (random() % 40 == 0) hexes.push_back(h);
    std::vector<std::uint8_t> marked(base.mesh.points.size(), 0);
    mark_nodes(base.mesh.hexes, hexes, marked);
    Split parts = split(base.mesh.hexes, base.mesh.n_nodes(), trisect_table(), trisect_codes(base.mesh.hexes, marked));
    Carried carried = carry(base.mesh, base.association, parts);
    place(base.mesh, base.association, parts, *base.model, carried.mesh, carried.association);
    repair_children(base.mesh, parts, base.model.get(), carried.mesh, carried.association);
    Grown grown(base);
    grown.refine(hexes);
    EXPECT_TRUE(test::same_bits(grown.mesh, {carried.mesh, base.model, carried.association})) << name;
  }
}

}  // namespace
}  // namespace hextwist
