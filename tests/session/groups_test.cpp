// group: what it collects, and what ranges make of it.
#include <gtest/gtest.h>

#include "session/session_fixture.h"

namespace hextwist {
namespace {

using Fixture = test::Fixture;

TEST(Groups, collect_entities_under_a_name) {
  Fixture f;
  f.session.run(
      "create brick x 3 interval 3; group \"rim\" add curve 1 2; group rim add vertex 5; group 1 add curve 3");
  EXPECT_EQ(f.output.back(), "group 1 'rim': 1 vertex, 3 curves");
  f.session.run("group 'rim' remove curve 1 9");
  EXPECT_EQ(f.output.back(), "group 1 'rim': 1 vertex, 2 curves");
  f.session.run("group rim xor curve 3 4");
  EXPECT_EQ(f.output.back(), "group 1 'rim': 1 vertex, 2 curves");
  f.session.run("list curve in rim");
  EXPECT_TRUE(f.output.back().starts_with("4      line "));
  f.session.run("group rim equals surface 1; list group 1");
  EXPECT_EQ(f.output.back(), "group 1 'rim': 1 surface");
  f.session.run("group other add hex 1; list group \"o*\"");
  EXPECT_EQ(f.output.back(), "group 2 'other': 1 hex");
  f.session.run("delete group rim");
  EXPECT_EQ(f.error("list curve in rim"), "nothing is named 'rim'; there are 'brick', 'other'");
}

TEST(Groups, take_several_kinds_in_one_command) {
  Fixture f;
  f.session.run("create brick x 3 interval 3; group g add surface 1 curve 2 surface 1 3; list group g");
  EXPECT_EQ(f.output.back(), "group 1 'g': 1 curve, 2 surfaces");
  f.session.run("group g xor curve 2 3 surface 4");
  EXPECT_EQ(f.output.back(), "group 1 'g': 1 curve, 3 surfaces");
  f.session.run("group g remove curve 3 surface 1 vertex 2");
  EXPECT_EQ(f.output.back(), "group 1 'g': 2 surfaces");
  f.session.run("group g equals hex 1 node 5 hex 3");
  EXPECT_EQ(f.output.back(), "group 1 'g': 1 node, 2 hexes");
  EXPECT_EQ(f.error("group g add curve 1 vertex 99"), "vertex 99 does not exist; vertices are 1 to 8");
  f.session.run("list group g");
  EXPECT_EQ(f.output.back(), "group 1 'g': 1 node, 2 hexes");
}

TEST(Groups, are_undone_and_forgotten_with_their_model) {
  Fixture f;
  f.session.run("create brick x 3 interval 3; group a add curve 1; group a add curve 2; undo; list group 1");
  EXPECT_EQ(f.output.back(), "group 1 'a': 1 curve");
  f.session.run("redo; list group 1");
  EXPECT_EQ(f.output.back(), "group 1 'a': 2 curves");
  f.session.run("create brick x 3 interval 3");
  EXPECT_EQ(f.error("list group 1"), "there are no groups");
  f.session.run("group a add curve 1; reset");
  EXPECT_EQ(f.error("list group 1"), "there are no groups");
  EXPECT_EQ(f.error("list group all; list nodeset all; delete sideset all"), "no error");
  EXPECT_EQ(f.notices,
            (std::vector<std::string>{"this takes the place of the mesh of 27 hexes that was here",
                                      "there are no groups", "there are no nodesets", "there are no sidesets"}));
}

TEST(Groups, members_that_are_gone_count_no_longer) {
  Fixture f;
  f.session.run(
      "create brick x 3 interval 3; group a add hex 1 14; group a add edge 1; group a add face 1; group a add node 64; "
      "refine hex 14; list group 1");
  EXPECT_EQ(f.output.back(), "group 1 'a': 1 node, 1 edge, 1 face, 1 hex (1 more gone)");
  f.session.run("undo; list group 1");
  EXPECT_EQ(f.output.back(), "group 1 'a': 1 node, 1 edge, 1 face, 2 hexes");
  f.session.run("refine node in a; check");
  EXPECT_GT(f.session.meshed().mesh.n_hexes(), 27);
}

TEST(Groups, errors_say_what_is_missing) {
  Fixture f;
  f.session.run("create brick x 3 interval 3");
  EXPECT_EQ(f.error("group 3 add curve 1"),
            "there is no group 3; a new one is made by its name: group \"name\" add ...");
  EXPECT_EQ(f.error("group \"\" add curve 1"), "this name is empty");
  EXPECT_EQ(f.error("group b remove curve 1"), "no group is named 'b'");
  EXPECT_EQ(f.error("group b add curve 99"), "curve 99 does not exist; curves are 1 to 12");
  EXPECT_EQ(f.error("list group 1"), "there are no groups");
}

}  // namespace
}  // namespace hextwist
