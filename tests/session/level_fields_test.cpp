// What levels in a session do to fields and groups.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/interpolation.h"
#include "session_fixture.h"
#include "support/seed.h"

namespace hextwist {
namespace {

using test::Fixture;

const Mesh& mesh_of(const Fixture& f) {
  return f.session.meshed().mesh;
}

/// Pieces of transitions are skew: the hex that holds a place need not be behind the face that looks nearest.
TEST(SessionLevels, nodal_fields_are_those_of_the_hex_that_holds_the_place) {
  const unsigned seed = test::random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  Fixture f;
  f.session.run("create brick x 4 interval 4");
  Mesh mesh = mesh_of(f);
  Field field{"any", Field::On::node, 1, {}};
  for (std::size_t n = 0; n < mesh.points.size(); ++n) field.values.push_back(static_cast<double>(random() % 1000));
  mesh.fields = {field};
  f.session.take(mesh, nullptr);
  std::size_t n_looked_at = 0;
  for (int step = 0; step < 20; ++step) {
    const Mesh before = mesh_of(f);
    std::vector<std::int8_t> changes(before.hexes.size(), 0);
    for (std::int8_t& change : changes)
      if (const auto dice = random() % 40; dice < 12) change = dice == 0 && before.n_hexes() < 5000 ? 1 : -1;
    f.session.adapt(changes);
    const Mesh& now = mesh_of(f);
    std::vector<Index> fresh;
    for (Index n = 0; n < now.n_nodes(); ++n) {
      const Index old = find_node(before, node_id(now, n));
      if (old < 0) {
        fresh.push_back(n);
      } else if (before.points[old] == now.points[n]) {
        ASSERT_EQ(before.fields[0].values[old], now.fields[0].values[n]);
      }
    }
    const std::vector<double> expected =
        values_at(before, before.fields[0], interpolation_at(before, items_at(now.points, fresh)));
    for (std::size_t i = 0; i < fresh.size(); ++i)
      ASSERT_NEAR(now.fields[0].values[fresh[i]], expected[i], 1e-6) << "step " << step << ", node " << fresh[i];
    n_looked_at += fresh.size();
  }
  EXPECT_GT(n_looked_at, 1000u);
}

TEST(SessionLevels, whole_numbers_that_are_shared_out_stay_whole) {
  std::mt19937 random(test::random_seed());
  Fixture f;
  f.session.run("create brick x 3 interval 3");
  Mesh mesh = mesh_of(f);
  Field number{"particles", Field::On::hex, 1, {}, true};
  for (std::size_t h = 0; h < mesh.hexes.size(); ++h) number.values.push_back(static_cast<double>(random() % 200));
  const double sum = std::accumulate(number.values.begin(), number.values.end(), 0.0);
  mesh.fields = {number};
  f.session.take(mesh, nullptr);
  for (int step = 0; step < 8; ++step) {
    std::vector<std::int8_t> changes(mesh_of(f).hexes.size());
    for (std::int8_t& change : changes) change = random() % 30 == 0 ? 1 : random() % 3 ? -1 : 0;
    f.session.adapt(changes, {.extensive = {"particles"}});
    const Field& now = mesh_of(f).fields[0];
    EXPECT_TRUE(now.integer);
    for (const double value : now.values) ASSERT_TRUE(value >= 0 && value == std::floor(value)) << value;
    EXPECT_EQ(std::accumulate(now.values.begin(), now.values.end(), 0.0), sum);
  }
}

TEST(SessionLevels, groups_that_are_not_in_the_file_of_levels_are_named) {
  const std::string file = (test::folder() / "groups.levels").string();
  Fixture f;
  f.session.run("create brick x 3 interval 3; nodeset 1 surface 1; refine hex 3; export levels \"" + file + "\"");
  f.session.run("import levels \"" + file + "\"");
  EXPECT_TRUE(f.notices.empty());
  f.session.run("nodeset 9 surface 2 name \"clamp\"; nodeset 1 surface 3; sideset 8 surface 4; import levels \"" +
                file + "\"");
  ASSERT_FALSE(f.notices.empty());
  EXPECT_EQ(
      f.notices.back(),
      file + ": blocks and sets are those of the levels; the mesh had others: nodeset 1, nodeset 9 'clamp', sideset 8");
}

TEST(SessionLevels, a_field_called_level_is_said_to_be_ours) {
  Fixture f;
  f.session.run("create brick x 3 interval 3");
  Mesh mesh = mesh_of(f);
  mesh.fields = {{"level", Field::On::hex, 1, std::vector<double>(mesh.hexes.size(), 0)}};
  f.session.take(mesh, nullptr);
  EXPECT_TRUE(f.notices.empty());
  mesh.fields[0].values[4] = 70;
  f.session.take(mesh, nullptr);
  ASSERT_EQ(f.notices.size(), 1u);
  EXPECT_NE(f.notices[0].find("the hex field 'level' is how often hexes were cut"), std::string::npos);
}

}  // namespace
}  // namespace hextwist
