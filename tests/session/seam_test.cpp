// Seams of double nodes (cracks, contact) and faces of the CAD inside a solid.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "geom/occ_shapes.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/corners.h"
#include "session/session_fixture.h"
#include "support/checkers.h"
#include "support/seed.h"

namespace hextwist {

using test::Fixture, test::folder;

namespace {

/// 4 x 4 x 2 cubes; cracked: the nodes of x = 2, y < 2 are doubled, and side sets 1 and 2 are the faces of the crack.
Mesh block(bool cracked) {
  Mesh mesh = test::grid(4, 4, 2);
  if (!cracked) return mesh;
  std::vector<Index> twin(mesh.points.size(), -1);
  for (Index n = 0; n < 75; ++n)
    if (const Vec3 p = mesh.points[n]; p.x() == 2 && p.y() < 2) {
      twin[n] = mesh.n_nodes();
      mesh.points.push_back(p);
    }
  mesh.side_sets = {{1, "left", {}}, {2, "right", {}}};
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    const int i = h % 4, j = h / 4 % 4;
    if (i == 1 && j < 2) mesh.side_sets[0].sides.push_back({h, 1});
    if (i == 2 && j < 2) mesh.side_sets[1].sides.push_back({h, 0});
    if (i >= 2)
      for (Index& n : mesh.hexes[h])
        if (twin[n] >= 0) n = twin[n];
  }
  return mesh;
}

double area(const Mesh& mesh, const std::vector<Side>& sides) {
  double sum = 0;
  for (const Side side : sides) {
    const auto cycle = face_node_cycle(mesh.hexes[side.hex], side.face);
    const auto at = [&](int k) { return mesh.points[cycle[k]]; };
    const Vec3 a = at(2) - at(0), b = at(3) - at(1);
    sum += Vec3(a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()).norm() / 2;
  }
  return sum;
}

std::vector<Side> skin(const Mesh& mesh) {
  std::map<std::array<Index, 4>, std::vector<Side>> faces;
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (int f = 0; f < 6; ++f) {
      auto key = face_nodes(mesh.hexes[h], f);
      std::ranges::sort(key);
      faces[key].push_back({h, f});
    }
  std::vector<Side> open;
  for (const auto& [key, sides] : faces)
    if (sides.size() == 1) open.push_back(sides[0]);
  return open;
}

void expect_cracked_block(const Mesh& mesh) {
  EXPECT_TRUE(test::uninverted(mesh));
  EXPECT_NEAR(volume(mesh), 32, 1e-10);
  EXPECT_NEAR(area(mesh, skin(mesh)), 64 + 8, 1e-9);  // nothing hangs but across the crack
  ASSERT_EQ(mesh.side_sets.size(), 2u);
  for (const SideSet& set : mesh.side_sets) EXPECT_NEAR(area(mesh, set.sides), 4, 1e-9);
}

const std::vector<std::string> on_one_side = {"refine face in sideset 1",
                                              "refine face in sideset 2 numsplit 2",
                                              "refine hex in face in sideset 1",
                                              "refine hex 1 2",
                                              "refine hex 6",
                                              "refine hex 6 depth 1 smooth",
                                              "refine hex 6; refine hex 3 numsplit 2",
                                              "refine node with x_coord = 2 and y_coord = 2",
                                              "refine node with x_coord = 2 and y_coord = 2 depth 1 smooth",
                                              "refine face in sideset 1 2 numsplit 2",
                                              "smooth volume all"};

TEST(Seam, either_side_of_a_crack_is_refined_by_itself) {
  for (const std::string& command : on_one_side) {
    SCOPED_TRACE(command);
    Fixture f;
    f.session.take(block(true), nullptr);
    f.session.run(command + "; check");
    expect_cracked_block(f.session.meshed().mesh);
    // What was written is read again.
    const auto file = folder() / "crack.e";
    f.session.run("export exodus '" + file.string() + "' overwrite; import mesh '" + file.string() + "'; check");
    expect_cracked_block(f.session.meshed().mesh);
  }
}

TEST(Seam, a_crack_lies_on_a_face_of_the_cad_inside_the_solid) {
  const auto cad = folder() / "crack.brep";
  test::OccShape::brick_with_face_inside(4, 4, 2, 2).write(cad);
  for (const std::string& command : on_one_side) {
    SCOPED_TRACE(command);
    Fixture f;
    f.session.run("import geometry '" + cad.string() + "'");
    f.session.take_mesh(block(true));
    f.session.run(command + "; check");
    expect_cracked_block(f.session.meshed().mesh);
  }
}

TEST(Seam, bodies_in_contact_lie_on_a_face_that_their_cad_shares) {
  Mesh two = test::grid(2, 3, 4);
  const Mesh other = test::grid(3, 3, 4);
  for (Vec3 p : other.points) two.points.push_back(p + Vec3(2, 0, 0));
  for (Hex hex : other.hexes) {
    for (Index& n : hex) n += 60;
    two.hexes.push_back(hex);
  }
  for (const bool glue : {true, false}) {
    const auto model = test::OccShape::two_bricks().import({.glue = glue}).model;
    Fixture f;
    f.session.take(two, model);
    f.session.run("refine hex 1 2; check; refine surface 1; check");
    EXPECT_NEAR(volume(f.session.meshed().mesh), 60, 1e-9);
  }
}

TEST(Embedded, a_face_of_the_cad_inside_a_solid_owns_its_faces_and_keeps_its_nodes) {
  const auto cad = folder() / "face.brep";
  test::OccShape::brick_with_face_inside(4, 4, 2, 2).write(cad);
  const std::string inner = "surface with x_max < 2.1 and x_min > 1.9";
  const std::vector<std::string> commands = {
      "refine " + inner, "refine " + inner + " depth 1 smooth",
      "refine curve with x_max < 2.1 and x_min > 1.9 and y_min > 1.9 numsplit 2 smooth", "smooth volume all",
      "refine " + inner + " numsplit 2 depth 1 smooth; refine " + inner};
  for (const std::string& command : commands) {
    SCOPED_TRACE(command);
    Fixture f;
    f.session.run("import geometry '" + cad.string() + "'");
    f.session.take_mesh(block(false));
    EXPECT_TRUE(f.notices.empty()) << f.notices.front();
    EXPECT_EQ(f.session.ids("face", "in " + inner).size(), 4u);
    f.session.run(command + "; check; nodeset 1 " + inner + "; sideset 1 " + inner);
    const Mesh& mesh = f.session.meshed().mesh;
    EXPECT_TRUE(test::conformal(mesh));
    EXPECT_TRUE(test::uninverted(mesh));
    EXPECT_NEAR(volume(mesh), 32, 1e-10);
    EXPECT_NEAR(area(mesh, mesh.side_sets[0].sides), 4, 1e-9);
    for (const Index n : mesh.node_sets[0].nodes) EXPECT_NEAR(mesh.points[n].x(), 2, 1e-9);
  }
  Fixture f;
  f.session.run("import geometry '" + cad.string() + "'");
  f.session.take_mesh(block(false));
  f.session.run("refine " + inner);
  EXPECT_EQ(f.session.ids("face", "in " + inner).size(), 36u);
}

/// The side that names a face inside is that of its first hex, whichever of the two was cut.
TEST(Embedded, a_face_keeps_its_side_through_levels_back_and_forth) {
  const auto cad = folder() / "face.brep";
  test::OccShape::brick_with_face_inside(4, 4, 2, 2).write(cad);
  std::mt19937 random(test::random_seed());
  const auto one_of = [&](int n) { return std::to_string(random() % static_cast<unsigned>(n) + 1); };
  for (int run = 0; run < 12; ++run) {
    Fixture f;
    f.session.run("import geometry '" + cad.string() + "'");
    f.session.take_mesh(block(false));
    if (run % 4 == 3) f.session.run("refine volume all numsplit 4");
    for (int i = 0; i < 6; ++i) {
      const Mesh& mesh = f.session.meshed().mesh;
      const std::string hex = std::to_string(hex_id(mesh, static_cast<Index>(random() % mesh.hexes.size())));
      const std::vector<std::string> commands = {"refine hex " + hex, "refine hex in vertex " + one_of(12),
                                                 "coarsen hex " + hex + " depth 1",
                                                 "coarsen hex in curve " + one_of(18)};
      const std::string& command = commands[random() % commands.size()];
      SCOPED_TRACE(command);
      if (f.error(command) != "no error") continue;  // nothing to coarsen
      f.session.run("check");
    }
  }
}

}  // namespace
}  // namespace hextwist
