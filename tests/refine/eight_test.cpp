// One into eight by itself: the markings it stands on, and what is decided about regions.
#include "hextwist/refine/plans/eight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "hextwist/refine/marks.h"
#include "hextwist/refine/plans/eight_internal.h"
#include "hextwist/refine/split.h"
#include "hextwist/refine/templates/enclose.h"
#include "support/grids.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

TEST(eight, a_box_marking_stays_one_on_all_children_of_a_hex_split_by_another) {
  std::vector<std::uint16_t> box;
  for (int mask = 0; mask < 255; ++mask)
    if (is_box_marking(mask)) box.push_back(static_cast<std::uint16_t>(mask));
  ASSERT_EQ(box.size(), 1 + 8 + 12 + 6);
  const auto table = enclose_table(EncloseAt::half);
  const std::vector<Hex> cube = {{0, 1, 2, 3, 4, 5, 6, 7}};
  for (const std::uint16_t first : box) {
    ASSERT_TRUE(has_enclosing_template(first));
    const std::vector<std::uint16_t> codes = {first};
    const Split parts = split(cube, 8, table, codes);
    for (const std::uint16_t second : box) {
      std::vector<std::uint8_t> marked(8);
      for (int c = 0; c < 8; ++c) marked[c] = second >> c & 1;
      carry_marks(parts.lineage, cube, parts.n_nodes, marked);
      for (const Hex& hex : parts.hexes) {
        int mask = 0;
        for (int c = 0; c < 8; ++c) mask |= marked[hex[c]] << c;
        EXPECT_TRUE(is_box_marking(mask)) << first << " then " << second << ": " << mask;
      }
    }
  }
}

EightRegion only_region(const Mesh& mesh, const std::vector<Index>& targets) {
  const EightPlan plan = plan_eight(mesh, targets);
  EXPECT_EQ(plan.regions.size(), 1U);
  return plan.regions.front();
}

std::vector<Index> all_hexes(const Mesh& mesh) {
  std::vector<Index> result(mesh.hexes.size());
  std::iota(result.begin(), result.end(), 0);
  return result;
}

TEST(eight, a_block_in_a_grid_is_structured_and_takes_three_passes) {
  std::mt19937 random(1);
  const Mesh mesh = test::grid(6, 6, 6);
  std::vector<Index> targets;
  for (int k = 2; k < 4; ++k)
    for (int j = 1; j < 4; ++j)
      for (int i = 1; i < 5; ++i) targets.push_back(i + 6 * (j + 6 * k));
  const EightRegion region = only_region(mesh, targets);
  EXPECT_TRUE(region.eight) << region.reason;
  EXPECT_EQ(region.first_hex, targets.front());
  EXPECT_EQ(region.n_hexes, 24);
  EXPECT_EQ(region.n_exact, 24);
  EXPECT_EQ(region.n_passes, 3);
  EXPECT_EQ(region.n_sheets, 4 + 3 + 2);
  EXPECT_EQ(region.n_irregular_edges, 0);
  EXPECT_EQ(region.n_added_nodes, 0);
}

TEST(eight, sheets_that_diverge_need_more_passes_unless_their_number_is_even) {
  // Around an irregular edge of valence v a sheet parts from its neighbour; with v even they can still take turns.
  for (const int valence : {3, 4, 5, 6, 8}) {
    SCOPED_TRACE(valence);
    const Mesh mesh = test::pinwheel(valence, 3, 5);
    std::vector<Index> targets;  // all hexes that touch the inner layers' irregular line
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      double r = 0, low = 1e9, high = -1e9;
      for (const Index n : mesh.hexes[h]) {
        r = std::max(r, mesh.points[n].head<2>().norm());
        low = std::min(low, mesh.points[n].z());
        high = std::max(high, mesh.points[n].z());
      }
      if (r < 2.1 && low > 0.5 && high < 4.5) targets.push_back(h);
    }
    ASSERT_FALSE(targets.empty());
    const EightRegion region = only_region(mesh, targets);
    EXPECT_EQ(region.n_irregular_edges > 0, valence != 4);
    EXPECT_EQ(region.n_self_crossing, 0);
    if (valence % 2 == 0) {
      EXPECT_TRUE(region.eight) << region.reason;
      EXPECT_EQ(region.n_passes, 3);
      EXPECT_EQ(region.n_exact, region.n_hexes);
    }
  }
}

TEST(eight, a_ring_with_nothing_around_it_is_halved_whatever_its_sheets_do) {
  for (const int turns : {0, 1, 2, 3}) {
    const Mesh mesh = test::ring(2, 7, turns);
    const EightPlan plan = plan_eight(mesh, all_hexes(mesh));
    ASSERT_EQ(plan.regions.size(), 1U);
    EXPECT_TRUE(plan.regions[0].alone);
    EXPECT_TRUE(plan.regions[0].eight);
    EXPECT_EQ(plan.alone, all_hexes(mesh));
    EXPECT_TRUE(plan.passes.empty() && plan.thirds.empty() && plan.trisected.empty());
  }
}

TEST(eight, a_ring_within_a_ring_is_halved_around_when_its_number_of_layers_is_even) {
  for (const int n : {6, 7}) {
    SCOPED_TRACE(n);
    const Mesh mesh = test::ring(4, n, 0);
    std::vector<Index> targets;  // the lower inner quarter of each section
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) targets.push_back(i + 4 * (j + 4 * k));
    const EightRegion region = only_region(mesh, targets);
    EXPECT_TRUE(region.eight) << region.reason;
    EXPECT_EQ(region.n_passes, 3);
    EXPECT_EQ(region.n_in_three, n % 2);
    EXPECT_EQ(region.n_exact, 4 * (n - n % 2));
  }
}

TEST(eight, of_a_marking_and_its_opposite_the_one_that_touches_less_outside_is_taken) {
  std::mt19937 random(17);
  int n_asked = 0, n_nearly_alike = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Mesh rugged = test::grid(5, 5, 5);  // so that what is touched differs by a hex here and there
    std::erase_if(rugged.hexes, [&](const Hex&) { return random() % 3 == 0; });
    const Mesh mesh = test::shuffled(rugged, random);
    std::vector<Index> targets = {static_cast<Index>(random() % mesh.hexes.size())};
    std::vector<char> is_target(mesh.hexes.size(), 0), in_region(mesh.points.size(), 0);
    const Faces all = faces(mesh);
    for (int step = 0; step < 20; ++step) {
      const Index at = targets[random() % targets.size()];
      const auto& sides = all.sides[all.of_hex[at][random() % 6]];
      const Index other = sides[sides[0].hex == at].hex;
      if (other >= 0 && std::ranges::find(targets, other) == targets.end()) targets.push_back(other);
    }
    std::ranges::sort(targets);
    for (const Index h : targets) {
      is_target[h] = 1;
      for (const Index n : mesh.hexes[h]) in_region[n] = 1;
    }
    const EightPlan plan = plan_eight(mesh, targets);
    if (plan.regions.size() != 1 || !plan.regions[0].eight || plan.regions[0].n_added_nodes > 0) continue;
    for (const std::vector<std::uint8_t>& marked : plan.passes) {
      std::array<std::pair<int, int>, 2> touched{};  // hexes outside and their nodes, by marking
      for (Index h = 0; h < mesh.n_hexes(); ++h) {
        if (is_target[h]) continue;
        std::array<int, 2> n{};
        for (const Index node : mesh.hexes[h])
          if (in_region[node]) ++n[marked[node] != 0];
        for (int side = 0; side < 2; ++side) {
          touched[side].first += n[side] > 0;
          touched[side].second += n[side];
        }
      }
      EXPECT_LE(touched[1], touched[0]) << trial;
      n_asked += touched[1] != touched[0];
      n_nearly_alike += touched[1] != touched[0] && touched[1].first + 1 >= touched[0].first;
    }
  }
  EXPECT_GT(n_asked, 100);
  EXPECT_GT(n_nearly_alike, 10);
}

TEST(eight, a_shell_around_a_ring_has_two_ways_around_each_with_a_layer_too_many) {
  for (const std::array<int, 2>& n : {std::array{7, 5}, {7, 6}, {8, 5}, {8, 6}}) {
    SCOPED_TRACE(std::to_string(n[0]) + " x " + std::to_string(n[1]));
    constexpr int n_layers = 3;
    Mesh mesh;  // around the ring, around its section, outwards
    const auto node = [&](int i, int j, int k) { return k + (n_layers + 1) * (j % n[1] + n[1] * (i % n[0])); };
    for (int i = 0; i < n[0]; ++i)
      for (int j = 0; j < n[1]; ++j)
        for (int k = 0; k <= n_layers; ++k) {
          const double a = 2 * std::numbers::pi * i / n[0], b = 2 * std::numbers::pi * j / n[1], r = 2 + k;
          mesh.points.emplace_back((10 + r * std::cos(b)) * std::cos(a), (10 + r * std::cos(b)) * std::sin(a),
                                   r * std::sin(b));
        }
    std::vector<Index> middle;
    for (int i = 0; i < n[0]; ++i)
      for (int j = 0; j < n[1]; ++j)
        for (int k = 0; k < n_layers; ++k) {
          if (k == 1) middle.push_back(mesh.n_hexes());
          Hex& hex = mesh.hexes.emplace_back();
          for (int c = 0; c < 8; ++c) hex[c] = node(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
        }
    const EightRegion region = only_region(mesh, middle);
    EXPECT_TRUE(region.eight) << region.reason;
    EXPECT_EQ(region.n_passes, 3);
    EXPECT_EQ(region.n_in_three, n[0] % 2 + n[1] % 2);
    EXPECT_EQ(region.n_exact, (n[0] - n[0] % 2) * (n[1] - n[1] % 2));
  }
}

TEST(eight, regions_near_each_other_are_enclosed_one_after_the_other_in_no_more_than_four_rounds) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937 random(seed);
    const Mesh mesh = test::shuffled(test::grid(12, 12, 12), random);
    std::vector<Index> order = all_hexes(mesh), targets;
    std::ranges::shuffle(order, random);
    std::vector<char> taken(mesh.points.size(), 0);
    for (const Index h : order) {  // single hexes as near to each other as they can be
      if (std::ranges::any_of(mesh.hexes[h], [&](Index n) { return taken[n] != 0; })) continue;
      for (const Index n : mesh.hexes[h]) taken[n] = 1;
      targets.push_back(h);
    }
    std::ranges::sort(targets);
    const EightPlan plan = plan_eight(mesh, targets);
    EXPECT_EQ(plan.passes.size(), 4U * 3) << seed;
    std::size_t n_eight = 0;
    for (const EightRegion& region : plan.regions) {
      n_eight += region.eight;
      EXPECT_EQ(region.reason, region.eight ? "" : "it lies too near to other regions") << seed;
    }
    EXPECT_GT(n_eight, 100U) << seed;
    EXPECT_GT(plan.trisected.size(), 10U) << "a fifth round would have been wanted, " << seed;
    EXPECT_EQ(n_eight + plan.trisected.size(), targets.size()) << seed;
  }
}

TEST(eight, a_region_whose_sheets_cross_themselves_gets_27) {
  // Turned by a quarter: the sheets of a section are joined with those across them, once around.
  const Mesh mesh = test::ring(4, 8, 1);
  std::vector<Index> targets;  // the inner 2 x 2 hexes of each section
  for (int k = 0; k < 8; ++k)
    for (int j = 1; j < 3; ++j)
      for (int i = 1; i < 3; ++i) targets.push_back(i + 4 * (j + 4 * k));
  const EightPlan plan = plan_eight(mesh, targets);
  ASSERT_EQ(plan.regions.size(), 1U);
  EXPECT_FALSE(plan.regions[0].eight);
  EXPECT_GT(plan.regions[0].n_self_crossing, 0);
  EXPECT_NE(plan.regions[0].reason.find("could be cut in eight"), std::string::npos) << plan.regions[0].reason;
  EXPECT_EQ(plan.trisected, targets);
  EXPECT_TRUE(plan.passes.empty());
  // Cut open, it is structured.
  const std::vector<Index> open(targets.begin(), targets.begin() + 4 * 6);
  EXPECT_TRUE(only_region(mesh, open).eight);
}

TEST(eight, regions_that_share_no_node_are_decided_about_one_by_one) {
  const Mesh mesh = test::ring(9, 8, 1);
  std::vector<Index> targets;
  for (int k = 0; k < 8; ++k) targets.push_back(4 + 9 * (4 + 9 * k));  // the middle: once around, crossing itself
  targets.push_back(0);
  targets.push_back(1);
  std::ranges::sort(targets);
  const EightPlan plan = plan_eight(mesh, targets);
  ASSERT_EQ(plan.regions.size(), 2U);
  EXPECT_TRUE(plan.regions[0].eight) << plan.regions[0].reason;
  EXPECT_FALSE(plan.regions[1].eight);
  EXPECT_EQ(plan.trisected.size(), 8U);
}

TEST(eight, a_thin_region_around_a_wide_notch_gets_27) {
  // Planes of nodes along an L would have to be filled to rectangles.
  const Mesh mesh = test::grid(12, 12, 4);
  std::vector<Index> targets;
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    const int i = h % 12, j = h / 12 % 12, k = h / 144;
    if ((k == 1 || k == 2) && (i == 0 || j == 0)) targets.push_back(h);
  }
  const EightRegion region = only_region(mesh, targets);
  EXPECT_FALSE(region.eight);
  EXPECT_EQ(region.reason, "concave sides would need more than half as many nodes again to be filled");
}

/// What the plan relies on, hex by hex and edge by edge: a template in every pass, one cut for each edge that is halved
/// and none for those cut in three, no more than three beside a single region.
void expect_marks_fit(const Mesh& mesh, const std::vector<Index>& targets, const EightPlan& plan) {
  const Edges all = edges(mesh);
  std::vector<int> n_cuts(all.nodes.size(), 0);
  for (const auto& marked : plan.passes) {
    for (const Hex& hex : mesh.hexes) EXPECT_TRUE(is_box_marking(corner_mask(hex, marked)));
    for (std::size_t e = 0; e < n_cuts.size(); ++e) n_cuts[e] += marked[all.nodes[e][0]] != marked[all.nodes[e][1]];
  }
  if (plan.regions.size() == 1) {
    EXPECT_LE(*std::ranges::max_element(n_cuts), 3);
  }
  const auto is_in = [](const auto& list, const auto& item) { return std::ranges::binary_search(list, item); };
  for (const Index h : targets)
    for (const Index e : all.of_hex[h])
      EXPECT_EQ(n_cuts[e],
                is_in(plan.trisected, h) || is_in(plan.alone, h) || is_in(plan.thirds, all.nodes[e]) ? 0 : 1);
}

TEST(eight, most_sets_of_three_or_four_hexes_around_an_irregular_edge_are_halved) {
  // Some only by the other of two markings, or with sheets in different passes that would cross beside the region.
  const Mesh mesh = test::pinwheel(3, 2, 1);
  std::array<int, 5> n_eight{};
  for (unsigned set = 0; set < 1U << mesh.hexes.size(); ++set) {
    const int n = std::popcount(set);
    if (n != 3 && n != 4) continue;
    std::vector<Index> targets;
    for (Index h = 0; h < mesh.n_hexes(); ++h)
      if (set >> h & 1) targets.push_back(h);
    SCOPED_TRACE(testing::PrintToString(targets));
    const EightPlan plan = plan_eight(mesh, targets);
    expect_marks_fit(mesh, targets, plan);
    n_eight[n] += plan.trisected.empty();
  }
  EXPECT_GE(n_eight[3], 203);  // of 220
  EXPECT_GE(n_eight[4], 389);  // of 495
}

TEST(eight, sheets_of_a_staircase_around_an_irregular_edge_are_kept_apart) {
  // In three passes sheets would cross in hexes beside the steps, which then have no template.
  const Mesh mesh = test::pinwheel(3, 1, 3);
  const std::vector<Index> steps = {2, 3 + 1, 6 + 0};
  const EightPlan plan = plan_eight(mesh, steps);
  EXPECT_TRUE(plan.regions[0].eight) << plan.regions[0].reason;
  EXPECT_EQ(plan.regions[0].n_passes, 4);
  expect_marks_fit(mesh, steps, plan);
}

}  // namespace
}  // namespace hextwist
