#include "hextwist/refine/plans/combine.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/refine/split.h"
#include "hextwist/refine/templates/enclose.h"
#include "hextwist/refine/templates/trisect.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/refined.h"

namespace hextwist {
namespace {

/// Nodes, edges and faces of a grid, picked by place.
struct Picker {
  int a, b, c;
  Index node(int i, int j, int k) const { return i + (a + 1) * (j + (b + 1) * k); }
  CombinationTarget target;
  void add_node(Index n) { target.nodes.push_back(n); }
  void add_edge(Index m, Index n) {
    target.edges.push_back({std::min(m, n), std::max(m, n)});
    add_node(m);
    add_node(n);
  }
  void add_face(const Quad& quad) {
    target.faces.push_back(quad);
    for (const Index n : quad) add_node(n);
  }
  /// Growth of the grid; checks the mesh on the way.
  Index growth() {
    sort_unique(target.nodes);
    std::ranges::sort(target.edges);
    const Mesh mesh = test::grid(a, b, c);
    std::vector<std::uint8_t> marked(mesh.points.size(), 0);
    for (const Index n : target.nodes) marked[n] = 1;
    EXPECT_EQ(close_enclosure(mesh.hexes, marked), 0);
    const Mesh enclosed = test::refined(
        mesh, split(mesh.hexes, mesh.n_nodes(), enclose_table(EncloseAt::third), enclose_codes(mesh.hexes, marked)));
    const Mesh fine = test::refined(enclosed, split(enclosed.hexes, enclosed.n_nodes(), trisect_table(),
                                                    combination_codes(enclosed, target, target_edges(target))));
    EXPECT_TRUE(test::conformal(fine));
    EXPECT_TRUE(test::uninverted(fine));
    EXPECT_NEAR(volume(fine), a * b * c, 1e-9);
    return fine.n_hexes() - mesh.n_hexes();
  }
};

TEST(combination_counts, nodes) {
  Picker interior{3, 3, 3, {}}, side{3, 3, 3, {}}, corner{3, 3, 3, {}};
  interior.add_node(interior.node(1, 1, 1));
  side.add_node(side.node(1, 2, 0));
  corner.add_node(corner.node(3, 0, 3));
  EXPECT_EQ(interior.growth(), 24);
  EXPECT_EQ(side.growth(), 12);
  EXPECT_EQ(corner.growth(), 3);
}

TEST(combination_counts, single_edges) {
  Picker interior{5, 4, 4, {}}, side{5, 4, 4, {}};
  interior.add_edge(interior.node(2, 2, 2), interior.node(3, 2, 2));
  side.add_edge(side.node(2, 2, 0), side.node(3, 2, 0));
  EXPECT_EQ(interior.growth(), 64);
  EXPECT_EQ(side.growth(), 32);
}

TEST(combination_counts, paths_on_a_flat_side) {
  for (int n = 1; n <= 4; ++n) {
    Picker path{8, 4, 3, {}};
    for (int i = 0; i < n; ++i) path.add_edge(path.node(2 + i, 2, 0), path.node(3 + i, 2, 0));
    EXPECT_EQ(path.growth(), 20 * n + 12);
  }
}

TEST(combination_counts, full_curves) {
  Picker convex{6, 3, 3, {}}, across{6, 4, 3, {}};
  for (int i = 0; i < 6; ++i) {
    convex.add_edge(convex.node(i, 0, 0), convex.node(i + 1, 0, 0));
    across.add_edge(across.node(i, 2, 0), across.node(i + 1, 2, 0));
  }
  EXPECT_EQ(convex.growth(), 10 * 6);
  EXPECT_EQ(across.growth(), 20 * 6);
}

TEST(combination_counts, patches_of_faces) {
  for (const auto& [p, q] : {std::pair{1, 1}, std::pair{2, 1}, std::pair{3, 2}}) {
    Picker patch{7, 6, 3, {}};
    for (int i = 0; i < p; ++i)
      for (int j = 0; j < q; ++j)
        patch.add_face({patch.node(2 + i, 2 + j, 0), patch.node(3 + i, 2 + j, 0), patch.node(2 + i, 3 + j, 0),
                        patch.node(3 + i, 3 + j, 0)});
    EXPECT_EQ(patch.growth(), 21 * p * q + 18 * (p + q) + 12);
  }
}

TEST(combination_counts, a_whole_side_and_an_interior_face) {
  Picker whole{4, 3, 3, {}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 3; ++j)
      whole.add_face(
          {whole.node(i, j, 0), whole.node(i + 1, j, 0), whole.node(i, j + 1, 0), whole.node(i + 1, j + 1, 0)});
  EXPECT_EQ(whole.growth(), 21 * 12);
  Picker interior{5, 5, 4, {}};
  interior.add_face({interior.node(2, 2, 2), interior.node(3, 2, 2), interior.node(2, 3, 2), interior.node(3, 3, 2)});
  EXPECT_EQ(interior.growth(), 138);
}

}  // namespace
}  // namespace hextwist
