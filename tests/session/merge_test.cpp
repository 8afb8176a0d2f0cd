// merge: coincident nodes of touching parts become one.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "geom/occ_shapes.h"
#include "hextwist/mesh/merge.h"
#include "hextwist/mesh/topology.h"
#include "session/session_fixture.h"
#include "support/association_checkers.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist {
namespace {

using test::Fixture;

/// Two grids beside each other that have nodes of their own where they touch, the second moved by so much.
Mesh two_grids(int a, int b, int c, const Vec3& by) {
  Mesh mesh = test::grid(a, b, c);
  const Mesh other = mesh;
  const Index n = mesh.n_nodes();
  for (const Vec3& p : other.points) mesh.points.push_back(p + Vec3(a, 0, 0) + by);
  for (Hex hex : other.hexes) {
    for (Index& node : hex) node += n;
    mesh.hexes.push_back(hex);
  }
  mesh.blocks = {{1, "left", {}}, {2, "right", {}}};
  for (Index h = 0; h < other.n_hexes(); ++h) {
    mesh.blocks[0].hexes.push_back(h);
    mesh.blocks[1].hexes.push_back(h + other.n_hexes());
  }
  // Nodes of the second grid where it touches, a field, and the sides there.
  NodeSet touching{3, "touching", {}};
  for (Index i = n; i < mesh.n_nodes(); ++i)
    if (other.points[i - n].x() == 0) touching.nodes.push_back(i);
  mesh.node_sets = {touching};
  SideSet wall{4, "wall", {}};
  for (Index h = 0; h < other.n_hexes(); ++h)
    if (other.points[other.hexes[h][0]].x() == 0) wall.sides.push_back({h + other.n_hexes(), 0});
  mesh.side_sets = {wall};
  Field place{"place", Field::On::node, 3, {}};
  for (const Vec3& p : mesh.points) place.values.insert(place.values.end(), {p.x(), p.y(), p.z()});
  mesh.fields = {place};
  return mesh;
}

TEST(Merge, makes_grids_that_touch_one_mesh_with_everything_carried) {
  const int a = 3, b = 2, c = 2;
  const Mesh before = two_grids(a, b, c, Vec3::Zero());
  const MergeResult result = merge_nodes(before, 1e-6);
  const Mesh& mesh = result.mesh;
  EXPECT_EQ(result.n_gone, (b + 1) * (c + 1));
  EXPECT_EQ(result.n_faces, b * c);
  EXPECT_EQ(mesh.n_nodes(), before.n_nodes() - result.n_gone);
  EXPECT_TRUE(test::conformal(mesh));
  EXPECT_TRUE(test::sets_valid(mesh));
  EXPECT_EQ(mesh.blocks, before.blocks);
  EXPECT_EQ(mesh.side_sets, before.side_sets);
  EXPECT_TRUE(result.notices.empty());
  // The set has the same places; its nodes are those of the first grid now.
  ASSERT_EQ(mesh.node_sets[0].nodes.size(), before.node_sets[0].nodes.size());
  for (const Index n : mesh.node_sets[0].nodes) EXPECT_EQ(mesh.points[n].x(), a);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(mesh.fields[0].values[3 * n + k], mesh.points[n][k]);
  for (Index h = 0; h < mesh.n_hexes(); ++h) EXPECT_EQ(corners_of(mesh, h), corners_of(before, h));
  // Ids are those that the nodes had.
  const Index n_first = (a + 1) * (b + 1) * (c + 1);
  for (Index n = 0; n < n_first; ++n) EXPECT_EQ(node_id(mesh, result.node_now[n]), node_id(before, n));
  EXPECT_EQ(boundary_sides(faces(mesh)).size(), boundary_sides(faces(before)).size() - 2 * b * c);
}

TEST(Merge, says_where_fields_differ) {
  Mesh mesh = two_grids(1, 1, 1, Vec3::Zero());
  mesh.fields[0].values[3 * 8] += 1;  // x of the first node of the second grid
  const MergeResult result = merge_nodes(mesh, 1e-6);
  ASSERT_EQ(result.notices.size(), 1U);
  EXPECT_NE(result.notices[0].find("\"place\" had other values at 1 node"), std::string::npos) << result.notices[0];
}

std::string refusal(const Mesh& mesh, double tolerance) {
  try {
    merge_nodes(mesh, tolerance);
  } catch (const Error& error) {
    return error.what();
  }
  return "not refused";
}

TEST(Merge, refuses_what_would_collapse_an_edge_or_crowd_a_face) {
  EXPECT_NE(refusal(test::grid(2, 2, 2), 1.0001).find("nodes 1 and 2 of hex 1 would become one"), std::string::npos)
      << refusal(test::grid(2, 2, 2), 1.0001);
  // A third grid in the place of the second.
  Mesh mesh = two_grids(1, 1, 1, Vec3::Zero());
  const Mesh second = mesh;
  for (Index n = 8; n < 16; ++n) mesh.points.push_back(second.points[n]);
  Hex hex = second.hexes[1];
  for (Index& n : hex) n += 8;
  mesh.hexes.push_back(hex);
  mesh.fields.clear();
  EXPECT_NE(refusal(mesh, 1e-6).find("hexes 1, 2 and 3 would share one face (nodes 2 4 6 8)"), std::string::npos)
      << refusal(mesh, 1e-6);
  // Two in one place.
  Mesh twice = test::grid(1, 1, 1);
  const Mesh one = twice;
  twice.points.insert(twice.points.end(), one.points.begin(), one.points.end());
  twice.hexes.push_back(one.hexes[0]);
  for (Index& n : twice.hexes[1]) n += 8;
  EXPECT_NE(refusal(twice, 1e-6).find("hexes 1 and 2 would have the same nodes"), std::string::npos)
      << refusal(twice, 1e-6);
}

/// Writes and reads it.
void import(Fixture& f, const Mesh& mesh) {
  const auto file = test::folder() / "parts.msh";
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(mesh.n_nodes()) + "\n";
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    text += std::to_string(n + 1) + " " + std::to_string(mesh.points[n].x()) + " " +
            std::to_string(mesh.points[n].y()) + " " + std::to_string(mesh.points[n].z()) + "\n";
  text += "$EndNodes\n$Elements\n" + std::to_string(mesh.n_hexes()) + "\n";
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    const bool second = std::ranges::binary_search(mesh.blocks[1].hexes, h);
    text += std::to_string(h + 1) + " 5 2 " + (second ? "2 2" : "1 1");
    for (const int c : {0, 1, 3, 2, 4, 5, 7, 6}) text += " " + std::to_string(mesh.hexes[h][c] + 1);
    text += "\n";
  }
  std::ofstream(file) << text << "$EndElements\n";
  f.session.run("import mesh '" + file.string() + "'");
}

TEST(Merge, joins_parts_in_a_session_and_refinement_goes_across) {
  Fixture f;
  import(f, two_grids(2, 2, 2, Vec3::Zero()));
  const Index n = f.session.meshed().mesh.n_nodes();
  f.session.run("merge all");
  EXPECT_NE(f.all_output().find("9 nodes within"), std::string::npos) << f.all_output();
  EXPECT_NE(f.all_output().find("4 pairs of faces are one now"), std::string::npos) << f.all_output();
  const MeshedModel& meshed = f.session.meshed();
  EXPECT_EQ(meshed.mesh.n_nodes(), n - 9);
  EXPECT_TRUE(test::conformal(meshed.mesh));
  EXPECT_TRUE(test::complete(meshed.mesh, meshed.association, *meshed.model));
  f.session.run("refine hex in block 1 depth 1; check");
  EXPECT_TRUE(test::conformal(f.session.meshed().mesh));
  f.session.run("undo 2");
  EXPECT_EQ(f.session.meshed().mesh.n_nodes(), n);
}

TEST(Merge, changes_nothing_where_it_refuses_and_says_where_there_is_nothing_to_do) {
  Fixture f;
  import(f, two_grids(2, 2, 2, Vec3(0, 1e-3, 0)));
  const Index n = f.session.meshed().mesh.n_nodes();
  f.session.run("merge all");
  EXPECT_NE(f.all_output().find("nothing is merged"), std::string::npos) << f.all_output();
  EXPECT_NE(f.error("merge all tolerance 1").find("would become one"), std::string::npos);
  EXPECT_EQ(f.session.meshed().mesh.n_nodes(), n);
  f.session.run("merge all tolerance 0.01");
  EXPECT_EQ(f.session.meshed().mesh.n_nodes(), n - 9);
}

TEST(Merge, keeps_to_the_entities_that_are_named_and_refuses_half_of_a_face) {
  Fixture f;
  import(f, two_grids(2, 2, 2, Vec3::Zero()));
  const Index n = f.session.meshed().mesh.n_nodes();
  f.session.run("merge block 1");  // alone it touches nothing
  EXPECT_EQ(f.session.meshed().mesh.n_nodes(), n);
  f.session.run("merge block 1 2");
  EXPECT_EQ(f.session.meshed().mesh.n_nodes(), n - 9);
}

TEST(Merge, of_cad_alone_glues_touching_solids) {
  Fixture f;
  const auto file = test::folder() / "two.step";
  test::OccShape::two_bricks().write(file);
  f.session.run("import step '" + file.string() + "'");
  EXPECT_EQ(f.session.meshed().model->count(2), 12);
  f.session.run("merge all");
  EXPECT_EQ(f.session.meshed().model->count(2), 11);
  EXPECT_NE(f.error("merge volume 1").find("'merge all'"), std::string::npos);
  f.session.run("reset");
  EXPECT_NE(f.error("merge all").find("no mesh"), std::string::npos) << f.error("merge all");
}

TEST(Merge, of_cad_closes_gaps_that_the_mesh_does_not_have) {
  const auto cad = (test::folder() / "gap.step").string(), grid = (test::folder() / "grid.msh").string();
  for (const auto& [gap, closes] : {std::pair(0.0, false), {1e-5, true}, {4e-4, true}}) {
    using test::OccShape;
    OccShape::together({OccShape::brick(2, 3, 4), OccShape::brick(3 - gap, 3, 4).moved({2 + gap, 0, 0}, 0)}).write(cad);
    Fixture f;
    f.session.run("create brick x 5 y 3 z 4 interval 5 3 4; move x 2.5 y 1.5 z 2; export mesh '" + grid +
                  "' overwrite; reset");
    f.session.run("set tolerance 1e-4; import step '" + cad + "'; import mesh '" + grid +
                  "'; check; refine surface in volume 1 depth 1; check");
    EXPECT_EQ(f.session.meshed().model->count(2), 11) << gap;
    const std::vector<int>& volumes = f.session.meshed().association.hex_volume;
    EXPECT_EQ(std::set<int>(volumes.begin(), volumes.end()), (std::set<int>{1, 2})) << gap;
    EXPECT_EQ(f.all_notices().find("between solids are closed") != std::string::npos, closes) << gap << f.all_notices();
    EXPECT_TRUE(test::conformal(f.session.meshed().mesh));
  }
}

TEST(Slivers, of_cad_that_the_mesh_does_not_have_are_merged_into_what_lies_beside) {
  using test::OccShape;
  constexpr double e = 2e-5;
  const auto prism = [](const std::vector<std::array<double, 2>>& polygon) {
    return OccShape::extruded(polygon, {0, 0, 2});
  };
  const std::vector<std::pair<const char*, OccShape>> parts = {
      {"a vertex beside a corner", OccShape::brick_with_vertex(4, 3, 2, {e, 0, 0})},
      {"a narrow face in a side", prism({{0, 0}, {4, 0}, {4, 3 - e}, {4, 3}, {0, 3}})},
      {"a narrow chamfer", prism({{0, 0}, {4, 0}, {4, 3 - e}, {4 - e, 3}, {0, 3}})},
      {"solids that are shifted",
       OccShape::together({OccShape::brick(2, 3, 2), OccShape::brick(2, 3, 2).moved({2, e, 0}, 0)})}};
  const auto grid = (test::folder() / "grid.msh").string();
  for (const auto& [name, part] : parts)
    for (const char* format : {"brep", "step"}) {
      SCOPED_TRACE(std::string(name) + " " + format);
      const auto cad = (test::folder() / (std::string("part.") + format)).string();
      part.write(cad);
      Fixture f;
      f.session.run("create brick x 4 y 3 z 2 interval 4 3 2; move x 2 y 1.5 z 1; export mesh '" + grid +
                    "' overwrite; reset");
      f.session.run("import " + std::string(format) + " '" + cad + "'; group 'some' add surface 1");
      f.session.run("import mesh '" + grid + "'; check; refine surface 2 depth 1; check");
      const MeshedModel& meshed = f.session.meshed();
      EXPECT_EQ(meshed.model->count(2), meshed.model->count(3) == 1 ? 6 : 11);
      EXPECT_NE(f.all_notices().find("as the mesh does not have them"), std::string::npos) << f.all_notices();
      EXPECT_NE(f.all_notices().find("groups are empty now"), std::string::npos) << f.all_notices();
      EXPECT_TRUE(test::conformal(meshed.mesh));
      EXPECT_TRUE(test::on_model(meshed.mesh, meshed.association, *meshed.model, 2e-5));
    }
}

}  // namespace
}  // namespace hextwist
