// mesh volume: hexes where there was only CAD, judged by checkers that know nothing of how they came about.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "geom/occ_shapes.h"
#include "hextwist/base/fenced.h"
#include "hextwist/mesh/topology.h"
#include "session/session_fixture.h"
#include "support/association_checkers.h"
#include "support/checkers.h"

namespace hextwist {
namespace {

using test::Fixture;
using test::OccShape;

std::string model_file(const std::string& name) {
  return std::string(HEXTWIST_SOURCE_DIR) + "/models/" + name;
}

bool has_gmsh() {
  return !find_program("gmsh").empty();
}

/// Everything that must hold of a mesh that was just made. volume_error: part of the CAD's volume that flat facets may
/// miss.
void expect_filled(const Fixture& f, double volume_error) {
  const MeshedModel& meshed = f.session.meshed();
  const Mesh& mesh = meshed.mesh;
  ASSERT_GT(mesh.n_hexes(), 0);
  EXPECT_TRUE(test::conformal(mesh));
  EXPECT_TRUE(test::uninverted(mesh));
  EXPECT_TRUE(test::sets_valid(mesh));
  EXPECT_TRUE(test::on_model(mesh, meshed.association, *meshed.model, 1e-5));
  EXPECT_TRUE(test::complete(mesh, meshed.association, *meshed.model));
  // Every surface and every vertex where curves meet has its part of the mesh.
  std::set<int> surfaces(meshed.association.face_surface.begin(), meshed.association.face_surface.end());
  std::map<int, double> volumes;
  for (Index h = 0; h < mesh.n_hexes(); ++h) volumes[meshed.association.hex_volume[h]] += volume(mesh, h);
  ASSERT_EQ(volumes.size(), mesh.blocks.size());
  for (const auto& [id, filled] : volumes) {
    const double cad = meshed.model->measure({3, id});
    EXPECT_NEAR(filled / cad, 1, volume_error) << "volume " << id;
    for (const int surface : meshed.model->adjacent({3, id}, 2))
      EXPECT_TRUE(surfaces.contains(surface)) << "surface " << surface << " of volume " << id;
  }
  // A block for each volume, of its number and of all its hexes.
  for (const Block& block : mesh.blocks)
    for (const Index h : block.hexes) EXPECT_EQ(meshed.association.hex_volume[h], block.id);
  EXPECT_EQ(f.last().violations.size(), 0U);
}

/// What quality the worst hex has.
double worst(const Fixture& f) {
  return f.last().after.scaled_jacobian.min;
}

struct Shape {
  const char* name;
  std::function<OccShape()> make;
  double volume_error;  ///< of facets of the default size
  double least_jacobian;
  bool needs_gmsh;
};

const std::vector<Shape> swept = {
    {"brick", [] { return OccShape::brick(4, 3, 2); }, 1e-9, 0.999, false},
    {"cylinder", [] { return OccShape::cylinder(2, 5); }, 0.05, 0.6, false},
    {"cone", [] { return OccShape::cone(2, 1, 3); }, 0.05, 0.5, false},
    {"ball", [] { return OccShape::sphere(2); }, 0.1, 0.6, false},
    {"loft", [] { return OccShape::loft(); }, 0.05, 0.2, true},
    {"brick with a hole", [] { return OccShape::brick_with_hole(10, 6, 2, 1.5); }, 0.02, 0.3, true},
    {"half a cylinder", [] { return OccShape::cylinder_sector(2, 4, 0.3, 0.3 + 3.14159); }, 0.05, 0.3, true},
    {"a sector across the seam", [] { return OccShape::cylinder_sector(2, 4, -0.7, 0.9); }, 0.05, 0.3, true},
    {"an L",
     [] {
       return OccShape::extruded({{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}}}, {0.3, 0, 2});
     },
     1e-9, 0.3, true},
    {"a triangle",
     [] {
       return OccShape::extruded({{{0, 0}, {4, 0}, {1, 3}}}, {0, 0, 2});
     },
     1e-9, 0.3, true},
    {"a turned L",
     [] {
       return OccShape::turned({{{2, 0}, {4, 0}, {4, 1}, {3, 1}, {3, 2}, {2, 2}}}, 1.1);
     },
     0.05, 0.3, true},
    {"a ring of an L",
     [] {
       return OccShape::turned({{{2, 0}, {4, 0}, {4, 1}, {3, 1}, {3, 2}, {2, 2}}}, 7);
     },
     0.1, 0.3, true},
    {"a washer",
     [] {
       return OccShape::turned({{{2, 0}, {3, 0}, {3, 1}, {2, 1}}}, 7);
     },
     0.1, 0.3, false},
    // Turned about an axis that they touch.
    {"a shaft with steps",
     [] {
       return OccShape::turned({{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {1.4, 3}, {1.4, 4}, {0, 4}}}, 7);
     },
     0.1, 0.3, true},
    {"a cup",
     [] {
       return OccShape::turned({{{0, 0}, {3, 0}, {3, 4}, {2, 4}, {2, 1}, {0, 1}}}, 7);
     },
     0.1, 0.3, true},
    // Three edges at its tip, whose half angle has a tangent of 2/3: no hex there can do better than the square of the
    // sine.
    {"a cone with its tip", [] { return OccShape::cone(2, 0, 3); }, 0.1, 0.2, true},
    {"a pin with a blunt point",
     [] {
       return OccShape::turned({{{0, 0}, {1, 0}, {1, 3}, {0, 4}}}, 7);
     },
     0.1, 0.3, true},
    {"a hollow ball", [] { return OccShape::hollow_ball(2, 1.2); }, 0.1, 0.3, true},
    {"a dome", [] { return OccShape::dome(2); }, 0.1, 0.1, true},
    // Its parts begin at different angles.
    {"a shaft made of two", [] { return OccShape::fused_shaft(); }, 0.1, 0.3, true},
    {"a bent rod", [] { return OccShape::turned_disc(3, 1, 1.6); }, 0.1, 0.5, false},
    {"a torus", [] { return OccShape::torus(3, 1); }, 0.15, 0.5, false},
    {"a NURBS cylinder", [] { return OccShape::cylinder(2, 5).as_nurbs(); }, 0.05, 0.3, true},
    {"a NURBS brick", [] { return OccShape::brick(4, 3, 2).as_nurbs(); }, 1e-9, 0.999, false},
};

void expect_fills(const Shape& shape, const std::string& format, const std::string& how) {
  SCOPED_TRACE(shape.name + (" " + format) + how);
  Fixture f;
  const auto file = test::folder() / ("solid." + format);
  shape.make().moved({1, -2, 0.5}, 0.4).write(file);
  f.session.run("import " + format + " '" + file.string() + "'");
  f.session.run("mesh volume all" + how);
  expect_filled(f, shape.volume_error);
  // As many intervals along short curves as along long ones leave narrow quads where a cap is paved.
  const bool is_uneven = shape.needs_gmsh && how.starts_with(" interval");
  EXPECT_GE(worst(f), is_uneven ? std::min(0.2, shape.least_jacobian) : shape.least_jacobian);
}

TEST(SlowMeshVolume, fills_solids_that_can_be_swept) {
  for (const Shape& shape : swept) {
    if (shape.needs_gmsh && !has_gmsh()) continue;
    for (const char* format : {"brep", "step"})
      for (const char* how : {"", " size 0.4", " interval 16"}) expect_fills(shape, format, how);
  }
}

TEST(MeshVolume, fills_what_was_turned_about_an_axis) {
  if (!has_gmsh()) GTEST_SKIP() << "gmsh is not installed";
  for (const char* name : {"a shaft with steps", "a dome", "a torus", "a shaft made of two"})
    expect_fills(*std::ranges::find(swept, std::string_view(name), &Shape::name), "brep", "");
}

// The chords at a waist cut into what is no part of the solid: at a coarse size nodes inside of the mesh lie there.
TEST(SlowMeshVolume, fills_a_vase_at_a_size_that_its_waist_needs) {
  if (!has_gmsh()) GTEST_SKIP() << "gmsh is not installed";
  for (const char* format : {"brep", "step"}) {
    Fixture f;
    const auto file = test::folder() / (std::string("vase.") + format);
    OccShape::vase().moved({1, -2, 0.5}, 0.4).write(file);
    f.session.run("import " + std::string(format) + " '" + file.string() + "'; mesh volume all size 0.4");
    expect_filled(f, 0.02);
    EXPECT_GE(worst(f), 0.1);
  }
}

TEST(MeshVolume, gives_grids_to_bricks_and_the_number_of_intervals_that_was_said) {
  Fixture f;
  const auto file = test::folder() / "brick.brep";
  OccShape::brick(4, 3, 2).write(file);
  f.session.run("import brep '" + file.string() + "'; mesh volume 1 interval 5");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 125);
  f.session.run("reset mesh; mesh volume 1 size 0.5");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 8 * 6 * 4);
  for (Index n = 0; n < f.session.meshed().mesh.n_nodes(); ++n) {
    const Vec3 twice = 2 * f.session.meshed().mesh.points[n];
    EXPECT_NEAR((twice - twice.array().round().matrix()).norm(), 0, 1e-9);
  }
}

TEST(MeshVolume, meshes_can_be_refined_exported_and_undone) {
  Fixture f;
  f.session.run("import brep '" + model_file("cylinder.brep") + "'");
  f.session.run("mesh volume all interval 8");
  const Index n = f.session.meshed().mesh.n_hexes();
  f.session.run("refine curve 1 depth 1; check");
  EXPECT_GT(f.session.meshed().mesh.n_hexes(), n);
  expect_filled(f, 0.1);
  f.session.run("undo 2");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 0);
  ASSERT_TRUE(f.session.meshed().model);
  f.session.run("redo");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), n);
  const auto out = (test::folder() / "out.msh").string();
  f.session.run("export mesh '" + out + "'; reset; import brep '" + model_file("cylinder.brep") + "'; import mesh '" +
                out + "'");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), n);
}

TEST(MeshVolume, touching_solids_are_glued_and_share_their_faces) {
  Fixture f;
  const auto file = test::folder() / "two.step";
  OccShape::two_bricks().write(file);
  f.session.run("import step '" + file.string() + "'; mesh volume all interval 4");
  expect_filled(f, 1e-9);
  const Mesh& mesh = f.session.meshed().mesh;
  EXPECT_EQ(mesh.blocks.size(), 2U);
  EXPECT_EQ(test::conformal(mesh), testing::AssertionSuccess());
  // Joined: the skin of 4 x 4 faces is that of one box, and the face between is no part of it.
  Index n_between = 0;
  const Faces all = faces(mesh);
  for (const auto& sides : all.sides)
    if (sides[1].hex >= 0 && f.session.meshed().association.hex_volume[sides[0].hex] !=
                                 f.session.meshed().association.hex_volume[sides[1].hex])
      ++n_between;
  EXPECT_EQ(n_between, 16);
}

/// Faces between different volumes.
Index n_shared(const Fixture& f) {
  Index n = 0;
  const Association& association = f.session.meshed().association;
  for (const auto& sides : faces(f.session.meshed().mesh).sides)
    n += sides[1].hex >= 0 && association.hex_volume[sides[0].hex] != association.hex_volume[sides[1].hex];
  return n;
}

TEST(MeshVolume, volumes_one_behind_the_other_agree_on_what_they_share) {
  const std::vector<std::array<double, 2>> l = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};
  const std::vector<std::pair<const char*, std::vector<OccShape>>> cases = {
      // The step in the middle has a disc and a ring at both of its ends, the last ones at one of theirs.
      {"a shaft of three steps",
       {OccShape::cylinder(1, 2), OccShape::cylinder(2, 1).moved({0, 0, 2}, 0),
        OccShape::cylinder(1, 2).moved({0, 0, 3}, 0)}},
      {"a shaft that grows",
       {OccShape::cylinder(1, 2), OccShape::cylinder(1.6, 2).moved({0, 0, 2}, 0),
        OccShape::cylinder(2.2, 2).moved({0, 0, 4}, 0)}},
      {"two L", {OccShape::extruded(l, {0, 0, 2}), OccShape::extruded(l, {0, 0, 1}).moved({0, 0, 2}, 0)}},
      // Nowhere a grid can be copied from: three boxes around an edge, one of them across two.
      {"boxes",
       {OccShape::brick(1, 1, 1), OccShape::brick(2, 1, 1).moved({1, 0, 0}, 0),
        OccShape::brick(3, 1, 1).moved({0, 1, 0}, 0)}},
      {"a bent rod and a straight one",
       {OccShape::turned_disc(3, 1, 1.5), OccShape::cylinder(1, 2).moved({3, 0, 0}, 0)}},
  };
  for (const auto& [name, solids] : cases) {
    if (std::string(name) == "two L" && !has_gmsh()) continue;
    for (const char* how : {"", " size 0.45", " interval 13"}) {
      SCOPED_TRACE(std::string(name) + how);
      Fixture f;
      const auto file = test::folder() / "together.step";
      OccShape::together(solids).write(file);
      f.session.run("import step '" + file.string() + "'; mesh volume all" + how);
      expect_filled(f, 0.1);
      EXPECT_GT(n_shared(f), 0);
      EXPECT_GT(worst(f), 0.3);
      EXPECT_EQ(f.session.meshed().mesh.blocks.size(), solids.size());
      f.session.run("refine volume 1 depth 1");
      EXPECT_TRUE(test::conformal(f.session.meshed().mesh));
    }
  }
}

TEST(MeshVolume, one_of_several_volumes_may_be_filled_alone) {
  Fixture f;
  const auto file = test::folder() / "together.step";
  OccShape::together({OccShape::brick(1, 1, 1), OccShape::brick(2, 1, 1).moved({1, 0, 0}, 0)}).write(file);
  f.session.run("import step '" + file.string() + "'; mesh volume 2 interval 3");
  expect_filled(f, 1e-9);
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 27);
  EXPECT_EQ(f.session.meshed().mesh.blocks.front().id, 2);
}

TEST(MeshVolume, shipped_models_are_filled_or_refused_by_name) {
  const std::map<std::string, bool> can = {
      {"bracket", false},      {"bracket_fillet", false}, {"plate_hole", true}, {"plate_quarter", true},
      {"cylinder", true},      {"sphere", true},          {"inclusion", false}, {"pipe_tee", false},
      {"ring_twist", false},   {"curved_plate", true},    {"cam", true},        {"l_block", true},
      {"notched_cube", false}, {"bent_bar", true},        {"graded_rod", true}, {"bearing_plate", true}};
  for (const auto& [model, fills] : can) {
    if (fills && !has_gmsh()) continue;
    SCOPED_TRACE(model);
    Fixture f;
    f.session.run("import brep '" + model_file(model + ".brep") + "'");
    const std::string wrong = f.error("mesh volume all");
    if (fills) {
      EXPECT_EQ(wrong, "no error");
      expect_filled(f, 0.1);
    } else {
      EXPECT_TRUE(wrong.starts_with(model == "inclusion" ? "volume 2: seen from surface" : "volume 1: s")) << wrong;
      EXPECT_NE(wrong.find("import mesh"), std::string::npos) << wrong;
      EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 0);
    }
  }
}

TEST(MeshVolume, real_cad_is_filled_where_it_can_be_swept) {
  const std::filesystem::path data = std::filesystem::path(HEXTWIST_TEST_DATA) / "cad";
  if (!std::filesystem::exists(data) || !has_gmsh()) GTEST_SKIP() << "no CAD in " << data << ", or no gmsh";
  // Blossom leaves an element over a hole of the fillet's bracket, which is mended; the ring is four solids that are
  // glued, the ball seven.
  for (const char* name : {"bracket_fillet", "cyl_ogrid", "plate_hole", "ring_twist90", "sphere7", "two_material"})
    for (const char* format : {".brep", ".step"}) {
      SCOPED_TRACE(name + std::string(format));
      Fixture f;
      f.session.run("import geometry '" + (data / (name + std::string(format))).string() + "'; mesh volume all");
      expect_filled(f, 0.1);
      EXPECT_GT(worst(f), 0.2);
    }
}

TEST(MeshVolume, without_the_program_gmsh_says_which_surface_needs_it) {
  const char* path = std::getenv("PATH");
  const std::string before = path ? path : "";
  ::setenv("PATH", "/nonexistent", 1);
  Fixture f;
  const auto file = test::folder() / "hole.brep";
  OccShape::brick_with_hole(10, 6, 2, 1.5).write(file);
  f.session.run("import brep '" + file.string() + "'");
  const std::string wrong = f.error("mesh volume all");
  Fixture g;
  g.session.run("import brep '" + model_file("cylinder.brep") + "'");
  const std::string right = g.error("mesh volume all");
  ::setenv("PATH", before.c_str(), 1);
  EXPECT_NE(wrong.find("volume 1: surface"), std::string::npos) << wrong;
  EXPECT_NE(wrong.find("program gmsh"), std::string::npos) << wrong;
  EXPECT_EQ(right, "no error");
}

/// A folder with a program called gmsh that does this, instead of the real one.
class FakeGmsh {
 public:
  explicit FakeGmsh(const std::string& script) : before_(std::getenv("PATH")) {
    const auto program = test::written("gmsh", "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    ::setenv("PATH", (program.parent_path().string() + ":" + before_).c_str(), 1);
  }
  ~FakeGmsh() { ::setenv("PATH", before_.c_str(), 1); }
  FakeGmsh(const FakeGmsh&) = delete;
  FakeGmsh& operator=(const FakeGmsh&) = delete;

 private:
  std::string before_;
};

TEST(MeshVolume, whatever_becomes_of_gmsh_is_one_line_and_changes_nothing) {
  // It crashes; fails; leaves nothing; leaves half a mesh; a mesh of something else.
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"kill -SEGV $$", "gmsh crashed"},
      {"exit 3", "gmsh failed (it ended with status 3)"},
      {"exit 0", "gmsh has not left a mesh"},
      {"echo '$Nodes\n3\n1 0 0 0' >&3", "gmsh has not left a mesh"},
      {"printf '$Nodes\\n40\\n' >&3; for i in $(seq 40); do echo $i $i 0 0 >&3; done; printf "
       "'$EndNodes\\n$Elements\\n1\\n1 2 2 0 1 1 2 3\\n$EndElements\\n' >&3",
       "gmsh has left elements that overlap"},
      // Triangles over a part of the surface alone.
      {"printf '$Nodes\\n40\\n' >&3; for i in $(seq 40); do echo $i $i $((i * i)) 0 >&3; done; printf "
       "'$EndNodes\\n$Elements\\n1\\n1 2 2 0 1 1 2 3\\n$EndElements\\n' >&3",
       "was not paved as asked"},
  };
  const auto file = test::folder() / "hole.brep";
  OccShape::brick_with_hole(10, 6, 2, 1.5).write(file);
  for (const auto& [script, said] : cases) {
    SCOPED_TRACE(script);
    const FakeGmsh fake(script);
    Fixture f;
    f.session.run("import brep '" + file.string() + "'");
    const std::string wrong = f.error("mesh volume all interval 8");
    EXPECT_NE(wrong.find(said), std::string::npos) << wrong;
    EXPECT_NE(wrong.find("volume 1"), std::string::npos) << wrong;
    EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 0);
    EXPECT_TRUE(f.session.meshed().model);
  }
}

TEST(MeshVolume, says_what_is_in_the_way) {
  Fixture f;
  EXPECT_NE(f.error("mesh volume all").find("there is no"), std::string::npos);
  f.session.run("create brick x 2 interval 2");
  EXPECT_NE(f.error("mesh volume all").find("there is a mesh of 8 hexes already"), std::string::npos);
  f.session.run("reset mesh; mesh volume 1 interval 3");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 27);
  EXPECT_NE(f.error("mesh volume 7").find("7"), std::string::npos);
  EXPECT_NE(f.error("mesh surface 1").find("mesh volume all"), std::string::npos);
  EXPECT_NE(f.error("reset mesh; mesh volume 1 size 0").find("size"), std::string::npos);
  f.session.run("set max_hexes 1000");
  EXPECT_NE(f.error("mesh volume 1 interval 20").find("1000"), std::string::npos);
  f.session.run("set max_hexes 0");
}

TEST(MeshVolume, stops_when_the_user_wishes_while_gmsh_is_at_work) {
  const auto file = test::folder() / "hole.brep";
  OccShape::brick_with_hole(10, 6, 2, 1.5).write(file);
  const FakeGmsh fake("exec sleep 60");
  Fixture f;
  f.session.run("import brep '" + file.string() + "'");
  f.go_on = false;
  EXPECT_THROW(f.session.run("mesh volume all interval 8"), CommandError);
  int asked = 0;
  SessionCallbacks callbacks = f.callbacks();
  callbacks.progress = [&](const char*, double) { return ++asked < 12; };
  f.session.set_callbacks(callbacks);
  const std::string wrong = f.error("mesh volume all interval 8");
  EXPECT_NE(wrong.find("cancelled"), std::string::npos) << wrong;
  EXPECT_GE(asked, 12);
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 0);
}

TEST(MeshVolume, is_the_same_every_time_and_for_any_number_of_threads) {
  if (!has_gmsh()) GTEST_SKIP() << "gmsh is not installed";
  const auto file = test::folder() / "hole.brep";
  OccShape::brick_with_hole(10, 6, 2, 1.5).write(file);
  std::vector<Mesh> meshes;
  for (const char* threads : {"1", "2", "8"}) {
    Fixture f;
    f.session.run("set threads " + std::string(threads) + "; import brep '" + file.string() + "'; mesh volume all");
    meshes.push_back(f.session.meshed().mesh);
    f.session.run("set threads 0");
  }
  EXPECT_EQ(meshes[0].points, meshes[1].points);
  EXPECT_EQ(meshes[0].points, meshes[2].points);
  EXPECT_EQ(meshes[0].hexes, meshes[1].hexes);
  EXPECT_EQ(meshes[0].hexes, meshes[2].hexes);
}

}  // namespace
}  // namespace hextwist
