// The facet model on skins of real meshes.
#include <gtest/gtest.h>

#include <algorithm>

#include "hextwist/geom/facet/bilinear.h"
#include "hextwist/io/io.h"
#include "support/grids.h"
#include "support/model_checks.h"
#include "support/skins.h"

namespace hextwist {
namespace {

struct DataFile {
  const char* name;
  std::array<int, 4> counts;  ///< vertices, curves, surfaces, volumes of the skin
  double angle = 35;
};

void PrintTo(const DataFile& file, std::ostream* out) {
  *out << file.name;
}

class FacetData : public testing::TestWithParam<DataFile> {};

TEST_P(FacetData, becomes_a_model_that_the_mesh_and_its_children_lie_on) {
  const auto folder = test::data_folder();
  if (folder.empty()) GTEST_SKIP() << "no folder of real meshes";
  const auto extension = std::filesystem::path(GetParam().name).extension().string();
  if (readable_extensions().find(extension) == std::string::npos) GTEST_SKIP() << extension << " can't be read yet";
  Mesh mesh = read_mesh(folder / GetParam().name).mesh;
  if (volume(mesh) < 0)  // the pipe junction is inside out
    for (Hex& hex : mesh.hexes)
      for (int c = 0; c < 4; ++c) std::swap(hex[c], hex[c + 4]);
  const test::Skin skin = test::skin(mesh);
  const auto [model, classes] = facet_model(mesh.points, skin.quads, skin.volumes, {GetParam().angle});
  const std::array counts = {model->count(0), model->count(1), model->count(2), model->count(3)};
  EXPECT_EQ(counts, GetParam().counts);
  test::expect_entities_consistent(*model);
  std::mt19937 random(99);
  test::expect_projections_consistent(*model, random, {.n_points = 5, .n_rivals = 20});
  const double size = model->box().diagonal();
  EXPECT_NEAR(model->measure({3, 1}), volume(mesh), 1e-10 * volume(mesh));

  // Every point that trisecting puts on the skin, all surfaces at once.
  for (int s = 1; s <= model->count(2); ++s) {
    std::vector<Vec3> children;
    for (std::size_t q = 0; q < skin.quads.size(); ++q) {
      if (classes.quad_surface[q] != s) continue;
      BilinearPatch x;
      for (int c = 0; c < 4; ++c) x[c] = mesh.points[skin.quads[q][c]];
      for (int i = 0; i <= 3; ++i)
        for (int j = 0; j <= 3; ++j) children.push_back(point(x, i / 3.0, j / 3.0));
    }
    std::vector<Projection> feet(children.size());
    model->project({2, s}, children, {}, feet);
    EXPECT_LT(std::ranges::max(feet, {}, &Projection::distance).distance, 1e-13 * size);
  }
  // Inside and outside of the hexes.
  int n_outside = 0;
  for (Index h = 0; h < mesh.n_hexes(); h += 1 + mesh.n_hexes() / 300) {
    Vec3 centre = Vec3::Zero();
    for (const Index n : mesh.hexes[h]) centre += mesh.points[n] / 8;
    EXPECT_TRUE(model->contains(1, centre)) << "hex " << h;
    const Vec3 away = centre + size * Vec3(1, 0.01, 0.02);
    n_outside += model->contains(1, away);
  }
  EXPECT_EQ(n_outside, 0);
}

INSTANTIATE_TEST_SUITE_P(
    files, FacetData,
    testing::Values(
        DataFile{"cad/bracket_fillet_1k.msh", {8, 18, 9, 1}, 50}, DataFile{"cad/cyl_ogrid_1k.msh", {0, 2, 3, 1}},
        DataFile{"cad/plate_hole_1k.msh", {8, 14, 7, 1}}, DataFile{"cad/ring_twist90_1k.msh", {0, 1, 1, 1}},
        DataFile{"cad/sphere7_1k.msh", {0, 0, 1, 1}}, DataFile{"cad/two_material_1k.msh", {8, 12, 6, 1}},
        DataFile{"mesh/cad_component_hex.msh", {0, 2, 3, 1}, 50}, DataFile{"mesh/pipe_junction_Y_r1.msh", {6, 6, 4, 1}},
        DataFile{"mesh/hole_3d_cubit.inp", {8, 14, 7, 1}}, DataFile{"mesh/mastodon_model_1.e", {0, 4, 5, 1}},
        DataFile{"mesh/moebius_rot1_r1.vtk", {0, 1, 1, 1}}, DataFile{"mesh/hyper_ball_balanced_r1.vtk", {0, 0, 1, 1}},
        DataFile{"mesh/teaport_14941.mesh", {162, 107, 2, 1}}, DataFile{"mesh/swivel2_7494.mesh", {35, 51, 17, 1}}),
    [](const auto& test) {
      std::string name = std::filesystem::path(test.param.name).filename().string();
      std::ranges::replace_if(
          name, [](char c) { return !std::isalnum(c); }, '_');
      return name;
    });

}  // namespace
}  // namespace hextwist
