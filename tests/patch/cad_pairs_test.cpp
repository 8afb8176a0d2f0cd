// The promise on real pairs of CAD and mesh: six parts, both CAD formats, with and without tags.
#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Geometry>

#include "hextwist/geom/occ/model.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/patch/refine.h"
#include "support/association_checkers.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist {
namespace {

struct Pair {
  const char* name;
  const char* cad;
  bool tags;
  double tolerance;  // of the distance of owned nodes, relative to the model size
};

void PrintTo(const Pair& pair, std::ostream* out) {
  *out << pair.name << pair.cad << (pair.tags ? " tags" : " stripped");
}

class cad_pair : public testing::TestWithParam<Pair> {
 protected:
  void SetUp() override {
    const auto folder = test::data_folder();
    if (folder.empty()) GTEST_SKIP() << "the folder of real CAD and meshes is not here";
    const auto [name, cad, tags, tolerance] = GetParam();
    MeshFile file = read_mesh(folder / "cad" / (std::string(name) + "_1k.msh"));
    CadOptions options;
    options.glue = std::string(cad) == ".step";
    input_.model = read_cad(folder / "cad" / (std::string(name) + cad), options).model;
    input_.association = associate(file.mesh, *input_.model, tags ? &file.tags : nullptr).association;
    input_.mesh = std::move(file.mesh);
    volume_ = 0;
    for (int v = 1; v <= input_.model->count(3); ++v) volume_ += input_.model->measure({3, v});
  }

  MeshedModel run(const MeshedModel& from, const Request& request) {
    RefineResult result = refine(from, request);
    const MeshedModel& fine = result.refined;
    EXPECT_TRUE(test::conformal(fine.mesh));
    EXPECT_TRUE(test::uninverted(fine.mesh));
    EXPECT_TRUE(test::sets_valid(fine.mesh));
    EXPECT_TRUE(result.report.violations.empty());
    EXPECT_TRUE(result.report.off_nodes.empty()) << result.report.off_nodes.size();
    const auto broken = check_association(fine.mesh, fine.association, *fine.model);
    EXPECT_TRUE(broken.empty()) << broken.size() << ": " << broken.front();
    // Independent of off_model(): every owned node projected without any seed.
    const double size = fine.model->box().diagonal();
    double worst = 0;
    for (Index n = from.mesh.n_nodes(); n < fine.mesh.n_nodes(); ++n)
      if (const Owner owner = fine.association.node_owner[n]; owner.dim < 3)
        worst = std::max(worst, fine.model->project(owner, fine.mesh.points[n]).distance);
    EXPECT_LE(worst, GetParam().tolerance * size);
    // The volume between the skin and the CAD shrinks. (The signed error of the whole volume need not: too much at an
    // inner fillet and too little at an outer round cancel in the coarse mesh.)
    EXPECT_LE(skin_error(fine), skin_error(from) + 1e-9 * volume_);
    EXPECT_GT(fine.mesh.n_hexes(), from.mesh.n_hexes());
    return std::move(result.refined);
  }

  /// Volume between the boundary quads and the surfaces that they are on, by four points for each quad.
  static double skin_error(const MeshedModel& meshed) {
    double sum = 0;
    for (std::size_t i = 0; i < meshed.association.surface_faces.size(); ++i) {
      const Side side = meshed.association.surface_faces[i];
      const Quad nodes = face_nodes(meshed.mesh.hexes[side.hex], side.face);
      std::array<Vec3, 4> x, at;
      for (int k = 0; k < 4; ++k) x[k] = meshed.mesh.points[nodes[k]];
      for (int k = 0; k < 4; ++k) {
        const double u = k & 1 ? 0.75 : 0.25, v = k & 2 ? 0.75 : 0.25;
        at[k] = (1 - u) * (1 - v) * x[0] + u * (1 - v) * x[1] + (1 - u) * v * x[2] + u * v * x[3];
      }
      std::array<Projection, 4> projected;
      meshed.model->project({2, meshed.association.face_surface[i]}, at, {}, projected);
      const double area = (x[3] - x[0]).cross(x[2] - x[1]).norm() / 2;
      for (const Projection& p : projected) sum += p.distance * area / 4;
    }
    return sum;
  }

  std::vector<Index> all(int dim) const {
    std::vector<Index> ids;
    for (int id = 1; id <= input_.model->count(dim); ++id)
      if (!nodes_on(input_.association, *input_.model, {dim, id}).empty()) ids.push_back(id);
    return ids;
  }

  MeshedModel input_;
  double volume_ = 0;  // of the CAD
};

TEST_P(cad_pair, all_curves) {
  run(input_, {.target = {.kind = EntityKind::curve, .ids = all(1)}});
}

TEST_P(cad_pair, all_vertices) {
  run(input_, {.target = {.kind = EntityKind::vertex, .ids = all(0)}});
}

TEST_P(cad_pair, all_vertices_two_layers_deep) {
  run(input_, {.target = {.kind = EntityKind::vertex, .ids = all(0), .depth = 2}});
}

TEST_P(cad_pair, two_surfaces_twice) {
  std::vector<Index> surfaces = {1};
  if (input_.model->count(2) >= 3) surfaces.push_back(3);
  run(input_, {.target = {.kind = EntityKind::surface, .ids = surfaces}, .how = Cuts{2}});
}

TEST_P(cad_pair, two_refinements_in_a_row) {
  const MeshedModel once = run(input_, {.target = {.kind = EntityKind::curve, .ids = {all(1).front()}}});
  run(once, {.target = {.kind = EntityKind::curve, .ids = {all(1).back()}}});
}

TEST_P(cad_pair, filled_instead_of_templates) {
  run(input_, {.target = {.kind = EntityKind::curve, .ids = {all(1).front()}}, .concave = Concave::fill});
}

TEST_P(cad_pair, all_volumes_uniformly) {
  const MeshedModel fine = run(input_, {.target = {.kind = EntityKind::volume, .ids = all(3)}});
  EXPECT_EQ(fine.mesh.n_hexes(), 8 * input_.mesh.n_hexes());
}

/// Eight hexes around a hole, in walls not much thicker than these bulge: of what a second pass makes there, hundreds
/// of hexes come out inverted. They are untangled with all nodes on the CAD, and so that the skin does not fold over
/// itself.
class coarse_holes : public cad_pair {};

TEST_P(coarse_holes, all_surfaces_twice) {
  run(input_, {.target = {.kind = EntityKind::surface, .ids = all(2)}, .how = Cuts{2}});
}

TEST_P(coarse_holes, one_hole_twice_and_smooth) {
  ASSERT_EQ(input_.model->type({2, 9}), "cylinder");
  run(input_, {.target = {.kind = EntityKind::surface, .ids = {9}}, .how = Cuts{2}, .finish = {.smooth = true}});
}

std::vector<Pair> pairs() {
  std::vector<Pair> result;
  for (const auto& [name, tolerance] :
       {std::pair{"bracket_fillet", 1e-9}, std::pair{"cyl_ogrid", 1e-9}, std::pair{"plate_hole", 1e-9},
        std::pair{"ring_twist90", 1e-7}, std::pair{"sphere7", 1e-9}, std::pair{"two_material", 1e-9}})
    for (const char* cad : {".brep", ".step"})
      for (const bool tags : {true, false}) result.push_back({name, cad, tags, tolerance});
  return result;
}

std::string pair_name(const testing::TestParamInfo<Pair>& param) {
  return std::string(param.param.name) + (std::string(param.param.cad) == ".brep" ? "_brep" : "_step") +
         (param.param.tags ? "_tags" : "_stripped");
}

INSTANTIATE_TEST_SUITE_P(real, cad_pair, testing::ValuesIn(pairs()), pair_name);
INSTANTIATE_TEST_SUITE_P(real, coarse_holes, testing::Values(Pair{"bracket_fillet", ".brep", true, 1e-9}), pair_name);

}  // namespace
}  // namespace hextwist
