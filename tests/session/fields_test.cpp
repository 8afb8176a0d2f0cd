// Nodal fields through commands that move nodes, and through files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "hextwist/io/io.h"
#include "session/session_fixture.h"

namespace hextwist {

using test::Fixture, test::folder;

namespace {

double linear(const Vec3& p) {
  return 4 - p.x() + 2 * p.y() + p.z() / 3;
}
Mesh with_linear(Mesh mesh) {
  Field field{"f", Field::On::node, 1, {}};
  for (const Vec3& p : mesh.points) field.values.push_back(linear(p));
  mesh.fields = {std::move(field)};
  return mesh;
}
testing::AssertionResult is_linear(const Mesh& mesh) {
  const auto [low, high] = std::ranges::minmax(mesh.fields.at(0).values);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (std::abs(mesh.fields[0].values[n] - linear(mesh.points[n])) > 1e-9 * (high - low))
      return testing::AssertionFailure() << "node " << node_id(mesh, n) << ": " << mesh.fields[0].values[n];
  return testing::AssertionSuccess();
}

TEST(Fields, follow_their_nodes_through_all_that_moves_them) {
  const std::string models = std::string(HEXTWIST_SOURCE_DIR) + "/models/";
  for (const char* name : {"l_block", "inclusion", "cylinder"}) {
    Fixture f;
    f.session.run("import brep \"" + models + name + ".brep\"; import gmsh \"" + models + name + ".msh\"");
    const Mesh mesh = with_linear(f.session.meshed().mesh);
    for (const char* command : {"smooth volume all", "smooth volume all scheme laplacian", "refine vertex 1 depth 1",
                                "refine vertex 1 depth 1 smooth", "refine surface 1 depth 1 smooth",
                                "refine curve 1; refine curve 1; smooth surface all", "refine volume all numsplit 2"}) {
      f.session.take_mesh(mesh);
      f.session.run(command);
      EXPECT_TRUE(is_linear(f.session.meshed().mesh)) << name << ": " << command;
    }
    f.session.take_mesh(mesh);
    std::vector<std::uint8_t> flags(mesh.hexes.size(), 0);
    flags[5] = 1;
    f.session.adapt(flags, {.smooth = true});
    EXPECT_TRUE(is_linear(f.session.meshed().mesh)) << name << ": adapt";
  }
}

TEST(Fields, follow_nodes_that_untangling_moves) {
  Mesh mesh = test::grid(4, 4, 4);
  mesh.points[62] += Vec3(1.3, 0.2, 0.1);
  Fixture f;
  f.session.take_mesh(with_linear(mesh));
  EXPECT_FALSE(f.session.meshed().mesh.points == mesh.points);
  EXPECT_TRUE(is_linear(f.session.meshed().mesh));
}

TEST(Fields, of_whole_numbers_stay_so_in_files) {
  Mesh mesh = test::grid(3, 3, 3);
  Field kind{"kind", Field::On::node, 1, {}, true}, part{"part", Field::On::hex, 1, {}, true};
  for (Index n = 0; n < mesh.n_nodes(); ++n) kind.values.push_back(n % 7 - 2);
  for (Index h = 0; h < mesh.n_hexes(); ++h) part.values.push_back(h);
  mesh.fields = {kind, part};
  const auto file = folder() / "in.vtu", out = folder() / "out.vtu";
  write_mesh(file, mesh, nullptr);
  EXPECT_EQ(read_mesh(file).mesh.fields, mesh.fields);
  Fixture f;
  f.session.run("import mesh \"" + file.string() + "\"; refine hex 14; export mesh \"" + out.string() + "\"");
  const Mesh back = read_mesh(out).mesh;
  EXPECT_TRUE(back.fields[0].integer && back.fields[1].integer);
  for (const double value : back.fields[0].values) EXPECT_EQ(value, std::round(value));
}

}  // namespace
}  // namespace hextwist
