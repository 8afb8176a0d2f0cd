// The shipped models are what models.json says they are, and the README says the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "hextwist/geom/occ/model.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/validate/validate.h"
#include "source_tree.h"
#include "support/checkers.h"

namespace hextwist::test {
namespace {

const nlohmann::json& table() {
  static const auto rows = nlohmann::json::parse(content(source_folder() / "models/models.json"));
  return rows;
}

std::vector<std::string> names_of_models() {
  std::vector<std::string> names;
  for (const auto& row : table()) names.push_back(row["name"]);
  return names;
}

class ShippedModel : public testing::TestWithParam<std::string> {
 protected:
  const nlohmann::json& row() const {
    return *std::ranges::find_if(table(), [](const auto& each) { return each["name"] == GetParam(); });
  }
  std::filesystem::path file(const std::string& name) const { return source_folder() / "models" / name; }
  /// Largest distance allowed between a node and its owner, relative to the model size.
  double tolerance() const { return row()["splines"] ? 1e-7 : 1e-9; }
};

double total(const Model& model, int dim) {
  double sum = 0;
  for (int id = 1; id <= model.count(dim); ++id) sum += model.measure({dim, id});
  return sum;
}

TEST_P(ShippedModel, cad_has_the_stated_entities_and_exact_measures) {
  for (const std::string name : row()["cad"]) {
    const auto cad = read_cad(file(name), {.glue = row()["solids"] > 1});
    ASSERT_TRUE(cad.model);
    EXPECT_EQ(cad.model->count(3), row()["solids"]) << name;
    EXPECT_EQ(cad.model->count(2), row()["faces"]) << name;
    EXPECT_EQ(cad.model->count(1), row()["edges"]) << name;
    EXPECT_EQ(cad.model->count(0), row()["vertices"]) << name;
    // Closed forms to OpenCASCADE's own accuracy of integration; intersection curves and splines are approximations.
    const double error = row()["measure_error"];
    EXPECT_NEAR(total(*cad.model, 3) / double(row()["volume"]), 1, error) << name;
    EXPECT_NEAR(total(*cad.model, 2) / double(row()["area"]), 1, error) << name;
  }
}

TEST_P(ShippedModel, mesh_is_conformal_uninverted_and_as_good_as_stated) {
  const auto read = read_mesh(file(row()["mesh"]));
  EXPECT_EQ(read.mesh.n_hexes(), row()["hexes"]);
  EXPECT_EQ(read.mesh.n_nodes(), row()["nodes"]);
  EXPECT_TRUE(conformal(read.mesh));
  EXPECT_TRUE(uninverted(read.mesh));
  EXPECT_TRUE(sets_valid(read.mesh));
  EXPECT_TRUE(validate(read.mesh).empty());
  EXPECT_NEAR(summarize(quality(Metric::scaled_jacobian, read.mesh)).min, row()["min_scaled_jacobian"], 6e-5);
  EXPECT_NEAR(volume(read.mesh), row()["mesh_volume"], 1e-6);
  std::vector<std::string> names;
  for (const auto& set : read.mesh.side_sets) names.push_back(set.name);
  EXPECT_EQ(nlohmann::json(names), row()["side_sets"]);
  names.clear();
  for (const auto& set : read.mesh.node_sets) names.push_back(set.name);
  EXPECT_EQ(nlohmann::json(names), row()["node_sets"]);
  names.clear();
  for (const auto& block : read.mesh.blocks) names.push_back(block.name);
  EXPECT_EQ(nlohmann::json(names), row()["blocks"]);
}

TEST_P(ShippedModel, mesh_lies_on_its_cad_where_its_tags_say) {
  const auto cad = read_cad(file(row()["cad"][0]));
  const auto read = read_mesh(file(row()["mesh"]));
  const auto result = associate(read.mesh, *cad.model, &read.tags);
  EXPECT_TRUE(result.notices.empty()) << result.notices[0];
  EXPECT_LE(result.max_distance, tolerance() * cad.model->box().diagonal());
  EXPECT_EQ(check_association(read.mesh, result.association, *cad.model), std::vector<std::string>{});
  // Tags are the CAD's own ids: nothing was moved to another entity.
  EXPECT_EQ(result.association.node_owner, read.tags.node_owner);
}

TEST_P(ShippedModel, ownership_from_geometry_alone_equals_that_from_tags) {
  const auto cad = read_cad(file(row()["cad"][0]));
  const auto read = read_mesh(file(row()["mesh"]));
  const auto tagged = associate(read.mesh, *cad.model, &read.tags).association;
  const auto found = associate(read.mesh, *cad.model).association;
  EXPECT_EQ(found.node_owner, tagged.node_owner);
  EXPECT_EQ(found.curve_edges, tagged.curve_edges);
  EXPECT_EQ(found.edge_curve, tagged.edge_curve);
  EXPECT_EQ(found.surface_faces, tagged.surface_faces);
  EXPECT_EQ(found.face_surface, tagged.face_surface);
  EXPECT_EQ(found.hex_volume, tagged.hex_volume);
}

INSTANTIATE_TEST_SUITE_P(Models, ShippedModel, testing::ValuesIn(names_of_models()),
                         [](const auto& each) { return each.param; });

TEST(ShippedModels, every_file_in_the_folder_belongs_to_a_row) {
  for (const auto& found : files_below("models", {".brep", ".step", ".msh"})) {
    const bool known =
        std::ranges::any_of(table(), [&](const auto& row) { return row["name"] == found.stem().string(); });
    EXPECT_TRUE(known) << found << " is not in models.json";
  }
}

}  // namespace
}  // namespace hextwist::test
