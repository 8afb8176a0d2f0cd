// move, scale, rotate and reflect; names; parts of a mesh in a file; attributes.
#include <gtest/gtest.h>

#include "hextwist/io/exodus/exodus_internal.h"
#include "hextwist/io/io.h"
#include "hextwist/io/results.h"
#include "hextwist/mesh/validate/validate.h"
#include "session/session_fixture.h"
#include "support/association_checkers.h"
#include "support/checkers.h"

namespace hextwist {
namespace {

using test::Fixture;

std::string models() {
  return std::string(HEXTWIST_SOURCE_DIR) + "/models/";
}

void import(Fixture& f, const std::string& model, bool cad = true) {
  if (cad) f.session.run("import brep \"" + models() + model + ".brep\"");
  f.session.run("import mesh \"" + models() + model + ".msh\"");
}

TEST(Moving, keeps_mesh_and_cad_together_ids_and_owners_with_every_kind_of_surface) {
  for (const char* model : {"bracket_fillet", "sphere", "inclusion", "pipe_tee"})
    for (const bool cad : {true, false}) {
      Fixture f;
      import(f, model, cad);
      f.session.run("sideset 77 surface 1; nodeset 77 surface 1");
      const MeshedModel before = f.session.meshed();
      for (const char* line : {"move 3 -2 50", "scale 0.001", "rotate model 33 about 1 2 3", "reflect model y",
                               "rotate model -90 about origin 1 0 0 direction 0 1 0", "scale 250 about 1 1 1"}) {
        SCOPED_TRACE(std::string(model) + (cad ? ", " : " without CAD, ") + line);
        f.session.run(line);
        const MeshedModel& now = f.session.meshed();
        ASSERT_EQ(f.error("check"), "no error");
        EXPECT_TRUE(test::conformal(now.mesh));
        EXPECT_TRUE(test::uninverted(now.mesh));
        EXPECT_TRUE(test::on_model(now.mesh, now.association, *now.model, 1e-9));
        EXPECT_TRUE(test::complete(now.mesh, now.association, *now.model));
        EXPECT_EQ(now.association.node_owner, before.association.node_owner);
        EXPECT_EQ(now.association.edge_curve, before.association.edge_curve);
        EXPECT_EQ(now.association.hex_volume, before.association.hex_volume);
        EXPECT_EQ(now.mesh.side_sets.back().sides.size(), before.mesh.side_sets.back().sides.size());
        const Faces around = faces(now.mesh);
        for (const Side& side : now.mesh.side_sets.back().sides)
          EXPECT_EQ(owner_of_face(now.association, around, around.of_hex[side.hex][side.face]), (Owner{2, 1}));
        if (testing::Test::HasFailure()) return;
      }
      const double scale = 0.001 * 250;
      EXPECT_NEAR(volume(f.session.meshed().mesh), volume(before.mesh) * scale * scale * scale,
                  1e-9 * volume(before.mesh));
      f.session.run("refine surface 1 depth 1");
      EXPECT_EQ(f.error("check"), "no error");
      f.session.run("undo 7");
      EXPECT_EQ(f.session.meshed().mesh, before.mesh);
    }
}

TEST(Moving, is_told_what_it_cannot_do) {
  Fixture f;
  EXPECT_EQ(f.error("move 1 0 0"), "there is neither mesh nor CAD to move");
  import(f, "inclusion");
  EXPECT_EQ(f.error("volume 1 move x 1"), "all 2 volumes of the model move together: say 'volume all'");
  EXPECT_EQ(f.error("rotate model 3 about 0 0 0"), "this is not a direction");
  EXPECT_EQ(f.error("scale 0"), "scale must be a number above 0");
  f.session.run("refine hex 1; move 1 0 0");
  EXPECT_EQ(f.notices.back(), "levels end here: this mesh is the base of what is refined from now on");
}

TEST(Moving, only_cad_then_its_mesh) {
  Fixture f;
  f.session.run("import step \"" + models() + "bracket.step\"; scale 0.001");
  EXPECT_NE(f.output.back().find("CAD scaled by 0.001"), std::string::npos);
  EXPECT_NE(f.error("import mesh \"" + models() + "bracket.msh\"").find("scale"), std::string::npos);
  f.session.run("import mesh \"" + models() + "bracket.msh\" scale 0.001; check");
  f.session.run("import step \"" + models() + "bracket.step\" scale 0.001; check");
}

TEST(Moving, turns_what_an_exodus_file_says_of_sides_with_the_mesh) {
  Fixture f;
  f.session.run("create brick x 1 y 2 z 3 interval 2; sideset 1 surface all; block 1 volume 1");
  Mesh mesh = f.session.meshed().mesh;
  auto results = std::make_shared<FileResults>();
  auto file = std::make_shared<Mesh>(mesh);
  results->mesh = file;
  mesh.file_hexes.resize(mesh.hexes.size());
  for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.file_hexes[h] = h;
  SetExtras set;
  set.id = 1;
  set.sides = mesh.side_sets[0].sides;
  // Factors say where their node is.
  for (const Side& side : set.sides)
    for (const int c : io::exodus_cycle(side.face)) set.factors.push_back(mesh.points[mesh.hexes[side.hex][c]].z());
  results->side_sets.push_back(set);
  mesh.results = results;
  f.session.take_mesh(mesh);
  f.session.run("reflect model z; move 0 0 5");
  const Mesh& now = f.session.meshed().mesh;
  ASSERT_EQ(now.side_sets[0].sides.size(), set.sides.size());
  const std::vector<double> factors =
      ExtrasNow(now, *now.results).factors(now.side_sets[0].sides, now.results->side_sets[0]);
  for (std::size_t i = 0; i < now.side_sets[0].sides.size(); ++i) {
    const Side& side = now.side_sets[0].sides[i];
    const auto cycle = io::exodus_cycle(side.face);
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(factors[4 * i + k], 5 - now.points[now.hexes[side.hex][cycle[k]]].z(), 1e-12);
  }
}

TEST(Naming, of_cad_entities_is_for_ranges_and_goes_with_undo_and_moves) {
  Fixture f;
  import(f, "inclusion");
  f.session.run("surface 1 name \"inner\"; volume 2 name 'matrix'; vertex 1 name 'tip'");
  f.session.run("scale 2; refine surface inner");
  EXPECT_EQ(f.session.meshed().model->name({2, 1}), "inner");
  EXPECT_EQ(f.session.meshed().model->name({3, 2}), "matrix");
  f.session.run("surface 2 name 'outer'; surface 1 name 'ball'");
  EXPECT_EQ(f.session.meshed().model->name({2, 2}), "outer");
  EXPECT_EQ(f.session.meshed().model->name({2, 1}), "ball");
  f.session.run("undo");
  EXPECT_EQ(f.session.meshed().model->name({2, 1}), "inner");
  EXPECT_EQ(f.error("surface 1 name ''"), "this name is empty");
  EXPECT_NE(f.error("list surface ball"), "no error");
}

TEST(Parts, of_a_mesh_are_written_with_their_blocks_sets_and_fields) {
  Fixture f;
  import(f, "inclusion");
  f.session.run(
      "reset genesis; block 10 volume 1; block 20 volume 2; nodeset 1 surface 1; sideset 1 surface all in volume 2");
  f.session.run("nodeset 2 vertex in volume 2");
  const std::string file = (test::folder() / "ball.e").string();
  f.session.run("export exodus \"" + file + "\" block 10 partial");
  EXPECT_EQ(f.notices.back().substr(0, 25), "only 1 block of 2: 256 of");
  MeshFile read = read_mesh(file);
  EXPECT_EQ(read.mesh.n_hexes(), std::ssize(f.session.meshed().mesh.blocks[0].hexes));
  ASSERT_EQ(read.mesh.blocks.size(), 1u);
  EXPECT_EQ(read.mesh.blocks[0].id, 10);
  EXPECT_TRUE(validate(read.mesh).empty());
  EXPECT_NEAR(volume(read.mesh), f.session.meshed().model->measure({3, 1}), 0.08 * volume(read.mesh));
  for (const char* name : {"part.msh", "part.vtu", "part.inp", "part.mesh"}) {
    const std::string other = (test::folder() / name).string();
    f.session.run("export mesh \"" + other + "\" block 20");
    EXPECT_EQ(read_mesh(other).mesh.n_hexes(), std::ssize(f.session.meshed().mesh.blocks[1].hexes)) << name;
  }
  EXPECT_NE(f.error("export mesh \"" + file + "\" block 30 overwrite"), "no error");
}

TEST(Attributes, of_blocks_are_written_and_read_again_with_the_children_of_their_hexes) {
  Fixture f;
  f.session.run("create brick x 1 interval 2; reset block; block 1 hex 1 to 4; block 2 hex 5 to 8");
  f.session.run("block 1 attribute count 2; block 1 attribute index 2 0.5; block 1 attribute index 2 name 'thickness'");
  EXPECT_EQ(f.output.back(), "block 1: 2 attributes 'attribute_1' 'thickness'");
  EXPECT_EQ(f.error("block 1 attribute index 3 1"), "block 1 has 2 attributes; 'block 1 attribute count 3' makes more");
  EXPECT_EQ(f.error("block 7 attribute count 3"), "there is no block 7");
  const std::string file = (test::folder() / "a.e").string();
  f.session.run("refine hex 1; export exodus \"" + file + "\"");
  const Mesh mesh = read_mesh(file).mesh;
  ASSERT_TRUE(mesh.results);
  ASSERT_EQ(mesh.results->blocks.size(), 1u);
  EXPECT_EQ(mesh.results->blocks[0].attributes, (std::vector<std::string>{"attribute_1", "thickness"}));
  for (const TimedValues& attribute : mesh.results->attributes)
    for (const Index h : mesh.blocks[0].hexes)
      EXPECT_EQ((*attribute.at[0])[mesh.file_hexes[h]], attribute.name == "thickness" ? 0.5 : 0);
}

}  // namespace
}  // namespace hextwist
