#include "hextwist/mesh/topology.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <set>

#include "hextwist/mesh/corners.h"
#include "support/grids.h"

namespace hextwist {
namespace {

std::vector<Mesh> samples() {
  std::mt19937 random(11);
  std::vector<Mesh> meshes = {test::grid(1, 1, 1), test::grid(3, 2, 4), test::pinwheel(3, 2, 2),
                              test::pinwheel(5, 3, 2)};
  for (std::size_t i = 0, n = meshes.size(); i < n; ++i) meshes.push_back(test::shuffled(meshes[i], random));
  meshes.push_back(Mesh{});
  return meshes;
}

/// Nodes taken from few, so that everything that can be wrong is.
Mesh nonsense(std::mt19937& random, int n_nodes, int n_hexes) {
  Mesh mesh;
  mesh.points.resize(n_nodes, Vec3::Zero());
  mesh.hexes.resize(n_hexes);
  for (Hex& hex : mesh.hexes)
    for (Index& node : hex) node = static_cast<Index>(random() % n_nodes);
  return mesh;
}

void expect_edges_are_those_of_a_map(const Mesh& mesh) {
  const Edges e = edges(mesh);
  std::map<Edge, Index> expected;
  for (const Hex& hex : mesh.hexes)
    for (int i = 0; i < n_hex_edges; ++i) {
      const auto [low, high] = std::minmax(hex[edge_corner(i, 0)], hex[edge_corner(i, 1)]);
      expected[{low, high}] = 0;
    }
  Index count = 0;
  for (auto& [edge, number] : expected) number = count++;
  ASSERT_EQ(std::ssize(e.nodes), count);
  for (const auto& [edge, number] : expected) {
    ASSERT_EQ(e.nodes[number], edge);
    EXPECT_EQ(find_edge(e, edge[0], edge[1]), number);
    EXPECT_EQ(find_edge(e, edge[1], edge[0]), number);
    EXPECT_LE(e.first_of_node[edge[0]], number);
    EXPECT_GT(e.first_of_node[edge[0] + 1], number);
  }
  ASSERT_EQ(std::ssize(e.of_hex), mesh.n_hexes());
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (int i = 0; i < n_hex_edges; ++i) {
      const auto [low, high] = std::minmax(mesh.hexes[h][edge_corner(i, 0)], mesh.hexes[h][edge_corner(i, 1)]);
      EXPECT_EQ(e.of_hex[h][i], (expected[{low, high}]));
    }
}

void expect_faces_are_those_of_a_map(const Mesh& mesh) {
  const Faces all = faces(mesh);
  std::map<Quad, std::vector<Side>> expected;  // by lowest, diagonal, lower and higher neighbour
  const auto key = [](const Quad& quad) {
    const auto lowest = std::ranges::min_element(quad) - quad.begin();
    const auto [low, high] = std::minmax(quad[lowest ^ 1], quad[lowest ^ 2]);
    return Quad{quad[lowest], quad[lowest ^ 3], low, high};
  };
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (int f = 0; f < n_hex_faces; ++f) expected[key(face_nodes(mesh.hexes[h], f))].push_back({h, f});
  ASSERT_EQ(std::ssize(all.nodes), std::ssize(expected));
  Index face = 0;
  std::vector<Side> boundary;
  for (const auto& [quad, sides] : expected) {
    ASSERT_LE(sides.size(), 2u);
    EXPECT_EQ(all.nodes[face], face_nodes(mesh.hexes[sides[0].hex], sides[0].face));
    EXPECT_EQ(all.sides[face][0], sides[0]);
    EXPECT_EQ(all.sides[face][1], sides.size() == 2 ? sides[1] : Side{});
    for (const Side& side : sides) EXPECT_EQ(all.of_hex[side.hex][side.face], face);
    if (sides.size() == 1) boundary.push_back(sides[0]);
    Quad any = quad;
    std::ranges::sort(any);
    do EXPECT_EQ(find_face(all, any), face);
    while (std::ranges::next_permutation(any).found);
    ++face;
  }
  std::ranges::sort(boundary);
  EXPECT_EQ(boundary_sides(all), boundary);
}

TEST(topology, edges_are_numbered_by_their_nodes_and_found_again) {
  for (const Mesh& mesh : samples()) expect_edges_are_those_of_a_map(mesh);
}

TEST(topology, faces_are_numbered_by_their_nodes_and_found_again) {
  for (const Mesh& mesh : samples()) expect_faces_are_those_of_a_map(mesh);
}

/// More nodes than are looked at together: in their order, in none, and where the first ones have no faces.
TEST(topology, faces_of_many_nodes_are_numbered_alike) {
  std::mt19937 random(12);
  const Mesh grid = test::grid(2, 2, 4000);
  expect_faces_are_those_of_a_map(grid);
  expect_faces_are_those_of_a_map(test::shuffled(grid, random));
  Mesh later = grid;
  constexpr Index n_unused = 40000;
  later.points.insert(later.points.begin(), n_unused, Vec3::Zero());
  for (Hex& hex : later.hexes)
    for (Index& node : hex) node += n_unused;
  expect_faces_are_those_of_a_map(later);
}

TEST(topology, what_is_not_there_is_not_found) {
  const Mesh mesh = test::grid(2, 2, 2);
  const Edges e = edges(mesh);
  const Faces f = faces(mesh);
  std::set<Edge> known(e.nodes.begin(), e.nodes.end());
  for (Index a = -2; a < mesh.n_nodes() + 2; ++a)
    for (Index b = a; b < mesh.n_nodes() + 2; ++b) EXPECT_EQ(find_edge(e, a, b) >= 0, known.contains({a, b}));
  EXPECT_EQ(find_face(f, {0, 1, 2, 3}), -1);
  EXPECT_EQ(find_face(f, {-1, 1, 3, 4}), -1);
  EXPECT_EQ(find_face(f, {26, 27, 28, 29}), -1);
  EXPECT_EQ(find_face(f, {0, 0, 0, 0}), -1);
}

TEST(topology, hexes_around_nodes_and_edges_ascend) {
  for (const Mesh& mesh : samples()) {
    std::vector<std::vector<Index>> of_node(mesh.points.size());
    for (Index h = 0; h < mesh.n_hexes(); ++h)
      for (const Index n : mesh.hexes[h]) of_node[n].push_back(h);
    const CompressedRows around = node_hexes(mesh);
    ASSERT_EQ(around.size(), mesh.n_nodes());
    for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_TRUE(std::ranges::equal(around[n], of_node[n]));

    const Edges e = edges(mesh);
    std::vector<std::vector<Index>> of_edge(e.nodes.size());
    for (Index h = 0; h < mesh.n_hexes(); ++h)
      for (const Index edge : e.of_hex[h]) of_edge[edge].push_back(h);
    const CompressedRows around_edge = edge_hexes(e, mesh.n_hexes());
    ASSERT_EQ(around_edge.size(), std::ssize(e.nodes));
    for (Index i = 0; i < around_edge.size(); ++i) EXPECT_TRUE(std::ranges::equal(around_edge[i], of_edge[i]));
  }
}

TEST(topology, sides_are_found_from_quads_in_any_corner_order) {
  std::mt19937 random(5);
  for (const Mesh& mesh : samples()) {
    const Faces all = faces(mesh);
    std::vector<Quad> quads = all.nodes;
    std::vector<Side> expected;
    for (std::size_t face = 0; face < quads.size(); ++face) {
      std::ranges::shuffle(quads[face], random);
      expected.push_back(all.sides[face][0]);
    }
    for (const Quad& stranger :
         {Quad{-1, 0, 1, 2}, Quad{0, 0, 0, 0}, Quad{0, 1, 2, 1000}, Quad{1000, 1001, 1002, 1003}}) {
      quads.push_back(stranger);
      expected.push_back({});
    }
    if (!all.nodes.empty()) {  // asked twice, answered twice
      quads.push_back(quads[0]);
      expected.push_back(expected[0]);
    }
    EXPECT_EQ(find_sides(mesh, quads), expected);
  }
}

TEST(topology, an_unknown_node_is_an_error_naming_the_hex) {
  for (const Index stranger : {-1, 12, 1 << 30}) {
    Mesh mesh = test::grid(2, 1, 1);
    mesh.hex_ids = {10, 20};
    mesh.hexes[1][6] = stranger;
    for (const auto& make :
         {+[](const Mesh& m) { edges(m); }, +[](const Mesh& m) { faces(m); }, +[](const Mesh& m) { node_hexes(m); }}) {
      try {
        make(mesh);
        FAIL();
      } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "hex 20 names a node that does not exist");
      }
    }
  }
}

TEST(topology, a_face_of_three_hexes_is_an_error_naming_them) {
  Mesh mesh = test::grid(2, 1, 1);
  for (int i = 0; i < 4; ++i) mesh.points.push_back(Vec3(1.5, i & 1, i >> 1));
  Hex third = mesh.hexes[1];
  for (int i = 0; i < 4; ++i) third[2 * i + 1] = 12 + i;
  mesh.hexes.push_back(third);
  try {
    faces(mesh);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "hexes 1, 2 and 3 share one face: at most two can");
  }
}

TEST(topology, nonsense_meshes_do_not_crash) {
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    const Mesh mesh = nonsense(random, 1 + static_cast<int>(random() % 20), static_cast<int>(random() % 12));
    expect_edges_are_those_of_a_map(mesh);
    std::map<Quad, int> uses;  // by lowest, diagonal and neighbours; a quad that repeats nodes may be the same in two
    bool repeats = false;
    for (const Hex& hex : mesh.hexes)
      for (int f = 0; f < n_hex_faces; ++f) {
        const Quad q = face_nodes(hex, f);
        for (int i = 0; i < 4; ++i)
          for (int j = 0; j < i; ++j) repeats |= q[i] == q[j];
        const auto lowest = std::ranges::min_element(q) - q.begin();
        const auto [low, high] = std::minmax(q[lowest ^ 1], q[lowest ^ 2]);
        ++uses[{q[lowest], q[lowest ^ 3], low, high}];
      }
    const bool crowded = std::ranges::any_of(uses, [](const auto& use) { return use.second > 2; });
    try {
      faces(mesh);
      EXPECT_FALSE(crowded && !repeats);
    } catch (const Error&) {
      EXPECT_TRUE(crowded || repeats);
    }
    find_sides(mesh, edges(mesh).nodes.empty() ? std::vector<Quad>{} : std::vector<Quad>{face_nodes(mesh.hexes[0], 0)});
  }
}

TEST(topology, is_the_same_for_any_number_of_threads) {
  std::mt19937 random(17);
  const Mesh mesh = test::shuffled(test::grid(30, 31, 32), random);
  std::vector<Edges> e;
  std::vector<Faces> f;
  std::vector<CompressedRows> around;
  for (const int threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    e.push_back(edges(mesh));
    f.push_back(faces(mesh));
    around.push_back(node_hexes(mesh));
    around.push_back(edge_hexes(e.back(), mesh.n_hexes()));
  }
  for (int i = 1; i < 3; ++i) {
    EXPECT_EQ(e[i].nodes, e[0].nodes);
    EXPECT_EQ(e[i].of_hex, e[0].of_hex);
    EXPECT_EQ(f[i].nodes, f[0].nodes);
    EXPECT_EQ(f[i].sides, f[0].sides);
    EXPECT_EQ(f[i].of_hex, f[0].of_hex);
    EXPECT_EQ(around[2 * i].items, around[0].items);
    EXPECT_EQ(around[2 * i + 1].items, around[1].items);
  }
}

/// Prints what a million hexes cost. Run by hand: --gtest_also_run_disabled_tests --gtest_filter=*million*
TEST(topology, DISABLED_of_a_million_hexes_is_quick) {
  std::mt19937 random(1);
  const auto clock = [](const char* what, auto f) {
    const auto start = std::chrono::steady_clock::now();
    auto result = f();
    std::printf("  %-12s %.3f s\n", what,
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    return result;
  };
  const Mesh straight = test::grid(100, 100, 100);
  for (const Mesh& mesh : {straight, test::shuffled(straight, random)})
    for (const int threads : {1, 2}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      std::printf("%d threads, %s\n", threads, mesh == straight ? "in order" : "shuffled");
      const Edges e = clock("edges", [&] { return edges(mesh); });
      const Faces f = clock("faces", [&] { return faces(mesh); });
      clock("node_hexes", [&] { return node_hexes(mesh); });
      clock("edge_hexes", [&] { return edge_hexes(e, mesh.n_hexes()); });
      const auto sides = clock("boundary", [&] { return boundary_sides(f); });
      std::vector<Quad> quads;
      for (const Side& side : sides) quads.push_back(face_nodes(mesh.hexes[side.hex], side.face));
      clock("find_sides", [&] { return find_sides(mesh, quads); });
    }
}

}  // namespace
}  // namespace hextwist
