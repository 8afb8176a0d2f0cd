// Loops, chains, neighbours, directions, the largest, solids: ranges by what shapes the CAD has.
#include <gtest/gtest.h>

#include "command/range_fixture.h"
#include "hextwist/geom/occ/model.h"

namespace hextwist {
namespace {

using test::Ids;

/// The grid has no part in these: ranges of the CAD alone.
test::RangeFixture on(std::shared_ptr<const Model> model) {
  test::RangeFixture f;
  f.meshed.model = std::move(model);
  f.meshed.association = {};
  return f;
}
const std::filesystem::path models = std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models";

/// 120 x 80 x 8, with a hole of radius 16 in the middle whose seam is a curve.
test::RangeFixture plate_with_hole() {
  return on(read_cad(models / "plate_hole.brep").model);
}

TEST(RangesOfShapes, rims_of_holes_are_found_by_loops_and_by_asking_for_holes) {
  auto f = plate_with_hole();
  const Ids rims = f.ids("curve with radius = 16");
  ASSERT_EQ(rims.size(), 2u);
  EXPECT_EQ(f.ids("curve with is_hole"), rims);
  EXPECT_EQ(f.ids("curve with radius 15 to 17"), rims);
  EXPECT_EQ(f.ids("curve with radius 16 to 16"), rims);
  EXPECT_EQ(f.n("curve with radius 16.1 to 20"), 0u);
  const Ids faces = f.ids("surface in curve " + std::to_string(rims[0]) + " with is_planar");
  ASSERT_EQ(faces.size(), 1u);
  const std::string face = "surface " + std::to_string(faces[0]);
  EXPECT_EQ(f.n("curve loop of " + face), 4u);
  EXPECT_EQ(f.n("curve in loop of " + face), 4u);
  EXPECT_EQ(f.ids("curve loop of " + face + " (at 0 0 4)"), Ids{rims[0]});
  EXPECT_EQ(f.n("curve loop of " + face + " (at -60 0 4)"), 4u);
  EXPECT_EQ(f.n("curve loop of " + face + " (at -60 0 4) with length > 100"), 2u);
  EXPECT_EQ(f.error("surface loop of surface 1").substr(0, 2), "9:");
}

TEST(RangesOfShapes, neighbours_directions_and_the_largest) {
  auto f = plate_with_hole();
  EXPECT_EQ(f.n("surface adjacent to surface with radius = 16"), 2u);
  EXPECT_EQ(f.n("surface adjacent to surface with area > 8000"), 5u);
  EXPECT_EQ(f.n("hex adjacent to hex 1"), 3u);
  EXPECT_EQ(f.n("node adjacent to node 1"), 3u);
  EXPECT_EQ(f.n("surface parallel to surface with area > 8000"), 2u);
  EXPECT_EQ(f.n("surface perpendicular to z"), 2u);
  EXPECT_EQ(f.n("curve parallel to z"), 5u);  // with the seam of the hole
  EXPECT_EQ(f.n("curve parallel to x"), 4u);
  EXPECT_EQ(f.n("surface parallel to z"), 5u);
  EXPECT_EQ(f.n("curve perpendicular to z"), 8u);
  EXPECT_EQ(f.n("curve parallel to surface 3"), 10u);  // with the circles
  EXPECT_EQ(f.n("surface largest 2 by area"), 2u);
  EXPECT_EQ(f.ids("surface largest 2 by area"), f.ids("surface with area > 8000"));
  EXPECT_EQ(f.ids("surface smallest by area"), Ids{1});
  EXPECT_EQ(f.n("surface with is_planar smallest 3 by area"), 3u);
  EXPECT_NE(f.error("surface largest 2 by length").find("surfaces have no length"), std::string::npos);
}

TEST(RangesOfShapes, chains_go_on_where_curves_and_surfaces_are_smooth) {
  auto f = on(read_cad(models / "bracket_fillet.brep").model);
  const Ids fillets = f.ids("surface with radius > 0 largest by area");
  ASSERT_EQ(fillets.size(), 1u);
  const Ids chain = f.ids("surface chain from surface " + std::to_string(fillets[0]));
  EXPECT_GT(chain.size(), 2u);  // with the plane on either side
  auto plate = plate_with_hole();
  EXPECT_EQ(plate.n("curve chain from curve with is_hole"), 2u);
  EXPECT_EQ(plate.n("curve chain from curve 1"), 1u);
  EXPECT_EQ(plate.error("node chain from node 1").substr(0, 2), "6:");
}

TEST(RangesOfShapes, what_lies_near_or_in_a_solid) {
  test::RangeFixture f;
  EXPECT_EQ(f.ids("node (within 0 of 0 0 0)"), Ids{1});
  EXPECT_EQ(f.n("node (within 1 of 0 0 0)"), 4u);
  EXPECT_EQ(f.n("hex (within 0.1 of 0 0 0)"), 1u);
  EXPECT_EQ(f.n("vertex (within 4.01 0 0 0)"), 5u);
  EXPECT_EQ(f.n("hex in box 0 0 0 2 1 2"), 4u);
  EXPECT_EQ(f.n("hex in box 2 1 2 0 0 0"), 4u);
  EXPECT_EQ(f.n("hex in sphere 0.5 0.5 0.5 radius 1"), 4u);
  EXPECT_EQ(f.n("hex in cylinder 0 0.5 0.5 to 3 0.5 0.5 radius 0.1"), 3u);
  EXPECT_EQ(f.n("hex in block 10 in box 0 0 0 1 1 1"), 1u);
  EXPECT_EQ(f.error("hex in sphere 0 0 0 radius 0"), "28: a radius must be positive");
}

TEST(RangesOfShapes, what_leaves_nothing_says_what_comes_nearest) {
  test::RangeFixture f;
  DerivedTopology topology(f.meshed.mesh);
  const auto why = [&](const std::string& text) {
    const Command command = parse(split_statements("list " + text).at(0));
    const Item& item = *command.find("range");
    std::string result;
    std::vector<std::string> notices;
    EXPECT_TRUE(select({f.meshed, topology, {}}, command.statement, item.kind, item.range, notices, &result).empty());
    return result;
  };
  EXPECT_EQ(why("curve with length > 5"), "none of the 12 curves meets 'length > 5'; curve 1 comes nearest with 4");
  EXPECT_EQ(why("hex 3 with 0 > volume"),
            "the one hex that is left does not meet '0 > volume'; hex 3 comes nearest with 1");
  EXPECT_EQ(why("hex 1 2 except 1 2"), "'except' takes away all of them");
  EXPECT_EQ(why("hex 1 to 4 in node 60"), "none of the 4 hexes lies in or touches those");
  EXPECT_EQ(why("node (within 0.25 of -1 0 0)"),
            "none of the 60 nodes is that near; node 1 comes nearest with a distance of 1");
}

}  // namespace
}  // namespace hextwist
