// What ranges mean, on a grid of 4 x 3 x 2 unit cubes.
#include "hextwist/command/select/selection.h"

#include <gtest/gtest.h>

#include "command/range_fixture.h"

namespace hextwist {
namespace {

using test::Ids;
using Fixture = test::RangeFixture;

TEST(Ranges, lists_spans_steps_and_exceptions) {
  Fixture f;
  EXPECT_EQ(f.ids("hex 3 1 3"), (Ids{1, 3}));
  EXPECT_EQ(f.ids("hex 3 to 6"), (Ids{3, 4, 5, 6}));
  EXPECT_EQ(f.ids("hex 3 to 8 by 3"), (Ids{3, 6}));
  EXPECT_EQ(f.ids("hex 3 to 25 step 30"), (Ids{3}));  // 25 itself is not one of the ids meant
  EXPECT_EQ(f.n("hex all"), 24u);
  EXPECT_EQ(f.n("hex all except 2 to 24"), 1u);
  EXPECT_EQ(f.n("node all"), 60u);
  EXPECT_EQ(f.n("edge all"), 4u * 12 + 3u * 15 + 2u * 20);
  EXPECT_EQ(f.n("face all"), 5u * 6 + 4u * 8 + 3u * 12);
  EXPECT_EQ(f.n("sheet all"), 9u);
  EXPECT_TRUE(f.notices.empty());
}

TEST(Ranges, ids_that_do_not_exist_are_named) {
  Fixture f;
  EXPECT_EQ(f.error("hex 25"), "5: hex 25 does not exist; hexes are 1 to 24");
  EXPECT_EQ(f.error("hex 1 to 999999999"), "10: hex 25 does not exist; hexes are 1 to 24");
  EXPECT_EQ(f.error("hex 1 to 9000000000000000 by 1000000000000000"),
            "10: hex 1000000000000001 does not exist; hexes are 1 to 24");
  EXPECT_EQ(f.error("hex 99 to 999999999"), "5: hex 99 does not exist; hexes are 1 to 24");
  EXPECT_EQ(f.error("hex all except 30"), "16: hex 30 does not exist; hexes are 1 to 24");
  EXPECT_EQ(f.error("curve 13"), "7: curve 13 does not exist; curves are 1 to 12");
  EXPECT_EQ(f.error("hex in volume 2"), "15: volume 2 does not exist; the only one is 1");
  EXPECT_EQ(f.error("block 1"), "7: block 1 does not exist; blocks are 10 to 20");
  EXPECT_EQ(f.error("block \"up\""), "7: no block is named 'up'; there are 'left', 'right'");
  EXPECT_EQ(f.error("surface inlet"), "9: no surface is named 'inlet'");
  f.meshed.mesh.side_sets.clear();
  EXPECT_EQ(f.error("sideset all"), "9: there are no sidesets");
  f.meshed = {};
  EXPECT_EQ(f.error("hex 1"), "5: there are no hexes: no mesh was read");
  EXPECT_EQ(f.error("curve all"), "7: there are no curves: neither CAD nor mesh was read");
}

TEST(Ranges, ids_with_gaps_are_skipped_in_spans_and_said) {
  Fixture f;
  f.meshed.mesh.hex_ids.clear();
  for (int i = 1; i <= 24; ++i) f.meshed.mesh.hex_ids.push_back(i <= 4 ? i : i + 100);
  EXPECT_EQ(f.ids("hex 1 to 106"), (Ids{1, 2, 3, 4, 105, 106}));
  ASSERT_EQ(f.notices.size(), 1u);
  EXPECT_EQ(f.notices[0], "100 of the hexes 1 to 106 do not exist, the first is 5");
  EXPECT_EQ(f.ids("hex 2 to 106 by 2"), (Ids{2, 4, 106}));
  EXPECT_EQ(f.error("hex 5"), "5: hex 5 does not exist; hexes are 1 to 124");
  EXPECT_EQ(f.error("hex 5 to 50"), "5: hex 5 does not exist; hexes are 1 to 124");
  EXPECT_EQ(f.error("hex 1 to 125"), "10: hex 125 does not exist; hexes are 1 to 124");
}

TEST(Ranges, names_stand_for_ids) {
  Fixture f;
  EXPECT_EQ(f.ids("block left"), (Ids{10}));
  EXPECT_EQ(f.ids("block \"LEFT\" 20"), (Ids{20, 10}));  // in the order of the mesh
  EXPECT_EQ(f.ids("hex in block right"), (Ids{3, 4}));
  EXPECT_EQ(f.ids("node in nodeset corner"), (Ids{1}));
  EXPECT_EQ(f.n("face in sideset 'low x'"), 2u);
}

TEST(Ranges, in_goes_down) {
  Fixture f;
  EXPECT_EQ(f.n("node in hex 1"), 8u);
  EXPECT_EQ(f.n("edge in hex 1 2"), 20u);
  EXPECT_EQ(f.n("face in hex 1 2"), 11u);
  EXPECT_EQ(f.n("edge in face all in hex 1"), 12u);
  EXPECT_EQ(f.n("node in face in surface 1"), 4u * 3);
  EXPECT_EQ(f.n("node in surface 1"), 4u * 3);
  EXPECT_EQ(f.n("node in curve 1"), 5u);
  EXPECT_EQ(f.n("node in vertex all"), 8u);
  EXPECT_EQ(f.n("edge in surface 5"), 4u * 4 + 3u * 5);
  EXPECT_EQ(f.n("face in volume 1"), f.n("face all"));
  EXPECT_EQ(f.n("hex in sheet 1"), 6u);
  EXPECT_EQ(f.n("hex in sheet in hex 1"), 18u);  // all but those with another place in each direction
}

TEST(Ranges, in_goes_up) {
  Fixture f;
  EXPECT_EQ(f.ids("hex in vertex 1"), (Ids{1}));
  EXPECT_EQ(f.ids("hex in curve 1"), (Ids{1, 2, 3, 4}));
  EXPECT_EQ(f.n("hex in surface 1"), 6u);
  EXPECT_EQ(f.n("hex in node in hex 1"), 8u);
  EXPECT_EQ(f.ids("volume in hex 3"), (Ids{1}));
  EXPECT_EQ(f.ids("vertex in hex 1"), (Ids{1}));
  EXPECT_EQ(f.ids("curve in hex 1"), (Ids{1, 5, 9}));
  EXPECT_EQ(f.ids("surface in node 1"), (Ids{1, 3, 5}));
  EXPECT_EQ(f.ids("block in hex 2 3"), (Ids{20, 10}));
  EXPECT_EQ(f.ids("sideset in surface 1"), (Ids{7}));
  EXPECT_EQ(f.n("sideset in surface 2"), 0u);
  EXPECT_EQ(f.ids("nodeset in vertex 1"), (Ids{5}));
  EXPECT_EQ(f.n("sheet in hex 1"), 3u);
}

TEST(Ranges, in_between_cad_entities_needs_no_mesh) {
  Fixture f;
  f.meshed.mesh = {};
  f.meshed.association = {};
  EXPECT_EQ(f.ids("curve in surface 3"), (Ids{1, 3, 9, 10}));
  EXPECT_EQ(f.ids("surface in vertex 8"), (Ids{2, 4, 6}));
  EXPECT_EQ(f.ids("surface in surface 2 3"), (Ids{2, 3}));
  EXPECT_EQ(f.error("hex in surface 3"), "5: there are no hexes: no mesh was read");
}

TEST(Ranges, except_and_in_belong_to_the_list_before_them) {
  Fixture f;
  EXPECT_EQ(f.ids("hex 1 to 6 except 2 3 in curve 1"), (Ids{1, 4}));
  EXPECT_EQ(f.ids("curve in surface 1 3 except 3"), f.ids("curve in surface 1"));
  EXPECT_EQ(f.ids("hex in vertex 1 curve 3"), (Ids{1, 13, 14, 15, 16}));
  EXPECT_EQ(f.ids("hex in sheet in edge in curve 1 in hex 1"), f.ids("hex in sheet in edge in curve 1"));
  EXPECT_TRUE(f.notices.empty());
  EXPECT_EQ(f.ids("hex 1 except 2"), (Ids{1}));
  ASSERT_EQ(f.notices.size(), 1u);
  EXPECT_EQ(f.notices[0], "'except' took nothing away: none of those hexes was in the list before it");
}

}  // namespace
}  // namespace hextwist
