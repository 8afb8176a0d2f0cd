// What files have at other times and on sets, and fields whose sum stays, through levels and passes.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "hextwist/io/io.h"
#include "hextwist/io/results.h"
#include "hextwist/mesh/quality/quality.h"
#include "session_fixture.h"
#include "support/exodus_extras.h"

namespace hextwist {
namespace {

using test::Fixture;

void expect_near(const std::vector<TimedValues>& is, const std::vector<TimedValues>& should, const std::string& of) {
  ASSERT_EQ(is.size(), should.size()) << of;
  for (std::size_t i = 0; i < is.size(); ++i) {
    ASSERT_EQ(is[i].name, should[i].name) << of;
    ASSERT_EQ(is[i].at.size(), should[i].at.size()) << of << ' ' << is[i].name;
    for (std::size_t t = 0; t < is[i].at.size(); ++t) {
      ASSERT_EQ(is[i].at[t]->size(), should[i].at[t]->size()) << of << ' ' << is[i].name;
      for (std::size_t k = 0; k < is[i].at[t]->size(); ++k) {
        const double now = (*is[i].at[t])[k], then = (*should[i].at[t])[k];
        if (std::isnan(now) && std::isnan(then)) continue;
        EXPECT_NEAR(now, then, 1e-9) << of << ' ' << is[i].name << ", time " << t << ", " << k;
      }
    }
  }
}
void expect_near(const std::vector<SetExtras>& is, const std::vector<SetExtras>& should, const std::string& of) {
  ASSERT_EQ(is.size(), should.size()) << of;
  for (std::size_t i = 0; i < is.size(); ++i) {
    const std::string set = of + " " + std::to_string(should[i].id);
    EXPECT_EQ(is[i].nodes, should[i].nodes) << set;
    EXPECT_EQ(is[i].sides, should[i].sides) << set;
    ASSERT_EQ(is[i].factors.size(), should[i].factors.size()) << set;
    for (std::size_t k = 0; k < is[i].factors.size(); ++k)
      EXPECT_NEAR(is[i].factors[k], should[i].factors[k], 1e-9) << set;
    expect_near(is[i].variables, should[i].variables, set);
  }
}

/// A solver that is a program of its own: refined, written with levels, read again elsewhere, coarsened.
TEST(Transfer, all_that_a_file_has_comes_back_through_levels_that_were_read) {
  const auto folder = test::folder();
  const auto file = [&](const char* name) { return (folder / name).string(); };
  write_mesh(folder / "begin.e", test::with_extras(), nullptr, {.overwrite = true});
  {
    Fixture f;
    f.session.run("import exodus '" + file("begin.e") + "'; refine hex 6; refine hex in vertex 1; export exodus '" +
                  file("fine.e") + "' overwrite; export levels '" + file("fine.levels") + "' overwrite");
  }
  Fixture f;
  f.session.run("import exodus '" + file("fine.e") + "'; group 'some' add hex all; import levels '" +
                file("fine.levels") + "'");
  const Mesh fine = f.session.meshed().mesh;
  ASSERT_TRUE(fine.results);
  EXPECT_EQ(fine.results->times.size(), 3u);
  EXPECT_EQ(std::ssize(f.session.ids("hex", "in group some")), fine.n_hexes());
  // Transitions are made anew: some of their hexes come of several.
  f.session.run("refine hex in vertex 8; coarsen hex all levels 2; export exodus '" + file("end.e") + "' overwrite");
  const Mesh begin = read_mesh(folder / "begin.e").mesh, end = read_mesh(folder / "end.e").mesh;
  EXPECT_EQ(begin.hexes, end.hexes);
  EXPECT_EQ(begin.points, end.points);
  ASSERT_TRUE(end.results);
  const FileResults &is = *end.results, &should = *begin.results;
  EXPECT_EQ(is.times, should.times);
  expect_near(is.on_nodes, should.on_nodes, "nodes");
  expect_near(is.on_hexes, should.on_hexes, "hexes");
  expect_near(is.of_all, should.of_all, "all");
  expect_near(is.attributes, should.attributes, "attributes");
  expect_near(is.node_sets, should.node_sets, "nodeset");
  expect_near(is.side_sets, should.side_sets, "sideset");
}

/// Averages, of several pieces each with a value of its own, at a time that fields are not of.
TEST(Transfer, hexes_made_of_several_have_their_average_at_all_times) {
  const auto folder = test::folder();
  const auto file = [&](const char* name) { return (folder / name).string(); };
  Fixture first;
  first.session.run("create brick x 2 interval 2; export exodus '" + file("cubes.e") +
                    "' overwrite; reset; import exodus '" + file("cubes.e") + "'; refine hex 1 2; export levels '" +
                    file("cubes.levels") + "' overwrite");
  Mesh mesh = first.session.meshed().mesh;
  auto results = std::make_shared<FileResults>();
  results->times = {0, 1};
  results->step = 1;
  TimedValues e{"e", {}};
  for (const double time : results->times) {
    std::vector<double> values;
    for (Index h = 0; h < mesh.n_hexes(); ++h) values.push_back((1 + time) * h * h);
    e.at.push_back(test::list(values));
  }
  results->on_hexes = {e};
  mesh.fields = {{"e", Field::On::hex, 1, *e.at[1]}};
  place_in_itself(mesh, *results);
  mesh.results = results;
  write_mesh(folder / "fine_cubes.e", mesh, nullptr, {.overwrite = true});
  const std::vector<double> volumes = quality(Metric::volume, mesh);

  for (const char* sum : {"", " sum 'e'"}) {
    SCOPED_TRACE(sum);
    Fixture f;
    f.session.run("import exodus '" + file("fine_cubes.e") + "'; import levels '" + file("cubes.levels") +
                  "'; coarsen hex all" + sum + "; export exodus '" + file("coarse.e") + "' overwrite");
    const Mesh coarse = read_mesh(folder / "coarse.e").mesh;
    ASSERT_EQ(coarse.n_hexes(), 8);
    double all = 0, weighted = 0;
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      all += (*e.at[0])[h];
      weighted += volumes[h] * (*e.at[0])[h];
    }
    const std::vector<double>& now = *coarse.results->on_hexes.at(0).at.at(0);
    double sum_now = 0;
    for (const double value : now) sum_now += value;
    // All cells are cubes of one volume.
    EXPECT_NEAR(sum_now, *sum ? all : weighted / quality(Metric::volume, coarse)[0], 1e-9 * all);
    // At the moment of the fields it is what they are.
    for (Index h = 0; h < 8; ++h) EXPECT_NEAR(coarse.fields.at(0).values[h], 2 * now[h], 1e-9 * std::abs(now[h]));
  }
}

TEST(Transfer, a_sum_stays_by_every_technique_and_at_all_times) {
  const auto folder = test::folder();
  Fixture begin;
  begin.session.run("create brick x 6 interval 6");
  Mesh mesh = begin.session.meshed().mesh;
  auto results = std::make_shared<FileResults>();
  results->times = {0, 1};
  results->step = 1;
  TimedValues mass{"mass", {}};
  std::vector<double> values(mesh.hexes.size());
  std::iota(values.begin(), values.end(), 1);
  mass.at.push_back(test::list(values));
  for (double& value : values) value *= 3;
  mass.at.push_back(test::list(values));
  results->on_hexes = {mass};
  mesh.fields = {{"mass", Field::On::hex, 1, values},
                 {"count", Field::On::hex, 1, std::vector<double>(mesh.hexes.size(), 5), true},
                 {"density", Field::On::hex, 1, std::vector<double>(mesh.hexes.size(), 2)}};
  place_in_itself(mesh, *results);
  mesh.results = results;
  const double first = std::accumulate(mass.at[0]->begin(), mass.at[0]->end(), 0.0);
  for (const char* command :
       {"refine hex 100", "refine hex 100 transition nested", "refine hex 100 numsplit 2", "refine curve 1",
        "refine surface 1 method parallel", "refine volume all numsplit 1", "refine surface 2 direction thickness",
        "refine surface 2 direction layers 3", "refine vertex 1 size 0.2 bias 1.3", "refine curve 2 size 0.3",
        "refine sheet edge 1", "refine hex 100 to 130 method parallel", "refine hex 3 smooth"}) {
    SCOPED_TRACE(command);
    Fixture f;
    f.session.take(mesh, nullptr);
    const std::string with_sum = std::string(command) + " sum 'mass' 'count'";
    f.session.run(with_sum);
    const Mesh& now = f.session.meshed().mesh;
    ASSERT_GT(now.n_hexes(), mesh.n_hexes());
    const auto total = [&](std::size_t field) {
      return std::accumulate(now.fields[field].values.begin(), now.fields[field].values.end(), 0.0);
    };
    EXPECT_NEAR(total(0), 3 * first, 1e-9 * first);
    EXPECT_EQ(total(1), 5.0 * mesh.n_hexes());
    EXPECT_EQ(total(2), 2.0 * now.n_hexes());
    f.session.run("export exodus '" + (folder / "sum.e").string() + "' overwrite");
    const Mesh written = read_mesh(folder / "sum.e").mesh;
    for (std::size_t t = 0; t < 2; ++t) {
      const std::vector<double>& at = *written.results->on_hexes.at(0).at.at(t);
      EXPECT_NEAR(std::accumulate(at.begin(), at.end(), 0.0), t == 0 ? first : 3 * first, 1e-9 * first) << "time " << t;
    }
  }
  Fixture f;
  f.session.take(mesh, nullptr);
  EXPECT_EQ(f.error("refine hex 1 sum 'weight'"), "there is no field 'weight' of hexes");
}

/// Where nodes that were lifted go back, hexes around keep a part of theirs only: that does not go on through the mesh.
TEST(Transfer, a_small_change_of_flat_hexes_moves_nothing_far_away) {
  for (const char* command : {"refine vertex 1 depth 1", "coarsen vertex 1"}) {
    SCOPED_TRACE(command);
    Fixture f;
    f.session.run("create brick x 40 y 40 z 1 interval 20 20 8; refine surface 1 depth 1");
    const Mesh before = f.session.meshed().mesh;
    const double worst = summarize(quality(Metric::scaled_jacobian, before)).min;
    f.session.run(command);
    const Mesh& now = f.session.meshed().mesh;
    Index n_moved = 0;
    for (Index n = 0; n < now.n_nodes(); ++n) {
      const Index old = find_node(before, node_id(now, n));
      n_moved += old >= 0 && before.points[old] != now.points[n];
    }
    EXPECT_LT(n_moved, 400);
    EXPECT_GT(summarize(quality(Metric::scaled_jacobian, now)).min, 0.2 * worst);
  }
}

TEST(Transfer, levels_go_on_when_things_get_names) {
  Fixture f;
  f.session.run("create brick x 3 interval 3; block 1 volume 1; nodeset 4 curve 1; refine hex 14");
  f.session.run("surface 1 name 'inlet'; block 1 name 'steel'; nodeset 4 name 'rim'; block 1 attribute count 2");
  for (const std::string& line : f.notices) EXPECT_EQ(line.find("levels end"), std::string::npos) << line;
  f.session.run("refine hex in vertex 1; coarsen hex all levels 2");
  const Mesh& mesh = f.session.meshed().mesh;
  EXPECT_EQ(mesh.n_hexes(), 27);
  EXPECT_EQ(mesh.blocks.at(0).name, "steel");
  EXPECT_EQ(mesh.node_sets.at(0).name, "rim");
  EXPECT_EQ(f.session.ids("surface", "inlet").size(), 1u);
}

/// Formats without ids give what has the same places and hexes.
TEST(Transfer, levels_are_read_for_a_mesh_that_lost_its_ids) {
  Fixture f;
  f.session.run("create brick x 3 interval 3; export exodus '" + (test::folder() / "cubes.e").string() +
                "' overwrite; reset; import exodus '" + (test::folder() / "cubes.e").string() + "'; refine hex 14");
  const std::string levels = (test::folder() / "some.levels").string(), mesh = (test::folder() / "some.mesh").string();
  f.session.run("export levels '" + levels + "' overwrite; export medit '" + mesh + "' overwrite");
  Fixture other;
  other.session.run("import medit '" + mesh + "'; import levels '" + levels + "'");
  EXPECT_NE(other.all_notices().find("have the ids of the levels"), std::string::npos) << other.all_notices();
  EXPECT_EQ(other.session.meshed().mesh.hex_ids, f.session.meshed().mesh.hex_ids);
  other.session.run("coarsen hex all");
  EXPECT_EQ(other.session.meshed().mesh.n_hexes(), 27);
  Fixture wrong;
  wrong.session.run("import medit '" + mesh + "'; move x 1");
  EXPECT_NE(wrong.error("import levels '" + levels + "'").find("the place of node 1 differs"), std::string::npos);
}

}  // namespace
}  // namespace hextwist
