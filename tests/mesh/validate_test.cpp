#include "hextwist/mesh/validate/validate.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/quality/quality.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/seed.h"

namespace hextwist {
namespace {

using Kind = ViolationKind;

/// validate(), and the quick answer beside it: a mesh is in order for both or neither.
std::vector<Violation> validated(const Mesh& mesh, const ValidateOptions& options = {}) {
  auto found = validate(mesh, options);
  EXPECT_EQ(has_only_warnings(mesh), std::ranges::all_of(found, is_warning, &Violation::kind));
  return found;
}

/// Joined lines: what one reads in a failure.
std::string texts(const Mesh& mesh, const ValidateOptions& options = {}) {
  std::string all;
  for (const Violation& v : validated(mesh, options)) all += std::string(name(v.kind)) + ": " + v.text + "\n";
  return all;
}

std::vector<Violation> only(Kind kind, const Mesh& mesh) {
  auto found = validated(mesh);
  std::erase_if(found, [&](const Violation& v) { return v.kind != kind; });
  return found;
}

/// One mesh after another, without common nodes.
Mesh joined(const Mesh& a, const Mesh& b) {
  Mesh mesh = a;
  for (Hex hex : b.hexes) {
    for (Index& node : hex) node += a.n_nodes();
    mesh.hexes.push_back(hex);
  }
  mesh.points.insert(mesh.points.end(), b.points.begin(), b.points.end());
  return mesh;
}
Mesh moved(Mesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.points) p += by;
  return mesh;
}

/// Names node `from` as `to` everywhere and drops it.
Mesh merged(Mesh mesh, std::vector<std::pair<Index, Index>> from_to) {
  std::ranges::sort(from_to, std::ranges::greater{});
  for (const auto& [from, to] : from_to) {
    mesh.points.erase(mesh.points.begin() + from);
    for (Hex& hex : mesh.hexes)
      for (Index& node : hex) node = node == from ? to : node - (node > from);
  }
  return mesh;
}

/// Merges all nodes at one place.
Mesh welded(const Mesh& mesh) {
  std::map<std::array<double, 3>, Index> first;
  std::vector<std::pair<Index, Index>> from_to;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const Vec3& p = mesh.points[n];
    const auto [at, fresh] = first.try_emplace({p.x(), p.y(), p.z()}, n);
    if (!fresh) from_to.emplace_back(n, at->second);
  }
  return merged(mesh, from_to);
}

/// One of few, so that many coincide.
Vec3 some_place(std::mt19937& random) {
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis) p[axis] = static_cast<double>(random() % 4);
  return p;
}

/// A unit cube beside eight cubes of half the size, joined at the four corners of their common square.
Mesh one_beside_eight() {
  return welded(joined(test::grid(1, 1, 1), moved(test::grid(2, 2, 2, Vec3::Constant(0.5)), Vec3(1, 0, 0))));
}

TEST(validate, finds_nothing_in_good_meshes) {
  std::mt19937 random(1);
  for (const Mesh& mesh : {test::grid(1, 1, 1), test::grid(4, 3, 2), test::pinwheel(3, 2, 2), test::pinwheel(5, 3, 1),
                           test::ring(3, 12, 1), test::ring(2, 16, 2), Mesh{}}) {
    EXPECT_EQ(texts(mesh), "");
    EXPECT_EQ(texts(test::shuffled(mesh, random)), "");
    EXPECT_TRUE(test::conformal(mesh));
  }
}

TEST(validate, finds_nothing_in_thin_layers_and_steep_growth) {
  Mesh mesh = test::grid(6, 6, 20);
  for (Vec3& p : mesh.points) p.z() = std::pow(10, p.z() / 4 - 5);  // layers of 8e-6 to 0.4 under quads of size 1
  EXPECT_EQ(texts(mesh), "");
}

TEST(validate, tells_a_node_that_does_not_exist) {
  Mesh mesh = test::grid(3, 1, 1);
  mesh.hexes[1][3] = 99;
  mesh.hexes[2][0] = mesh.hexes[2][1] = -1;
  mesh.hex_ids = {10, 20, 30};
  EXPECT_EQ(texts(mesh),
            "bad index: hex 20 names a node that does not exist\n"
            "bad index: hex 30 names 2 nodes that do not exist\n"
            "unused node: node 4 belongs to no hex\n");
}

TEST(validate, tells_coordinates_that_are_not_finite) {
  Mesh mesh = test::grid(2, 1, 1);
  mesh.points[4].y() = std::numeric_limits<double>::quiet_NaN();
  mesh.points[7].z() = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(texts(mesh),
            "not finite: node 5 has a coordinate that is not finite\n"
            "not finite: node 8 has a coordinate that is not finite\n");
}

TEST(validate, tells_a_hex_that_names_a_node_twice_and_only_that) {
  Mesh mesh = test::grid(1, 1, 1);
  mesh.hexes[0][7] = mesh.hexes[0][6];
  EXPECT_EQ(texts(mesh),
            "repeated node: hex 1 names node 7 more than once\n"
            "unused node: node 8 belongs to no hex\n");
  mesh.hexes[0][1] = mesh.hexes[0][0];
  EXPECT_EQ(texts(mesh),
            "repeated node: hex 1 names nodes 1 and 7 more than once\n"
            "unused node: node 2 belongs to no hex\n"
            "unused node: node 8 belongs to no hex\n");
}

TEST(validate, tells_hexes_on_the_same_nodes_as_one_group) {
  Mesh mesh = test::grid(2, 1, 1);
  mesh.hexes.push_back(mesh.hexes[0]);
  Hex turned;
  for (int c = 0; c < 8; ++c) turned[c] = mesh.hexes[0][(c >> 2) | (c & 3) << 1];
  mesh.hexes.push_back(turned);
  const auto found = validated(mesh);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, Kind::duplicate_hex);
  EXPECT_EQ(found[0].hexes, (std::vector<Index>{0, 2, 3}));
  EXPECT_EQ(found[0].nodes, (std::vector<Index>{0, 1, 3, 4, 6, 7, 9, 10}));
  EXPECT_EQ(found[0].text, "hexes 1, 3 and 4 are on the same eight nodes");
  EXPECT_FALSE(is_warning(found[0].kind));
}

TEST(validate, tells_nodes_at_one_place) {
  // Two bricks that were never joined: four pairs.
  const Mesh mesh = joined(test::grid(1, 1, 1), moved(test::grid(1, 1, 1), Vec3(1, 0, 0)));
  EXPECT_EQ(texts(mesh),
            "duplicate node: nodes 2 and 9 are at the same place\n"
            "duplicate node: nodes 4 and 11 are at the same place\n"
            "duplicate node: nodes 6 and 13 are at the same place\n"
            "duplicate node: nodes 8 and 15 are at the same place\n");
  EXPECT_TRUE(is_warning(Kind::duplicate_node));
  EXPECT_EQ(texts(mesh, {.relative_tolerance = 0}), "");
}

TEST(validate, finds_exactly_the_nodes_that_are_near_wherever_they_lie) {
  // Pairs at distances on either side of the tolerance, in every direction, at round and random places.
  std::mt19937 random(12);
  std::uniform_real_distribution<double> at(0, 100), direction(-1, 1);
  const double tolerance = 1e-6;
  Mesh mesh = test::grid(1, 1, 1, Vec3::Constant(100));
  std::vector<std::vector<Index>> expected;
  const double size = 100 * std::sqrt(3.0);
  for (int i = 0; i < 20000; ++i) {
    Vec3 p(at(random), at(random), at(random)), step(direction(random), direction(random), direction(random));
    if (i % 2) p = (p.array() * 10).round() / 10 + 0.05;
    const bool near = i % 3 != 0;
    step *= tolerance * size * (near ? 0.99 : 1.01) / step.norm();
    const Index n = mesh.n_nodes();
    mesh.points.push_back(p);
    mesh.points.push_back((p + step).cwiseMax(0).cwiseMin(100));
    if ((mesh.points[n + 1] - p).norm() <= tolerance * size) expected.push_back({n, n + 1});
  }
  std::vector<std::vector<Index>> found;
  for (const Violation& v : validated(mesh, {.relative_tolerance = tolerance}))
    if (v.kind == Kind::duplicate_node) found.push_back(v.nodes);
  // Distinct pairs are further apart than the tolerance here, but for the unlucky few.
  std::size_t n_equal = 0;
  for (const auto& group : expected) n_equal += std::ranges::binary_search(found, group);
  EXPECT_GE(n_equal + 20, expected.size());
  EXPECT_LE(found.size(), expected.size() + 20);
  EXPECT_GT(expected.size(), 13000u);
}

TEST(validate, many_nodes_at_one_place_are_one_violation_and_quick) {
  Mesh mesh = test::grid(1, 1, 1);
  mesh.points.resize(200008, Vec3(0.5, 0.5, 0.5));
  const auto found = validated(mesh);
  EXPECT_EQ(found[0].kind, Kind::duplicate_node);
  EXPECT_EQ(found[0].nodes.size(), 200000u);
  EXPECT_EQ(found[0].text, "nodes 9, 10, 11, 12, 13 and 199995 more are at the same place");
}

TEST(validate, tells_unused_nodes) {
  Mesh mesh = test::grid(1, 1, 1);
  mesh.points.push_back(Vec3(0.5, 0.5, 0));  // in a face, but hanging there only if a hex used it
  mesh.node_ids = {1, 2, 3, 4, 5, 6, 7, 8, 900};
  EXPECT_EQ(texts(mesh), "unused node: node 900 belongs to no hex\n");
  EXPECT_TRUE(is_warning(Kind::unused_node));
}

TEST(validate, tells_nodes_hanging_in_a_face_and_its_edges) {
  const Mesh mesh = one_beside_eight();
  const auto found = only(Kind::hanging_node, mesh);
  ASSERT_EQ(found.size(), 5u) << texts(mesh);
  int n_in_face = 0;
  for (const Violation& v : found) {
    EXPECT_EQ(v.hexes, std::vector<Index>{0});
    ASSERT_EQ(v.nodes.size(), 1u);
    const Vec3& p = mesh.points[v.nodes[0]];
    EXPECT_EQ(p.x(), 1);
    const bool in_face = p.y() == 0.5 && p.z() == 0.5;
    n_in_face += in_face;
    EXPECT_EQ(v.text, "node " + std::to_string(v.nodes[0] + 1) + " lies inside " + (in_face ? "a face" : "an edge") +
                          " of hex 1 and is not a corner there");
  }
  EXPECT_EQ(n_in_face, 1);
  EXPECT_FALSE(is_warning(Kind::hanging_node));
  EXPECT_FALSE(test::conformal(mesh));  // the skin is open
}

TEST(validate, tells_hanging_nodes_however_the_mesh_is_turned_bent_and_rounded) {
  std::mt19937 random(33);
  std::uniform_real_distribution<double> any(-0.2, 0.2);
  for (int round = 0; round < 30; ++round) {
    // A map that is bilinear on the common square keeps nodes on it; then digits are lost as in a file.
    Mesh mesh = test::shuffled(one_beside_eight(), random);
    Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
    for (int i = 0; i < 9; ++i) linear(i / 3, i % 3) += any(random);
    const Vec3 warp(any(random), any(random), any(random));
    for (Vec3& p : mesh.points) {
      p = linear * p + warp * (p.y() * p.z());
      if (round % 2) p = p.cast<float>().cast<double>();
    }
    EXPECT_EQ(only(Kind::hanging_node, mesh).size(), 5u) << "round " << round << "\n" << texts(mesh);
  }
}

TEST(validate, tells_hanging_nodes_of_cuts_in_three_and_of_an_edge_alone) {
  const Mesh thirds =
      welded(joined(test::grid(1, 1, 1), moved(test::grid(3, 3, 3, Vec3::Constant(1.0 / 3)), Vec3(0, 0, 1))));
  EXPECT_EQ(only(Kind::hanging_node, thirds).size(), 12u);
  // Three whole hexes around a line and one cut across it: hex 1 has the line between other hexes, not on the skin.
  Mesh three = test::grid(2, 2, 1);
  three.hexes.erase(three.hexes.begin() + 3);
  const Mesh mesh = welded(joined(three, moved(test::grid(1, 1, 2, Vec3(1, 1, 0.5)), Vec3(1, 1, 0))));
  std::string all = texts(mesh);
  // Middle nodes of the cut column: on the common line of all (3 big hexes), and one on each of the two faces' far
  // edge.
  EXPECT_NE(all.find("lies inside an edge of hexes 1, 2 and 3 and is not a corner there"), std::string::npos) << all;
  EXPECT_NE(all.find("lies inside an edge of hex 2 and"), std::string::npos) << all;
  EXPECT_NE(all.find("lies inside an edge of hex 3 and"), std::string::npos) << all;
}

/// Two blocks of so many hexes side by side, joined where their nodes meet: the quick check is as strict as all of it.
TEST(validate, hanging_nodes_are_not_missed_by_the_quick_check) {
  const unsigned seed = test::random_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-0.2, 0.2);
  const auto one_to = [&](int most) { return 1 + static_cast<int>(random() % static_cast<unsigned>(most)); };
  int n_hanging = 0, n_fitting = 0;
  for (int round = 0; round < 400; ++round) {
    const int y = one_to(3), z = one_to(3), finer_y = one_to(3), finer_z = one_to(3);
    const Mesh coarse = test::grid(1, y, z);
    const Mesh fine = test::grid(one_to(2), finer_y * y, finer_z * z, Vec3(0.5, 1.0 / finer_y, 1.0 / finer_z));
    // Further along, some of them lie beside nothing; others beside half of a face, as a crack or in contact.
    const Vec3 shift(1, random() % 3 ? 0 : 1, random() % 4 ? 0 : 0.25);
    Mesh mesh = test::shuffled(welded(joined(coarse, moved(fine, shift))), random);
    Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
    for (int i = 0; i < 9; ++i) linear(i / 3, i % 3) += any(random);
    for (Vec3& p : mesh.points) p = linear * p;
    const std::vector<Violation> all = validate(mesh);
    const bool hangs = std::ranges::any_of(all, [](const Violation& v) { return !is_warning(v.kind); });
    EXPECT_EQ(has_only_warnings(mesh), !hangs) << "round " << round << "\n" << texts(mesh);
    ++(hangs ? n_hanging : n_fitting);
  }
  EXPECT_GT(n_hanging, 50);
  EXPECT_GT(n_fitting, 20);
}

TEST(validate, tells_parts_in_contact_apart_from_hanging_nodes) {
  const Mesh mesh = joined(test::grid(1, 1, 1), moved(test::grid(1, 1, 1, Vec3::Constant(0.5)), Vec3(1, 0.25, 0.25)));
  const auto found = validated(mesh);
  ASSERT_EQ(found.size(), 4u) << texts(mesh);
  for (const Violation& v : found) EXPECT_EQ(v.kind, Kind::touching_part);
  EXPECT_EQ(found[0].text, "node 9 lies inside a face of hex 1, which it is not joined to there");
  EXPECT_TRUE(is_warning(Kind::touching_part));
}

TEST(validate, tells_faces_of_three_hexes) {
  Mesh mesh = test::grid(2, 1, 1);
  for (int i = 0; i < 4; ++i) mesh.points.push_back(Vec3(1.5, i & 1, i >> 1));
  Hex third = mesh.hexes[1];
  for (int i = 0; i < 4; ++i) third[2 * i + 1] = 12 + i;
  mesh.hexes.push_back(third);
  const auto found = validated(mesh);
  ASSERT_GE(found.size(), 1u);
  const auto crowded = std::ranges::find(found, Kind::crowded_face, &Violation::kind);
  ASSERT_NE(crowded, found.end()) << texts(mesh);
  EXPECT_EQ(crowded->text, "hexes 1, 2 and 3 share the face of nodes 2, 5, 8 and 11: at most two can");
  EXPECT_EQ(crowded->hexes, (std::vector<Index>{0, 1, 2}));
  EXPECT_FALSE(is_warning(Kind::crowded_face));
}

TEST(validate, tells_two_hexes_on_the_same_side_of_their_face) {
  Mesh mesh = test::grid(1, 1, 1);
  for (int i = 0; i < 4; ++i) mesh.points.push_back(Vec3(0.5, i & 1, i >> 1));
  Hex second = mesh.hexes[0];
  for (int i = 0; i < 4; ++i) second[2 * i + 1] = 8 + i;
  mesh.hexes.push_back(second);
  const auto found = validated(mesh);
  const auto folded = std::ranges::find(found, Kind::folded_face, &Violation::kind);
  ASSERT_NE(folded, found.end()) << texts(mesh);
  EXPECT_EQ(folded->text, "hexes 1 and 2 lie on the same side of their face of nodes 1, 3, 5 and 7");
  EXPECT_FALSE(is_warning(Kind::folded_face));
  EXPECT_FALSE(test::conformal(mesh));
}

TEST(validate, tells_hexes_that_join_a_face_in_different_order) {
  Mesh mesh = test::grid(2, 1, 1);
  std::swap(mesh.hexes[1][4], mesh.hexes[1][6]);  // two corners of its x = 0 face
  const auto found = validated(mesh);
  const auto folded = std::ranges::find(found, Kind::folded_face, &Violation::kind);
  ASSERT_NE(folded, found.end()) << texts(mesh);
  EXPECT_EQ(folded->text, "hexes 1 and 2 join the four nodes 2, 5, 8 and 11 of a face in different order");
  EXPECT_NE(std::ranges::find(found, Kind::inverted, &Violation::kind), found.end());
}

TEST(validate, warns_of_hexes_joined_through_an_edge_or_a_node_alone) {
  Mesh edge = test::grid(2, 2, 1);
  edge.hexes = {edge.hexes[0], edge.hexes[3]};
  EXPECT_EQ(texts(edge).substr(0, 86),
            "unused node: node 3 belongs to no hex\nunused node: node 7 belongs to no hex\nunused nod");
  const auto found = validate(edge);
  const auto torn = std::ranges::find(found, Kind::torn_edge, &Violation::kind);
  ASSERT_NE(torn, found.end());
  EXPECT_EQ(std::ranges::count(found, Kind::torn_edge, &Violation::kind), 1);  // not also its two nodes
  EXPECT_EQ(torn->text, "hexes 1 and 2 meet at the edge of nodes 5 and 14 in 2 groups that share no face there");

  Mesh corner = test::grid(2, 2, 2);
  corner.hexes = {corner.hexes[0], corner.hexes[7]};
  const auto at_corner = validate(corner);
  EXPECT_EQ(std::ranges::count(at_corner, Kind::torn_edge, &Violation::kind), 1);
  EXPECT_EQ(at_corner.back().text, "hexes 1 and 2 meet at node 14 in 2 groups that share no face there");
  EXPECT_TRUE(is_warning(Kind::torn_edge));

  // Eight hexes around a node less two opposite ones: the skin touches itself there, the hexes do not fall apart.
  Mesh pinched = test::grid(2, 2, 2);
  pinched.hexes.erase(pinched.hexes.begin() + 7);
  pinched.hexes.erase(pinched.hexes.begin());
  for (const Violation& v : validate(pinched)) EXPECT_EQ(v.kind, Kind::unused_node);
}

TEST(validate, tells_inverted_and_flat_hexes) {
  Mesh mesh = test::grid(3, 1, 1);
  mesh.points[0].x() = 1.25;  // beyond the other end of its edge
  mesh.points[3].x() = 2;     // onto it
  EXPECT_EQ(texts(mesh).substr(texts(mesh).find("inverted:")),
            "inverted: hex 1 is inverted: its smallest corner Jacobian is -0.25\n"
            "inverted: hex 3 is flat: its smallest corner Jacobian is 0\n");
  EXPECT_FALSE(is_warning(Kind::inverted));
}

TEST(validate, names_every_kind) {
  for (int k = 0; k <= static_cast<int>(Kind::inverted); ++k) EXPECT_STRNE(name(static_cast<Kind>(k)), "");
}

TEST(validate, nonsense_meshes_are_told_without_a_crash_and_the_same_on_any_number_of_threads) {
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    Mesh mesh;
    const int n_nodes = 1 + static_cast<int>(random() % 30);
    for (int i = 0; i < n_nodes; ++i) mesh.points.push_back(some_place(random));
    if (round % 5 == 0) mesh.points[0].x() = std::numeric_limits<double>::infinity();
    mesh.hexes.resize(random() % 20);
    for (Hex& hex : mesh.hexes)
      for (Index& node : hex) node = static_cast<Index>(random() % (n_nodes + (round % 7 == 0))) - (round % 11 == 0);
    std::vector<std::string> runs;
    for (const int threads : {1, 8}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      runs.push_back(texts(mesh));
    }
    EXPECT_EQ(runs[0], runs[1]);
    const auto found = validated(mesh);
    EXPECT_TRUE(std::ranges::is_sorted(found, {}, &Violation::kind));
    for (const Violation& v : found) {
      EXPECT_TRUE(std::ranges::is_sorted(v.hexes));
      EXPECT_TRUE(std::ranges::is_sorted(v.nodes));
    }
  }
}

TEST(validate, is_the_same_for_any_number_of_threads_on_a_large_broken_mesh) {
  std::mt19937 random(5);
  Mesh mesh = test::shuffled(test::grid(30, 30, 30), random);
  std::uniform_real_distribution<double> step(-0.6, 0.6);
  for (int i = 0; i < 3000; ++i) mesh.points[random() % mesh.points.size()] += Vec3(step(random), step(random), 0);
  for (int i = 0; i < 30; ++i) mesh.hexes[random() % mesh.hexes.size()][0] = static_cast<Index>(random() % 1000);
  for (int i = 0; i < 3000; ++i) mesh.hexes.erase(mesh.hexes.begin() + random() % mesh.hexes.size());
  std::vector<std::string> runs;
  for (const int threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    runs.push_back(texts(mesh));
  }
  EXPECT_EQ(runs[1], runs[0]);
  EXPECT_EQ(runs[2], runs[0]);
  EXPECT_GT(runs[0].size(), 10000u);
}

/// Prints what a million hexes cost. Run by hand: --gtest_also_run_disabled_tests --gtest_filter=*million*
TEST(validate, DISABLED_of_a_million_hexes_is_quick) {
  std::mt19937 random(1);
  const Mesh straight = test::grid(100, 100, 100);
  for (const Mesh& mesh : {straight, test::shuffled(straight, random)})
    for (const int threads : {1, 2}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const auto start = std::chrono::steady_clock::now();
      EXPECT_TRUE(validated(mesh).empty());
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      std::printf("  %d threads, validate %.3f s\n", threads, seconds.count());
    }
}

void mirror(Hex& hex) {
  for (int c = 0; c < 4; ++c) std::swap(hex[c], hex[c + 4]);
}

TEST(repair_orientation, leaves_good_meshes_alone) {
  for (const Mesh& mesh : {test::grid(3, 2, 2), test::ring(3, 12, 1), Mesh{}}) {
    Mesh same = mesh;
    const OrientationRepair repair = repair_orientation(same);
    EXPECT_EQ(same, mesh);
    EXPECT_EQ(repair.notice, "");
    EXPECT_TRUE(repair.flipped.empty());
  }
}

TEST(repair_orientation, turns_a_mesh_that_is_inside_out_and_says_so) {
  std::mt19937 random(1);
  for (const Mesh& good : {test::grid(3, 2, 2), test::pinwheel(5, 2, 2), test::ring(3, 12, 1)}) {
    Mesh mesh = test::shuffled(good, random);
    for (Hex& hex : mesh.hexes) mirror(hex);
    const OrientationRepair repair = repair_orientation(mesh);
    EXPECT_EQ(std::ssize(repair.flipped), mesh.n_hexes());
    EXPECT_EQ(repair.notice, "all " + std::to_string(mesh.n_hexes()) + " hexes were inside out: turned");
    EXPECT_TRUE(test::uninverted(mesh));
    EXPECT_TRUE(test::conformal(mesh));
  }
}

TEST(repair_orientation, turns_hexes_in_every_pattern) {
  const Mesh good = test::grid(2, 2, 2);
  for (int pattern = 0; pattern < 256; ++pattern) {
    Mesh mesh = good;
    std::vector<Index> expected;
    for (Index h = 0; h < 8; ++h)
      if (pattern >> h & 1) {
        mirror(mesh.hexes[h]);
        expected.push_back(h);
      }
    const OrientationRepair repair = repair_orientation(mesh);
    EXPECT_EQ(repair.flipped, expected);
    EXPECT_EQ(mesh, good);
  }
}

TEST(repair_orientation, says_which_and_side_sets_follow) {
  Mesh mesh = test::grid(2, 1, 2);
  mesh.side_sets = {{1, "both ends", {{1, 4}, {3, 0}, {3, 4}, {3, 5}}}, {2, "top", {{2, 5}, {3, 5}}}};
  mesh.hex_ids = {10, 20, 30, 40};
  Mesh broken = mesh;
  mirror(broken.hexes[3]);
  broken.side_sets[1].sides = {{2, 5}, {3, 4}};
  const OrientationRepair repair = repair_orientation(broken);
  EXPECT_EQ(broken, mesh);
  EXPECT_EQ(repair.notice, "hex 40 was inside out: turned");
  EXPECT_EQ(side_after(repair, {3, 4}), (Side{3, 5}));
  EXPECT_EQ(side_after(repair, {3, 5}), (Side{3, 4}));
  EXPECT_EQ(side_after(repair, {3, 1}), (Side{3, 1}));
  EXPECT_EQ(side_after(repair, {2, 4}), (Side{2, 4}));
  mirror(broken.hexes[1]);
  mirror(broken.hexes[2]);
  EXPECT_EQ(repair_orientation(broken).notice, "2 hexes were inside out: turned (the first is hex 20)");
}

TEST(repair_orientation, leaves_inverted_hexes_that_agree_with_their_neighbours) {
  Mesh mesh = test::grid(3, 3, 3);
  for (const Index n : {21, 25, 37, 41}) mesh.points[n].x() += 1.5;  // the x = 1 side of the middle hex, past x = 2
  const Mesh before = mesh;
  ASSERT_LT(min_corner_jacobian(mesh, 13), 0);
  ASSERT_LT(volume(mesh, 13), 0);
  EXPECT_TRUE(repair_orientation(mesh).flipped.empty());
  EXPECT_EQ(mesh, before);
  // Turned wholly, it comes back as it was, inverted hex and all.
  for (Hex& hex : mesh.hexes) mirror(hex);
  EXPECT_EQ(repair_orientation(mesh).flipped.size(), 27u);
  EXPECT_EQ(mesh, before);
}

TEST(repair_orientation, leaves_hexes_folded_over_their_neighbours) {
  Mesh mesh = test::grid(1, 1, 1);
  for (int i = 0; i < 4; ++i) mesh.points.push_back(Vec3(0.5, i & 1, i >> 1));
  Hex second = mesh.hexes[0];
  for (int i = 0; i < 4; ++i) second[2 * i + 1] = 8 + i;
  mesh.hexes.push_back(second);
  EXPECT_TRUE(repair_orientation(mesh).flipped.empty());
}

TEST(repair_orientation, judges_parts_on_their_own_and_survives_nonsense) {
  Mesh mesh = joined(test::grid(2, 1, 1), moved(test::grid(1, 1, 1), Vec3(9, 0, 0)));
  const Mesh good = mesh;
  mirror(mesh.hexes[2]);
  EXPECT_EQ(repair_orientation(mesh).flipped, std::vector<Index>{2});
  EXPECT_EQ(mesh, good);
  mesh.hexes[0][0] = 99;
  EXPECT_THROW(repair_orientation(mesh), Error);
  std::mt19937 random(4);
  for (int round = 0; round < 200; ++round) {
    Mesh any;
    for (int i = 0; i < 20; ++i) any.points.push_back(some_place(random));
    if (round % 5 == 0) any.points[0].x() = std::numeric_limits<double>::quiet_NaN();
    any.hexes.resize(10);
    for (Hex& hex : any.hexes)
      for (Index& node : hex) node = static_cast<Index>(random() % 20);
    const Mesh before = any;
    const auto flipped = repair_orientation(any).flipped;
    for (Index h = 0; h < any.n_hexes(); ++h)
      EXPECT_EQ(any.hexes[h] != before.hexes[h], std::ranges::binary_search(flipped, h));
  }
}

}  // namespace
}  // namespace hextwist
