// Exact counts of the trisecting pass, and the sheet-by-sheet reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/split.h"
#include "hextwist/refine/templates/trisect.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/refined.h"
#include "support/sheet_reference.h"

namespace hextwist {
namespace {

/// A grid with target hexes, seen through one of the 48 symmetries of the axes.
struct Case {
  std::array<int, 3> size;
  std::vector<std::array<int, 3>> targets;

  Case seen_through(int symmetry) const {
    std::array<int, 3> axis = {0, 1, 2};
    for (int i = 0; i < symmetry / 8; ++i) std::ranges::next_permutation(axis);
    Case image;
    for (int i = 0; i < 3; ++i) image.size[axis[i]] = size[i];
    for (const auto& target : targets) {
      std::array<int, 3> moved;
      for (int i = 0; i < 3; ++i) moved[axis[i]] = symmetry >> i & 1 ? size[i] - 1 - target[i] : target[i];
      image.targets.push_back(moved);
    }
    return image;
  }
  Mesh mesh() const { return test::grid(size[0], size[1], size[2]); }
  std::vector<Index> hexes() const {
    std::vector<Index> result;
    for (const auto& [i, j, k] : targets) result.push_back(i + size[0] * (j + size[1] * k));
    std::ranges::sort(result);
    return result;
  }
};

Case box(std::array<int, 3> size, std::array<int, 3> low, std::array<int, 3> high) {
  Case result{size, {}};
  for (int k = low[2]; k < high[2]; ++k)
    for (int j = low[1]; j < high[1]; ++j)
      for (int i = low[0]; i < high[0]; ++i) result.targets.push_back({i, j, k});
  return result;
}

struct Counts {
  Index hexes, nodes, filled;
};

Counts refine_and_check(const Mesh& mesh, const std::vector<Index>& targets, bool fill) {
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  mark_nodes(mesh.hexes, targets, marked);
  const Index filled = fill ? fill_concave(mesh, marked) : 0;
  const Mesh fine =
      test::refined(mesh, split(mesh.hexes, mesh.n_nodes(), trisect_table(), trisect_codes(mesh.hexes, marked)));
  EXPECT_TRUE(test::conformal(fine));
  EXPECT_TRUE(test::uninverted(fine));
  EXPECT_NEAR(volume(fine), volume(mesh), 1e-9 * volume(mesh));
  return {fine.n_hexes(), fine.n_nodes(), filled};
}

TEST(trisect_counts, boxes_of_the_paper_and_ours_under_all_symmetries) {
  struct Row {
    Case target;
    Index hexes, nodes;
  };
  const std::vector<Row> rows = {{box({5, 5, 5}, {2, 2, 2}, {3, 3, 3}), 271, 368},
                                 {box({4, 4, 4}, {0, 0, 0}, {1, 1, 1}), 138, 223},
                                 {box({6, 13, 16}, {0, 0, 0}, {6, 13, 1}), 4212, 5172},   // paper, table 2, 7(d)
                                 {box({6, 13, 16}, {0, 0, 0}, {1, 1, 16}), 2112, 2738}};  // paper, table 2, 7(c)
  for (const Row& row : rows)
    for (int symmetry = 0; symmetry < 48; ++symmetry) {
      const Case seen = row.target.seen_through(symmetry);
      if (row.hexes > 1000 && symmetry % 8 != symmetry / 8) continue;  // the large ones: a sample
      const Counts counts = refine_and_check(seen.mesh(), seen.hexes(), false);
      EXPECT_EQ(counts.hexes, row.hexes) << symmetry;
      EXPECT_EQ(counts.nodes, row.nodes) << symmetry;
    }
}

TEST(trisect_counts, concave_targets_grow_less_with_templates_than_with_filling) {
  Case l{{7, 7, 5}, {}};
  for (int i = 0; i < 3; ++i) l.targets.push_back({2 + i, 2, 2});
  for (int j = 1; j < 3; ++j) l.targets.push_back({2, 2 + j, 2});
  Case notched = box({6, 6, 6}, {2, 2, 2}, {4, 4, 4});
  notched.targets.pop_back();
  for (int symmetry = 0; symmetry < 48; ++symmetry) {
    const Case seen = l.seen_through(symmetry);
    const Counts filled = refine_and_check(seen.mesh(), seen.hexes(), true);
    EXPECT_EQ(filled.hexes, 951);
    EXPECT_EQ(filled.nodes, 1104);
    EXPECT_EQ(filled.filled, 4);
    const Counts templates = refine_and_check(seen.mesh(), seen.hexes(), false);
    EXPECT_LE(templates.hexes, 805);
    EXPECT_EQ(templates.filled, 0);
    const Case seen_notched = notched.seen_through(symmetry);
    EXPECT_LE(refine_and_check(seen_notched.mesh(), seen_notched.hexes(), false).hexes, 854);
  }
}

TEST(trisect_counts, boxes_grow_by_rule) {
  // growth = 26 p q r + 12 F + 4 E: F free face neighbours, E free edge neighbours.
  std::mt19937 random(3);
  for (int trial = 0; trial < 40; ++trial) {
    std::array<int, 3> size, low, high, length;
    for (int i = 0; i < 3; ++i) {
      size[i] = 1 + static_cast<int>(random() % 6);
      low[i] = static_cast<int>(random() % size[i]);
      high[i] = low[i] + 1 + static_cast<int>(random() % (size[i] - low[i]));
      length[i] = high[i] - low[i];
    }
    int growth = 26 * length[0] * length[1] * length[2];
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const auto n_free = [&](int axis) { return (low[axis] > 0) + (high[axis] < size[axis]); };
      growth += 12 * n_free(i) * length[j] * length[k];
      growth += 4 * n_free(j) * n_free(k) * length[i];
    }
    const Case target = box(size, low, high);
    EXPECT_EQ(refine_and_check(target.mesh(), target.hexes(), false).hexes, size[0] * size[1] * size[2] + growth);
  }
}

std::vector<std::array<long, 3>> skeleton(const Mesh& mesh, const std::vector<char>& on_skeleton) {
  std::vector<std::array<long, 3>> places;
  for (std::size_t n = 0; n < mesh.points.size(); ++n)
    if (on_skeleton[n])
      places.push_back({std::lround(mesh.points[n].x() * 1e8), std::lround(mesh.points[n].y() * 1e8),
                        std::lround(mesh.points[n].z() * 1e8)});
  std::ranges::sort(places);
  return places;
}

/// One pass against sheet after sheet: same counts, same nodes on the original edges and faces.
void compare_with_reference(const Mesh& mesh, const std::vector<Index>& targets, std::mt19937& random) {
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  mark_nodes(mesh.hexes, targets, marked);
  fill_concave(mesh, marked);
  const Split parts = split(mesh.hexes, mesh.n_nodes(), trisect_table(), trisect_codes(mesh.hexes, marked));
  const Mesh fine = test::refined(mesh, parts);
  std::vector<char> on_skeleton(fine.points.size(), 1);
  for (const CutHex& hex : parts.lineage.hexes)
    for (std::size_t s = 0; s < trisect_table()->hex(hex.code).inside.size(); ++s) on_skeleton[hex.first_node + s] = 0;
  const double depth = trisect_table()->face[1].at[0][1];
  const auto reference =
      test::insert_sheet_by_sheet(mesh, std::vector<char>(marked.begin(), marked.end()), depth, random);
  ASSERT_TRUE(test::conformal(reference.mesh));
  ASSERT_EQ(fine.n_hexes(), reference.mesh.n_hexes());
  ASSERT_EQ(fine.n_nodes(), reference.mesh.n_nodes());
  ASSERT_TRUE(skeleton(fine, on_skeleton) == skeleton(reference.mesh, reference.on_skeleton));
}

TEST(trisect_reference, one_pass_equals_sheet_by_sheet_on_boxes_in_any_order_of_sheets) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 30; ++trial) {
    std::array<int, 3> size, low, high;
    for (int i = 0; i < 3; ++i) {
      size[i] = 2 + static_cast<int>(random() % 4);
      low[i] = static_cast<int>(random() % size[i]);
      high[i] = low[i] + 1 + static_cast<int>(random() % (size[i] - low[i]));
    }
    const Case target = box(size, low, high);
    const Mesh mesh = target.mesh();
    compare_with_reference(mesh, target.hexes(), random);
  }
}

TEST(trisect_reference, one_pass_equals_sheet_by_sheet_on_random_filled_targets) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Mesh mesh = test::shuffled(seed % 3 == 0   ? test::grid(4, 4, 3)
                                     : seed % 3 == 1 ? test::pinwheel(3, 3, 3)
                                                     : test::pinwheel(5, 2, 3),
                                     random);
    std::vector<Index> targets(mesh.hexes.size());
    std::iota(targets.begin(), targets.end(), 0);
    std::ranges::shuffle(targets, random);
    targets.resize(1 + random() % 3);
    std::ranges::sort(targets);
    compare_with_reference(mesh, targets, random);
  }
}

TEST(trisect, random_markings_of_irregular_meshes_are_conformal) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Mesh mesh =
        test::shuffled(seed % 2 ? test::pinwheel(3 + static_cast<int>(seed % 4), 2, 2) : test::grid(3, 3, 3), random);
    std::vector<char> marked(mesh.points.size());
    const auto share = 1 + random() % 9;
    for (char& mark : marked) mark = random() % 10 < share;
    const Mesh fine =
        test::refined(mesh, split(mesh.hexes, mesh.n_nodes(), trisect_table(), test::codes_of_nodes(mesh, marked)));
    ASSERT_TRUE(test::conformal(fine));
    ASSERT_TRUE(test::uninverted(fine));
    ASSERT_NEAR(volume(fine), volume(mesh), 1e-9);
  }
}

TEST(trisect, random_edge_markings_that_are_no_node_markings_are_conformal_too) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Mesh mesh = test::shuffled(test::pinwheel(3 + static_cast<int>(seed % 4), 2, 2), random);
    const Edges all = edges(mesh);
    std::vector<char> cut(all.nodes.size());
    for (char& c : cut) c = random() % 3 == 0;
    std::vector<std::uint16_t> codes(mesh.hexes.size());
    for (std::size_t h = 0; h < codes.size(); ++h)
      for (int e = 0; e < n_hex_edges; ++e)
        codes[h] = static_cast<std::uint16_t>(codes[h] | (cut[all.of_hex[h][e]] != 0) << e);
    const Mesh fine = test::refined(mesh, split(mesh.hexes, mesh.n_nodes(), trisect_table(), codes));
    ASSERT_TRUE(test::conformal(fine));
    ASSERT_TRUE(test::uninverted(fine));
    ASSERT_NEAR(volume(fine), volume(mesh), 1e-9);
  }
}

}  // namespace
}  // namespace hextwist
