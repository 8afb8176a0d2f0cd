// Sessions with meshes of second order: what files have, and the shape of a mesh without CAD.
#include <numbers>

#include "hextwist/io/io.h"
#include "hextwist/mesh/second_order/second_order.h"
#include "session/session_fixture.h"
#include "support/grids.h"

namespace hextwist {
namespace {

class SecondOrderSession : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::current_path(test::output_folder()); }
  void TearDown() override { std::filesystem::current_path(before_); }
  static int nodes_in(const char* file) { return read_mesh(file).middles.nodes_per_hex; }
  std::filesystem::path before_ = std::filesystem::current_path();
};

TEST_F(SecondOrderSession, order_is_said_of_a_file_of_all_files_or_of_blocks) {
  test::Fixture f;
  f.session.run("create cylinder height 2 radius 1; export vtk \"a.vtu\"; export vtk \"b.vtu\" order 2");
  EXPECT_EQ(nodes_in("a.vtu"), 8);
  EXPECT_EQ(nodes_in("b.vtu"), 20);
  f.session.run("set order 2; export exodus \"c.e\"; export exodus \"d.e\" order 1");
  EXPECT_EQ(nodes_in("c.e"), 20);
  EXPECT_EQ(nodes_in("d.e"), 8);
  f.session.run("block 1 volume 1; block 1 element type hex27; export gmsh \"e.msh\"");
  EXPECT_EQ(nodes_in("e.msh"), 27);
  f.session.run(
      "set order 1; export gmsh \"f.msh\"; set order 2; undo; export gmsh \"g.msh\"; redo; export gmsh \"h.msh\"");
  EXPECT_EQ(nodes_in("f.msh"), 8);
  EXPECT_EQ(nodes_in("g.msh"), 20);
  EXPECT_EQ(nodes_in("h.msh"), 27);
  EXPECT_EQ(f.error("export gmsh \"i.msh\" order 3").substr(0, 5), "order");
  EXPECT_EQ(f.error("block 7 element type hex20"), "there is no block 7");
  EXPECT_EQ(f.error("export openfoam \"h.foam\" order 2"),
            "h.foam: .foam files have no middle nodes here: export with order 1");
}

TEST_F(SecondOrderSession, blocks_of_two_orders_are_refused_where_they_are_written) {
  test::Fixture f;
  f.session.run("create brick x 2 interval 2 1 1; block 11 hex 1; block 2 hex 2; block 11 element type hex20");
  EXPECT_NE(f.error("export vtk \"a.vtu\"").find("hex 1 has 20 nodes and hex 2 8"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists("a.vtu"));
  f.session.run("block 2 element type hex20; export vtk \"a.vtu\"");
  EXPECT_EQ(nodes_in("a.vtu"), 20);
}

/// From the sphere on its CAD to a file without CAD, refined there, moved, and away and back as levels.
TEST_F(SecondOrderSession, a_curved_mesh_without_cad_keeps_its_shape_through_everything) {
  {
    test::Fixture f;
    f.session.run("create sphere radius 1 interval 4; export vtk \"ball.vtu\" order 2");
  }
  test::Fixture f;
  f.session.run("import mesh \"ball.vtu\"");
  const auto off_sphere = [&](double radius, const Vec3& centre) {
    double most = 0;
    const MeshedModel& meshed = f.session.meshed();
    for (Index n = 0; n < meshed.mesh.n_nodes(); ++n)
      if (meshed.association.node_owner[n].dim < 3)
        most = std::max(most, std::abs((meshed.mesh.points[n] - centre).norm() - radius));
    return most;
  };
  const double ball = 4 * std::numbers::pi / 3;
  EXPECT_NEAR(f.session.meshed().model->measure({3, 1}), ball, 0.002 * ball);
  f.session.run("refine hex in surface 1; check");
  EXPECT_LT(off_sphere(1, Vec3::Zero()), 0.002);  // chords are off by 0.03
  f.session.run("export levels \"ball.levels\"");
  f.session.run("smooth volume 1; check");
  EXPECT_LT(off_sphere(1, Vec3::Zero()), 0.002);
  f.session.run("scale 3; move volume 1 x 5; check");
  EXPECT_LT(off_sphere(3, Vec3(5, 0, 0)), 0.006);
  EXPECT_EQ(f.session.meshed().model->type({2, 1}), "quadratic facets");
  // The file that it came from says of which order it is.
  f.session.run("export vtk \"fine.vtu\"");
  EXPECT_EQ(nodes_in("fine.vtu"), 20);

  f.session.run("reset; import levels \"ball.levels\"; check");
  EXPECT_LT(off_sphere(1, Vec3::Zero()), 0.002);
  f.session.run("coarsen hex all; refine hex 5; check");
}

TEST_F(SecondOrderSession, what_was_straightened_is_a_note) {
  // A slab whose upper side dips through the lower one, halfway along the edges of its middle hex.
  Mesh mesh = test::grid(3, 1, 1, Vec3(10, 10, 1));
  MiddleNodes middles;
  for (const Edge& edge : edges(mesh).nodes) {
    const Vec3 a = mesh.points[edge[0]], b = mesh.points[edge[1]];
    Vec3 middle = (a + b) / 2;
    if (a.z() > 0.5 && b.z() > 0.5 && std::abs(middle.x() - 15) < 0.1) middle.z() -= 2;
    middles.edges.push_back(edge);
    middles.edge_points.push_back(middle);
  }
  const FacetResult skin = associate_with_own_skin(mesh, {.middles = &middles});
  test::Fixture f;
  f.session.take({mesh, skin.model, skin.association}, false);
  f.session.run("export vtk \"slab.vtu\" order 2");
  ASSERT_EQ(f.notices.size(), 1U);
  EXPECT_EQ(f.notices[0].find("1 hex was straightened"), 0U) << f.notices[0];
  EXPECT_EQ(nodes_in("slab.vtu"), 20);
}

}  // namespace
}  // namespace hextwist
