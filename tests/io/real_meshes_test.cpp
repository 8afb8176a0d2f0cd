// Meshes that people made with other programs: what is known about them is found, and nothing is found that is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "hextwist/io/io.h"
#include "hextwist/mesh/sheets.h"
#include "hextwist/mesh/validate/validate.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist {
namespace {

struct RealMesh {
  const char* file;
  Index n_hexes;
  Index n_crossing_sheets;  ///< sheets that cross themselves
  Index n_crossed_hexes;    ///< in so many hexes
  bool inside_out = false;
  const char* warnings = "";

  friend void PrintTo(const RealMesh& mesh, std::ostream* out) { *out << mesh.file; }
};

class real_meshes : public testing::TestWithParam<RealMesh> {};

TEST_P(real_meshes, are_valid_and_their_sheets_cross_where_known) {
  const RealMesh& known = GetParam();
  const std::filesystem::path file = test::data_folder() / known.file;
  if (test::data_folder().empty()) GTEST_SKIP() << "no folder of real meshes";
  if (readable_extensions().find(file.extension()) == std::string::npos)
    GTEST_SKIP() << file.extension() << " files cannot be read";
  Mesh mesh = read_mesh(file).mesh;
  ASSERT_EQ(mesh.n_hexes(), known.n_hexes);
  EXPECT_EQ(std::ssize(repair_orientation(mesh).flipped), known.inside_out ? mesh.n_hexes() : 0);
  std::string warnings;
  for (const Violation& v : validate(mesh)) {
    EXPECT_TRUE(is_warning(v.kind)) << name(v.kind) << ": " << v.text;
    warnings += v.text + "\n";
  }
  EXPECT_EQ(warnings, known.warnings);
  EXPECT_EQ(bool(test::conformal(mesh)), warnings.empty()) << test::conformal(mesh).message();
  EXPECT_TRUE(test::uninverted(mesh));

  const Sheets all = sheets(mesh, edges(mesh));
  const auto& crossings = all.n_self_crossings;
  EXPECT_EQ(std::ranges::count_if(crossings, [](Index n) { return n > 0; }), known.n_crossing_sheets);
  const Index n_crossed = std::accumulate(crossings.begin(), crossings.end(), 0);
  EXPECT_EQ(n_crossed, known.n_crossed_hexes);
  // Every hex is in three sheets, counted with directions.
  Index n_in = 0;
  for (Index s = 0; s < all.size(); ++s) n_in += static_cast<Index>(all.hexes[s].size());
  EXPECT_GE(3 * mesh.n_hexes(), n_in + n_crossed);
}

INSTANTIATE_TEST_SUITE_P(
    all, real_meshes,
    testing::Values(RealMesh{"cad/bracket_fillet_1k.msh", 3123, 1, 9}, RealMesh{"cad/cyl_ogrid_1k.msh", 975, 0, 0},
                    RealMesh{"cad/plate_hole_1k.msh", 1404, 0, 0}, RealMesh{"cad/sphere7_1k.msh", 896, 0, 0},
                    RealMesh{"cad/ring_twist90_1k.msh", 567, 2, 315}, RealMesh{"cad/two_material_1k.msh", 1728, 0, 0},
                    RealMesh{"mesh/cad_component_hex.msh", 40, 0, 0, false,
                             "nodes 17, 54 and 72 are at the same place\n"
                             "node 17 belongs to no hex\n"},
                    RealMesh{"mesh/pipe_junction_Y_r1.msh", 1920, 0, 0, true},
                    RealMesh{"mesh/hole_3d_cubit.inp", 1032, 1, 12}, RealMesh{"mesh/mastodon_model_1.e", 6456, 1, 19},
                    RealMesh{"mesh/moebius_rot1_r1.vtk", 96, 1, 96},
                    RealMesh{"mesh/hyper_ball_balanced_r1.vtk", 256, 0, 0},
                    RealMesh{"mesh/teaport_14941.mesh", 14941, 0, 0}, RealMesh{"mesh/swivel2_7494.mesh", 7464, 0, 0}));

}  // namespace
}  // namespace hextwist
