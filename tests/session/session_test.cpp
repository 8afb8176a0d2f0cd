// What commands do to a session.
#include "hextwist/session/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "hextwist/io/io.h"
#include "hextwist/mesh/quality/quality.h"
#include "session/session_fixture.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist {

using test::Fixture, test::folder, test::written;

namespace {

TEST(Session, creates_refines_and_checks_a_brick) {
  Fixture f;
  EXPECT_EQ(f.session.run("create brick x 1 interval 4; refine hex 1; check"), 0);
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 138);
  EXPECT_EQ(f.session.meshed().mesh.n_nodes(), 223);
  EXPECT_TRUE(test::conformal(f.session.meshed().mesh));
  EXPECT_TRUE(test::uninverted(f.session.meshed().mesh));
  ASSERT_EQ(f.session.records().size(), 3u);
  const CommandRecord& record = f.session.records()[1];
  EXPECT_EQ(record.command, "refine hex 1");
  EXPECT_TRUE(record.ok);
  EXPECT_EQ(record.before.hexes, 64);
  EXPECT_EQ(record.after.hexes, 138);
  EXPECT_EQ(record.before.nodes, 125);
  EXPECT_EQ(record.after.nodes, 223);
  EXPECT_NEAR(record.before.shape.min, 1, 1e-12);
  EXPECT_LT(record.after.shape.min, 1);
  EXPECT_EQ(record.after.shape.count, 138);
  EXPECT_NEAR(record.after.volume, 1, 1e-12);
  EXPECT_NEAR(record.cad_volume, 1, 1e-12);
  EXPECT_TRUE(record.has_cad);
  EXPECT_LT(record.off_cad.max_relative, 1e-9);
  EXPECT_GT(record.off_cad_node, 0);
  EXPECT_FALSE(record.seconds.empty());
  EXPECT_GT(record.peak_memory_bytes, 1000000u);
  EXPECT_NE(f.all_output().find("refine hex 1: 64 -> 138 hexes, smallest shape 1 -> "), std::string::npos)
      << f.all_output();
  EXPECT_NE(f.all_output().find("no violations"), std::string::npos);
}

TEST(Session, creates_solids_with_the_intervals_asked) {
  Fixture f;
  f.session.run("create brick x 4 y 3 z 2 interval 8 6 4");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 8 * 6 * 4);
  EXPECT_NEAR(f.last().after.volume, 24, 1e-9);
  f.session.run("create brick x 2 interval 3");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 27);
  EXPECT_NEAR(f.last().cad_volume, 8, 1e-9);
  f.session.run("create cylinder height 10 radius 2 interval 6; check");
  EXPECT_NEAR(f.last().cad_volume, 40 * 3.14159265358979, 1e-6);
  f.session.run("create sphere radius 1; refine surface all; check");
  EXPECT_LT(f.last().off_cad.max_relative, 1e-9);
  EXPECT_NE(f.error("create sphere radius 1e80").find("radius"), std::string::npos);
}

TEST(Session, every_kind_of_target_can_be_refined) {
  for (const char* target : {"node 1", "edge 1", "face 1", "hex 1", "vertex 1", "curve 1", "surface 1", "volume 1"}) {
    Fixture f;
    f.session.run(std::string("create brick x 3 interval 3; refine ") + target);
    EXPECT_GT(f.session.meshed().mesh.n_hexes(), 27) << target;
    EXPECT_TRUE(test::conformal(f.session.meshed().mesh)) << target;
    EXPECT_EQ(f.last().off_cad.max_relative < 1e-9, true) << target;
  }
}

TEST(Session, all_volumes_together_are_refined_uniformly) {
  Fixture f;
  f.session.run("create brick x 1 interval 2; refine volume all numsplit 3");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 8 * 64);
  EXPECT_EQ(f.error("refine hex 9 numsplit 9"), "numsplit must be at most 8 unless all volumes are refined");
}

TEST(Session, concave_places_are_filled_when_asked) {
  // An L of three hexes in a plane: filling adds the fourth.
  const std::string start = "create brick x 6 interval 6; refine hex 87 88 93 concave ";
  Fixture fill, other;
  fill.session.run(start + "fill");
  other.session.run(start + "template");
  EXPECT_EQ(fill.last().filled_hexes, 1);
  EXPECT_EQ(other.last().filled_hexes, 0);
  EXPECT_TRUE(test::conformal(fill.session.meshed().mesh));
  EXPECT_TRUE(test::conformal(other.session.meshed().mesh));
}

TEST(Session, a_dry_run_says_what_would_happen_and_does_nothing) {
  Fixture f;
  f.session.run("create brick x 1 interval 4");
  const MeshedModel* before = &f.session.meshed();
  f.session.run("refine hex 1 dry_run");
  EXPECT_EQ(&f.session.meshed(), before);
  EXPECT_TRUE(f.last().dry_run);
  EXPECT_EQ(f.last().after.hexes, 138);
  EXPECT_NE(f.output.back().find("64 -> 138 hexes"), std::string::npos) << f.output.back();
}

TEST(Session, a_failed_command_leaves_everything_as_it_was) {
  Fixture f;
  f.session.run("create brick x 1 interval 2");
  const MeshedModel* before = &f.session.meshed();
  for (const char* text : {"refine hex 9", "refine curve 13", "refine crve 1", "import mesh \"none.msh\"",
                           "import step \"none.step\"", "refine curve 1 bias 1.5", "export vtk \"/nowhere/at/all.vtu\"",
                           "playback \"none.jou\"", "create sphere radius 1e80", "refine hex 1 except 1", "help bogus",
                           "export vtk \"a.msh\"", "import gmsh \"a.e\""}) {
    EXPECT_NE(f.error(text), "no error") << text;
    EXPECT_EQ(&f.session.meshed(), before) << text;
    EXPECT_FALSE(f.last().ok);
    EXPECT_EQ(f.last().error, f.error(text));
    EXPECT_EQ(f.last().after.hexes, 8);
    EXPECT_EQ(f.last().command, text);
  }
  EXPECT_EQ(f.error("refine hex 1 except 1"), "there is no such hex: 'except' takes away all of them");
  EXPECT_EQ(f.error("refine curve 1 bias 1.5"), "a bias other than 1 needs a size or a sizing function to grow from");
  EXPECT_EQ(f.error("help bogus"), "there is no command 'bogus'; 'help' lists them");
  EXPECT_EQ(f.error("export vtk \"a.msh\""), "vtk files end in .vtu here, not in '.msh'");
  EXPECT_EQ(f.error("import gmsh \"a.e\""), "gmsh files end in .msh here, not in '.e'");
  f.session.run("check");
}

TEST(Session, a_cancelled_command_leaves_everything_as_it_was) {
  Fixture f;
  f.session.run("create brick x 1 interval 2");
  const MeshedModel* before = &f.session.meshed();
  f.go_on = false;
  EXPECT_EQ(f.error("refine hex 1"), "cancelled");
  EXPECT_EQ(&f.session.meshed(), before);
  f.session.set_keep_going(true);
  EXPECT_EQ(f.error("refine hex 1; refine hex 2"), "cancelled");  // the user wants all of it to stop
  f.go_on = true;
  f.session.run("refine hex 1");
  EXPECT_GT(f.session.meshed().mesh.n_hexes(), 8);
}

TEST(Session, without_a_mesh_commands_say_so) {
  Fixture f;
  EXPECT_TRUE(f.error("refine hex 1").starts_with("there is no mesh to refine; read one"));
  EXPECT_TRUE(f.error("quality hex all").starts_with("there is no mesh to measure; read one ('import mesh"));
  EXPECT_TRUE(f.error("check").starts_with("there is no mesh to check; read one"));
  EXPECT_TRUE(f.error("export mesh \"a.msh\"").starts_with("there is no mesh to export; read one"));
  EXPECT_EQ(f.error("list hex 1"), "there are no hexes: no mesh was read");
  f.session.run("list");
  EXPECT_EQ(f.output.back(), "nothing: neither CAD nor mesh was read");
}

TEST(Session, stops_at_the_first_error_unless_told_to_keep_going) {
  Fixture f;
  EXPECT_NE(f.error("create brick x 1 interval 2; bogus; refine hex 1").find("there is no command 'bogus'"),
            std::string::npos);
  EXPECT_EQ(f.session.records().size(), 2u);
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 8);
  Fixture g;
  g.session.set_keep_going(true);
  EXPECT_EQ(g.session.run("create brick x 1 interval 2; bogus; refine hex 99; refine hex 1"), 2);
  EXPECT_GT(g.session.meshed().mesh.n_hexes(), 8);
  ASSERT_EQ(g.errors.size(), 2u);
  EXPECT_NE(g.errors[1].find("hex 99 does not exist"), std::string::npos);
}

TEST(Session, quit_ends_it) {
  Fixture f;
  f.session.run("create brick x 1 interval 2; quit; refine hex 1");
  EXPECT_TRUE(f.session.finished());
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 8);
  EXPECT_EQ(f.notices, (std::vector<std::string>{"what stands behind 'quit' is left out"}));
  EXPECT_THROW(f.session.run("refine hex 1"), Error);
}

/// Those of other programs end in one.
TEST(Session, exit_ends_a_journal_and_not_who_plays_it) {
  Fixture f;
  const auto journal = written("exit.jou", "create brick x 1 interval 2\nexit\nrefine hex 1\n");
  f.session.playback(journal);
  f.session.run("playback '" + journal.string() + "'; refine hex 1");
  EXPECT_FALSE(f.session.finished());
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 8 - 8 + 82);
  EXPECT_EQ(f.notices.size(), 2 + 1U);  // and that the brick took the place of another
}

TEST(Session, a_shortened_kind_is_no_name_and_a_name_no_kind) {
  Fixture f;
  f.session.run("create brick x 6 interval 6; group g add hex 1 to 10; group other add hex 50 to 60");
  f.session.run("group found add hex in g with id < 100; group few add hex in gro 1 with id < 3");
  f.session.run("group middle add node with x_coord -1 to 1; group right add node with x_coord (1) to (2)");
  const auto members = [&](const char* name) {
    f.output.clear();
    f.session.run(std::string("list group '") + name + "'");
    return f.all_output();
  };
  EXPECT_NE(members("found").find("10 hexes"), std::string::npos) << members("found");
  EXPECT_NE(members("few").find("2 hexes"), std::string::npos) << members("few");
  EXPECT_NE(members("middle").find("147 nodes"), std::string::npos) << members("middle");
  EXPECT_NE(members("right").find("98 nodes"), std::string::npos) << members("right");
}

TEST(Session, a_place_is_narrowed_as_other_targets_are) {
  Fixture f;
  f.session.run("create brick x 6 interval 6");
  EXPECT_EQ(f.error("refine location 0 0 0 radius 1 using surface 1"), "none of the 8 hexes lies there");
  EXPECT_EQ(f.error("refine location 0 0 0 radius 1 depth 2"), "give a depth or a radius, not both");
  f.session.run("refine location 2.5 2.5 2.5 radius 1.1 using surface 1 to 6; undo; refine location 0 0 0 radius 1");
}

TEST(Session, journals_are_played_back_and_errors_name_their_line) {
  Fixture f;
  const auto inner = written("inner.jou", "# comment\nrefine hex 1\n");
  const auto outer =
      written("outer.jou", "create brick x 1 interval 4\nplayback '" + inner.string() + "'\nbogus\nreset\n");
  try {
    f.session.run("playback \"" + outer.string() + "\"");
    FAIL();
  } catch (const CommandError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with(outer.string() + ":3:1: there is no command 'bogus'"))
        << error.what();
  }
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 138);  // what was done before the error stays done
  const auto endless = folder() / "endless.jou";
  std::ofstream(endless) << "playback '" << endless.string() << "'";
  EXPECT_EQ(f.error("playback \"" + endless.string() + "\""), "journals play each other back without end");
}

TEST(Session, lists_what_there_is) {
  Fixture f;
  f.session.run("create brick x 3 interval 3");
  for (const auto& [text, line] : std::vector<std::pair<std::string, std::string>>{
           {"list", "mesh: 27 hexes, 64 nodes, volume 27, 1 block, 0 nodesets, 0 sidesets, 0 fields"},
           {"list surface 1", "surface 1: plane, area 9, curves "},
           {"list curve 1", "curve 1: line, length 3, vertices "},
           {"list volume 1", "volume 1: solid"},
           {"list vertex 1", "vertex 1: point (-1.5, -1.5, "},
           {"list hex 14", "in volume 1, block 1, volume 1, shape 1, scaled Jacobian 1"},
           {"list node 1", "node 1: (-1.5, -1.5, -1.5), on vertex "},
           {"list edge 1", "edge 1: nodes 1 2, length 1, on curve "},
           {"list face 1", ", hexes 1, on surface "},
           {"list sheet 1", "sheet 1: 16 edges, 9 hexes"},
           {"list block 1", "27 hexes"},
       }) {
    f.output.clear();
    f.session.run(text);
    EXPECT_NE(f.all_output().find(line), std::string::npos) << text << "\n" << f.all_output();
  }
}

TEST(Session, lists_say_what_shapes_are_and_several_are_a_table) {
  Fixture f;
  f.session.run("create cylinder radius 2 height 6 interval 2; group rims add curve with radius = 2");
  const auto listed = [&](const std::string& text) {
    f.output.clear();
    f.session.run(text);
    return f.all_output();
  };
  const std::string rim = listed("list curve with radius = 2 and z_coord > 0");
  for (const char* part : {"circle", "closed", "radius 2, centre (0, 0, 3), axis (0, 0, ",
                           "box (-2, -2, 3) to (2, 2, 3)", "in group 'rims'"})
    EXPECT_NE(rim.find(part), std::string::npos) << part << "\n" << rim;
  const std::string side = listed("list surface with radius = 2");
  for (const char* part : {"cylinder", "radius 2, around (0, 0, 0), axis (0, 0, "})
    EXPECT_NE(side.find(part), std::string::npos) << part << "\n" << side;
  const std::string seam = listed("list curve with radius = 0");
  EXPECT_NE(seam.find("direction (0, 0, "), std::string::npos) << seam;
  listed("list surface all");
  EXPECT_EQ(f.output.size(), 4u);
  EXPECT_TRUE(f.output[0].starts_with("surface  type      area   radius  box from")) << f.output[0];
  EXPECT_EQ(listed("list field"), "");
  EXPECT_EQ(f.notices.back(), "there are no fields");
}

TEST(Session, a_location_is_refined_by_the_hexes_near_it) {
  Fixture f;
  f.session.run("create brick x 4 interval 4; refine location 0 0 0 radius 1");
  Fixture g;
  g.session.run("create brick x 4 interval 4; refine hex in sphere 0 0 0 radius 1");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), g.session.meshed().mesh.n_hexes());
  EXPECT_EQ(f.error("refine location 0 0 0"), "say how far around the point, such as 'radius 2'");
  EXPECT_NE(f.error("refine location 9 9 9 radius 1").find("no hex has its middle within 1 of there; hex "),
            std::string::npos);
}

TEST(Session, quality_is_a_table) {
  Fixture f;
  f.session.run("create brick x 1 interval 4; refine hex 1");
  f.output.clear();
  f.session.run("quality volume 1 all");
  ASSERT_EQ(f.output.size(), 1 + metrics().size());
  EXPECT_NE(f.output[0].find("std. dev."), std::string::npos);
  EXPECT_TRUE(f.output[1].starts_with("shape "));
  EXPECT_TRUE(f.output[2].starts_with("scaled Jacobian "));
  const Mesh& mesh = f.session.meshed().mesh;
  const Summary summary = summarize(quality(Metric::shape, mesh));
  std::istringstream row(f.output[1].substr(5));
  double count = 0, average = 0, deviation = 0, min = 0, min_hex = 0, max = 0, max_hex = 0;
  row >> count >> average >> deviation >> min >> min_hex >> max >> max_hex;
  EXPECT_EQ(count, 138);
  EXPECT_NEAR(average, summary.average, 1e-4);
  EXPECT_NEAR(deviation, summary.std_dev, 1e-4);
  EXPECT_NEAR(min, summary.min, 1e-4);
  EXPECT_EQ(min_hex, hex_id(mesh, summary.min_hex));
  EXPECT_NEAR(max, summary.max, 1e-4);
  EXPECT_EQ(max_hex, hex_id(mesh, summary.max_hex));
  // Entities of less than three dimensions stand for the hexes that touch them.
  f.output.clear();
  f.session.run("quality vertex all scaled");
  EXPECT_NE(f.output[1].find(" 8 "), std::string::npos) << f.output[1];
}

TEST(Session, quality_knows_every_metric_by_name) {
  Fixture f;
  f.session.run("create brick x 4 y 2 z 1 interval 4 2 1");
  for (const Metric metric : metrics()) {
    f.output.clear();
    f.session.run(std::string("quality volume 1 ") + name(metric));
    ASSERT_EQ(f.output.size(), 2u);
    EXPECT_TRUE(f.output[1].starts_with(std::string(name(metric)) + " ")) << f.output[1];
    std::istringstream row(f.output[1].substr(std::string(name(metric)).size()));
    double count = 0, average = 0;
    row >> count >> average;
    EXPECT_EQ(count, 8);
    EXPECT_NEAR(average, quality(metric, f.session.meshed().mesh, 0), 1e-4) << name(metric);
  }
}

TEST(Session, quality_can_be_limited_and_shown_as_a_histogram) {
  Fixture f;
  f.session.run("create brick x 1 interval 4; refine hex 1");
  const auto shapes = quality(Metric::shape, f.session.meshed().mesh);
  const auto n_below = std::ranges::count_if(shapes, [](double v) { return v <= 0.9; });
  ASSERT_GT(n_below, 0);
  f.output.clear();
  f.session.run("quality volume 1 high 0.9 histogram");
  ASSERT_EQ(f.output.size(), 12u);
  long total = 0;
  for (std::size_t i = 2; i < f.output.size(); ++i) {
    std::istringstream row(f.output[i]);
    std::string low, dots, high;
    long count = 0;
    row >> low >> dots >> high >> count;
    EXPECT_EQ(dots, "..");
    total += count;
  }
  EXPECT_EQ(total, n_below);
  EXPECT_NE(f.output[1].find(" " + std::to_string(n_below) + " "), std::string::npos) << f.output[1];
  f.output.clear();
  f.session.run("quality volume 1 low 2 histogram");
  ASSERT_EQ(f.output.size(), 2u);
  EXPECT_TRUE(f.output[1].ends_with(" 0")) << f.output[1];
}

TEST(Session, quality_keeps_the_ends_and_lists_them) {
  Fixture f;
  f.session.run("create brick x 1 interval 4; refine hex 1");
  const Mesh& mesh = f.session.meshed().mesh;
  auto volumes = quality(Metric::volume, mesh);
  const auto said = [&](const std::string& text) {
    f.output.clear();
    f.session.run("quality volume 1 element volume " + text);
    EXPECT_EQ(f.output.size(), 3u) << text;
    return f.output.back();
  };
  const std::string smallest = said("bottom 27 list");
  f.output.clear();
  // What is printed is a range: the children of the hex that was cut in all directions, which are the smallest.
  f.session.run("quality" + smallest.substr(1) + " volume");
  EXPECT_NE(f.output.back().find(" 27 "), std::string::npos) << f.output.back();
  std::ranges::sort(volumes);
  double count = 0, average = 0, deviation = 0, min = 0, hex = 0, max = 0;
  std::istringstream(f.output.back().substr(6)) >> count >> average >> deviation >> min >> hex >> max;
  EXPECT_NEAR(max, volumes[26], 1e-6);
  f.session.run("quality volume 1 volume low 0.01 top 4 bottom 3");
  EXPECT_NE(f.output.back().find(" 7 "), std::string::npos) << f.output.back();
  f.session.run("quality volume 1 volume top 1000");
  EXPECT_NE(f.output.back().find(" 138 "), std::string::npos) << f.output.back();
  EXPECT_NE(f.error("quality volume 1 shape top 0").find("top must be a whole number"), std::string::npos);
}

TEST(Session, quality_understands_the_words_of_journals) {
  Fixture f;
  f.session.run("create brick x 1 interval 2");
  const auto table = [&](const std::string& text) {
    f.output.clear();
    f.session.run(text);
    return f.output;
  };
  const auto all = table("quality volume 1 all");
  EXPECT_EQ(table("Quality Volume 1 AllMetrics"), all);
  EXPECT_EQ(table("quality volume 1 allmetric global draw mesh monochrome add"), all);
  EXPECT_EQ(table("quality volume 1 shape draw histogram"), table("quality volume 1 shape histogram"));
  EXPECT_EQ(table("quality volume 1 list detail id"), table("quality volume 1 list"));
  EXPECT_EQ(table("quality volume 1 list skew"), table("quality volume 1 skew list"));
  EXPECT_EQ(table("quality hex in hex 1 list volume top 2"), table("quality hex 1 volume top 2 list"));
  EXPECT_EQ(table("quality volume 1 draw all"), all);
  EXPECT_EQ(table("group all add volume 1; quality group all").back(), table("quality volume 1").back());
  EXPECT_NE(f.error("quality volume 1 shape and size").find("found 'and'"), std::string::npos);
  EXPECT_NE(f.error("quality volume 1 timestep").find("'timestep' cannot stand here"), std::string::npos);
}

TEST(Session, files_come_back_as_they_went_out) {
  const auto file = folder() / "brick.msh";
  Fixture f;
  f.session.run("create brick x 3 interval 3; refine curve 1; export mesh '" + file.string() + "' overwrite");
  const auto n = f.session.meshed().mesh.n_hexes();
  EXPECT_NE(f.error("export mesh '" + file.string() + "'").find("exists"), std::string::npos);
  Fixture g;
  g.session.run("import mesh '" + file.string() + "'; check");
  EXPECT_EQ(g.session.meshed().mesh.n_hexes(), n);
  EXPECT_FALSE(g.last().has_cad);
  EXPECT_EQ(g.session.meshed().model->count(2), 6);
  g.session.run("refine curve all; check; reset; list");
  EXPECT_EQ(g.session.meshed().mesh.n_hexes(), 0);
}

TEST(Session, an_upside_down_mesh_is_turned_with_a_notice) {
  Mesh mesh = test::grid(2, 2, 2);
  for (Hex& hex : mesh.hexes)
    for (int c = 0; c < 4; ++c) std::swap(hex[c], hex[c + 4]);
  Fixture f;
  f.session.take(mesh, nullptr);
  EXPECT_TRUE(test::uninverted(f.session.meshed().mesh));
  ASSERT_EQ(f.notices.size(), 1u);
}

TEST(Session, a_broken_mesh_is_refused_with_its_violations) {
  Mesh mesh = test::grid(2, 2, 2);
  mesh.points[13] += Vec3(1.5, 1.5, 1.5);  // the middle node goes through the corner
  const auto file = folder() / "broken.msh";
  write_mesh(file, mesh, nullptr);
  Fixture f;
  f.session.run("create brick x 1 interval 2; set untangle off");
  const MeshedModel* before = &f.session.meshed();
  const std::string error = f.error("import mesh '" + file.string() + "'");
  EXPECT_NE(error.find("violations, the first: "), std::string::npos) << error;
  EXPECT_EQ(&f.session.meshed(), before);
  EXPECT_GT(f.last().n_violations, 1);
  EXPECT_EQ(f.last().violations.at(0).kind, name(ViolationKind::inverted));
  EXPECT_FALSE(f.last().violations.at(0).hexes.empty());
  EXPECT_THROW(f.session.take(mesh, nullptr), Error);
  EXPECT_THROW(f.session.take({}, nullptr), Error);
  EXPECT_EQ(&f.session.meshed(), before);
}

TEST(Session, settings_take_effect_and_are_kept) {
  // A roof of two quads that meet at 30 degrees: a ridge below that angle (which also cuts
  // the two curves that it ends on), none above.
  Mesh mesh = test::grid(2, 1, 1);
  for (const Index i : {7, 10}) mesh.points[i].z() += 0.27;
  const auto file = folder() / "roof.msh";
  write_mesh(file, mesh, nullptr);
  Fixture f;
  f.session.run("import mesh '" + file.string() + "'");
  const int blunt = f.session.meshed().model->count(1);
  f.session.run("set feature_angle 10; set glue off; set tolerance 1e-3; set threads 1; reset; import mesh '" +
                file.string() + "'");
  EXPECT_EQ(f.session.meshed().model->count(1), blunt + 3);
}

TEST(Session, real_parts_are_read_refined_and_written) {
  if (test::data_folder().empty()) GTEST_SKIP() << "no real CAD here";
  const auto cad = test::data_folder() / "cad";
  for (const char* part : {"plate_hole", "two_material"})
    for (const char* format : {".brep", ".step"}) {
      Fixture f;
      f.session.import_cad((cad / part).string() + format);
      f.session.import_mesh((cad / part).string() + "_1k.msh");
      f.session.run("check; refine curve 1; check");
      EXPECT_GT(f.last().after.hexes, f.session.records()[1].after.hexes);
      EXPECT_LT(f.last().off_cad.max_relative, 1e-7);
      EXPECT_TRUE(f.last().has_cad);
    }
}

TEST(Session, solids_that_the_mesh_joins_are_glued) {
  if (test::data_folder().empty()) GTEST_SKIP() << "no real CAD here";
  const auto cad = test::data_folder() / "cad";
  Fixture f;
  f.session.import_cad(cad / "two_material.step");
  const int apart = f.session.meshed().model->count(2);
  f.session.import_mesh(cad / "two_material_1k.msh");
  EXPECT_LT(f.session.meshed().model->count(2), apart);
  std::string notices;
  for (const std::string& line : f.notices) notices += line + "\n";
  EXPECT_NE(notices.find("its touching solids are glued"), std::string::npos) << notices;
  Fixture off;
  off.session.run("set glue off");
  off.session.import_cad(cad / "two_material.step");
  EXPECT_THROW(off.session.import_mesh(cad / "two_material_1k.msh"), Error);
  Fixture on;
  on.session.run("set glue on");
  on.session.import_cad(cad / "two_material.step");
  EXPECT_EQ(on.session.meshed().model->count(2), f.session.meshed().model->count(2));
}

TEST(Session, a_mesh_of_another_part_is_refused) {
  if (test::data_folder().empty()) GTEST_SKIP() << "no real CAD here";
  const auto cad = test::data_folder() / "cad";
  Fixture f;
  f.session.import_cad(cad / "plate_hole.brep");
  EXPECT_THROW(f.session.import_mesh(cad / "sphere7_1k.msh"), Error);
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 0);
  f.session.import_mesh(cad / "plate_hole_1k.msh");
  EXPECT_NE(f.error("import brep '" + (cad / "sphere7.brep").string() + "'").find("('reset' drops the mesh"),
            std::string::npos);
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 1404);
}

TEST(Session, completion_knows_names_and_commands) {
  using List = std::vector<std::string>;
  Fixture f;
  f.session.run(
      "create brick x 1 interval 2; block 1 name 'steel'; block 2 hex 1 name 'soft rubber'; nodeset 3 node 1");
  f.session.run("nodeset 3 name 'stop'");
  EXPECT_EQ(f.session.completions("refine hex in block st"), (List{"steel"}));
  EXPECT_EQ(f.session.completions("list block s"), (List{"\"soft rubber\"", "steel"}));
  EXPECT_EQ(f.session.completions("list nodes s"), (List{"stop"}));
  EXPECT_EQ(f.session.completions("list hex s"), List{});
  EXPECT_EQ(f.session.completions("help ref"), (List{"refine", "reflect"}));
  EXPECT_EQ(f.session.completions("qui"), (List{"quit"}));
  EXPECT_EQ(f.session.completions("refine hex 3 to "), (List{"8"}));
  EXPECT_EQ(f.session.completions("refine curve 3 lo"), (List{"loop"}));
  EXPECT_EQ(f.session.completions("refine curve loop o"), (List{"of"}));
  EXPECT_EQ(f.session.completions("refine curve chain "), (List{"from"}));
  EXPECT_EQ(f.session.completions("list surface adj"), (List{"adjacent"}));
  EXPECT_EQ(f.session.completions("refine hex in cyl"), (List{"cylinder"}));
  EXPECT_EQ(f.session.completions("bogus s"), List{});
  EXPECT_EQ(f.session.completions("list block \"s"), List{}) << "quotes are the caller's";
}

TEST(Session, words_of_other_programs_are_understood) {
  Fixture f;
  f.session.run("create brick x 2 interval 2; nodeset 1 curve 1; sideset 1 surface 1");
  const std::string mesh = (folder() / "part.g").string();
  for (const std::string& line : {
           std::string("block all element type HEX8"),
           std::string("block 1 element type hex"),
           "export genesis '" + mesh + "' dimension 3 block all overwrite",
           "export mesh '" + mesh + "' block all overwrite",
           std::string("quality volume all shape global"),
           std::string("quality volume 1 scaled jacobian global low 0.2"),
           std::string("list totals"),
           std::string("list volume 1 geometry"),
           std::string("list hex 1 position"),
           std::string("volume 1 smooth scheme condition number beta 2 cpu 10"),
           std::string("surface all smooth scheme laplacian free"),
           std::string("smooth volume 1"),
           std::string("undo off"),
           std::string("undo on"),
           std::string("reset genesis"),
           "import mesh geometry '" + mesh + "' block all feature_angle 135",
           "import mesh geometry '" + mesh + "' no_geom",
       })
    EXPECT_EQ(f.error(line), "no error") << line;
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 8);
  EXPECT_EQ(f.session.meshed().mesh.side_sets.size(), 1u);
  EXPECT_EQ(f.notices.back(), "this takes the place of the mesh of 8 hexes that was here");
  EXPECT_EQ(f.notices.at(f.notices.size() - 2), "'no_geom' changes nothing here");
  EXPECT_EQ(f.error("import mesh geometry '" + mesh + "' block 1"),
            "all blocks are read together: say 'all', and 'export ... block 1' writes some");
}

TEST(Session, the_feature_angle_of_an_import_is_that_between_faces) {
  // A roof whose two slopes turn by 30 degrees: a ridge for 160 (20), none for 135 (45).
  Mesh mesh = test::grid(2, 1, 1);
  for (const Index i : {7, 10}) mesh.points[i].z() += 0.27;
  const auto file = folder() / "roof.e";
  write_mesh(file, mesh, nullptr);
  Fixture f;
  f.session.run("import mesh geometry '" + file.string() + "' feature_angle 135");
  const int blunt = f.session.meshed().model->count(1);
  f.session.run("import mesh geometry '" + file.string() + "' feature_angle 160");
  EXPECT_GT(f.session.meshed().model->count(1), blunt);
  f.session.run("import mesh '" + file.string() + "'");
  EXPECT_EQ(f.session.meshed().model->count(1), blunt) << "for that import alone";
}

}  // namespace
}  // namespace hextwist
