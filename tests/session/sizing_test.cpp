// Size-driven, directional and adaptive refinement as commands.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hextwist/io/io.h"
#include "hextwist/patch/adapt.h"
#include "hextwist/session/session.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

struct Fixture {
  Session session;
  std::vector<std::string> output;

  Fixture() {
    SessionCallbacks callbacks;
    callbacks.output = [this](const std::string& line) { output.push_back(line); };
    session.set_callbacks(std::move(callbacks));
  }
  std::string error(std::string_view text) {
    try {
      session.run(text);
    } catch (const CommandError& error) {
      return error.message();
    }
    return "no error";
  }
  const CommandRecord& last() const { return session.records().back(); }
  const Mesh& mesh() const { return session.meshed().mesh; }
};

/// A brick of 4 x 4 x 4 unit cubes from 0 to 4 with fields: "h" of nodes, 1 + x; "error" of hexes, its number.
void take_fields(Session& session) {
  Mesh mesh = test::grid(4, 4, 4);
  Field h{"h", Field::On::node, 1, {}}, error{"error", Field::On::hex, 1, {}};
  for (const Vec3& p : mesh.points) h.values.push_back(1 + p.x());
  for (std::size_t i = 0; i < mesh.hexes.size(); ++i) error.values.push_back(static_cast<double>(i + 1));
  mesh.fields = {h, error};
  session.take(std::move(mesh), nullptr);
}

TEST(Sizing, size_with_bias_reports_how_well_it_was_met) {
  Fixture f;
  f.session.run("create brick x 10 interval 10; refine curve 1 size 0.2 bias 1.5");
  EXPECT_TRUE(test::conformal(f.mesh()));
  EXPECT_TRUE(test::uninverted(f.mesh()));
  const SizesRow& sizes = f.last().sizes;
  EXPECT_GT(sizes.hexes, 0);
  EXPECT_GE(sizes.passes, 1);
  EXPECT_EQ(sizes.coarser, 0);
  EXPECT_EQ(sizes.n_unmet, 0);
  EXPECT_GE(sizes.met, 0.9);
  EXPECT_LE(sizes.largest_ratio, std::sqrt(3.0));
  ASSERT_GE(f.output.size(), 2u);
  EXPECT_TRUE(f.output.back().starts_with("actual / wished size of " + std::to_string(sizes.hexes) + " hexes after "))
      << f.output.back();
  EXPECT_NE(f.output.back().find(" .. "), std::string::npos) << "a histogram";
}

TEST(Sizing, numsplit_with_a_bias_of_one_is_accepted) {
  Fixture f;
  f.session.run("create brick x 4 interval 4; refine hex 1 numsplit 2 bias 1.0");
  EXPECT_EQ(f.last().sizes.hexes, 0);
  EXPECT_GT(f.mesh().n_hexes(), 64);
}

TEST(Sizing, what_makes_no_sense_together_is_refused) {
  Fixture f;
  f.session.run("create brick x 4 interval 4");
  EXPECT_EQ(f.error("refine curve 1 numsplit 2 size 0.5"), "give numsplit or a size, not both");
  EXPECT_EQ(f.error("refine curve 1 numsplit 2 sizing_function \"1\""), "give numsplit or a sizing function, not both");
  EXPECT_EQ(f.error("refine curve 1 bias 1.5"), "a bias other than 1 needs a size or a sizing function to grow from");
  EXPECT_EQ(f.error("refine curve 1 depth 1 radius 2"), "give a depth or a radius, not both");
  EXPECT_EQ(f.error("refine curve 1 sizing_function"),
            "there is no sizing function; define one with 'sizing function'");
  EXPECT_EQ(f.error("refine curve 1 sizing_function f"),
            "there is no sizing function 'f'; define one with 'sizing function'");
  EXPECT_EQ(f.error("refine hex 1 graded concave fill"),
            "graded cuts whole hexes: not in one direction, and not with concave fill");
  EXPECT_EQ(f.error("refine hex 1 graded transition nested"), "graded levels have a regular transition");
  EXPECT_EQ(f.error("refine hex 1 direction layers 3"), "layers lie along nodes, edges and faces, not a hex");
  EXPECT_EQ(f.mesh().n_hexes(), 64);
}

TEST(Sizing, functions_by_expression_name_and_the_last_one) {
  Fixture f;
  f.session.run("create brick x 8 interval 8");
  f.session.run("sizing function f \"0.4 + 0*x\"; refine volume 1 sizing_function f");
  const Index n = f.mesh().n_hexes();
  EXPECT_EQ(n, 512 * 27);
  Fixture g;
  g.session.run("create brick x 8 interval 8; sizing function f constant 5");
  EXPECT_EQ(g.error("sizing function g constant 0.4"),
            "'g' could be an option behind 'refine ... sizing_function': choose another name");
  g.session.run("sizing function fine constant 0.4; refine volume 1 sizing_function no_smooth");
  EXPECT_EQ(g.mesh().n_hexes(), n) << "the last one; and an option behind it is no name";
  Fixture h;
  h.session.run("create brick x 8 interval 8; refine volume 1 sizing_function \"0.4\"");
  EXPECT_EQ(h.mesh().n_hexes(), n);
  h.session.run("sizing list");
  EXPECT_EQ(h.output.back(), "no sizing functions");
  h.session.run("refine volume 1 sizing_function \"1/0\"");
  EXPECT_EQ(h.output.back(), "no hex has a wished size") << "infinite: no wish";
  EXPECT_EQ(h.mesh().n_hexes(), n);
}

TEST(Sizing, errors_in_expressions_point_into_them) {
  Fixture f;
  f.session.run("create brick x 1 interval 2");
  try {
    f.session.run("refine volume 1 sizing_function \"1 + foo(x)\"");
    FAIL();
  } catch (const CommandError& error) {
    EXPECT_EQ(error.column(), 38) << error.what();
  }
  EXPECT_NE(f.error("refine volume 1 sizing_function \"x - 5\"").find("sizes must be positive"), std::string::npos);
}

TEST(Sizing, every_kind_of_function_can_be_defined_and_listed) {
  Fixture f;
  f.session.run("create cylinder radius 2 height 10");
  f.session.run(
      "sizing function fa constant 1; sizing function fb \"1 + abs(z)\"; sizing function fc curvature 4 growth 1.2;"
      "sizing function fd interval 20 curve 1; sizing function fe linear vertex 1 size 0.1 growth 2;"
      "sizing function fm minimum fa fb fc fd; sizing function fc curvature 4 surface 1; sizing list");
  ASSERT_EQ(f.output.size(), 1u + 6u);
  EXPECT_EQ(f.output.back(), "fm: sizing function fm minimum fa fb fc fd");
  EXPECT_EQ(f.output[3], "fc: sizing function fc curvature 4 surface 1 (the last)");
  f.session.run("refine volume 1 sizing_function fm");
  EXPECT_TRUE(test::conformal(f.mesh()));
  EXPECT_EQ(f.last().sizes.coarser, 0);
  EXPECT_EQ(f.error("sizing function x minimum fa zz"),
            "there is no sizing function 'zz'; there are: fa, fb, fc, fd, fe, fm");
  f.session.run("reset; sizing list");
  EXPECT_EQ(f.output.back(), "no sizing functions");
  EXPECT_EQ(f.error("sizing function fc curvature 4"), "there is no CAD or mesh whose curvature could be asked for");
  EXPECT_EQ(f.error("sizing field \"h\""), "there is no mesh to take a field from");
}

TEST(Sizing, fields_of_this_mesh_and_of_another_file) {
  Fixture f;
  take_fields(f.session);
  const auto file = test::output_folder() / "sizes.vtu";
  f.session.run("export vtk \"" + file.string() + "\" overwrite");
  f.session.run("sizing field \"h\"; refine volume 1 sizing_function h size 0.5");
  EXPECT_EQ(f.mesh().n_hexes(), 64 * 27);
  Fixture g;
  g.session.run("create brick x 4 interval 4");
  g.session.run("sizing function fs field \"h\" file \"" + file.string() + "\"");
  g.session.run("refine volume 1 sizing_function fs");
  EXPECT_EQ(g.mesh().n_hexes(), 64) << "sizes of 1 to 3 where the brick is: there is nothing to cut";
  EXPECT_EQ(f.error("sizing field \"nope\""), "the mesh has no field \"nope\"; it has h, error");
}

TEST(Sizing, hexes_in_a_field_above_below_and_top) {
  Fixture f;
  take_fields(f.session);
  const auto count = [&](const std::string& range) {
    f.session.run("delete block all; block 1 hex " + range);
    return f.mesh().blocks.front().hexes.size();
  };
  f.session.run("block 1 hex 1");
  EXPECT_EQ(count("in field \"error\" above 60"), 4u);
  EXPECT_EQ(count("in field \"error\" below 3"), 2u);
  EXPECT_EQ(count("in field \"error\" top 25 %"), 16u);
  EXPECT_EQ(count("1 to 10 in field \"error\" top 25%"), 3u);
  EXPECT_EQ(count("1 to 10 in field \"error\" top 25"), 3u);
  EXPECT_EQ(count("in field \"h\" above 4"), 16u) << "the average of the nodes";
  EXPECT_EQ(count("in field \"error\" above 60 in field \"error\" below 62"), 1u);
  EXPECT_EQ(f.error("refine hex in field \"nope\" above 1"), "there is no field 'nope' of hexes; there are h, error");
  EXPECT_EQ(f.error("list node in field \"error\" above 1"), "there is no field 'error' of nodes; there are h");
  EXPECT_EQ(f.error("list face in field \"h\" above 1"), "fields have values at hexes and nodes, not at faces");
  EXPECT_EQ(f.error("refine hex in field \"error\" above 100"),
            "there is no such hex: none of the 64 hexes has such values");
}

TEST(Sizing, components_of_fields_go_by_the_names_that_files_have_for_them) {
  Fixture f;
  MeshedModel meshed = test::brick(2, 2, 1);
  meshed.mesh.fields.push_back({"err", Field::On::hex, 2, {1, -9, 2, -8, 3, -7, 4, -6}});
  meshed.mesh.fields.push_back({"v", Field::On::hex, 3, {1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0}});
  f.session.take(meshed.mesh, meshed.model);
  const auto hexes = [&](const std::string& range) {
    f.session.run("delete block all; block 1 hex " + range);
    return f.mesh().blocks.front().hexes;
  };
  f.session.run("block 1 hex 1");
  EXPECT_EQ(hexes("in field \"err_1\" above 2.5"), (std::vector<Index>{2, 3}));
  EXPECT_EQ(hexes("in field \"err_2\" below -7.5"), (std::vector<Index>{0, 1}));
  EXPECT_EQ(hexes("in field \"v_z\" above 0"), (std::vector<Index>{2}));
  EXPECT_EQ(hexes("in field \"v\" above 1.5"), (std::vector<Index>{1, 2}));
  EXPECT_EQ(f.error("refine hex in field \"err_3\" above 1"), "there is no field 'err_3' of hexes; there are err, v");
}

TEST(Sizing, graded_refinement_keeps_levels_within_one) {
  Fixture f;
  take_fields(f.session);
  f.session.run("refine hex in field \"error\" top 2 % graded");
  f.session.run("refine hex in field \"level\" above 0 graded");
  EXPECT_TRUE(test::conformal(f.mesh()));
  const std::vector<int> level = test::levels(f.mesh());
  EXPECT_EQ(std::ranges::max(level), 2);
  std::vector<int> low(f.mesh().points.size(), 9), high(f.mesh().points.size(), 0);
  for (std::size_t h = 0; h < level.size(); ++h)
    for (const Index n : f.mesh().hexes[h]) {
      low[n] = std::min(low[n], level[h]);
      high[n] = std::max(high[n], level[h]);
    }
  for (std::size_t n = 0; n < low.size(); ++n) EXPECT_LE(high[n] - low[n], 1);
}

TEST(Sizing, sheets_layers_and_thickness_as_commands) {
  Fixture f;
  f.session.run("create brick x 4 interval 4; refine sheet node 1 2");
  EXPECT_EQ(f.mesh().n_hexes(), 64 + 2 * 16);
  f.session.run("undo; refine sheet edge 1 greater_than 0.5");
  EXPECT_EQ(f.mesh().n_hexes(), 64 + 2 * 16);
  f.session.run("undo; refine sheet edge 1 factor 1.5");
  EXPECT_EQ(f.mesh().n_hexes(), 64) << "none is longer than 1.5 times the shortest";
  f.session.run("refine sheet intersect edge 1");
  EXPECT_EQ(f.mesh().n_hexes(), 4 * (9 + 2 * 3 * 3 + 9));
  f.session.run("undo; refine surface 1 direction layers 3 growth 1.5");
  EXPECT_EQ(f.mesh().n_hexes(), 64 + 2 * 16);
  f.session.run("undo; refine surface 1 direction thickness");
  EXPECT_EQ(f.mesh().n_hexes(), 64 * 3);
  EXPECT_EQ(f.error("refine sheet node 1 9999"), "there is no node 9999");
  f.session.run("undo");
  EXPECT_EQ(f.error("refine sheet node 1 125"), "no edge joins these nodes");
}

TEST(Sizing, limits_of_hexes_hold_for_every_way_to_refine) {
  Fixture f;
  f.session.run("create cylinder radius 1 height 2 interval 2; set max_hexes 1500");
  const Mesh before = f.session.meshed().mesh;
  for (const std::string how :
       {"volume all numsplit 3", "hex all numsplit 2 depth 1", "hex all numsplit 3 transition nested",
        "curve 1 numsplit 5", "surface 1 numsplit 4 transition nested", "surface 1 size 0.01",
        "curve 1 size 0.001 bias 1.2", "vertex 1 size 0.000001 bias 1.3 transition nested",
        "volume all sizing_function \"0.02\"", "surface all direction layers 50", "hex all numsplit 2 method auto"}) {
    SCOPED_TRACE(how);
    try {
      f.session.run("refine " + how);
      ADD_FAILURE() << "made " << f.session.meshed().mesh.n_hexes() << " hexes";
      f.session.run("undo");
    } catch (const CommandError& error) {
      EXPECT_NE(error.message().find("more than the 1500 that are allowed"), std::string::npos) << error.message();
    }
    EXPECT_TRUE(f.session.meshed().mesh == before);
  }
  f.session.run("set max_hexes 0; refine curve 1 size 0.01 bias 1.3");
  EXPECT_GT(f.session.meshed().mesh.n_hexes(), 1500);
}

TEST(Sizing, a_wish_that_is_met_already_changes_nothing) {
  Fixture f;
  f.session.run("create brick x 4 interval 4; refine surface 1 depth 1; refine curve 2 size 1 bias 1.2");
  const CommandRecord& record = f.last();
  EXPECT_GT(record.sizes.hexes, 0);
  EXPECT_EQ(record.before.hexes, record.after.hexes);
  EXPECT_EQ(record.before.shape.min, record.after.shape.min);
  EXPECT_EQ(record.after.shape.count, record.after.hexes);
}

}  // namespace
}  // namespace hextwist
