// Real CAD with meshes that lie on it: .brep and .step, with tags and without.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <bit>

#include "hextwist/geom/occ/model.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/association/association.h"
#include "support/association_checkers.h"
#include "support/grids.h"

namespace hextwist {
namespace {

struct Pair {
  const char* name;
  int n_volumes;
};
void PrintTo(const Pair& pair, std::ostream* out) {
  *out << pair.name;
}

class association_on_cad : public testing::TestWithParam<Pair> {
 protected:
  void SetUp() override {
    folder_ = test::data_folder();
    if (folder_.empty()) GTEST_SKIP() << "no shared data";
    file_ = read_mesh(folder_ / "cad" / (std::string(GetParam().name) + "_1k.msh"));
    ASSERT_FALSE(file_.tags.empty());
  }
  CadImport cad(const char* extension) const {
    return read_cad(folder_ / "cad" / (std::string(GetParam().name) + extension), {.glue = GetParam().n_volumes > 1});
  }
  std::filesystem::path folder_;
  MeshFile file_;
};

void expect_good(const Mesh& mesh, const AssociateResult& result, const Model& model) {
  EXPECT_TRUE(test::complete(mesh, result.association, model));
  EXPECT_TRUE(test::on_model(mesh, result.association, model, 1e-7));
  EXPECT_EQ(check_association(mesh, result.association, model), std::vector<std::string>{});
  const OffModel off = off_model(mesh, result.association, model);
  EXPECT_LT(off.max_relative, 1e-7) << to_string(off.owner);
  EXPECT_LT(result.max_distance / model.box().diagonal(), 1e-7);
}

TEST_P(association_on_cad, tags_and_geometry_agree_on_the_brep) {
  const auto model = cad(".brep").model;
  EXPECT_EQ(model->count(3), GetParam().n_volumes);
  const auto by_tags = associate(file_.mesh, *model, &file_.tags);
  EXPECT_EQ(by_tags.notices, std::vector<std::string>{});
  expect_good(file_.mesh, by_tags, *model);
  const auto by_geometry = associate(file_.mesh, *model);
  EXPECT_EQ(by_geometry.notices, std::vector<std::string>{});
  EXPECT_TRUE(test::same_owners(by_tags.association, by_geometry.association));
  // The tags of the file are the truth: it was meshed on this CAD.
  EXPECT_EQ(by_tags.association.surface_faces, file_.tags.surface_faces);
  EXPECT_EQ(by_tags.association.face_surface, file_.tags.face_surface);
  EXPECT_EQ(by_tags.association.curve_edges, file_.tags.curve_edges);
  EXPECT_EQ(by_tags.association.edge_curve, file_.tags.edge_curve);
  EXPECT_EQ(by_tags.association.hex_volume, file_.tags.hex_volume);
  EXPECT_EQ(by_tags.association.node_owner, file_.tags.node_owner);
}

TEST_P(association_on_cad, tags_and_geometry_agree_on_the_step) {
  const auto model = cad(".step").model;
  EXPECT_EQ(model->count(3), GetParam().n_volumes);
  const auto by_tags = associate(file_.mesh, *model, &file_.tags);
  expect_good(file_.mesh, by_tags, *model);
  const auto by_geometry = associate(file_.mesh, *model);
  EXPECT_EQ(by_geometry.notices, std::vector<std::string>{});
  EXPECT_TRUE(test::same_owners(by_tags.association, by_geometry.association));
  for (const std::string& notice : by_tags.notices) RecordProperty("notice", notice);
}

TEST_P(association_on_cad, scrambled_tags_are_found_out) {
  const auto model = cad(".brep").model;
  const auto truth = associate(file_.mesh, *model).association;
  std::mt19937 random(3);
  for (int round = 0; round < 3; ++round) {
    Association wrong = file_.tags;
    const auto scramble = [&](std::vector<int>& ids, int dim) {
      std::uniform_int_distribution<int> any(1, model->count(dim));
      if (round == 0)  // another numbering
        for (int& id : ids) id = model->count(dim) + 1 - id;
      else
        for (int& id : ids)
          if (round == 2 || random() % 10 == 0) id = any(random);
    };
    scramble(wrong.face_surface, 2);
    scramble(wrong.edge_curve, 1);
    scramble(wrong.hex_volume, 3);
    const auto result = associate(file_.mesh, *model, &wrong);
    EXPECT_TRUE(test::same_owners(result.association, truth)) << round;
    EXPECT_FALSE(result.notices.empty());
  }
}

TEST_P(association_on_cad, a_mesh_in_metres_on_cad_in_millimetres_is_explained) {
  const auto model = cad(".brep").model;
  for (Vec3& p : file_.mesh.points) p /= 1000;
  try {
    associate(file_.mesh, *model, &file_.tags);
    FAIL() << "no error";
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("the mesh does not lie on the model: node "), std::string::npos) << text;
    EXPECT_NE(text.find("the mesh is 1000 times smaller than the model: millimetres and metres mixed up?"),
              std::string::npos)
        << text;
  }
}

TEST_P(association_on_cad, volumes_that_share_nothing_ask_for_glue) {
  if (GetParam().n_volumes == 1) GTEST_SKIP() << "one volume";
  const auto model = read_cad(folder_ / "cad" / (std::string(GetParam().name) + ".step")).model;
  for (const Association* tags : {static_cast<const Association*>(nullptr), &std::as_const(file_.tags)}) {
    try {
      associate(file_.mesh, *model, tags);
      FAIL() << "no error";
    } catch (const Error& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find("which share no surface: glue them"), std::string::npos) << text;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(pairs, association_on_cad,
                         testing::Values(Pair{"bracket_fillet", 1}, Pair{"cyl_ogrid", 5}, Pair{"plate_hole", 1},
                                         Pair{"ring_twist90", 3}, Pair{"sphere7", 7}, Pair{"two_material", 2}),
                         [](const auto& pair) { return std::string(pair.param.name); });

TEST(association_on_other_cad, dangling_tags_are_named_and_change_nothing) {
  const auto folder = test::data_folder();
  if (folder.empty()) GTEST_SKIP() << "no shared data";
  const MeshFile file = read_mesh(folder / "mesh" / "cad_component_hex.msh");
  const auto model = read_cad(folder / "mesh" / "cad_component_hex.brep").model;
  const auto by_tags = associate(file.mesh, *model, &file.tags);
  const auto by_geometry = associate(file.mesh, *model);
  EXPECT_TRUE(test::same_owners(by_tags.association, by_geometry.association));
  EXPECT_EQ(check_association(file.mesh, by_tags.association, *model), std::vector<std::string>{});
  EXPECT_TRUE(test::complete(file.mesh, by_tags.association, *model));
  ASSERT_GE(by_tags.notices.size(), 2);
  EXPECT_EQ(by_tags.notices[0],
            "1 vertex tag of the file numbers the CAD in another way: matched by geometry (first: node 17, tag 17, on "
            "nothing)");
  EXPECT_EQ(by_tags.notices[1], "1 surface has no face of the mesh: 23");
}

/// The models that come with the project.
class association_on_models : public testing::TestWithParam<const char*> {};

TEST_P(association_on_models, tags_and_geometry_agree) {
  const auto stem = std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models" / GetParam();
  const MeshFile file = read_mesh(stem.string() + ".msh");
  for (const char* extension : {".brep", ".step"}) {
    const auto model = read_cad(stem.string() + extension, {.glue = true}).model;
    const auto by_tags = associate(file.mesh, *model, &file.tags);
    const auto by_geometry = associate(file.mesh, *model);
    EXPECT_EQ(by_geometry.notices, std::vector<std::string>{});
    EXPECT_TRUE(test::same_owners(by_tags.association, by_geometry.association));
    EXPECT_TRUE(test::complete(file.mesh, by_tags.association, *model));
    EXPECT_TRUE(test::on_model(file.mesh, by_tags.association, *model, 1e-7));
    EXPECT_EQ(check_association(file.mesh, by_tags.association, *model), std::vector<std::string>{});
  }
}

INSTANTIATE_TEST_SUITE_P(all, association_on_models,
                         testing::Values("bracket", "bracket_fillet", "cam", "curved_plate", "cylinder", "inclusion",
                                         "l_block", "notched_cube", "pipe_tee", "plate_hole", "plate_quarter",
                                         "ring_twist", "sphere"),
                         [](const auto& model) { return std::string(model.param); });

TEST(association_threads, their_number_changes_nothing) {
  const auto stem = std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models" / "inclusion";
  const Mesh mesh = read_mesh(stem.string() + ".msh").mesh;
  const auto model = read_cad(stem.string() + ".brep").model;
  std::vector<AssociateResult> results;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(associate(mesh, *model));
  }
  for (const auto& result : results) {
    EXPECT_TRUE(test::same_owners(result.association, results[0].association));
    EXPECT_EQ(result.worst_node, results[0].worst_node);
    EXPECT_EQ(result.max_distance, results[0].max_distance);
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      const auto bits = [](const Parameters& p) { return std::bit_cast<std::array<std::uint64_t, 2>>(p); };
      EXPECT_EQ(bits(result.association.node_parameters[n]), bits(results[0].association.node_parameters[n]));
    }
  }
}

}  // namespace
}  // namespace hextwist
