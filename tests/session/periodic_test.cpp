// Surfaces that repeat others stay alike, whatever is done to one of them. The checker matches by coordinates alone.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "hextwist/base/same_bits.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/quality/quality.h"
#include "session_fixture.h"
#include "support/checkers.h"
#include "support/same_meshed.h"
#include "support/seed.h"

namespace hextwist {
namespace {

using test::Fixture;
using Map = std::function<Vec3(const Vec3&)>;
using On = std::function<bool(const Vec3&)>;

const Mesh& mesh_of(const Fixture& f) {
  return f.session.meshed().mesh;
}

/// Quads of the skin all of whose corners are there, as sets of nodes.
std::set<std::set<Index>> skin_quads(const Mesh& mesh, const On& on) {
  constexpr int faces[6][4] = {{0, 2, 4, 6}, {1, 3, 5, 7}, {0, 1, 4, 5}, {2, 3, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}};
  std::map<std::set<Index>, int> count;
  for (const Hex& hex : mesh.hexes)
    for (const auto& face : faces) {
      std::set<Index> quad;
      for (const int c : face) quad.insert(hex[c]);
      if (std::ranges::all_of(quad, [&](Index n) { return on(mesh.points[n]); })) ++count[quad];
    }
  std::set<std::set<Index>> result;
  for (const auto& [quad, n] : count)
    if (n == 1) result.insert(quad);
  return result;
}

testing::AssertionResult alike(const Mesh& mesh, const On& from, const On& to, const Map& map) {
  const auto quads = skin_quads(mesh, from), images = skin_quads(mesh, to);
  std::set<Index> nodes, there;
  for (const auto& quad : quads) nodes.insert(quad.begin(), quad.end());
  for (const auto& quad : images) there.insert(quad.begin(), quad.end());
  if (quads.empty()) return testing::AssertionFailure() << "nothing there";
  if (quads.size() != images.size())
    return testing::AssertionFailure() << quads.size() << " faces and " << images.size();
  std::map<Index, Index> image;
  for (const Index n : nodes) {
    const Vec3 p = map(mesh.points[n]);
    for (const Index m : there)
      if ((mesh.points[m] - p).norm() < 1e-8) image[n] = m;
    if (!image.contains(n)) return testing::AssertionFailure() << "node " << node_id(mesh, n) << " has no image";
  }
  for (const auto& quad : quads) {
    std::set<Index> mapped;
    for (const Index n : quad) mapped.insert(image.at(n));
    if (!images.contains(mapped))
      return testing::AssertionFailure() << "the face with node " << node_id(mesh, *quad.begin()) << " has no image";
  }
  return testing::AssertionSuccess();
}

/// The surface of a box that lies at a place along an axis.
int surface_at(const Fixture& f, int axis, double place) {
  const Model& model = *f.session.meshed().model;
  for (int id = 1; id <= model.count(2); ++id) {
    const Box box = model.box({2, id});
    if (std::abs(box.min[axis] - place) < 1e-6 && std::abs(box.max[axis] - place) < 1e-6) return id;
  }
  return 0;
}

testing::AssertionResult alike_along(const Mesh& mesh, int axis, double half) {
  return alike(
      mesh, [&](const Vec3& p) { return std::abs(p[axis] + half) < 1e-9; },
      [&](const Vec3& p) { return std::abs(p[axis] - half) < 1e-9; },
      [&](const Vec3& p) { return Vec3(p + 2 * half * Vec3::Unit(axis)); });
}

constexpr double halves[3] = {2, 1.5, 1};

/// A box, periodic along the first `n_axes` axes.
void start(Fixture& f, int n_axes, const std::string& intervals = "4 3 3") {
  f.session.run("create brick x 4 y 3 z 2 interval " + intervals);
  for (int axis = 0; axis < n_axes; ++axis)
    f.session.run("periodic surface " + std::to_string(surface_at(f, axis, -halves[axis])) + " " +
                  std::to_string(surface_at(f, axis, halves[axis])));
}

class Chance {
 public:
  explicit Chance(unsigned seed) : random_(seed) {}
  std::string of(int n) { return std::to_string(1 + random_() % static_cast<unsigned>(n)); }
  unsigned below(unsigned n) { return static_cast<unsigned>(random_() % n); }

 private:
  std::mt19937 random_;
};

std::string any_hex(const Mesh& mesh, Chance& chance) {
  return std::to_string(hex_id(mesh, static_cast<Index>(chance.below(static_cast<unsigned>(mesh.n_hexes())))));
}

void random_boxes(int n_rounds, int n_steps, Index most) {
  const unsigned seed = test::random_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  Chance chance(seed);
  int n_done = 0, n_refused = 0;
  for (int round = 0; round < n_rounds; ++round) {
    const int n_axes = 1 + static_cast<int>(chance.below(3));
    Fixture f;
    start(f, n_axes, round % 2 ? "2 3 4" : "4 3 3");
    for (int step = 0; step < n_steps && mesh_of(f).n_hexes() < most; ++step) {
      const std::string hex = any_hex(mesh_of(f), chance);
      const std::string commands[] = {
          // these keep pairs wherever they are
          "refine hex " + hex, "refine hex " + hex + " numsplit 2", "refine vertex " + chance.of(8) + " depth 1",
          "refine curve " + chance.of(12) + " depth 1", "refine surface " + chance.of(6) + " depth 1",
          "refine curve " + chance.of(12) + " depth 1 smooth", "refine vertex " + chance.of(8) + " size 0.3 bias 1.6",
          "smooth volume all", "refine hex " + hex + " graded",
          // these where they can
          "coarsen hex " + hex, "coarsen surface " + chance.of(6), "refine curve " + chance.of(12),
          "refine vertex " + chance.of(8), "refine surface " + chance.of(6),
          "refine surface " + chance.of(6) + " direction thickness",
          "refine surface " + chance.of(6) + " direction layers 2", "refine hex " + hex + " method parallel",
          "refine sheet edge 1", "refine hex " + hex + " transition nested", "refine hex " + hex + " concave fill",
          "refine volume all"};
      constexpr unsigned n_sure = 9;
      const unsigned which = chance.below(std::size(commands));
      SCOPED_TRACE("round " + std::to_string(round) + ", " + std::to_string(n_axes) + " axes: " + commands[which]);
      const MeshedModel before = f.session.meshed();
      const std::string error = f.error(commands[which]);
      if (error == "no error") {
        ++n_done;
        EXPECT_TRUE(test::conformal(mesh_of(f)));
        EXPECT_TRUE(test::uninverted(mesh_of(f)));
      } else {
        ++n_refused;
        EXPECT_GE(which, n_sure) << error;
        EXPECT_TRUE(test::same_bits(before, f.session.meshed()));
      }
      for (int axis = 0; axis < n_axes; ++axis) ASSERT_TRUE(alike_along(mesh_of(f), axis, halves[axis])) << error;
    }
  }
  EXPECT_GT(n_done, n_refused / 2);
}

TEST(Periodic, boxes_stay_alike_under_random_commands) {
  random_boxes(8, 4, 3000);
}
TEST(SlowPeriodic, boxes_stay_alike_under_many_random_commands) {
  random_boxes(60, 6, 6000);
}

TEST(Periodic, what_comes_out_inverted_beside_a_side_is_repaired_without_moving_its_nodes) {
  Fixture f;
  start(f, 1, "2 3 4");
  f.session.run(
      "refine curve 12 depth 1 smooth; refine hex 80; refine surface 4 direction thickness; refine sheet edge 1");
  f.session.run("refine curve 5 depth 1");
  EXPECT_TRUE(test::uninverted(mesh_of(f)));
  EXPECT_TRUE(alike_along(mesh_of(f), 0, 2));
}

TEST(Periodic, what_is_cut_at_one_side_is_cut_at_the_other) {
  Fixture f;
  start(f, 1);
  const Index before = mesh_of(f).n_hexes();
  f.session.run("refine hex in surface " + std::to_string(surface_at(f, 0, -2)) + " numsplit 2");
  EXPECT_TRUE(alike_along(mesh_of(f), 0, 2));
  Index n_left = 0, n_right = 0;
  for (const Hex& hex : mesh_of(f).hexes) {
    double x = 0;
    for (const Index n : hex) x += mesh_of(f).points[n].x() / 8;
    ++(x < 0 ? n_left : n_right);
  }
  EXPECT_GT(n_right, before / 2 + 100);
  EXPECT_GT(n_left, n_right);
  f.session.run("coarsen volume all levels 9");
  EXPECT_EQ(mesh_of(f).n_hexes(), before);
}

TEST(Periodic, what_would_differ_is_refused_by_name) {
  Fixture f;
  start(f, 1);
  const MeshedModel before = f.session.meshed();
  const int side = surface_at(f, 0, -2);
  const std::string error = f.error("refine surface " + std::to_string(side));
  EXPECT_NE(error.find("surface " + std::to_string(side) + " does not repeat on surface"), std::string::npos) << error;
  EXPECT_NE(error.find("whole hexes"), std::string::npos) << error;
  EXPECT_TRUE(test::same_bits(before, f.session.meshed()));
  f.session.run("periodic off; refine surface " + std::to_string(side));
  EXPECT_FALSE(alike_along(mesh_of(f), 0, 2));
  EXPECT_NE(f.error("periodic surface " + std::to_string(side) + " " + std::to_string(surface_at(f, 0, 2))),
            "no error");
}

TEST(Periodic, pairs_are_listed_undone_and_moved_along) {
  Fixture f;
  start(f, 2);
  f.session.run("list periodic");
  EXPECT_NE(f.all_output().find("moved by (4, 0, 0): 16 pairs of nodes"), std::string::npos) << f.all_output();
  f.session.run(
      "rotate model 30 about z; scale 2; move 1 2 3; reflect model x; refine hex 1 2 numsplit 2; refine vertex 1 depth "
      "1");
  EXPECT_EQ(f.error("list periodic"), "no error");
  f.session.run("undo 8; list periodic");
  EXPECT_EQ(f.output.back(), "no surface is periodic");
  f.session.run("redo 8; list periodic");
  EXPECT_NE(f.output.back().find("repeats surface"), std::string::npos);
  EXPECT_NE(f.error("periodic surface 1 1"), "no error");
  EXPECT_NE(f.error("periodic surface 1 99"), "no error");
  EXPECT_NE(f.error("export levels 'a.levels'"), "no error");
}

/// A sector of an annulus, from an angle of 0 on.
Mesh sector(double degrees, int around, int outwards, int up) {
  Mesh mesh;
  for (int k = 0; k <= up; ++k)
    for (int j = 0; j <= outwards; ++j)
      for (int i = 0; i <= around; ++i) {
        const double angle = degrees * i / around * std::numbers::pi / 180, r = 1 + 1.0 * j / outwards;
        mesh.points.emplace_back(r * std::cos(angle), r * std::sin(angle), 1.0 * k / up);
      }
  const auto at = [&](int i, int j, int k) { return static_cast<Index>((k * (outwards + 1) + j) * (around + 1) + i); };
  for (int k = 0; k < up; ++k)
    for (int j = 0; j < outwards; ++j)
      for (int i = 0; i < around; ++i) {
        Hex hex;
        for (int c = 0; c < 8; ++c) hex[c] = at(i + (c >> 1 & 1), j + (c & 1), k + (c >> 2));
        mesh.hexes.push_back(hex);
      }
  return mesh;
}

TEST(Periodic, a_sector_repeats_by_turning) {
  const unsigned seed = test::random_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  Chance chance(seed);
  for (const double degrees : {60.0, 90.0}) {
    Fixture f;
    f.session.take_mesh(sector(degrees, 6, 3, 2));
    const double angle = degrees * std::numbers::pi / 180;
    const Vec3 across(-std::sin(angle), std::cos(angle), 0);
    const On from = [](const Vec3& p) { return std::abs(p.y()) < 1e-9; };
    const On to = [&](const Vec3& p) { return std::abs(across.dot(p)) < 1e-9; };
    const Map turn = [&](const Vec3& p) { return Vec3(Eigen::AngleAxisd(angle, Vec3::UnitZ()) * p); };
    ASSERT_TRUE(alike(mesh_of(f), from, to, turn));
    const auto surface = [&](const On& on) {
      const Association& a = f.session.meshed().association;
      for (std::size_t i = 0; i < a.surface_faces.size(); ++i) {
        const auto nodes = face_nodes(mesh_of(f).hexes[a.surface_faces[i].hex], a.surface_faces[i].face);
        if (std::ranges::all_of(nodes, [&](Index n) { return on(mesh_of(f).points[n]); })) return a.face_surface[i];
      }
      return 0;
    };
    const std::string pair = std::to_string(surface(from)) + " " + std::to_string(surface(to));
    f.session.run(degrees == 60 ? "periodic surface " + pair : "periodic surface " + pair + " angle 90 about z");
    EXPECT_NE(f.output.back().find("turned by " + std::to_string(static_cast<int>(degrees)) + " degrees"),
              std::string::npos)
        << f.output.back();
    f.session.run("refine hex in surface " + std::to_string(surface(to)));
    ASSERT_TRUE(alike(mesh_of(f), from, to, turn));
    for (int step = 0; step < 3; ++step) {
      const std::string command = "refine hex " + any_hex(mesh_of(f), chance) + (step == 1 ? " smooth" : "");
      SCOPED_TRACE(command);
      f.session.run(command);
      EXPECT_TRUE(test::conformal(mesh_of(f)));
      EXPECT_TRUE(test::uninverted(mesh_of(f)));
      ASSERT_TRUE(alike(mesh_of(f), from, to, turn));
    }
  }
}

TEST(Periodic, gmsh_files_say_pairs_both_ways) {
  Fixture f;
  start(f, 3);
  f.session.run("refine hex 1 to 3");
  const std::string file = (test::folder() / "periodic.msh").string();
  f.session.run("export gmsh '" + file + "' text");
  const MeshFile read = read_mesh(file);
  std::map<int, int> n_of_dim;
  for (const PeriodicPairs& link : read.extras.periodic) {
    ++n_of_dim[link.dim];
    for (const auto& [image, node] : link.nodes) {
      const Vec3 shift = read.mesh.points[find_node(read.mesh, image)] - read.mesh.points[find_node(read.mesh, node)];
      const int n_along = (std::abs(shift.x()) > 1e-9) + (std::abs(shift.y()) > 1e-9) + (std::abs(shift.z()) > 1e-9);
      EXPECT_EQ(n_along, 1);
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_TRUE(std::abs(shift[axis]) < 1e-9 || std::abs(shift[axis] - 2 * halves[axis]) < 1e-9);
    }
  }
  EXPECT_EQ(n_of_dim[2], 3);
  EXPECT_GT(n_of_dim[1], 3);
  Fixture g;
  g.session.run("import mesh '" + file + "'; list periodic");
  EXPECT_NE(g.all_output().find("moved by (4, 0, 0)"), std::string::npos) << g.all_output();
  EXPECT_NE(g.all_output().find("moved by (0, 0, 2)"), std::string::npos) << g.all_output();
  g.session.run("refine hex 40");
  for (int axis = 0; axis < 3; ++axis) EXPECT_TRUE(alike_along(mesh_of(g), axis, halves[axis]));
  g.session.run("export gmsh '" + file + "' text overwrite");
  const MeshFile again = read_mesh(file);
  EXPECT_EQ(std::ranges::count(again.extras.periodic, 2, &PeriodicPairs::dim), 3);
}

}  // namespace
}  // namespace hextwist
