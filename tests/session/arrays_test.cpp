// What a new array gets from one line in mesh/arrays.h.
#include "hextwist/mesh/arrays.h"

#include <gtest/gtest.h>

#include "hextwist/mesh/primitives.h"
#include "hextwist/patch/patch_refine.h"
#include "hextwist/session/array_delta_internal.h"
#include "support/same_meshed.h"

namespace hextwist::test {
namespace {

double heat_at(const Vec3& point) {
  return 3 + 2 * point.x() - point.y() + 0.5 * point.z();
}

/// With two values per node that are linear in space, so that one knows what new nodes must get.
MeshedModel heated_brick() {
  MeshedModel result{mesh_brick({5, 5, 5}, {5, 5, 5}), cad_brick({5, 5, 5}).model, {}};
  result.association = associate(result.mesh, *result.model).association;
  Field heat{"heat", Field::On::node, 2, {}};
  for (const Vec3& point : result.mesh.points) {
    heat.values.push_back(heat_at(point));
    heat.values.push_back(-heat_at(point));
  }
  result.mesh.fields.push_back(heat);
  return result;
}
void expect_heated(const Mesh& mesh) {
  const std::vector<double>& heat = mesh.fields.at(0).values;
  ASSERT_EQ(heat.size(), 2 * mesh.points.size());
  for (std::size_t n = 0; n < mesh.points.size(); ++n) {
    EXPECT_NEAR(heat[2 * n], heat_at(mesh.points[n]), 1e-12);
    EXPECT_NEAR(heat[2 * n + 1], -heat_at(mesh.points[n]), 1e-12);
  }
}

TEST(arrays, all_members_of_mesh_and_association_are_visited) {
  std::size_t n_mesh = 0, n_association = 0;
  const Mesh mesh;
  const Association association;
  for_each_array(lists_apart([&](const ArrayTag&, const auto&) { ++n_mesh; }), mesh);
  for_each_array(lists_apart([&](const ArrayTag&, const auto&) { ++n_association; }), association);
  constexpr std::size_t n_group_lists = 4;  // blocks, node sets, side sets, fields: none of each here
  const char* const add_a_line = "a member that is not in mesh/arrays.h is lost by patches, undo and refinement";
  // What came with a file is no array, and goes along as it is.
  EXPECT_EQ(sizeof(Mesh),
            (n_mesh + n_group_lists) * sizeof(std::vector<Index>) + sizeof mesh.others + sizeof mesh.results)
      << add_a_line;
  EXPECT_EQ(sizeof(Association), n_association * sizeof(std::vector<Index>)) << add_a_line;
}

TEST(arrays, an_array_of_nodes_is_carried_cut_out_spliced_undone_and_counted) {
  const MeshedModel meshed = heated_brick();
  MeshedModel without = meshed;
  without.mesh.fields.clear();
  EXPECT_EQ(bytes_of(meshed) - bytes_of(without), 2 * sizeof(double) * meshed.mesh.points.size());

  const Patch patch = make_patch(meshed, {0, 1, 5, 6});
  expect_heated(patch.meshed.mesh);

  const PatchRule before = patch_rule;
  patch_rule = {0, 1};
  const auto made = refine_patch(meshed, measured(meshed), {.target = {.kind = EntityKind::hex, .ids = {62}}}, {});
  patch_rule = before;
  ASSERT_TRUE(made.has_value());
  const MeshedModel refined = spliced(meshed, *made->splice);
  EXPECT_GT(refined.mesh.n_nodes(), meshed.mesh.n_nodes());
  expect_heated(refined.mesh);  // carried in the patch, then spliced
  MeshedModel in_place = meshed;
  for (const bool forward : {true, false}) {
    made->splice->make_room(in_place, forward);
    made->splice->apply(in_place, forward);
    EXPECT_TRUE(same_bits(in_place, forward ? refined : meshed));
  }
  EXPECT_TRUE(same_bits(spliced(refined, *made->splice, false), meshed));

  const MeshedDelta back = MeshedDelta::between(refined, meshed);
  EXPECT_LT(back.bytes(), bytes_of(meshed));
  EXPECT_TRUE(same_bits(back.apply(refined), meshed));
  EXPECT_TRUE(same_bits(MeshedDelta::between(meshed, refined).apply(meshed), refined));
}

TEST(arrays, have_names_of_their_own) {
  MeshedModel meshed = heated_brick();
  meshed.mesh.node_sets = {{7, "seven", {1}}, {9, "nine", {}}};
  std::vector<std::string> names;
  for_each_array(lists_apart([&](const ArrayTag& tag, const auto&) { names.push_back(tag.full_name()); }), meshed);
  for (const char* name : {"points", "node_fields/heat", "node_sets/7", "node_sets/9", "curve_edges", "edge_curves"})
    EXPECT_EQ(std::ranges::count(names, name), 1) << name;
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

TEST(arrays, groups_that_another_mesh_does_not_have_are_empty_there) {
  Mesh mesh, other;
  mesh.node_sets = {{7, "", {1, 2}}, {9, "", {3}}};
  other.node_sets = {{9, "", {4, 5, 6}}};
  const Mesh& constant = other;
  std::vector<std::pair<std::size_t, std::size_t>> sizes;
  for_each_set(
      [&](const ArrayTag&, const auto& a, const auto& b) { sizes.emplace_back(a.items.size(), b.items.size()); }, mesh,
      constant);
  EXPECT_EQ(sizes, (std::vector<std::pair<std::size_t, std::size_t>>{{2, 0}, {1, 3}}));
}

}  // namespace
}  // namespace hextwist::test
