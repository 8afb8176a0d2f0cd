#include "hextwist/mesh/sheets.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <numeric>
#include <queue>
#include <set>

#include "hextwist/mesh/corners.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist {
namespace {

Sheets sheets(const Mesh& mesh) {
  return sheets(mesh, edges(mesh));
}

/// Steps across quads from edge to opposite edge, as the definition says.
void expect_sheets_are_those_of_the_definition(const Mesh& mesh) {
  const Edges e = edges(mesh);
  const Sheets found = sheets(mesh, e);
  std::map<Edge, std::set<Edge>> across;
  const auto sorted = [](Index a, Index b) { return Edge{std::min(a, b), std::max(a, b)}; };
  for (const Hex& hex : mesh.hexes)
    for (int f = 0; f < n_hex_faces; ++f) {
      const Quad q = face_nodes(hex, f);
      for (const auto& [a, b] :
           {std::pair{sorted(q[0], q[1]), sorted(q[2], q[3])}, {sorted(q[0], q[2]), sorted(q[1], q[3])}}) {
        across[a].insert(b);
        across[b].insert(a);
      }
    }
  std::map<Edge, Index> of_edge;
  Index n_sheets = 0;
  for (const auto& [start, unused] : across) {  // ascending, as edges are numbered
    if (of_edge.contains(start)) continue;
    std::queue<Edge> front({start});
    of_edge[start] = n_sheets;
    for (; !front.empty(); front.pop())
      for (const Edge& next : across[front.front()])
        if (of_edge.try_emplace(next, n_sheets).second) front.push(next);
    ++n_sheets;
  }
  ASSERT_EQ(found.size(), n_sheets);
  std::vector<std::vector<Index>> edges_of(n_sheets);
  for (std::size_t i = 0; i < e.nodes.size(); ++i) {
    ASSERT_EQ(found.of_edge[i], of_edge[e.nodes[i]]);
    edges_of[found.of_edge[i]].push_back(static_cast<Index>(i));
  }
  std::vector<std::set<Index>> hexes_of(n_sheets);
  std::vector<Index> crossings(n_sheets, 0);
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    std::map<Index, int> directions;
    for (int axis = 0; axis < 3; ++axis) ++directions[sheet_of(found, e, h, axis)];
    for (const auto& [sheet, count] : directions) {
      hexes_of[sheet].insert(h);
      crossings[sheet] += count > 1;
    }
  }
  for (Index s = 0; s < n_sheets; ++s) {
    EXPECT_TRUE(std::ranges::equal(found.edges[s], edges_of[s]));
    EXPECT_TRUE(std::ranges::equal(found.hexes[s], hexes_of[s]));
  }
  EXPECT_EQ(found.n_self_crossings, crossings);
}

TEST(sheets, are_those_of_the_definition_on_all_kinds_of_meshes) {
  std::mt19937 random(2);
  for (const Mesh& mesh : {test::grid(3, 2, 4), test::pinwheel(3, 3, 1), test::pinwheel(5, 2, 2), test::ring(3, 8, 1),
                           test::ring(2, 9, 2), test::ring(4, 12, 3), Mesh{}}) {
    expect_sheets_are_those_of_the_definition(mesh);
    expect_sheets_are_those_of_the_definition(test::shuffled(mesh, random));
  }
}

TEST(sheets, of_a_grid_are_its_layers) {
  const Sheets all = sheets(test::grid(2, 3, 5));
  EXPECT_EQ(all.size(), 2 + 3 + 5);
  std::multiset<std::size_t> sizes;
  for (Index s = 0; s < all.size(); ++s) sizes.insert(all.hexes[s].size());
  EXPECT_EQ(sizes, (std::multiset<std::size_t>{15, 15, 10, 10, 10, 6, 6, 6, 6, 6}));
  EXPECT_EQ(std::ranges::count(all.n_self_crossings, 0), all.size());
  EXPECT_EQ(std::ranges::count(all.n_self_touches, 0), all.size());
}

TEST(sheets, of_a_ring_turned_by_a_quarter_cross_themselves) {
  // Rows and columns of the 3 x 3 section take turns: the outer four are one sheet, the middle two another.
  const Mesh mesh = test::ring(3, 63, 1);
  ASSERT_TRUE(test::conformal(mesh));
  ASSERT_TRUE(test::uninverted(mesh));
  const Sheets all = sheets(mesh);
  EXPECT_EQ(all.size(), 63 + 2);
  std::vector<Index> crossings = all.n_self_crossings;
  std::ranges::sort(crossings);
  EXPECT_EQ(crossings[62], 0);
  EXPECT_EQ(crossings[63], 63);
  EXPECT_EQ(crossings[64], 4 * 63);
}

TEST(sheets, of_a_moebius_ring_lie_against_themselves) {
  // Half a turn joins layer 0 with layer 1 of each direction, which share 2 x n faces.
  const Mesh mesh = test::ring(2, 16, 2);
  ASSERT_TRUE(test::conformal(mesh));
  const Sheets all = sheets(mesh);
  EXPECT_EQ(all.size(), 16 + 2);
  std::vector<Index> touches = all.n_self_touches;
  std::ranges::sort(touches);
  EXPECT_EQ(touches[15], 0);
  EXPECT_EQ(touches[16], 32);
  EXPECT_EQ(touches[17], 32);
  EXPECT_EQ(std::ranges::count(all.n_self_crossings, 0), all.size());
  // Three layers: the outer two are joined but do not meet.
  const Sheets three = sheets(test::ring(3, 16, 2));
  EXPECT_EQ(std::ranges::count(three.n_self_touches, 0), three.size());
}

TEST(sheets, are_the_same_for_any_number_of_threads) {
  std::mt19937 random(6);
  const Mesh mesh = test::shuffled(test::ring(7, 400, 1), random);
  std::vector<Sheets> runs;
  for (const int threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    runs.push_back(sheets(mesh));
  }
  for (int i = 1; i < 3; ++i) {
    EXPECT_EQ(runs[i].of_edge, runs[0].of_edge);
    EXPECT_EQ(runs[i].edges.items, runs[0].edges.items);
    EXPECT_EQ(runs[i].hexes.items, runs[0].hexes.items);
    EXPECT_EQ(runs[i].n_self_crossings, runs[0].n_self_crossings);
    EXPECT_EQ(runs[i].n_self_touches, runs[0].n_self_touches);
  }
}

/// Prints what a million hexes cost. Run by hand: --gtest_also_run_disabled_tests --gtest_filter=*million*
TEST(sheets, DISABLED_of_a_million_hexes_is_quick) {
  std::mt19937 random(1);
  const Mesh straight = test::grid(100, 100, 100);
  for (const Mesh& mesh : {straight, test::shuffled(straight, random)}) {
    const Edges e = edges(mesh);
    for (const int threads : {1, 2}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const auto start = std::chrono::steady_clock::now();
      EXPECT_EQ(sheets(mesh, e).size(), 300);
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      std::printf("  %d threads, sheets %.3f s\n", threads, seconds.count());
    }
  }
}

}  // namespace
}  // namespace hextwist
