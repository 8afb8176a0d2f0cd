#include "hextwist/mesh/mesh.h"

#include <gtest/gtest.h>

#include "hextwist/mesh/corners.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist {
namespace {

TEST(corners, an_edge_joins_corners_that_differ_in_one_bit) {
  for (int e = 0; e < n_hex_edges; ++e) EXPECT_EQ(edge_between(edge_corner(e, 0), edge_corner(e, 1)), e);
}

TEST(corners, a_face_cycle_turns_outwards) {
  for (int f = 0; f < n_hex_faces; ++f) {
    const auto cycle = face_cycle(f);
    const auto at = [](int c) { return Vec3(c & 1, c >> 1 & 1, c >> 2 & 1); };
    const Vec3 a = at(cycle[1]) - at(cycle[0]), b = at(cycle[3]) - at(cycle[0]);
    const Vec3 normal(a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x());
    const Vec3 outward = (f & 1 ? 1.0 : -1.0) * Vec3::Unit(f >> 1);
    EXPECT_EQ(normal, outward) << f;
  }
}

TEST(corners, the_file_order_is_its_own_inverse) {
  for (int c = 0; c < 8; ++c) EXPECT_EQ(file_corner[file_corner[c]], c);
}

TEST(mesh, grids_and_pinwheels_are_good_meshes_however_shuffled) {
  std::mt19937 random(7);
  for (const Mesh& mesh : {test::grid(3, 2, 4), test::pinwheel(3, 2, 2), test::pinwheel(5, 3, 1)}) {
    EXPECT_TRUE(test::conformal(mesh));
    EXPECT_TRUE(test::uninverted(mesh));
    const Mesh turned = test::shuffled(mesh, random);
    EXPECT_TRUE(test::conformal(turned));
    EXPECT_TRUE(test::uninverted(turned));
    EXPECT_NEAR(volume(turned), volume(mesh), 1e-12);
  }
}

TEST(mesh, ids_are_positions_or_come_from_the_file) {
  Mesh mesh = test::grid(2, 1, 1);
  EXPECT_EQ(find_hex(mesh, 2), 1);
  EXPECT_EQ(find_hex(mesh, 3), -1);
  EXPECT_EQ(find_hex(mesh, 0), -1);
  mesh.hex_ids = {10, 20};
  EXPECT_EQ(find_hex(mesh, 20), 1);
  EXPECT_EQ(find_hex(mesh, 2), -1);
  EXPECT_EQ(hex_id(mesh, 0), 10);
}

}  // namespace
}  // namespace hextwist
