// One into eight on real models and meshes: whatever is decided, every hex gets the children that the decision says.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "hextwist/base/sorted.h"
#include "hextwist/geom/occ/model.h"
#include "hextwist/io/io.h"
#include "hextwist/patch/refine.h"
#include "hextwist/refine/plans/eight.h"
#include "hextwist/sizing/targets.h"
#include "support/association_checkers.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist {
namespace {

/// How the regions of several requests were decided, to see that a test tests something.
struct Decided {
  int eight = 0, trisected = 0, mixed = 0;
};

/// Follows every hex by a field that its children inherit.
void check(const MeshedModel& given, Request request, Decided& decided, double tolerance = 1e-9) {
  MeshedModel input = given;
  Field origin{"origin", Field::On::hex, 1, std::vector<double>(input.mesh.hexes.size())};
  std::iota(origin.values.begin(), origin.values.end(), 0.0);
  input.mesh.fields = {std::move(origin)};
  request.method = Method::parallel;
  const RefineResult result = refine(input, request);
  const MeshedModel& fine = result.refined;
  EXPECT_TRUE(test::conformal(fine.mesh, test::UnusedNodes::allowed));
  EXPECT_TRUE(test::uninverted(fine.mesh));
  EXPECT_TRUE(test::sets_valid(fine.mesh));
  EXPECT_TRUE(result.report.violations.empty());
  EXPECT_TRUE(result.report.off_nodes.empty());
  EXPECT_LE(result.report.off_cad.max_relative, tolerance);
  const auto broken = check_association(fine.mesh, fine.association, *fine.model);
  EXPECT_TRUE(broken.empty()) << broken.front();

  std::vector<int> n_children(input.mesh.hexes.size(), 0);
  for (const double parent : fine.mesh.fields.front().values) ++n_children[static_cast<std::size_t>(parent)];
  std::vector<std::string> notices;
  const std::vector<Index> targets = region_target(input, request.target, notices);
  const EightPlan plan = plan_eight(input.mesh, targets);
  Index n_exact = 0, n_eight = 0;
  for (const EightRegion& region : plan.regions) {
    ++(!region.eight ? decided.trisected : region.n_in_three > 0 ? decided.mixed : decided.eight);
    if (!region.eight) {
      EXPECT_FALSE(region.reason.empty());
      continue;
    }
    n_eight += region.n_hexes;
    n_exact += region.n_exact;
    EXPECT_GE(2 * region.n_exact, region.n_hexes);
  }
  Index n_with_eight = 0;
  for (const Index h : targets) {
    if (std::ranges::binary_search(plan.trisected, h)) {
      EXPECT_EQ(n_children[h], 27) << h;
    } else {
      n_with_eight += n_children[h] == 8;
      EXPECT_TRUE(n_children[h] == 8 || n_children[h] == 12 || n_children[h] == 18) << h << ": " << n_children[h];
    }
  }
  EXPECT_EQ(n_with_eight, n_exact);
  EXPECT_EQ(n_eight + static_cast<Index>(plan.trisected.size()), static_cast<Index>(targets.size()));
}

std::vector<Index> some_hexes(const Mesh& mesh, std::mt19937& random) {
  // A run of neighbours by number, and a few anywhere.
  std::vector<Index> hexes;
  const auto n = static_cast<unsigned>(mesh.n_hexes());
  const auto first = static_cast<Index>(random() % n);
  for (Index h = first; h < std::min(first + mesh.n_hexes() / 20 + 1, mesh.n_hexes()); ++h) hexes.push_back(h);
  for (int i = 0; i < 5; ++i) hexes.push_back(static_cast<Index>(random() % n));
  sort_unique(hexes);
  return hexes;
}

void check_everywhere(const MeshedModel& input, Decided& decided, double tolerance = 1e-9) {
  std::mt19937 random(7);
  for (int i = 0; i < 2; ++i)
    check(input, {.target = {.kind = EntityKind::hex, .ids = some_hexes(input.mesh, random)}}, decided);
  const int n_dims =
      input.mesh.n_hexes() > 5000 ? 2 : 3;  // layers along whole surfaces of a large mesh take long to check
  for (int dim = 0; dim < n_dims; ++dim)
    for (int id = 1; id <= std::min(input.model->count(dim), 3); ++id) {
      if (nodes_on(input.association, *input.model, {dim, id}).empty()) continue;
      SCOPED_TRACE(testing::Message() << "dimension " << dim << ", id " << id);
      const auto kind = static_cast<EntityKind>(static_cast<int>(EntityKind::vertex) + dim);
      check(input, {.target = {.kind = kind, .ids = {id}, .depth = 1 + (id + dim) % 2}}, decided, tolerance);
    }
}

class model_in_eight : public testing::TestWithParam<const char*> {};

TEST_P(model_in_eight, every_hex_gets_the_children_that_were_decided_upon) {
  const std::filesystem::path folder = std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models";
  MeshedModel input;
  input.model = read_cad(folder / (std::string(GetParam()) + ".brep")).model;
  MeshFile file = read_mesh(folder / (std::string(GetParam()) + ".msh"));
  input.association = associate(file.mesh, *input.model, &file.tags).association;
  input.mesh = std::move(file.mesh);
  Decided decided;
  check_everywhere(input, decided);
  EXPECT_GT(decided.eight, 0);
  // One of the volumes of an assembly, or the whole.
  check(input, {.target = {.kind = EntityKind::volume, .ids = {1}}}, decided);
}

std::string file_stem(const testing::TestParamInfo<const char*>& param) {
  return std::filesystem::path(param.param).stem().string();
}

INSTANTIATE_TEST_SUITE_P(models, model_in_eight,
                         testing::Values("bracket", "bracket_fillet", "cam", "curved_plate", "cylinder", "inclusion",
                                         "l_block", "notched_cube", "pipe_tee", "plate_hole", "plate_quarter",
                                         "ring_twist", "sphere"),
                         file_stem);

class mesh_in_eight : public testing::TestWithParam<const char*> {};

TEST_P(mesh_in_eight, every_hex_gets_the_children_that_were_decided_upon) {
  const auto folder = test::data_folder();
  if (folder.empty()) GTEST_SKIP() << "the folder of real CAD and meshes is not here";
  MeshedModel input;
  input.mesh = read_mesh(folder / GetParam()).mesh;
  input.mesh.others = nullptr;  // one has a quad that stands off the hexes, which no cut may end at
  repair_orientation(input.mesh);
  FacetResult skin = associate_with_own_skin(input.mesh);
  input.model = skin.model;
  input.association = std::move(skin.association);
  Decided decided;
  check_everywhere(input, decided);
  EXPECT_GT(decided.eight + decided.trisected + decided.mixed, 0);
}

INSTANTIATE_TEST_SUITE_P(meshes, mesh_in_eight,
                         testing::Values("cad/bracket_fillet_1k.msh", "cad/cyl_ogrid_1k.msh", "cad/plate_hole_1k.msh",
                                         "cad/sphere7_1k.msh", "cad/ring_twist90_1k.msh", "cad/two_material_1k.msh",
                                         "mesh/hole_3d_cubit.inp", "mesh/mastodon_model_1.e",
                                         "mesh/cad_component_hex.msh", "mesh/moebius_rot1_r1.vtk",
                                         "mesh/hyper_ball_balanced_r1.vtk", "mesh/pipe_junction_Y_r1.msh",
                                         "mesh/teaport_14941.mesh", "mesh/swivel2_7494.mesh"),
                         file_stem);

}  // namespace
}  // namespace hextwist
