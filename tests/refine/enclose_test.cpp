#include "hextwist/refine/templates/enclose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>

#include "hextwist/mesh/quality/quality.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/split.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/refined.h"

namespace hextwist {
namespace {

TEST(enclose_table, every_marking_with_a_template_fills_the_hex_with_positive_hexes) {
  const Mesh cube = test::grid(1, 1, 1);
  int n_templates = 0;
  for (const EncloseAt at : {EncloseAt::half, EncloseAt::third})
    for (int mask = 0; mask < 256; ++mask) {
      if (!has_enclosing_template(mask)) continue;
      ++n_templates;
      const std::vector<std::uint16_t> codes = {static_cast<std::uint16_t>(mask)};
      const Mesh mesh = test::refined(cube, split(cube.hexes, 8, enclose_table(at), codes));
      ASSERT_TRUE(test::conformal(mesh)) << mask;
      ASSERT_TRUE(test::uninverted(mesh)) << mask;
      ASSERT_NEAR(volume(mesh), 1, 1e-12);
      const int n = std::popcount(static_cast<unsigned>(mask));
      const Index expected[] = {1, 4, 3, -1, 2, -1, 3, 4, 1};
      EXPECT_EQ(mesh.n_hexes(), expected[n]) << mask;
    }
  EXPECT_EQ(n_templates, 2 * (1 + 8 + 12 + 6 + 12 + 8 + 1));
}

TEST(enclose_table, layers_of_any_thickness_have_inner_nodes_a_little_nearer_to_the_middle) {
  const Mesh cube = test::grid(1, 1, 1);
  for (const double at : {0.01, 0.1, 0.3, 0.45, 0.5, 0.55, 0.7, 0.9, 0.99}) {
    SCOPED_TRACE(at);
    const auto table = enclose_table(at), opposite = enclose_table(1 - at);
    for (int mask = 0; mask < 256; ++mask) {
      if (!has_enclosing_template(mask)) continue;
      const Mesh mesh = test::refined(cube, split(cube.hexes, 8, table, std::vector{static_cast<std::uint16_t>(mask)}));
      EXPECT_TRUE(test::conformal(mesh)) << mask;
      EXPECT_TRUE(test::uninverted(mesh)) << mask;
    }
    // One marked corner, and all but that one: the same seen from the other side.
    for (const auto& places : {table->positions(1), opposite->positions(254)}) {
      const double edge = places[table->edge_node(0, 0)].x(), face = places[table->face_node(0, 0)].y();
      const Vec3 inside = places[table->inside_node(0)];
      EXPECT_NEAR(edge, at, 1e-12);
      EXPECT_NEAR(inside.x(), inside.y(), 1e-12);
      EXPECT_NEAR(inside.x(), inside.z(), 1e-12);
      EXPECT_EQ(std::abs(inside.x() - 0.5) < std::abs(face - 0.5), at != 0.5);
      EXPECT_EQ(std::abs(face - 0.5) < std::abs(edge - 0.5), at != 0.5);
      EXPECT_LE(std::abs(edge - inside.x()), 0.1);
    }
  }
}

TEST(enclose, any_marking_can_be_closed_and_is_conformal_then) {
  for (unsigned seed = 0; seed < 80; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Mesh mesh =
        test::shuffled(seed % 2 ? test::pinwheel(3 + static_cast<int>(seed % 4), 2, 2) : test::grid(4, 3, 3), random);
    std::vector<std::uint8_t> marked(mesh.points.size());
    const auto share = 1 + random() % 8;
    for (auto& mark : marked) mark = random() % 16 < share;
    const auto before = marked;
    close_enclosure(mesh.hexes, marked);
    for (std::size_t n = 0; n < marked.size(); ++n) EXPECT_GE(marked[n], before[n]);
    const auto table = enclose_table(seed % 3 ? EncloseAt::half : EncloseAt::third);
    const Mesh fine = test::refined(mesh, split(mesh.hexes, mesh.n_nodes(), table, enclose_codes(mesh.hexes, marked)));
    ASSERT_TRUE(test::conformal(fine));
    ASSERT_TRUE(test::uninverted(fine));
    ASSERT_NEAR(volume(fine), volume(mesh), 1e-9);
  }
}

/// Corners of a mask that the smallest marking with a template adds to it.
int n_missing(int mask) {
  int fewest = 8;
  for (int m = 0; m < 256; ++m)
    if ((m & mask) == mask && has_enclosing_template(m))
      fewest = std::min(fewest, std::popcount(static_cast<unsigned>(m ^ mask)));
  return fewest;
}

TEST(enclose, a_hex_alone_gets_its_smallest_template_nearby_unless_that_is_too_far) {
  std::mt19937 random(4);
  for (int numbering = 0; numbering < 20; ++numbering) {
    const Mesh cube = test::shuffled(test::grid(1, 1, 1), random);
    for (int mask = 0; mask < 256; ++mask)
      for (Index limit = 0; limit <= 8; ++limit) {
        std::vector<std::uint8_t> marked(8);
        for (int c = 0; c < 8; ++c) marked[cube.hexes[0][c]] = mask >> c & 1;
        const Index n_added = close_enclosure_nearby(cube, marked, limit);
        const int closed = corner_mask(cube.hexes[0], marked);
        EXPECT_EQ(n_added, n_missing(mask) <= limit ? n_missing(mask) : 0) << mask;
        EXPECT_EQ(closed & mask, mask);
        EXPECT_EQ(std::popcount(static_cast<unsigned>(closed ^ mask)), n_added) << mask;
        EXPECT_EQ(has_enclosing_template(closed), n_missing(mask) <= limit) << mask;
      }
  }
}

/// Of the marked corners of a hex without a template those that go first, by the rule.
int first_part(const Hex& hex, int mask) {
  if (has_enclosing_template(mask)) return mask;
  int lowest = -1;
  for (int c = 0; c < 8; ++c)
    if (mask >> c & 1 && (lowest < 0 || hex[c] < hex[lowest])) lowest = c;
  const auto beside = [&](int c) { return mask & (1 << (c ^ 1) | 1 << (c ^ 2) | 1 << (c ^ 4)); };
  int piece = 1 << lowest;
  for (int round = 0; round < 8; ++round)
    for (int c = 0; c < 8; ++c)
      if (piece >> c & 1) piece |= beside(c);
  if (piece != mask) return first_part(hex, piece);
  std::array<int, 4> by_n_beside{};
  for (int c = 0; c < 8; ++c)
    if (mask >> c & 1) by_n_beside[std::popcount(static_cast<unsigned>(beside(c)))] |= 1 << c;
  const int meeting = *std::find_if(by_n_beside.rbegin(), by_n_beside.rend(), [](int corners) { return corners != 0; });
  if (meeting != mask && has_enclosing_template(meeting)) return meeting;
  lowest = -1;
  for (int c = 0; c < 8; ++c)
    if (meeting >> c & 1 && (lowest < 0 || hex[c] < hex[lowest])) lowest = c;
  return 1 << lowest;
}

TEST(enclose, of_a_hex_alone_the_piece_with_the_lowest_node_goes_first_or_where_most_marked_edges_meet) {
  std::mt19937 random(3);
  for (int numbering = 0; numbering < 20; ++numbering) {
    const Mesh cube = test::shuffled(test::grid(1, 1, 1), random);
    for (int mask = 0; mask < 256; ++mask) {
      std::vector<std::uint8_t> marked(8);
      for (int c = 0; c < 8; ++c) marked[cube.hexes[0][c]] = mask >> c & 1;
      EXPECT_EQ(corner_mask(cube.hexes[0], enclosable_part(cube.hexes, marked)), first_part(cube.hexes[0], mask))
          << mask;
    }
  }
}

TEST(enclose, what_has_templates_everywhere_is_not_taken_apart_because_something_else_has_none) {
  const int a = 7, b = 7;
  const Mesh mesh = test::grid(a, b, 1);
  const auto node = [&](int i, int j, int k) { return i + (a + 1) * (j + (b + 1) * k); };
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j <= b; ++j)
      for (int i = 0; i <= a; ++i) marked[node(i, j, k)] = i < 2 || j < 2;  // an L with a ridge, six corners of a hex
  EXPECT_EQ(enclosable_part(mesh.hexes, marked), marked);
  const Index corner = node(5, 5, 0);
  for (const Index n : {corner, node(6, 5, 0), node(5, 6, 0)}) marked[n] = 1;
  std::vector<std::uint8_t> expected(mesh.points.size(), 0);
  expected[corner] = 1;
  EXPECT_EQ(enclosable_part(mesh.hexes, marked), expected);
}

TEST(enclose, a_ridge_goes_with_the_corner_in_which_it_ends) {
  constexpr int n = 4, top = 6;
  const Mesh mesh = test::grid(n, n, top + 2);
  const auto node = [&](int i, int j, int k) { return i + (n + 1) * (j + (n + 1) * k); };
  for (int mirror = 0; mirror < 8; ++mirror) {  // so that the ridge is at each corner of hexes
    const auto mirrored = [&](int i, int j, int k) {
      return node(mirror & 1 ? n - i : i, mirror & 2 ? n - j : j, mirror & 4 ? top + 2 - k : k);
    };
    std::vector<std::uint8_t> marked(mesh.points.size(), 0), ridge(mesh.points.size(), 0);
    for (int k = 0; k <= top; ++k) {
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) marked[mirrored(i, j, k)] = i < 2 || j < 2;
      ridge[mirrored(1, 1, k)] = 1;
    }
    EXPECT_EQ(enclosable_part(mesh.hexes, marked), ridge) << mirror;
  }
}

TEST(enclose, single_nodes_grow_as_the_paper_says) {
  const auto growth = [](Index node) {
    const Mesh mesh = test::grid(3, 3, 3);
    std::vector<std::uint8_t> marked(mesh.points.size(), 0);
    marked[node] = 1;
    EXPECT_EQ(close_enclosure(mesh.hexes, marked), 0);
    const Split parts =
        split(mesh.hexes, mesh.n_nodes(), enclose_table(EncloseAt::third), enclose_codes(mesh.hexes, marked));
    return static_cast<Index>(parts.hexes.size()) - mesh.n_hexes();
  };
  EXPECT_EQ(growth(1 + 4 * (1 + 4 * 1)), 24);
  EXPECT_EQ(growth(1 + 4 * (1 + 4 * 0)), 12);
  EXPECT_EQ(growth(0), 3);
}

}  // namespace
}  // namespace hextwist
