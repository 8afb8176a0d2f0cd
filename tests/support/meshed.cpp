#include "support/meshed.h"

#include <filesystem>

#include "hextwist/geom/occ/model.h"
#include "hextwist/io/io.h"
#include "support/analytic_model.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist::test {

MeshedModel brick(int a, int b, int c) {
  MeshedModel result{grid(a, b, c), analytic_brick(a, b, c), {}};
  result.association = associate(result.mesh, *result.model).association;
  return result;
}

MeshedModel shipped(const std::string& name) {
  const auto models = std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models";
  MeshFile file = read_mesh(models / (name + ".msh"));
  MeshedModel result{std::move(file.mesh), read_cad(models / (name + ".brep")).model, {}};
  result.association = associate(result.mesh, *result.model, &file.tags).association;
  return result;
}

void expect_sound(const RefineResult& result) {
  const MeshedModel& fine = result.refined;
  EXPECT_TRUE(conformal(fine.mesh));
  EXPECT_TRUE(uninverted(fine.mesh));
  EXPECT_TRUE(result.report.violations.empty());
  const auto broken = check_association(fine.mesh, fine.association, *fine.model);
  EXPECT_TRUE(broken.empty()) << broken.front();
}

std::vector<int> levels(const Mesh& mesh) {
  std::vector<int> result(mesh.hexes.size(), 0);
  for (const Field& field : mesh.fields)
    if (field.name == "level" && field.on == Field::On::hex)
      for (std::size_t h = 0; h < result.size(); ++h) result[h] = static_cast<int>(field.values[h]);
  return result;
}

Vec3 centroid(const Mesh& mesh, Index hex) {
  Vec3 sum = Vec3::Zero();
  for (const Index n : mesh.hexes[hex]) sum += mesh.points[n];
  return sum / 8;
}

}  // namespace hextwist::test
