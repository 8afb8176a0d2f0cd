// Nodal fields through commands that move nodes, and through files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "hextwist/io/io.h"
#include "hextwist/io/results.h"
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

/// A grid with T = t x at three times, written as Exodus.
std::filesystem::path with_times() {
  Mesh mesh = test::grid(4, 2, 2);
  auto extras = std::make_shared<FileResults>();
  extras->mesh = std::make_shared<const Mesh>(mesh);
  extras->times = {0, 1, 2.5};
  extras->step = 2;
  extras->on_nodes = {{"T", {}}};
  for (const double time : extras->times) {
    std::vector<double> values;
    for (const Vec3& p : mesh.points) values.push_back(time * p.x());
    extras->on_nodes[0].at.push_back(std::make_shared<const std::vector<double>>(values));
  }
  mesh.fields = {{"T", Field::On::node, 1, *extras->on_nodes[0].at[2]}};
  mesh.results = extras;
  for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.file_hexes.push_back(h);
  const auto file = folder() / "in.e";
  write_mesh(file, mesh, nullptr);
  return file;
}

TEST(Fields, of_all_time_steps_go_from_file_to_file_and_one_is_chosen) {
  const auto file = with_times(), out = folder() / "out.e";
  const auto expect_time = [](const Mesh& mesh, double time) {
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      ASSERT_NEAR(mesh.fields.at(0).values[n], time * mesh.points[n].x(), 1e-12);
  };
  Fixture f;
  f.session.run("import exodus \"" + file.string() + "\"; refine hex 1; smooth volume all");
  EXPECT_NE(f.notices.at(0).find("3 time steps (0 to 2.5; fields are those of step 3)"), std::string::npos);
  expect_time(f.session.meshed().mesh, 2.5);
  f.session.run("step 2");
  expect_time(f.session.meshed().mesh, 1);
  f.session.run("step time 0.2");
  expect_time(f.session.meshed().mesh, 0);
  f.session.run("undo");
  expect_time(f.session.meshed().mesh, 1);
  f.session.run("refine hex 4; step last");
  expect_time(f.session.meshed().mesh, 2.5);
  f.session.run("step 1; export exodus \"" + out.string() + "\"");
  const Mesh back = read_mesh(out).mesh;
  EXPECT_EQ(back.results->times, (std::vector<double>{0, 1, 2.5}));
  for (std::size_t t = 0; t < 3; ++t)
    for (Index n = 0; n < back.n_nodes(); ++n)
      ASSERT_NEAR((*back.results->on_nodes[0].at[t])[n], back.results->times[t] * back.points[n].x(), 1e-12);
  EXPECT_EQ(f.error("step 4"), "there are 3 time steps");
  f.session.run("create brick x 1 interval 1");
  EXPECT_EQ(f.error("step 1"), "the mesh has come with no more than one time step");
}

TEST(Fields, of_another_time_leave_the_levels_as_they_are) {
  Fixture f, coarse;
  f.session.run("import exodus \"" + with_times().string() + "\"; refine hex 1; step 2; coarsen hex all");
  coarse.session.run("import exodus \"" + with_times().string() + "\"; step 2");
  const Mesh &back = f.session.meshed().mesh, &wanted = coarse.session.meshed().mesh;
  EXPECT_EQ(back.hexes, wanted.hexes);
  EXPECT_EQ(back.fields, wanted.fields);
  EXPECT_EQ(back.results->step, 1u);
}

TEST(Fields, of_a_patch_find_their_time_steps_too) {
  Mesh mesh = test::grid(30, 30, 30);
  auto extras = std::make_shared<FileResults>();
  extras->mesh = std::make_shared<const Mesh>(mesh);
  extras->times = {1, 2};
  extras->step = 1;
  std::vector<double> values;
  for (Index h = 0; h < mesh.n_hexes(); ++h) values.push_back(h);
  extras->on_hexes = {
      {"number",
       {std::make_shared<const std::vector<double>>(values), std::make_shared<const std::vector<double>>(values)}}};
  mesh.fields = {{"number", Field::On::hex, 1, values}};
  mesh.results = extras;
  for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.file_hexes.push_back(h);
  Fixture f;
  f.session.take_mesh(mesh);
  f.session.run("refine hex 13000; refine hex 20000 5000; undo; redo; step 1");
  const Mesh& now = f.session.meshed().mesh;
  ASSERT_EQ(now.file_hexes.size(), now.hexes.size());
  for (Index h = 0; h < now.n_hexes(); ++h) ASSERT_EQ(now.fields[0].values[h], now.file_hexes[h]);
}

/// ParaView's filters and error estimators leave such pairs.
TEST(Fields, of_hexes_come_first_where_nodes_have_one_of_that_name) {
  test::Fixture f;
  f.session.run("create brick x 3 interval 3");
  Mesh mesh = f.session.meshed().mesh;
  Field of_nodes{"error", Field::On::node, 1, {}}, of_hexes{"error", Field::On::hex, 1, {}};
  for (const Vec3& p : mesh.points) of_nodes.values.push_back(-p.x());
  for (Index h = 0; h < mesh.n_hexes(); ++h) of_hexes.values.push_back(h);
  Field vector{"v", Field::On::node, 3, std::vector<double>(3 * mesh.points.size(), 1)};
  mesh.fields = {of_nodes, of_hexes, vector};
  f.session.take(mesh, nullptr);
  EXPECT_EQ(f.session.ids("hex", "in field \"error\" top 10 %"), (std::vector<std::int64_t>{25, 26, 27}));
  EXPECT_EQ(f.session.ids("node", "in field \"error\" above 0").size(), 32u);
  EXPECT_EQ(f.session.ids("hex", "in field \"v_x\" above 0").size(), 27u);
}

}  // namespace
}  // namespace hextwist
