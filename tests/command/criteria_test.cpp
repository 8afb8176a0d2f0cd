// `with`, `common_to`, `(at x y z)`, names and parentheses in ranges, on a grid of 4 x 3 x 2 unit cubes.
#include <gtest/gtest.h>

#include <numbers>

#include "command/range_fixture.h"
#include "hextwist/geom/occ/model.h"
#include "hextwist/geom/primitives.h"
#include "hextwist/mesh/quality/quality.h"

namespace hextwist {
namespace {

using test::Ids;
using Fixture = test::RangeFixture;

TEST(Criteria, coordinates_choose_mesh_entities) {
  Fixture f;
  EXPECT_EQ(f.ids("hex with x_coord < 1 and y_coord < 1"), (Ids{1, 13}));
  EXPECT_EQ(f.n("node with x_coord = 0"), 12u);
  EXPECT_EQ(f.n("node with z_coord > 1.5"), 20u);
  EXPECT_EQ(f.n("edge with x_min = 0 and x_max = 0"), 17u);
  EXPECT_EQ(f.n("face with x_coord = 0"), 6u);
  EXPECT_EQ(f.n("face with x_max <= 0"), 6u);
  EXPECT_EQ(f.n("hex with x_min >= 1 and x_max <= 3"), 12u);
  EXPECT_EQ(f.n("hex with x_coord + y_coord <= 2"), 6u);
  EXPECT_EQ(f.n("hex with x_coord-1 < y_coord/2"), f.n("hex with x_coord - 1 < y_coord / 2"));
  EXPECT_EQ(f.n("hex with (x_coord + 1) * 2 > 2*3 -1"), 12u);
  EXPECT_EQ(f.n("hex with id <= 5 or id > 20"), 9u);
  EXPECT_EQ(f.n("node with id <> 1"), 59u);
}

TEST(Criteria, cad_entities_have_their_measures) {
  Fixture f;
  EXPECT_EQ(f.ids("curve with length > 3"), (Ids{1, 2, 3, 4}));
  EXPECT_EQ(f.ids("curve with length = 3"), (Ids{5, 6, 7, 8}));
  EXPECT_EQ(f.ids("curve with length <> 2 and x_max = 0"), (Ids{5, 7}));
  EXPECT_EQ(f.ids("surface with area = 12"), (Ids{5, 6}));
  EXPECT_EQ(f.ids("surface with x_coord = 4"), (Ids{2}));
  EXPECT_EQ(f.ids("surface with is_planar and z_coord < 0.5"), (Ids{5}));
  EXPECT_EQ(f.n("surface with not is_planar"), 0u);
  EXPECT_EQ(f.n("surface with is_plane = true"), 6u);
  EXPECT_EQ(f.ids("vertex with x_coord > 3 and z_coord > 1"), (Ids{6, 8}));
  EXPECT_EQ(f.ids("volume with volume = 24"), (Ids{1}));
  EXPECT_EQ(f.n("curve with radius = 0"), 12u);
  EXPECT_EQ(f.n("curve with is_meshed"), 12u);
  EXPECT_EQ(f.ids("curve with element_count = 2"), (Ids{9, 10, 11, 12}));
  EXPECT_EQ(f.n("surface with num_parents = 1"), 6u);
  EXPECT_EQ(f.n("vertex with num_parents = 3"), 8u);
  EXPECT_EQ(f.n("curve with length < length of curve 5"), 4u);
  EXPECT_EQ(f.ids("curve with length = 2.9 tolerance 0.2"), (Ids{5, 6, 7, 8}));
}

TEST(Criteria, mesh_entities_have_their_measures) {
  Fixture f;
  f.meshed.mesh.points[0] -= Vec3(1, 0, 0);
  EXPECT_EQ(f.ids("edge with length > 1.5"), (Ids{1}));
  EXPECT_EQ(f.n("face with area > 1.2"), 3u);
  EXPECT_EQ(f.ids("hex with volume > 1.2"), (Ids{1}));
  EXPECT_EQ(f.ids("block with volume > 2.1"), (Ids{10}));
  EXPECT_EQ(f.ids("sideset with area > 2"), (Ids{7}));
  EXPECT_EQ(f.ids("hex with quality < 1"), (Ids{1}));
  EXPECT_EQ(f.ids("hex with quality shape < 1"), (Ids{1}));
  EXPECT_EQ(f.ids("hex with quality scaled jac < 0.99"), (Ids{1}));
  EXPECT_EQ(f.ids("hex with quality aspect_ratio > 1.1 and not id = 2"), (Ids{1}));
  EXPECT_EQ(f.ids("hex with quality volume > 1.2"), (Ids{1}));
  EXPECT_EQ(f.ids("hex with block_assigned"), (Ids{1, 2, 3, 4}));
  EXPECT_EQ(f.n("hex with not block_assigned"), 20u);
  EXPECT_EQ(f.ids("block with element_count = 2"), (Ids{20, 10}));
  EXPECT_EQ(f.ids("nodeset with element_count = 1"), (Ids{5}));
}

TEST(Criteria, round_things_have_a_radius) {
  // The shipped models: a cylinder's side, a sphere, circles and arcs, through OpenCASCADE.
  const std::string models = std::string(HEXTWIST_SOURCE_DIR) + "/models/";
  Fixture f;
  f.meshed = {{}, analytic_cylinder(2, 5), {}};
  EXPECT_EQ(f.ids("surface with radius = 2"), (Ids{1}));
  EXPECT_EQ(f.ids("curve with radius = 2"), (Ids{1, 2}));
  EXPECT_EQ(f.ids("surface with is_planar"), (Ids{2, 3}));
  f.meshed = {{}, analytic_sphere(3), {}};
  EXPECT_EQ(f.ids("surface with radius = 3"), (Ids{1}));
  f.meshed = {{}, cad_cylinder({2, 5}).model, {}};
  EXPECT_EQ(f.n("surface with radius = 2"), 1u);
  EXPECT_EQ(f.n("surface with radius = 0 and is_planar"), 2u);
  EXPECT_EQ(f.n("curve with radius = 2"), 2u);
  EXPECT_EQ(f.n("surface with is_spline"), 0u);
  f.meshed = {{}, cad_sphere({3}).model, {}};
  EXPECT_EQ(f.n("surface with radius = 3"), 1u);
}

TEST(Criteria, facets_are_planar_when_the_mesh_is_flat_there) {
  Fixture f;
  FacetResult own = associate_with_own_skin(f.meshed.mesh);
  f.meshed.model = own.model;
  f.meshed.association = own.association;
  EXPECT_EQ(f.n("surface with is_planar"), 6u);
  f.meshed.mesh.points[0] -= Vec3(0.01, 0, 0);
  own = associate_with_own_skin(f.meshed.mesh);
  f.meshed.model = own.model;
  f.meshed.association = own.association;
  EXPECT_EQ(f.n("surface with is_planar"), 5u);
}

TEST(Criteria, and_and_or_go_from_left_to_right_and_not_takes_a_comparison) {
  Fixture f;
  EXPECT_EQ(f.ids("hex with id = 1 or id = 2 and id = 2"), (Ids{2}));
  EXPECT_EQ(f.ids("hex with id = 1 or (id = 2 and id = 2)"), (Ids{1, 2}));
  EXPECT_EQ(f.n("hex with not id > 3 and id > 1"), 2u);
  EXPECT_EQ(f.ids("hex with id < 3 and with not (id = 1 or id = 7)"), (Ids{2}));
  EXPECT_EQ(f.ids("surface with is_planar = false or x_min > 3"), (Ids{2}));
  EXPECT_EQ(f.n("hex with true"), 24u);
  EXPECT_EQ(f.n("hex with 2 * 3 - 1 = 5"), 24u);
  EXPECT_EQ(f.n("hex with -x_coord > -1"), 6u);
}

TEST(Criteria, with_is_about_the_kind_before_it) {
  Fixture f;
  EXPECT_EQ(f.ids("curve in surface 1 with length > 2"), (Ids{5, 7}));
  EXPECT_EQ(f.ids("edge in surface all with x_coord = 0").size(), 17u);
  EXPECT_EQ(f.n("hex in node in face in surface 1 with z_coord > 1"), 3u);
  EXPECT_EQ(f.n("curve in surface with area > 8"), 8u);  // 12 and 8: two surfaces
  EXPECT_EQ(f.n("curve in (surface all with area > 8)"), 8u);
  EXPECT_EQ(f.n("curve in surface with area > 8 with length > 3"), 4u);
  EXPECT_EQ(f.ids("curve with length > 3 in surface 3"), (Ids{1, 3}));
  EXPECT_EQ(f.ids("curve with length > 3 in surface 3 with z_coord > 1"), (Ids{3}));
  EXPECT_EQ(f.ids("hex 1 to 4 with x_coord > 2"), (Ids{3, 4}));
}

TEST(Ranges, common_to_means_in_all_of_them) {
  Fixture f;
  EXPECT_EQ(f.ids("curve common_to surface 1 3"), (Ids{9}));
  EXPECT_EQ(f.ids("vertex common_to surface 1 3 5"), (Ids{1}));
  EXPECT_EQ(f.ids("vertex common_to surface 1 curve 1"), (Ids{1}));
  EXPECT_EQ(f.n("curve common_to surface 1 2"), 0u);
  EXPECT_EQ(f.n("face common_to hex 1 2"), 1u);
  EXPECT_EQ(f.n("node common_to hex 1 2"), 4u);
  EXPECT_EQ(f.ids("hex common_to node 1 2"), (Ids{1}));
  EXPECT_EQ(f.ids("volume common_to hex all"), (Ids{1}));
  EXPECT_EQ(f.ids("surface common_to vertex 1 2"), (Ids{3, 5}));
  EXPECT_EQ(f.ids("surface common_to curve in surface 1"), (Ids{1}));
  EXPECT_EQ(f.n("hex common_to block all"), 0u);
}

TEST(Ranges, except_takes_ids_or_a_whole_range_of_the_same_kind) {
  Fixture f;
  EXPECT_EQ(f.n("face all except face in surface all"), f.n("face all") - 52);
  EXPECT_EQ(f.n("face in volume 1 except face in surface all"), f.n("face all") - 52);
  EXPECT_EQ(f.ids("curve with length > 3 except curve 3"), (Ids{1, 2, 4}));
  EXPECT_EQ(f.ids("curve in (surface 3) except 1"), (Ids{3, 9, 10}));
  EXPECT_EQ(f.ids("curve in surface 1 3 except 3 with z_coord > 1.5"), (Ids{7}));
  EXPECT_EQ(f.n("hex all except hex in block 10"), 22u);
  EXPECT_EQ(f.n("hex all except (hex in block 10) in vertex all"), 7u);
  EXPECT_EQ(f.n("hex all except hex 1 2"), 22u);
  EXPECT_EQ(f.n("hex all except hex with x_coord < 1"), 18u);
  EXPECT_EQ(f.error("curve all except left"), "18: no curve is named 'left'");
  EXPECT_EQ(f.error("curve all except surface 3"),
            "18: only curves can be taken from a list of curves; 'curve in surface ...' names those that lie there");
}

TEST(Ranges, names_may_have_wildcards_and_stand_without_a_kind) {
  Fixture f;
  EXPECT_EQ(f.ids("block \"*t\""), (Ids{20, 10}));
  EXPECT_EQ(f.ids("block 'l?ft'"), (Ids{10}));
  EXPECT_EQ(f.ids("block with name 'LE*'"), (Ids{10}));
  EXPECT_EQ(f.ids("block with name <> 'left'"), (Ids{20}));
  EXPECT_EQ(f.ids("hex in left"), (Ids{1, 2}));
  EXPECT_EQ(f.ids("hex in (left right)"), (Ids{1, 2, 3, 4}));
  EXPECT_EQ(f.ids("hex in 'right' block 10"), (Ids{1, 2, 3, 4}));
  EXPECT_EQ(f.ids("hex in left expand"), (Ids{1, 2}));
  EXPECT_EQ(f.error("hex in lefft"), "8: nothing is named 'lefft' (did you mean 'left'?)");
  EXPECT_EQ(f.error("hex in elsewhere"),
            "8: nothing is named 'elsewhere'; there are 'corner', 'left', 'low x', 'right'");
  EXPECT_EQ(f.error("block lift"), "7: no block is named 'lift' (did you mean 'left'?)");
  EXPECT_EQ(f.error("block 'x*'"), "7: no block is named 'x*'; there are 'left', 'right'");
  EXPECT_TRUE(matches("surface_inlet", "*in*t"));
  EXPECT_TRUE(matches("", "**"));
  EXPECT_TRUE(matches("aaab", "a*ab"));
  EXPECT_FALSE(matches("aaab", "a*aa"));
  EXPECT_FALSE(matches("ab", "a"));
  EXPECT_FALSE(matches("a", "a?"));
}

TEST(Ranges, at_names_the_nearest) {
  Fixture f;
  EXPECT_EQ(f.ids("vertex (at 4 0 0)"), (Ids{2}));
  EXPECT_EQ(f.ids("vertex ( at 3.9, 0.1, 0.2 )"), (Ids{2}));
  EXPECT_EQ(f.ids("node (at 1.1 0.2 -5)"), (Ids{2}));
  EXPECT_EQ(f.ids("curve (at 2 0 0)"), (Ids{1}));
  EXPECT_EQ(f.ids("surface (at 2 1.5 2 ordinal 1 ordered)"), (Ids{6}));
  EXPECT_EQ(f.ids("surface (at 2 1.5 2 ordinal 6)"), (Ids{2}));  // 1 and 2 are 2 away, 1 by its lower id first
  EXPECT_EQ(f.ids("volume (at 9 9 9)"), (Ids{1}));
  EXPECT_EQ(f.ids("hex (at 1.5 0.5 0.5)"), (Ids{2}));
  EXPECT_EQ(f.ids("hex (at 3.5 2.5 9)"), (Ids{24}));
  EXPECT_EQ(f.ids("hex (at 0.5 0.5 0.5) (at 1.5 0.5 0.5) 7"), (Ids{1, 2, 7}));
  EXPECT_EQ(f.ids("face (at 0 0.5 0.5)"), f.ids("face common_to hex 1 surface 1"));
  EXPECT_EQ(f.ids("edge (at 0.5 0 0)"), (Ids{1}));
  EXPECT_EQ(f.ids("block (at 3 0.5 0.5)"), (Ids{20}));
  EXPECT_EQ(f.ids("sideset (at 0 0 0)"), (Ids{7}));
  EXPECT_EQ(f.ids("nodeset (at 0 0 0)"), (Ids{5}));
  // Where three curves meet the one whose middle is nearest comes first.
  EXPECT_EQ(f.ids("curve (at 0 0 0)"), (Ids{9}));
  EXPECT_EQ(f.ids("curve (at 0 0 0 ordinal 3)"), (Ids{1}));
  EXPECT_EQ(f.error("volume (at 0 0 0 ordinal 2)"), "8: there is no volume of ordinal 2: there are 1");
}

TEST(Ranges, every_pair_of_kinds_is_related_both_ways) {
  Fixture f;
  f.meshed.mesh.blocks[1].hexes = {0, 1, 5};
  f.groups.push_back({1, "mixed", {}});
  DerivedTopology topology(f.meshed.mesh);
  const Selector selector{f.meshed, topology, f.groups};
  f.groups[0].members[static_cast<int>(EntityKind::curve)] = {{5}};
  f.groups[0].members[static_cast<int>(EntityKind::hex)] = {{7}};
  for (int a = 0; a < n_entity_kinds; ++a)
    for (int b = 0; b < n_entity_kinds; ++b) {
      const auto from = static_cast<EntityKind>(a), to = static_cast<EntityKind>(b);
      std::vector<std::vector<char>> there(count(selector, from), std::vector<char>(count(selector, to), 0));
      int n = 0;
      for (Index i = 0; i < count(selector, from); ++i)
        for (const Index j : related(selector, from, {i}, to)) {
          there[i][j] = 1;
          ++n;
        }
      EXPECT_GT(n, 0) << name(from) << " to " << name(to);
      if (from == EntityKind::group || to == EntityKind::group) continue;
      for (Index j = 0; j < count(selector, to); ++j) {
        std::vector<char> back(count(selector, from), 0);
        for (const Index i : related(selector, to, {j}, from)) back[i] = 1;
        for (Index i = 0; i < count(selector, from); ++i)
          ASSERT_EQ(there[i][j], back[i]) << name(from) << " " << i << ", " << name(to) << " " << j;
      }
    }
}

TEST(Ranges, groups_stand_for_their_members) {
  Fixture f;
  f.groups.push_back({1, "mixed", {}});
  f.groups[0].members[static_cast<int>(EntityKind::curve)] = {{1}, {6}, {99}};
  f.groups[0].members[static_cast<int>(EntityKind::surface)] = {{1}};
  EXPECT_EQ(f.ids("curve in group 1"), (Ids{1, 6}));  // its own curves, not those of its surface
  EXPECT_EQ(f.ids("curve in mixed"), (Ids{1, 6}));
  EXPECT_EQ(f.ids("vertex in surface in group mixed"), (Ids{1, 3, 5, 7}));
  EXPECT_EQ(f.n("node in mixed"), 12u + 5 + 4 - 2 - 0);
  EXPECT_EQ(f.ids("group in curve 6"), (Ids{1}));
  EXPECT_EQ(f.ids("group in curve 7"), Ids{});
  EXPECT_EQ(f.error("group 2"), "7: group 2 does not exist; the only one is 1");
  EXPECT_EQ(f.ids("group (at 0 0 0)"), (Ids{1}));
  f.groups.clear();
  EXPECT_EQ(f.error("curve in group 1"), "16: there are no groups");
}

// The ways in which journals of today's tools say it.
TEST(Ranges, are_read_as_journals_write_them) {
  Fixture f;
  f.groups = {{1, "all_vol", {}}, {2, "gaps", {}}};
  f.groups[0].members[static_cast<int>(EntityKind::volume)] = {{1}};
  f.groups[1].members[static_cast<int>(EntityKind::surface)] = {{1}, {2}};
  EXPECT_EQ(f.ids("surface in volume in all_vol with x_coord < 1e-3"), (Ids{1}));
  EXPECT_EQ(f.ids("surface in gaps with y_coord > -0.001 and x_coord>3"), (Ids{2}));
  EXPECT_EQ(f.n("edge in surf all with Z_coord > 1.9"), 31u);
  EXPECT_EQ(f.n("hex in node in face in block left with Z_coord < 1"), 6u);
  EXPECT_EQ(f.n("node in all_vol expand with z_coord = 0 tolerance 0.001"), 20u);
  EXPECT_EQ(f.n("node with z_coord > 0 and y_max <= 1.5 and x_max > 0.5"), 16u);
  EXPECT_EQ(f.n("face all except face in block 10 20"), f.n("face all") - 21);
  EXPECT_EQ(f.n("curve all except curve in surf 1"), 8u);
  EXPECT_EQ(f.ids("surface ( at 2 1.5 2 ordinal 1 ordered )"), (Ids{6}));
  EXPECT_EQ(f.n("node in hex in face in surface 2 5"), 48u);
  EXPECT_EQ(f.n("hex with not block_assigned"), 20u);
  EXPECT_EQ(f.n("surface with area < 9 or with is_planar = false"), 4u);
}

}  // namespace
}  // namespace hextwist
