// What a session promises of its mesh: valid hexes, nodes on the CAD, named shapes kept.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "geom/occ_shapes.h"
#include "hextwist/base/same_bits.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/quality/validity.h"
#include "session/session_fixture.h"
#include "support/checkers.h"
#include "support/seed.h"

namespace hextwist {

using test::Fixture, test::folder;

namespace {

bool has(const std::vector<std::string>& lines, const std::string& part) {
  return std::ranges::any_of(lines, [&](const std::string& line) { return line.find(part) != std::string::npos; });
}

/// A grid with a hex that is inverted between its corners alone: a layer of its inner column is turned by half, wider
/// than long.
Mesh inverted_inside() {
  Mesh mesh = test::grid(3, 3, 4, Vec3(1, 1, 2));
  for (const Index n : {21, 22, 25, 26}) {
    Vec3& p = mesh.points[16 + n];
    p = Vec3(1.5, 1.5, p.z()) - Vec3(1.3, 0.6, 0).cwiseProduct(p - Vec3(1.5, 1.5, p.z()));
  }
  return mesh;
}

TEST(Valid, hexes_inverted_between_their_corners_are_refused_by_check_and_untangled_on_reading) {
  const Mesh mesh = inverted_inside();
  const std::vector<Index> bad = inverted_hexes(mesh);
  ASSERT_FALSE(bad.empty());
  ASSERT_TRUE(std::ranges::any_of(bad, [&](Index h) { return judge(mesh, h).fault == HexFault::inside; }));
  const auto file = folder() / "a.vtu";
  write_mesh(file, mesh, nullptr);
  Fixture f;
  f.session.run("import mesh '" + file.string() + "'; check");
  EXPECT_TRUE(has(f.notices, "untangled"));
  EXPECT_TRUE(test::uninverted(f.session.meshed().mesh));
  EXPECT_NE(f.error("set untangle off; import mesh '" + file.string() + "'"), "no error");
}

TEST(Valid, untangling_moves_only_what_is_near) {
  Mesh mesh = test::grid(16, 16, 16);
  const std::vector<Vec3> before = mesh.points;
  const auto push = [&](const Vec3& at, const Vec3& by) { *std::ranges::find(mesh.points, at) += by; };
  push(Vec3(4, 4, 4), Vec3(1.2, 0.1, 0));
  push(Vec3(12, 12, 12), Vec3(0, 0, -1.1));
  push(Vec3(8, 8, 0), Vec3(1.1, 0, 0));
  Fixture f;
  f.session.take(mesh, nullptr);
  const Mesh& mended = f.session.meshed().mesh;
  EXPECT_TRUE(test::uninverted(mended));
  Index n_moved = 0;
  for (Index n = 0; n < mended.n_nodes(); ++n) {
    if (mended.points[n] == mesh.points[n]) continue;
    ++n_moved;
    double nearest = INFINITY;
    for (const Vec3& at : {Vec3(4, 4, 4), Vec3(12, 12, 12), Vec3(8, 8, 0)})
      nearest = std::min(nearest, (before[n] - at).cwiseAbs().maxCoeff());
    EXPECT_LE(nearest, 4) << n;
  }
  EXPECT_LT(n_moved, mended.n_nodes() / 10);
  EXPECT_GT(n_moved, 2);
}

TEST(Valid, thin_hexes_refined_again_and_again_are_told_or_refused) {
  // Templates that are wide for slabs: quality falls with every cut, and the notice says how far.
  Fixture f;
  Mesh mesh = test::grid(6, 6, 4, Vec3(1, 1, 0.02));
  f.session.take(mesh, nullptr);
  bool told = false;
  for (int i = 0; i < 6 && f.error("refine edge 60 numsplit 2") == "no error"; ++i) {
    told |= has(f.notices, "scaled Jacobian below 0.1, the smallest 0.0");
    const Mesh& refined = f.session.meshed().mesh;
    EXPECT_TRUE(inverted_hexes(refined).empty());
    EXPECT_TRUE(test::uninverted(refined));
  }
  EXPECT_TRUE(told);
}

/// Boxes in the way of nodes: volumes of what was named, before and after.
double volume_of(const Mesh& mesh, const std::vector<Index>& hexes) {
  double sum = 0;
  for (const Index h : hexes) sum += volume(mesh, h);
  return sum;
}

TEST(Kept, interfaces_of_blocks_that_overlap_or_leave_hexes_out_stay_when_refined_with_smoothing) {
  const auto cad = folder() / "box.brep";
  test::OccShape::brick(8, 4, 4).write(cad);
  for (int kind = 0; kind < 4; ++kind) {
    SCOPED_TRACE(kind);
    Mesh mesh = test::grid(8, 4, 4);
    mesh.blocks = {{1, "A", {}}, {2, "B", {}}, {3, "all", {}}};
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      mesh.blocks[h % 8 < 4 ? 0 : 1].hexes.push_back(h);
      mesh.blocks[2].hexes.push_back(h);
    }
    if (kind == 0 || kind == 3) mesh.blocks.pop_back();
    if (kind == 2) mesh.blocks.resize(1);
    for (const std::string command :
         {"refine hex all with x_min > 2.9 and x_max < 4.1 and y_max < 1.1 and z_max < 1.1 depth 1 smooth",
          "refine node with x_coord = 4 and y_coord = 2 and z_coord = 2 numsplit 3",
          "refine hex 4 numsplit 2 smooth; smooth volume all"}) {
      Fixture f;
      if (kind == 3) f.session.run("import geometry '" + cad.string() + "'");
      f.session.take_mesh(mesh);
      f.session.run(command);
      const Mesh& after = f.session.meshed().mesh;
      EXPECT_NEAR(volume_of(after, after.blocks[0].hexes), 64, 1e-9) << command;
    }
  }
}

TEST(Kept, a_side_set_that_ends_within_a_surface_stays_as_large) {
  const auto cad = folder() / "box.brep";
  test::OccShape::brick(8, 4, 4).write(cad);
  std::mt19937 random(test::random_seed());
  std::uniform_real_distribution<double> off(-0.3, 0.3);
  Mesh mesh = test::grid(8, 4, 4);
  mesh.side_sets = {{1, "load", {}}};
  for (Index h = 96; h < mesh.n_hexes(); ++h)
    if (h % 8 < 4) mesh.side_sets[0].sides.push_back({h, 5});
  for (Vec3& p : mesh.points)
    if (p.z() == 4 && p.x() > 0 && p.x() < 8 && p.y() > 0 && p.y() < 4) {
      p.y() += off(random);
      if (p.x() != 4) p.x() += off(random);
    }
  const auto area = [](const Mesh& of) {
    double sum = 0;
    for (const Side side : of.side_sets[0].sides) {
      const auto n = face_nodes(of.hexes[side.hex], side.face);
      sum += (of.points[n[3]] - of.points[n[0]]).cross(of.points[n[2]] - of.points[n[1]]).norm() / 2;
    }
    return sum;
  };
  for (const std::string command : {"smooth volume all", "refine hex 101 smooth", "smooth surface all"}) {
    SCOPED_TRACE(command);
    Fixture f;
    f.session.run("import geometry '" + cad.string() + "'");
    f.session.take_mesh(mesh);
    EXPECT_NEAR(area(f.session.meshed().mesh), 16, 1e-9);
    f.session.run(command);
    EXPECT_FALSE(same_bits(f.session.meshed().mesh.points, mesh.points));
    EXPECT_NEAR(area(f.session.meshed().mesh), 16, 1e-9);
  }
}

TEST(Kept, jumps_of_a_field_stay_when_asked_for) {
  Mesh mesh = test::grid(8, 4, 4);
  Field field{"grain", Field::On::hex, 1, {}};
  for (Index h = 0; h < mesh.n_hexes(); ++h) field.values.push_back(h % 8 < 4 ? 1 : 2);
  mesh.fields = {field};
  for (const bool keep : {false, true}) {
    Fixture f;
    f.session.take(mesh, nullptr);
    if (keep) f.session.run("set keep_jumps \"grain\"");
    f.session.run("refine hex all with x_min > 2.9 and x_max < 4.1 and y_max < 1.1 and z_max < 1.1 depth 1 smooth");
    const Mesh& after = f.session.meshed().mesh;
    std::vector<Index> ones;
    for (Index h = 0; h < after.n_hexes(); ++h)
      if (after.fields[0].values[h] == 1) ones.push_back(h);
    if (keep)
      EXPECT_NEAR(volume_of(after, ones), 64, 1e-9);
    else
      EXPECT_GT(std::abs(volume_of(after, ones) - 64), 1e-6);
  }
}

TEST(Kept, jumps_of_a_field_stay_in_adaptive_calls) {
  Mesh mesh = test::grid(8, 4, 4);
  Field field{"grain", Field::On::hex, 1, {}};
  for (Index h = 0; h < mesh.n_hexes(); ++h) field.values.push_back(h % 8 < 4 ? 1 : 2);
  mesh.fields = {field};
  std::vector<std::int8_t> changes(mesh.hexes.size(), 0);
  changes[3] = 2;  // beside the jump, in a corner
  for (const bool keep : {false, true}) {
    Fixture f;
    f.session.take(mesh, nullptr);
    if (keep) f.session.run("set keep_jumps \"grain\"");
    f.session.adapt(changes, {.smooth = true});
    const Mesh& after = f.session.meshed().mesh;
    const Field& grain = *std::ranges::find(after.fields, "grain", &Field::name);
    std::vector<Index> ones;
    for (Index h = 0; h < after.n_hexes(); ++h)
      if (grain.values[h] == 1) ones.push_back(h);
    if (keep)
      EXPECT_NEAR(volume_of(after, ones), 64, 1e-9);
    else
      EXPECT_GT(std::abs(volume_of(after, ones) - 64), 1e-6);
  }
}

/// A hole of radius 1 with four hexes around it in a thin first layer: the middle of a quarter of the hole lies beyond
/// the layer.
Fixture hole_behind_a_thin_layer() {
  const auto cad = folder() / "hole.brep";
  test::OccShape::brick_with_hole(2.4, 2.4, 1, 1).write(cad);
  Mesh mesh;
  for (const double z : {0.0, 1.0})
    for (const double r : {1.0, 1.02, 1.2 * std::sqrt(2.0)})
      for (int quarter = 0; quarter < 4; ++quarter) {
        const double angle = (2 * quarter + 1) * std::numbers::pi / 4;
        mesh.points.emplace_back(1.2 + r * std::cos(angle), 1.2 + r * std::sin(angle), z);
      }
  for (int layer = 0; layer < 2; ++layer)
    for (int quarter = 0; quarter < 4; ++quarter) {
      const Index a = 4 * layer + quarter, b = 4 * layer + (quarter + 1) % 4;
      mesh.hexes.push_back({a, a + 4, b, b + 4, a + 12, a + 16, b + 12, b + 16});
    }
  Fixture f;
  f.session.run("import geometry '" + cad.string() + "'");
  f.session.take_mesh(std::move(mesh));
  return f;
}

TEST(OffCad, a_refinement_that_cannot_put_nodes_on_the_cad_is_refused_unless_that_is_allowed) {
  Fixture f = hole_behind_a_thin_layer();
  const Mesh before = f.session.meshed().mesh;
  const std::string error = f.error("refine curve with radius = 1");
  EXPECT_NE(error.find("could not be put on"), std::string::npos) << error;
  EXPECT_NE(error.find("'allow off_cad' would leave it there"), std::string::npos) << error;
  EXPECT_EQ(f.session.meshed().mesh.points, before.points);
  EXPECT_EQ(f.session.meshed().mesh.hexes, before.hexes);
  EXPECT_FALSE(f.last().violations.empty());
  EXPECT_EQ(f.error("refine curve with radius = 1 allow off_cad"), "no error");
  EXPECT_TRUE(has(f.notices, "could not be put where they belong"));
  EXPECT_GT(f.last().off_cad.max, 1e-3);
  EXPECT_TRUE(test::uninverted(f.session.meshed().mesh));
}

TEST(Snap, nodes_that_a_file_has_rounded_are_put_on_the_cad) {
  Fixture made;
  made.session.run("create cylinder radius 2 height 5 interval 4");
  Mesh rounded = made.session.meshed().mesh;
  for (Vec3& p : rounded.points)
    for (double& x : p) x = std::round(x * 1e6) / 1e6;
  const auto model = made.session.meshed().model;
  Fixture f;
  f.session.take(rounded, model);
  EXPECT_TRUE(has(f.notices, "put on the CAD, moved by at most"));
  EXPECT_LT(f.last().off_cad.max_relative, 1e-12);
  f.session.run("refine surface 1; check");
  EXPECT_LT(f.last().off_cad.max_relative, 1e-12);

  Fixture kept;
  kept.session.run("set snap off");
  kept.session.take(rounded, model);
  EXPECT_EQ(kept.session.meshed().mesh.points, rounded.points);
  EXPECT_GT(kept.last().off_cad.max_relative, 1e-9);
  // A mesh that lies on it is left alone, to the bit.
  Fixture exact;
  exact.session.take(made.session.meshed().mesh, model);
  EXPECT_EQ(exact.session.meshed().mesh.points, made.session.meshed().mesh.points);
  EXPECT_TRUE(exact.notices.empty());
}

}  // namespace
}  // namespace hextwist
