#include "support/meshed.h"

#include <filesystem>

#include "hextwist/geom/analytic_model.h"
#include "hextwist/geom/occ_model.h"
#include "hextwist/mesh/io.h"
#include "support/grids.h"

namespace hextwist::test {

MeshedModel brick(int a, int b, int c) {
  MeshedModel result{grid(a, b, c), analytic_brick(a, b, c), {}};
  result.association = associate(result.mesh, *result.model, nullptr).association;
  return result;
}

MeshedModel shipped(const std::string& name) {
  const auto models = std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models";
  MeshFile file = read_mesh(models / (name + ".msh"));
  MeshedModel result{std::move(file.mesh), read_cad(models / (name + ".brep")).model, {}};
  result.association = associate(result.mesh, *result.model, &file.tags).association;
  return result;
}

}  // namespace hextwist::test
