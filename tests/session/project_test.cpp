// project to geometry, and tolerances that are larger than what a mesh needs.
#include <gtest/gtest.h>

#include <cmath>

#include "hextwist/geom/occ/model.h"
#include "hextwist/geom/similarity.h"
#include "session/session_fixture.h"
#include "support/association_checkers.h"
#include "support/checkers.h"

namespace hextwist {
namespace {

using test::Fixture;

std::string file_of(const std::string& name) {
  return std::string(HEXTWIST_SOURCE_DIR) + "/models/" + name;
}

void import(Fixture& f, const std::string& model) {
  f.session.run("import brep '" + file_of(model + ".brep") + "'; import mesh '" + file_of(model + ".msh") + "'");
}

/// The CAD of a model, larger by that factor about its centre.
std::string changed_cad(const std::string& model, double factor) {
  const auto cad = read_cad(file_of(model + ".brep")).model;
  const Vec3 centre = (cad->box().min + cad->box().max) / 2;
  const std::string file = (test::folder() / "changed.brep").string();
  write_cad(file, *moved(*cad, {.factor = factor, .shift = (1 - factor) * centre}));
  return file;
}

TEST(Project, puts_the_mesh_on_a_cad_that_has_changed_a_little_and_says_where) {
  for (const char* model : {"bracket_fillet", "sphere", "inclusion", "curved_plate"})
    for (const double factor : {1.004, 0.997}) {
      SCOPED_TRACE(std::string(model) + " " + std::to_string(factor));
      Fixture f;
      import(f, model);
      f.session.run("nodeset 5 surface 1");
      const MeshedModel before = f.session.meshed();
      const double size = before.model->box().diagonal();
      const std::string file = changed_cad(model, factor);
      EXPECT_NE(f.error("import brep '" + file + "'").find("does not lie on the model"), std::string::npos);
      f.output.clear();
      ASSERT_EQ(f.error("project to geometry '" + file + "'"), "no error");
      const MeshedModel& now = f.session.meshed();
      EXPECT_EQ(f.error("check"), "no error");
      EXPECT_TRUE(test::on_model(now.mesh, now.association, *now.model, 1e-9));
      EXPECT_TRUE(test::complete(now.mesh, now.association, *now.model));
      EXPECT_TRUE(test::uninverted(now.mesh));
      EXPECT_EQ(now.association.node_owner, before.association.node_owner);
      // Every node of the boundary by its distance from the centre.
      const Vec3 centre = (before.model->box().min + before.model->box().max) / 2;
      for (Index n = 0; n < now.mesh.n_nodes(); ++n) {
        if (now.association.node_owner[n].dim != 0) continue;
        EXPECT_LT((now.mesh.points[n] - (factor * (before.mesh.points[n] - centre) + centre)).norm(), 1e-9 * size);
      }
      EXPECT_NE(f.output.front().find("surface 1: "), std::string::npos) << f.all_output();
      EXPECT_NE(f.all_output().find("smallest shape"), std::string::npos);
      f.session.run("undo");
      EXPECT_EQ(f.session.meshed().mesh, before.mesh);
    }
}

TEST(Project, does_not_go_farther_than_told) {
  Fixture f;
  import(f, "bracket");
  const std::string file = changed_cad("bracket", 1.03);
  EXPECT_NE(f.error("project to geometry '" + file + "'"), "no error");
  EXPECT_NE(f.error("project to geometry '" + file + "' within 0.5"), "no error");
  EXPECT_EQ(f.error("check"), "no error");
  EXPECT_EQ(f.error("project to geometry '" + file + "' within 2.5"), "no error");
  EXPECT_EQ(f.error("check"), "no error");
}

TEST(Project, to_the_cad_that_is_there_mends_what_no_snap_has_left) {
  Fixture f;
  f.session.run("create sphere radius 1 interval 3");
  Mesh mesh = f.session.meshed().mesh;
  for (Vec3& p : mesh.points) p = (p * 1e5).array().round() / 1e5;
  f.session.run("set snap off; set tolerance 1e-4");
  f.session.take_mesh(mesh);
  EXPECT_GT(f.session.records().back().off_cad.max, 1e-7);
  f.session.run("set tolerance 1e-9");
  EXPECT_NE(f.notices.back().find("'project to geometry'"), std::string::npos);
  EXPECT_NE(f.error("check"), "no error");
  f.session.run("project to geometry");
  EXPECT_EQ(f.error("check"), "no error");
  EXPECT_NE(f.output.back().find("no violations"), std::string::npos);
  EXPECT_EQ(f.error("project to geometry within 1e-9"), "no error");
}

TEST(Project, needs_mesh_and_cad) {
  Fixture f;
  EXPECT_TRUE(f.error("project to geometry").starts_with("there is no mesh to project"));
  f.session.run("import mesh '" + file_of("bracket.msh") + "'");
  EXPECT_TRUE(f.error("project to geometry").starts_with("there is no CAD to project to"));
  EXPECT_EQ(f.error("project to geometry '" + file_of("bracket.brep") + "'"), "no error");
  f.session.run("reset; import brep '" + file_of("bracket.brep") + "'");
  EXPECT_TRUE(f.error("refine hex 1").starts_with("there is no mesh to refine; there is only CAD: read its mesh"));
}

TEST(Tolerance, of_any_size_leads_to_a_mesh_that_is_sound_or_to_an_error) {
  for (const char* model : {"bracket", "sphere", "inclusion", "pipe_tee", "bracket_fillet"})
    for (const char* tolerance : {"1e-3", "0.05", "0.2", "0.9"}) {
      SCOPED_TRACE(std::string(model) + " " + tolerance);
      Fixture f;
      f.session.run(std::string("set tolerance ") + tolerance);
      ASSERT_NO_THROW(import(f, model));
      EXPECT_EQ(f.error("check"), "no error");
    }
}

TEST(Tolerance, without_snapping_is_the_one_that_check_goes_by) {
  const std::string file = changed_cad("bracket_fillet", 1.004);
  Fixture f;
  f.session.run("set tolerance 0.01; set snap off; import brep '" + file + "'; import mesh '" +
                file_of("bracket_fillet.msh") + "'");
  EXPECT_EQ(f.error("check"), "no error");
  EXPECT_GT(f.session.records().back().off_cad.max_relative, 1e-3);
}

}  // namespace
}  // namespace hextwist
