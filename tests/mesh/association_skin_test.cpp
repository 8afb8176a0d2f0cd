// Meshes without CAD: the facet model of their own skin owns them.
#include <gtest/gtest.h>

#include "hextwist/io/io.h"
#include "hextwist/mesh/association/association.h"
#include "support/association_checkers.h"
#include "support/grids.h"

namespace hextwist {
namespace {

void expect_good(const Mesh& mesh, const FacetResult& result) {
  EXPECT_EQ(check_association(mesh, result.association, *result.model), std::vector<std::string>{});
  EXPECT_TRUE(test::complete(mesh, result.association, *result.model));
  EXPECT_LT(off_model(mesh, result.association, *result.model).max_relative, 1e-12);
}

TEST(own_skin, a_grid_is_a_brick) {
  const Mesh mesh = test::grid(3, 2, 4);
  const auto result = associate_with_own_skin(mesh);
  EXPECT_EQ(result.model->count(0), 8);
  EXPECT_EQ(result.model->count(1), 12);
  EXPECT_EQ(result.model->count(2), 6);
  EXPECT_EQ(result.model->count(3), 1);
  expect_good(mesh, result);
  EXPECT_TRUE(test::on_model(mesh, result.association, *result.model, 1e-12));
}

TEST(own_skin, blocks_that_partition_the_mesh_are_volumes_and_others_are_not) {
  Mesh mesh = test::grid(4, 2, 2);
  mesh.blocks = {{7, "left", {}}, {3, "right", {}}, {4, "empty", {}}};
  for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.blocks[h % 4 / 2].hexes.push_back(h);
  const auto two = associate_with_own_skin(mesh);
  EXPECT_EQ(two.model->count(3), 2);
  EXPECT_EQ(two.model->count(2), 11);
  EXPECT_EQ(two.association.hex_volume[0], 1);
  EXPECT_EQ(two.association.hex_volume[2], 2);
  expect_good(mesh, two);
  mesh.blocks[1].hexes.pop_back();
  EXPECT_EQ(associate_with_own_skin(mesh).model->count(3), 1);
  mesh.blocks[1].hexes = mesh.blocks[0].hexes;
  EXPECT_EQ(associate_with_own_skin(mesh).model->count(3), 1);
}

TEST(own_skin, the_mesh_lies_on_it_by_geometry_alone) {
  std::mt19937 random(5);
  for (const Mesh& plain : {test::grid(3, 3, 2), test::pinwheel(3, 2, 2), test::pinwheel(5, 3, 2)}) {
    const Mesh mesh = test::shuffled(plain, random);
    const auto own = associate_with_own_skin(mesh);
    expect_good(mesh, own);
    const auto again = associate(mesh, *own.model);
    EXPECT_TRUE(test::same_owners(again.association, own.association));
    EXPECT_EQ(again.notices, std::vector<std::string>{});
  }
}

class own_skin_of_file : public testing::TestWithParam<const char*> {};

TEST_P(own_skin_of_file, is_a_complete_model) {
  const auto folder = test::data_folder();
  if (folder.empty()) GTEST_SKIP() << "no shared data";
  const auto file = folder / GetParam();
  if (readable_extensions().find(file.extension().string()) == std::string::npos) GTEST_SKIP() << "no such reader";
  const Mesh mesh = read_mesh(file).mesh;
  for (const double angle : {10.0, 35.0, 80.0}) expect_good(mesh, associate_with_own_skin(mesh, {angle}));
}

INSTANTIATE_TEST_SUITE_P(real, own_skin_of_file,
                         testing::Values("mesh/hole_3d_cubit.inp", "mesh/mastodon_model_1.e",
                                         "mesh/cad_component_hex.msh", "mesh/moebius_rot1_r1.vtk",
                                         "mesh/hyper_ball_balanced_r1.vtk", "mesh/pipe_junction_Y_r1.msh",
                                         "mesh/teaport_14941.mesh", "mesh/swivel2_7494.mesh",
                                         "cad/bracket_fillet_1k.msh", "cad/cyl_ogrid_1k.msh", "cad/plate_hole_1k.msh",
                                         "cad/ring_twist90_1k.msh", "cad/sphere7_1k.msh", "cad/two_material_1k.msh"));

TEST(own_skin, a_mesh_without_hexes_is_refused) {
  EXPECT_THROW(associate_with_own_skin(Mesh{}), Error);
}

}  // namespace
}  // namespace hextwist
