// What children inherit, lineage, determinism, and the pass that does nothing.
#include "hextwist/refine/carry.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/origin.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/refine/templates/uniform.h"
#include "support/analytic_model.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/refined.h"

namespace hextwist {
namespace {

/// A shuffled irregular mesh with overlapping sets and linear fields.
Mesh decorated(unsigned seed) {
  std::mt19937 random(seed);
  Mesh mesh = test::shuffled(seed % 2 ? test::pinwheel(5, 2, 3) : test::grid(4, 3, 3), random);
  const auto some = [&](Index n) {
    std::vector<Index> members;
    for (Index i = 0; i < n; ++i)
      if (random() % 2) members.push_back(i);
    return members;
  };
  mesh.blocks = {{7, "left", some(mesh.n_hexes())}, {3, "overlapping", some(mesh.n_hexes())}};
  mesh.node_sets = {{1, "fixed", some(mesh.n_nodes())}, {2, "", some(mesh.n_nodes())}};
  SideSet sides{5, "loaded", {}};
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (int f = 0; f < 6; ++f)
      if (random() % 3 == 0) sides.sides.push_back({h, f});
  mesh.side_sets = {sides};
  Field linear{"linear", Field::On::node, 2, {}}, constant{"number", Field::On::hex, 1, {}};
  for (const Vec3& p : mesh.points) {
    linear.values.push_back(1 + p.x() - 2 * p.y());
    linear.values.push_back(p.z());
  }
  for (Index h = 0; h < mesh.n_hexes(); ++h) constant.values.push_back(h);
  mesh.fields = {linear, constant};
  for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.hex_ids.push_back(10 + 3 * h);
  for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.node_ids.push_back(100 + 2 * n);
  return mesh;
}

std::vector<std::uint16_t> some_codes(const Mesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  std::vector<Index> targets;
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (random() % 6 == 0) targets.push_back(h);
  mark_nodes(mesh.hexes, targets, marked);
  return trisect_codes(mesh.hexes, marked);
}

TEST(carry, without_marks_the_mesh_comes_back_bit_for_bit) {
  const Mesh mesh = decorated(1);
  Split parts = split(mesh.hexes, mesh.n_nodes(), trisect_table(), std::vector<std::uint16_t>(mesh.hexes.size(), 0));
  EXPECT_TRUE(carry(mesh, {}, parts).mesh == mesh);
  EXPECT_TRUE(parts.lineage.edges.empty() && parts.lineage.faces.empty() && parts.lineage.hexes.empty());
}

TEST(carry, old_ids_stay_and_new_ones_follow) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Mesh mesh = decorated(seed);
    Split parts = split(mesh.hexes, mesh.n_nodes(), trisect_table(), some_codes(mesh, seed));
    const Mesh fine = carry(mesh, {}, parts).mesh;
    ASSERT_EQ(fine.hex_ids.size(), fine.hexes.size());
    ASSERT_EQ(fine.node_ids.size(), fine.points.size());
    EXPECT_TRUE(std::ranges::is_sorted(fine.hex_ids, std::less_equal{}));
    EXPECT_TRUE(std::ranges::is_sorted(fine.node_ids, std::less_equal{}));
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      if (parts.is_cut(h)) {
        EXPECT_EQ(find_hex(fine, hex_id(mesh, h)), -1) << "the id of a hex that was cut is not given again";
      } else {
        EXPECT_EQ(fine.hexes[find_hex(fine, hex_id(mesh, h))], mesh.hexes[h]);
      }
    }
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      EXPECT_EQ(fine.points[find_node(fine, node_id(mesh, n))], mesh.points[n]);
  }
}

TEST(carry, sets_are_kept) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    const Mesh mesh = decorated(seed);
    Split parts = split(mesh.hexes, mesh.n_nodes(), trisect_table(), some_codes(mesh, seed));
    const Mesh fine = carry(mesh, {}, parts).mesh;
    ASSERT_TRUE(test::conformal(fine));
    ASSERT_TRUE(test::sets_valid(fine));
    // Blocks: same volume; exactly the children of the members.
    for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
      EXPECT_EQ(fine.blocks[b].name, mesh.blocks[b].name);
      std::vector<char> member(mesh.hexes.size(), 0);
      double before = 0, after = 0;
      for (const Index h : mesh.blocks[b].hexes) {
        member[h] = 1;
        before += volume(mesh, h);
      }
      for (const Index h : fine.blocks[b].hexes) {
        EXPECT_TRUE(member[parts.lineage.parent[h]]);
        after += volume(fine, h);
      }
      EXPECT_NEAR(before, after, 1e-9);
    }
    // Sides: each old side's area is covered by new sides whose nodes lie in its plane.
    const auto area = [](const Mesh& m, const std::vector<Side>& sides) {
      double sum = 0;
      for (const Side& side : sides) {
        const auto q = face_nodes(m.hexes[side.hex], side.face);
        const auto triangle = [&](Index a, Index b, Index c) {
          const Vec3 x = m.points[b] - m.points[a], y = m.points[c] - m.points[a];
          return Vec3(x.y() * y.z() - x.z() * y.y(), x.z() * y.x() - x.x() * y.z(), x.x() * y.y() - x.y() * y.x())
                     .norm() /
                 2;
        };
        sum += triangle(q[0], q[1], q[3]) + triangle(q[0], q[3], q[2]);
      }
      return sum;
    };
    EXPECT_NEAR(area(mesh, mesh.side_sets[0].sides), area(fine, fine.side_sets[0].sides), 1e-9);
    // Node sets: a new node is in exactly when all nodes that it lies between are.
    for (std::size_t i = 0; i < mesh.node_sets.size(); ++i) {
      const auto& old_nodes = mesh.node_sets[i].nodes;
      const auto is_old_member = [&](Index n) { return std::ranges::binary_search(old_nodes, n); };
      std::set<Index> expected(old_nodes.begin(), old_nodes.end());
      const auto take = [&](Index node, const Origin& origin) {
        if (std::ranges::all_of(origin.nodes(), is_old_member)) expected.insert(node);
      };
      for (const auto& e : parts.lineage.edges) for_each_node(parts.lineage, e, take);
      for (const auto& f : parts.lineage.faces) for_each_node(parts.lineage, f, take);
      for (const auto& h : parts.lineage.hexes) for_each_node(parts.lineage, h, mesh.hexes, take);
      EXPECT_EQ(std::set<Index>(fine.node_sets[i].nodes.begin(), fine.node_sets[i].nodes.end()), expected);
    }
    // Fields: a linear one stays linear, one per hex is the parent's.
    for (Index n = 0; n < fine.n_nodes(); ++n) {
      const Vec3& p = fine.points[n];
      ASSERT_NEAR(fine.fields[0].values[2 * n], 1 + p.x() - 2 * p.y(), 1e-12);
      ASSERT_NEAR(fine.fields[0].values[2 * n + 1], p.z(), 1e-12);
    }
    for (Index h = 0; h < fine.n_hexes(); ++h) ASSERT_EQ(fine.fields[1].values[h], parts.lineage.parent[h]);
  }
}

TEST(lineage, is_total) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const Mesh mesh = decorated(seed);
    const Split parts = split(mesh.hexes, mesh.n_nodes(), trisect_table(), some_codes(mesh, seed));
    std::vector<int> n_origins(parts.n_nodes, 0);
    const auto take = [&](Index node, const Origin& origin) {
      ++n_origins[node];
      EXPECT_NEAR(std::accumulate(origin.weight.begin(), origin.weight.begin() + origin.n, 0.0), 1, 1e-12);
    };
    for (const auto& e : parts.lineage.edges) for_each_node(parts.lineage, e, take);
    for (const auto& f : parts.lineage.faces) for_each_node(parts.lineage, f, take);
    for (const auto& h : parts.lineage.hexes) for_each_node(parts.lineage, h, mesh.hexes, take);
    for (Index n = 0; n < parts.n_nodes; ++n) EXPECT_EQ(n_origins[n], n < mesh.n_nodes() ? 0 : 1) << n;
    for (const Index parent : parts.lineage.parent) EXPECT_TRUE(parent >= 0 && parent < mesh.n_hexes());
    EXPECT_TRUE(std::ranges::is_sorted(parts.lineage.edges, {}, [](const CutEdge& e) { return std::pair(e.a, e.b); }));
  }
}

TEST(split, gives_the_same_bytes_for_one_two_and_eight_threads) {
  std::mt19937 random(4);
  const Mesh mesh = test::shuffled(test::grid(24, 24, 24), random);  // large enough for several threads to get work
  const auto codes = some_codes(mesh, 4);
  const auto run = [&](int threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    Split parts = split(mesh.hexes, mesh.n_nodes(), trisect_table(), codes);
    return carry(mesh, {}, parts).mesh;
  };
  const Mesh one = run(1);
  EXPECT_TRUE(one == run(2));
  EXPECT_TRUE(one == run(8));
}

TEST(uniform, cuts_every_edge_in_equal_pieces) {
  for (const int pieces : {2, 3, 4, 7}) {
    std::mt19937 random(5);
    const Mesh mesh = test::shuffled(pieces < 5 ? test::pinwheel(5, 2, 2) : test::grid(2, 1, 1), random);
    const Split parts =
        split(mesh.hexes, mesh.n_nodes(), uniform_table(pieces), std::vector<std::uint16_t>(mesh.hexes.size(), 1));
    const Mesh fine = test::refined(mesh, parts);
    EXPECT_EQ(fine.n_hexes(), mesh.n_hexes() * pieces * pieces * pieces);
    EXPECT_TRUE(test::conformal(fine));
    EXPECT_TRUE(test::uninverted(fine));
    EXPECT_NEAR(volume(fine), volume(mesh), 1e-9);
    for (Index h = 0; h < fine.n_hexes(); ++h)
      EXPECT_NEAR(volume(fine, h) * pieces * pieces * pieces, volume(mesh, parts.lineage.parent[h]), 1e-9);
  }
}

TEST(uniform, the_largest_template_is_whole) {
  const Mesh cube = test::grid(1, 1, 1);
  const Mesh fine =
      test::refined(cube, split(cube.hexes, 8, uniform_table(max_uniform_pieces), std::vector<std::uint16_t>{1}));
  EXPECT_EQ(fine.n_hexes(), max_uniform_pieces * max_uniform_pieces * max_uniform_pieces);
  EXPECT_TRUE(test::conformal(fine));
  EXPECT_TRUE(test::uninverted(fine));
}

}  // namespace
}  // namespace hextwist
