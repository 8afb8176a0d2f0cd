// Commands on meshes with elements beside the hexes.
#include "support/others.h"

#include <sstream>

#include "hextwist/io/io.h"
#include "hextwist/patch/patch.h"
#include "session/session_fixture.h"
#include "support/checkers.h"

namespace hextwist {
namespace {

using Fixture = test::Fixture;

/// n x n x n cubes with shells on z = n, a beam along the edge x = y = 0, a wedge on a face at x = n, and masses.
std::string mixed(int n) {
  std::ostringstream out;
  const int m = n + 1;
  const auto node = [&](int i, int j, int k) { return 1 + i + m * (j + m * k); };
  out << "*NODE\n";
  for (int k = 0; k < m; ++k)
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i) out << node(i, j, k) << ", " << i << ", " << j << ", " << k << '\n';
  const int tip = m * m * m + 1;
  out << tip << ", " << n + 1 << ", 0, 0.5\n" << tip + 1 << ", " << n + 1 << ", 1, 0.5\n" << tip + 7 << ", 0, 0, -2\n";
  out << "*ELEMENT, TYPE=C3D8, ELSET=cubes\n";
  int id = 0;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        out << ++id << ", " << node(i, j, k) << ", " << node(i + 1, j, k) << ", " << node(i + 1, j + 1, k) << ", "
            << node(i, j + 1, k) << ", " << node(i, j, k + 1) << ", " << node(i + 1, j, k + 1) << ", "
            << node(i + 1, j + 1, k + 1) << ", " << node(i, j + 1, k + 1) << '\n';
  out << "*ELEMENT, TYPE=S4, ELSET=lid\n";
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      out << ++id << ", " << node(i, j, n) << ", " << node(i + 1, j, n) << ", " << node(i + 1, j + 1, n) << ", "
          << node(i, j + 1, n) << '\n';
  out << "*ELEMENT, TYPE=B31, ELSET=beam\n";
  for (int k = 0; k < n; ++k) out << ++id << ", " << node(0, 0, k) << ", " << node(0, 0, k + 1) << '\n';
  out << "*ELEMENT, TYPE=C3D6, ELSET=glue\n"
      << ++id << ", " << node(n, 0, 0) << ", " << node(n, 0, 1) << ", " << tip << ", " << node(n, 1, 0) << ", "
      << node(n, 1, 1) << ", " << tip + 1 << '\n';
  ++id;
  out << "*ELEMENT, TYPE=MASS, ELSET=lump\n"
      << id << ", " << node(n, n, n) << "\n"
      << id + 1 << ", " << tip + 7 << "\n";
  out << "*SHELL SECTION, ELSET=lid, MATERIAL=m\n0.1\n*SURFACE, NAME=pressed\nlid, SPOS\n";
  return out.str();
}

const Mesh& mesh_of(const Fixture& f) {
  return f.session.meshed().mesh;
}
std::int64_t n_of(const Mesh& mesh, const std::string& type) {
  std::int64_t n = 0;
  for (Index e = 0; e < n_others(mesh); ++e) n += mesh.others->type_of(e).name == type;
  return n;
}

TEST(SessionOthers, commands_keep_them_cut_along_refuse_and_stop) {
  Fixture f;
  f.session.import_mesh(test::written("in.inp", mixed(3)));
  const Mesh before = mesh_of(f);
  EXPECT_NE(f.all_output().find("beside them 9 quads (S4), 3 lines (B31), 1 wedge (C3D6), 2 points (MASS)"),
            std::string::npos)
      << f.all_output();
  EXPECT_TRUE(f.notices.empty()) << f.notices.front();
  f.session.run("list");
  EXPECT_NE(f.all_output().find("other elements: 9 quads"), std::string::npos);
  f.session.run("check");
  EXPECT_NE(f.all_output().find("other elements, which are not checked: 9 quads"), std::string::npos);

  // Cut along: a hex at the lid and the beam.
  f.session.run("refine hex 19");
  EXPECT_EQ(n_of(mesh_of(f), "S4"), 9 - 3 + 9 + 2 * 4);  // itself and two neighbours; those at a corner stay
  EXPECT_EQ(n_of(mesh_of(f), "B31"), 3 + 2);
  EXPECT_TRUE(test::others_kept(before, mesh_of(f)));
  EXPECT_TRUE(test::others_conformal(before, mesh_of(f)));
  const auto out = test::folder() / "out.inp";
  f.session.run("export abaqus '" + out.string() + "' overwrite");
  {
    Fixture again;
    again.session.import_mesh(out);
    EXPECT_EQ(n_of(mesh_of(again), "S4"), n_of(mesh_of(f), "S4"));
    EXPECT_EQ(n_of(mesh_of(again), "C3D6"), 1);
    EXPECT_TRUE(again.notices.empty()) << again.notices.front();
    const auto lid = std::ranges::find(mesh_of(again).blocks, "lid", &Block::name);
    ASSERT_NE(lid, mesh_of(again).blocks.end());
    const auto& sets = mesh_of(again).others->heads->sets;
    EXPECT_EQ(std::ranges::find(sets, lid->id, &OtherSet::id)->elements.size(), 23u);
    EXPECT_EQ(mesh_of(again).others->heads->sides.at(0).elements.size(), 23u);
    const Mesh read = mesh_of(again);
    again.session.run("refine hex 21");
    EXPECT_TRUE(test::others_kept(read, mesh_of(again)));
    EXPECT_TRUE(test::others_conformal(read, mesh_of(again)));
  }
  f.session.run("undo");
  EXPECT_EQ(mesh_of(f), before);
  f.session.run("redo; coarsen hex all");
  EXPECT_EQ(mesh_of(f).others, before.others);
  EXPECT_EQ(mesh_of(f).hexes, before.hexes);

  // In the way: the wedge at hex 3.
  const std::string refused = f.error("refine hex 3");
  EXPECT_NE(refused.find("hex 3 would be cut at the edge between nodes "), std::string::npos) << refused;
  EXPECT_NE(refused.find("wedge 40 (C3D6, block 'glue') shares"), std::string::npos) << refused;
  EXPECT_EQ(mesh_of(f).hexes, before.hexes);
  EXPECT_NE(f.error("refine hex 3 stop_at other")
                .find("'stop_at other' leaves nothing to refine: 1 hex lies within 1 "
                      "layer of hexes"),
            std::string::npos);
  EXPECT_NE(f.error("refine volume all numsplit 1 stop_at other").find("all volumes together are cut evenly"),
            std::string::npos);
  f.notices.clear();
  f.session.run("refine hex 1 to 27 stop_at other");
  ASSERT_FALSE(f.notices.empty());
  EXPECT_EQ(
      f.notices.front(),
      "'stop_at other': 4 of 27 hexes left out, which lie within 1 layer of hexes from elements that are not cut");
  EXPECT_TRUE(test::others_kept(before, mesh_of(f)));
  EXPECT_TRUE(test::others_conformal(before, mesh_of(f)));
  f.notices.clear();
  f.session.run("undo; refine hex 1 2 3 numsplit 2 stop_at other");
  ASSERT_FALSE(f.notices.empty());
  EXPECT_EQ(
      f.notices.front(),
      "'stop_at other': 2 of 3 hexes left out, which lie within 2 layers of hexes from elements that are not cut");
  EXPECT_TRUE(test::others_conformal(before, mesh_of(f)));
  f.session.run("undo; refine surface all stop_at other");
  EXPECT_TRUE(test::others_conformal(before, mesh_of(f)));
  EXPECT_GT(mesh_of(f).n_hexes(), 27);

  // Nodes of theirs stay.
  f.session.run("undo; smooth volume all");
  EXPECT_TRUE(test::others_kept(before, mesh_of(f)));
  EXPECT_NE(f.error("reflect model x").find("other elements can't be reflected"), std::string::npos);
  f.session.run("move 2 0 0");
  EXPECT_EQ(mesh_of(f).points.back(), Vec3(2, 0, -2));
}

TEST(SessionOthers, patches_make_what_the_whole_makes) {
  const PatchRule rule = patch_rule;
  const auto file = test::written("in.inp", mixed(10));
  Mesh result[2];
  for (const bool patches : {false, true}) {
    patch_rule = patches ? PatchRule{1, 1} : PatchRule{1'000'000'000, 8};
    Fixture f;
    f.session.import_mesh(file);
    f.session.run(
        "refine hex 555; coarsen hex in block cubes; refine hex 555; refine hex 1; refine hex 558 numsplit 2; refine "
        "hex 991");
    EXPECT_TRUE(test::conformal(mesh_of(f), test::UnusedNodes::allowed));
    result[patches] = mesh_of(f);
  }
  patch_rule = rule;
  EXPECT_EQ(result[0].hexes, result[1].hexes);
  EXPECT_EQ(result[0].hex_ids, result[1].hex_ids);
  EXPECT_EQ(result[0].points, result[1].points);
  ASSERT_TRUE(result[0].others && result[1].others);
  EXPECT_EQ(result[0].others->nodes, result[1].others->nodes);
  EXPECT_EQ(result[0].others->of, result[1].others->of);
  EXPECT_GT(n_of(result[0], "S4"), 100);
}

}  // namespace
}  // namespace hextwist
