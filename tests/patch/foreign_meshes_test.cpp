// Meshes without CAD, from other programs: refined on their own skin and written back in every format.
#include <gtest/gtest.h>

#include "hextwist/io/io.h"
#include "hextwist/mesh/sheets.h"
#include "hextwist/patch/refine.h"
#include "support/association_checkers.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist {
namespace {

struct Foreign {
  const char* file;
  bool crosses_itself;  // at least one sheet does
};

void PrintTo(const Foreign& foreign, std::ostream* out) {
  *out << foreign.file;
}

class foreign_mesh : public testing::TestWithParam<Foreign> {
 protected:
  void SetUp() override {
    const auto folder = test::data_folder();
    if (folder.empty()) GTEST_SKIP() << "the folder of real CAD and meshes is not here";
    input_.mesh = read_mesh(folder / GetParam().file).mesh;
    repair_orientation(input_.mesh);
    FacetResult skin = associate_with_own_skin(input_.mesh);
    input_.model = skin.model;
    input_.association = std::move(skin.association);
  }

  MeshedModel run(const Request& request) {
    RefineResult result = refine(input_, request);
    const MeshedModel& fine = result.refined;
    EXPECT_TRUE(test::conformal(fine.mesh, test::UnusedNodes::allowed));  // one of the files has two
    EXPECT_TRUE(test::uninverted(fine.mesh));
    EXPECT_TRUE(test::sets_valid(fine.mesh));
    EXPECT_TRUE(result.report.violations.empty());
    EXPECT_LE(result.report.off_cad.max_relative, 1e-9);
    const auto broken = check_association(fine.mesh, fine.association, *fine.model);
    EXPECT_TRUE(broken.empty()) << broken.size() << ": " << broken.front();
    EXPECT_EQ(fine.mesh.blocks.size(), input_.mesh.blocks.size());
    EXPECT_EQ(fine.mesh.side_sets.size(), input_.mesh.side_sets.size());
    EXPECT_EQ(fine.mesh.node_sets.size(), input_.mesh.node_sets.size());
    return std::move(result.refined);
  }

  MeshedModel input_;
};

TEST_P(foreign_mesh, some_hexes_are_refined_and_written_back_in_every_format) {
  // A quad of one file, on a face of the CAD that has no hexes, is in the way: it shares an edge with a hex.
  input_.mesh.others = nullptr;
  Request request{.target = {.kind = EntityKind::hex}};
  for (Index h = 0; h < input_.mesh.n_hexes(); h += 1 + input_.mesh.n_hexes() / 20) request.target.ids.push_back(h);
  const MeshedModel fine = run(request);
  EXPECT_GE(fine.mesh.n_hexes(), input_.mesh.n_hexes() + 26);
  const auto folder = test::output_folder();
  for (const char* extension : {".msh", ".e", ".inp", ".mesh"}) {
    SCOPED_TRACE(extension);
    const auto path = folder / ("fine" + std::string(extension));
    write_mesh(path, fine.mesh, &fine.association);
    const Mesh back = read_mesh(path).mesh;
    EXPECT_EQ(back.hexes.size(), fine.mesh.hexes.size());
    if (std::string(extension) == ".inp") {  // 20 characters, which is what CalculiX reads
      ASSERT_EQ(back.points.size(), fine.mesh.points.size());
      for (std::size_t n = 0; n < back.points.size(); ++n)
        EXPECT_LE((back.points[n] - fine.mesh.points[n]).norm(), 1e-13 * (fine.mesh.points[n].norm() + 1e-3)) << n;
    } else {
      EXPECT_EQ(back.points, fine.mesh.points);
    }
    EXPECT_EQ(back.side_sets.size(), fine.mesh.side_sets.size());
  }
  write_mesh(folder / "fine.vtu", fine.mesh, &fine.association);
}

TEST_P(foreign_mesh, sheets_that_cross_themselves_are_ordinary) {
  const Edges all = edges(input_.mesh);
  const Sheets of = sheets(input_.mesh, all);
  Index crossing = -1;
  for (Index s = 0; s < of.size(); ++s)
    if (of.n_self_crossings[s] > 0) crossing = s;
  EXPECT_EQ(crossing >= 0, GetParam().crosses_itself);
  if (crossing < 0) return;
  // Every fourth hex of the sheet.
  Request request{.target = {.kind = EntityKind::hex}};
  for (std::size_t i = 0; i < of.hexes[crossing].size(); i += 4) request.target.ids.push_back(of.hexes[crossing][i]);
  for (const Concave concave : {Concave::templates, Concave::fill}) {
    request.concave = concave;
    run(request);
  }
}

INSTANTIATE_TEST_SUITE_P(
    real, foreign_mesh,
    testing::Values(Foreign{"mesh/hole_3d_cubit.inp", true}, Foreign{"mesh/mastodon_model_1.e", true},
                    Foreign{"mesh/cad_component_hex.msh", false}, Foreign{"mesh/moebius_rot1_r1.vtk", true},
                    Foreign{"mesh/hyper_ball_balanced_r1.vtk", false}, Foreign{"mesh/pipe_junction_Y_r1.msh", false},
                    Foreign{"mesh/teaport_14941.mesh", false}, Foreign{"mesh/swivel2_7494.mesh", false},
                    Foreign{"cad/ring_twist90_1k.msh", true}));

}  // namespace
}  // namespace hextwist
