// Lines as they stand in journals of full meshers around a refinement: each is done, skipped with a note, or refused
// with what to do instead.
#include <gtest/gtest.h>

#include "hextwist/command/command_error.h"
#include "session/session_fixture.h"

namespace hextwist {
namespace {

struct Line {
  const char* said;
  enum Kind { done, skipped, refused } kind;
  const char* part = "";  ///< of what is printed, noted or the error
};

using enum Line::Kind;

const std::vector<Line> lines = {
    // What refines.
    {"refine volume all", done, "64 -> 512 hexes"},
    {"refine volume all numsplit 1", done, "64 -> 512 hexes"},
    {"refine volume 1 numsplit 1", done, "64 -> 512 hexes"},
    {"refine vol all numsplit 2", done, "64 -> 1728 hexes"},
    {"Refine Volume all NumSplit 1 Bias 1.0 Depth 1 Smooth", done, "64 -> 512 hexes"},
    {"refine volume all numsplit 1 bias 1.5 depth 1 smooth", done, "'bias' is how sizes grow"},
    {"refine volume in block 1 numsplit 1", done, "64 -> 512 hexes"},
    {"refine body all", done, "64 -> 512 hexes"},
    {"refine body 1 numsplit 1", done, "64 -> 512 hexes"},
    {"refine hex all", done, "64 -> 1728 hexes"},
    {"refine hex 1 22 43 64 numsplit 1 bias 1.0 depth 1", done, " hexes"},
    {"refine node 5 numsplit 1 bias 1.0 depth 0", done, " hexes"},
    {"refine node in surface 2 numsplit 1 bias 1.0 depth 2", done, " hexes"},
    {"refine node all", done, "nothing is cut"},
    {"refine edge 7 numsplit 1", done, " hexes"},
    {"refine face in surface 1 numsplit 1 bias 1 depth 1", done, " hexes"},
    {"refine vertex 3 numsplit 2 radius 3", done, " hexes"},
    {"refine curve 2 5 numsplit 1 bias 1.0 depth 1 smooth", done, " hexes"},
    {"refine curve 2 size 0.8 bias 1.3", done, "actual / wished size"},
    {"refine surface 6 numsplit 1 bias 1.0 depth 1", done, " hexes"},
    {"refine surface with z_coord > 4.9 numsplit 1", done, " hexes"},
    {"refine volume 1 numsplit 1 using surface 3", done, "'using': 16 of 64 hexes lie there"},
    {"refine curve all using surface 1", done, "'using': 4 of 12 curves lie there"},
    {"refine sheet edge 3", done, " hexes"},
    {"refine location 0 0 0 radius 3", done, " hexes"},
    {"refine mesh boundary surface 1 volume 1 layer 2", refused, "direction layers"},
    {"refine tri in surface 1 numsplit 1", refused, "all-hexahedral"},
    {"smooth volume all", done, "smallest shape"},
    {"smooth surface all", done, "smallest shape"},
    {"volume all smooth scheme condition number beta 2.0 cpu 10", done, "'smooth' uses condition number"},
    {"surface 1 to 3 smooth scheme laplacian free", done, "'smooth' uses laplacian"},

    // What measures.
    {"quality volume all shape global draw mesh", done, "shape"},
    {"quality volume 1 scaled jacobian global draw histogram draw mesh list detail", done, "scaled Jacobian"},
    {"quality hex all allmetrics", done, "oddy"},
    {"quality volume 1 skew high 0.5 draw mesh monochrome add", done, "skew"},
    {"quality hex all condition no. top 4 list id", done, "condition number"},
    {"quality tet all shape", refused, "all-hexahedral"},
    {"group 'poor' add quality volume all shape high 0.3", done, "group 1 'poor': empty"},
    {"group 'good' add quality hex all scaled jacobian low 0.3", done, "group 1 'good': 64 hexes"},
    {"group 'rim' equals curve 1 2", done, "group 1 'rim': 2 curves"},
    {"create group 'fillets'", done, "group 1 'fillets': empty"},
    {"list model", done, "64 hexes"},
    {"list totals", done, "64 hexes"},
    {"list volume 1 geometry", done, "solid"},
    {"measure between vertex 1 vertex 2", skipped, "'list' prints lengths"},
    {"locate surface 3", skipped, "'list' prints lengths"},

    // Blocks and sets.
    {"block 1 volume 1", done, "block 1: 64 hexes -> 64"},
    {"block 2 add volume all", done, "block 2: 0 hexes -> 64"},
    {"block 1 add hex 1 to 8", done, "block 1: 64 hexes -> 64"},
    {"block 1 name \"steel\"", done, "block 1 is called 'steel'"},
    {"block 1 element type hex8", done, "every element of block 1 is a hex8"},
    {"block all element type hex", done, "every element is a hex8"},
    {"block 1 element type hex20", done, "every element of block 1 is a hex20"},
    {"block 1 element type HEX27", done, "every element of block 1 is a hex27"},
    {"set order 2", done, ""},
    {"block 1 element type tet10", refused, "hex8, hex20 or hex27"},
    {"block 1 attribute count 2", done, "2 attributes"},
    {"block 1 attribute count 1; block 1 attribute index 1 0.5", done, "1 attribute"},
    {"block 1 attribute 7.5", done, "1 attribute"},
    {"block 3 surface 1", refused, "blocks hold hexes"},
    {"create block 4", done, "begins with its first hex"},
    {"nodeset 1 surface 2", done, "nodeset 1"},
    {"nodeset 2 add curve 3 vertex 1", done, "nodeset 2"},
    {"nodeset 1 surface 2; nodeset 1 name 'fixed'", done, "'fixed'"},
    {"sideset 1 add surface 4", done, "sideset 1"},
    {"sideset 3 add surface 1 2 3 5", done, "sideset 3"},
    {"sideset 5 surface 6 wrt volume 1", done, "sideset 5"},
    {"set duplicate block elements off", done, "blocks may always overlap"},
    {"reset genesis", done, ""},
    {"delete block all", done, ""},

    // Solids, and where they are.
    {"brick x 10", done, "64 hexes"},
    {"brick x 1 y 1 z 0.6", done, "64 hexes"},
    {"create brick width 2 depth 3 height 4", done, "64 hexes"},
    {"cylinder height 4 radius 1", done, "hexes"},
    {"create sphere radius 3", done, "hexes"},
    {"volume 1 move x 33 y 67 z -30", done, "moved by (33, 67, -30)"},
    {"volume 1 move 1 2 3", done, "moved by (1, 2, 3)"},
    {"move volume 1 y 0.5", done, "moved by (0, 0.5, 0)"},
    {"move volume all x 1 include_merged", done, "moved by (1, 0, 0)"},
    {"body 1 move z -1", done, "moved by (0, 0, -1)"},
    {"volume all scale 0.001", done, "scaled by 0.001"},
    {"volume 1 scale x 2 y 2 z 2", done, "scaled by 2"},
    {"volume 1 scale x 2 y 1 z 1", refused, "the same factor along x, y and z"},
    {"volume 1 rotate 45 about z", done, "turned by 45 degrees"},
    {"rotate volume 1 angle 45 about z include_merged", done, "turned by 45 degrees"},
    {"rotate volume all angle 90 about origin 1 0 0 direction 0 1 0", done, "turned by 90 degrees"},
    {"volume 1 reflect x", done, "mirrored"},
    {"reflect volume 1 about 0 1 1", done, "mirrored"},
    {"volume 1 copy move x 2", refused, "cannot be copied"},
    {"surface 1 name \"inlet\"", done, "surface 1 is called 'inlet'"},
    {"surface 1 rename 'inlet'", done, "surface 1 is called 'inlet'"},
    {"volume 1 name 'core'; refine volume core", done, "64 -> 512 hexes"},
    {"curve 2 3 name 'rim'", done, "2 curves are called 'rim'"},
    {"transform mesh output scale 0.001", refused, "scale 0.001"},

    // Files.
    {"export mesh \"part.e\" overwrite", done, "64 hexes written"},
    {"export genesis 'part.g' dimension 3 block all overwrite", done, "64 hexes written"},
    {"export mesh \"some.e\" block 1 overwrite partial", done, "hexes written"},
    {"export abaqus \"part.inp\" everything overwrite", done, "64 hexes written"},
    {"export genesis 'p.g'; reset; import mesh geometry \"p.g\" block all use nodeset sideset feature_angle 135.00 "
     "linear merge",
     done, "64 hexes"},
    {"export genesis 'q.g'; import mesh 'q.g' no_geom", done, "64 hexes"},
    {"export step \"part.step\" overwrite", refused, "meshes are written as exodus"},
    {"import cubit \"part.cub\"", refused, "write the mesh there as Exodus"},
    {"import acis \"part.sat\"", refused, "CAD comes as .step"},
    {"import stl \"part.stl\" feature_angle 135 merge", refused, "CAD comes as .step"},
    {"open \"part.cub5\"", refused, "'export mesh"},
    {"save as \"part.cub\" overwrite", skipped, "'export mesh"},

    // Variables, loops and conditions.
    {"# {h = 2}\nrefine volume 1 numsplit {h}", done, "64 -> 1728 hexes"},
    {"#{loop(2)}\nrefine volume all numsplit 1\n#{endloop}", done, "512 -> 4096 hexes"},
    {"{n = 0}\n{Loop(3)}\n{n++}\n{EndLoop}\nrefine vertex {n} numsplit 1 bias 1.0 depth 1", done, "64 -> 138 hexes"},
    {"{fine = 1}\n{Ifdef(fine)}\nrefine volume all\n{Else}\nrefine curve 1\n{Endif}", done, "64 -> 512 hexes"},
    {"{if(2 > 3)}\nrefine volume all\n{elseif(1)}\nrefine volume all numsplit 2\n{endif}", done, "64 -> 1728 hexes"},
    {"#{ifndef(fine)}\nrefine hex all\n#{endif}", done, "64 -> 1728 hexes"},

    // What shows, logs or waits.
    {"graphics off", skipped, "nothing is shown here"},
    {"graphics mode hiddenline", skipped, "nothing is shown here"},
    {"view iso", skipped, "nothing is shown here"},
    {"zoom reset", skipped, "nothing is shown here"},
    {"rotate 30 about world x", skipped, "nothing is shown here"},
    {"display", skipped, "nothing is shown here"},
    {"draw surface 3", skipped, "nothing is shown here"},
    {"draw volume all", skipped, "nothing is shown here"},
    {"draw hex 5 add", skipped, "nothing is shown here"},
    {"color volume 1 blue", skipped, "nothing is shown here"},
    {"label surface on", skipped, "nothing is shown here"},
    {"volume 1 visibility off", skipped, "nothing is shown here"},
    {"pause", skipped, "'pause' is skipped"},
    {"comment 'a remark'", skipped, "'comment' is skipped"},
    {"echo on", skipped, "'echo' is skipped"},
    {"journal off", skipped, "'record"},
    {"set echo off", skipped, "'record"},
    {"set info off", skipped, "'record"},
    {"set journal on", skipped, "'record"},
    {"set logging on file 'log.txt'", skipped, "'record"},
    {"set large exodus file on", skipped, "suits their size"},
    {"set exodus netcdf4 off", skipped, "suits their size"},
    {"compress all", skipped, "ids stay"},
    {"set default autosize on", skipped, "sets up a mesher"},
    {"undo on", done, ""},
    {"undo off", done, ""},

    // What makes meshes, geometry and loads.
    {"mesh volume all", refused, "there is a mesh of"},
    {"mesh surface 3", refused, "'mesh volume all size 0.5'"},
    {"volume all size 0.2", refused, "'mesh volume all size 0.5'"},
    {"volume 1 size auto factor 4", refused, "'mesh volume all size 0.5'"},
    {"surface 3 scheme pave", refused, "'mesh volume all size 0.5'"},
    {"volume 2 scheme sweep source surface 1 target surface 2", refused, "'mesh volume all size 0.5'"},
    {"curve 1 interval 10", refused, "'mesh volume all size 0.5'"},
    {"delete mesh", refused, "'reset mesh' drops the mesh"},
    {"delete volume 2", refused, "'export ... block 1 partial'"},
    {"webcut volume 1 with plane xplane offset 0 noimprint nomerge", refused, "geometry is not edited here"},
    {"imprint volume all", refused, "'set glue on'"},
    {"merge all", done, "nothing is merged"},
    {"subtract volume 2 from volume 1", refused, "geometry is not edited here"},
    {"unite volume 1 2", refused, "geometry is not edited here"},
    {"create surface curve 1 2 3 4", refused, "geometry is not edited here"},
    {"torus major radius 5 minor radius 1", refused, "'create brick', 'create cylinder'"},
    {"create material \"steel\" property_group \"CUBIT-ABAQUS\"", refused, "the solver's own input"},
    {"create pressure 1 on sideset 1 magnitude 10", refused, "the solver's own input"},
};

class Lines : public testing::Test {
 protected:
  const std::filesystem::path before_ = std::filesystem::current_path();
  void SetUp() override { std::filesystem::current_path(test::folder()); }
  void TearDown() override { std::filesystem::current_path(before_); }
};

TEST_F(Lines, of_journals_of_others_are_done_or_skipped_or_refused_with_what_to_do) {
  for (const Line& line : lines) {
    SCOPED_TRACE(line.said);
    test::Fixture f;
    f.session.run("create brick x 10; block 1 volume 1; nodeset 9 surface 5");
    f.output.clear();
    f.notices.clear();
    const Index n_hexes = f.session.meshed().mesh.n_hexes();
    const std::string error = f.error(line.said);
    std::string notes;
    for (const std::string& note : f.notices) notes += note + "\n";
    switch (line.kind) {
      case done:
        EXPECT_EQ(error, "no error");
        EXPECT_NE((f.all_output() + notes).find(line.part), std::string::npos) << f.all_output() << notes;
        EXPECT_EQ(notes.find("is skipped"), std::string::npos) << notes;
        EXPECT_EQ(f.error("check"), "no error");
        break;
      case skipped:
        EXPECT_EQ(error, "no error");
        EXPECT_NE(notes.find("is skipped"), std::string::npos) << notes;
        EXPECT_NE(notes.find(line.part), std::string::npos) << notes;
        EXPECT_EQ(f.session.meshed().mesh.n_hexes(), n_hexes);
        EXPECT_TRUE(f.all_output().empty());
        break;
      case refused:
        EXPECT_NE(error.find(line.part), std::string::npos) << error;
        EXPECT_EQ(f.session.meshed().mesh.n_hexes(), n_hexes);
    }
  }
}

TEST_F(Lines, that_are_skipped_are_noted_once) {
  test::Fixture f;
  f.session.run("pause\ngraphics off\nGraphics Mode wireframe\npause; set echo off; set echo on");
  EXPECT_EQ(f.notices.size(), 3u);
  EXPECT_EQ(f.session.records().size(), 6u);
}

TEST_F(Lines, of_our_own_commands_keep_their_errors) {
  test::Fixture f;
  f.session.run("create brick x 10");
  EXPECT_NE(f.error("draw surfce 3 to \"x.png\"").find("surface"), std::string::npos);
  EXPECT_NE(f.error("volume 1 smooth scheme mena").find("mean"), std::string::npos);
  EXPECT_NE(f.error("set glue maybe").find("auto"), std::string::npos);
}

TEST_F(Lines, from_included_files_share_variables_and_must_lie_below_the_working_folder) {
  test::Fixture f;
  std::filesystem::create_directories("parts");
  test::written("parts/size.inc", "{n = 3}\ncreate brick x 1 interval {n}\n");
  test::written("again.jou", "{include(\"again.jou\")}\n");
  f.session.run("{file = \"parts/size.inc\"}\n{include(file)}\nrefine volume all numsplit {n - 2}");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 216);
  EXPECT_EQ(f.error("{include(\"none.jou\")}"), "none.jou: this journal can't be read");
  f.session.run("#{cinclude(\"none.jou\")}");
  EXPECT_EQ(f.notices.back(), "there is no file 'none.jou': nothing was included");
  EXPECT_NE(f.error("{include(\"../x.jou\")}").find("below the working folder"), std::string::npos);
  EXPECT_NE(f.error("{include(\"again.jou\")}").find("without end"), std::string::npos);
  EXPECT_NE(f.error("{include(3)}").find("the name of a file in quotes"), std::string::npos);
}

TEST_F(Lines, of_loops_and_conditions_fail_where_they_are_wrong_before_anything_runs) {
  test::Fixture f;
  EXPECT_EQ(f.error("create brick x 1\n{loop(3)}\nrefine hex 1"), "this loop has no end: {endloop} is missing");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 0);
  EXPECT_EQ(f.error("{endif}"), "no {if(...)} or {ifdef(...)} is open here");
  EXPECT_EQ(f.error("{endloop}"), "no {loop(...)} is open here");
  EXPECT_EQ(f.error("{if(1)}\n{endloop}"), "this comes before the end of '{if(1)}'");
  EXPECT_EQ(f.error("{if(1)}\n{else}\n{else}\n{endif}"), "after {else} only {endif} can follow");
  EXPECT_EQ(f.error("{loop(n)}\n{endloop}"), "'n' has no value yet");
  EXPECT_EQ(f.error("{loop(\"a\")}\n{endloop}"), "a number was expected here, not a text");
  EXPECT_EQ(f.error("{loop(1e9)}\n{endloop}"), "this loop has too many rounds");
  EXPECT_EQ(f.error("{switch(1)}"), "this is not known here: say it with {if(...)}, {elseif(...)}, {else} and {endif}");
  EXPECT_EQ(f.error("{if(1)} create brick x 1\n{endif}"), "nothing may stand behind '{if(1)}' on its line");
  f.go_on = false;
  EXPECT_EQ(f.error("{loop(3)}\n{endloop}"), "cancelled");
}

TEST_F(Lines, of_something_that_is_no_journal_are_one_error) {
  test::Fixture f;
  f.session.set_keep_going(true);
  test::written("a.jou", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2 3\n4 5 6\n7 8 9\n");
  EXPECT_EQ(f.session.run("playback 'a.jou'"), 1);
  EXPECT_EQ(f.errors.size(), 1u);
  EXPECT_NE(f.errors[0].find("a.jou: this is not a journal"), std::string::npos);
  std::ofstream("b.jou", std::ios::binary) << std::string("refine\0curve", 12);
  EXPECT_EQ(f.session.run("playback 'b.jou'"), 1);
  test::written("c.jou", "refine curve 99\nlist curve 99\nlist hex 1\nlist node 1\nquit\n");
  EXPECT_GT(f.session.run("playback 'c.jou'"), 0);
  EXPECT_GT(f.errors.size(), 3u);
}

}  // namespace
}  // namespace hextwist
