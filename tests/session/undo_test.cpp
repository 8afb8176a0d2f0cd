// undo, redo, and what a step costs.
#include <gtest/gtest.h>

#include <random>

#include "hextwist/session/history.h"
#include "session/session_fixture.h"
#include "support/checkers.h"
#include "support/seed.h"

namespace hextwist {

using test::Fixture;

namespace {

/// Everything that undo has to bring back, for comparison.
struct Snapshot {
  Mesh mesh;
  std::vector<Owner> owners;
  std::vector<Edge> curve_edges;
  std::vector<Side> surface_faces;
  const Model* model;
  double min_shape;
  bool operator==(const Snapshot&) const = default;
};
Snapshot snapshot(const Fixture& f) {
  const auto& [mesh, model, association] = f.session.meshed();
  const double min_shape = f.session.records().empty() ? 0 : f.last().after.shape.min;
  return {mesh, association.node_owner, association.curve_edges, association.surface_faces, model.get(), min_shape};
}

/// Bytes of the step that is undone next, as the session says.
std::size_t last_step_bytes(Fixture& f) {
  f.output.clear();
  f.session.run("list undo");
  const std::string& line = f.output.at(0);
  const std::size_t open = line.rfind('(');
  double value = std::stod(line.substr(open + 1));
  if (line.find(" kB)") != std::string::npos) value *= 1e3;
  if (line.find(" MB)") != std::string::npos) value *= 1e6;
  return static_cast<std::size_t>(value);
}

TEST(Undo, takes_back_every_kind_of_command_in_any_number_of_steps) {
  const std::vector<std::string> commands = {"create brick x 4 interval 4",
                                             "nodeset 3 curve 4",
                                             "refine curve 4",
                                             "block 7 hex 30 to 40 name \"b\"",
                                             "nodeset 3 add node 1 to 9 name \"n\"",
                                             "smooth volume all iterations 3",
                                             "sideset 5 surface 2",
                                             "refine volume all",
                                             "delete sideset 5",
                                             "reset block",
                                             "create sphere radius 2",
                                             "refine surface 1 depth 1",
                                             "reset"};
  Fixture f;
  std::vector<Snapshot> states = {snapshot(f)};
  for (const std::string& command : commands) {
    f.session.run(command);
    states.push_back(snapshot(f));
    EXPECT_NE(states[states.size() - 1], states[states.size() - 2]) << command;
  }
  const int last = static_cast<int>(commands.size());
  for (int i = last - 1; i >= 0; --i) {
    f.session.run("undo");
    EXPECT_EQ(snapshot(f), states[i]) << "undo of " << commands[i];
  }
  EXPECT_EQ(f.error("undo"), "there is nothing to undo");
  for (int i = 1; i <= last; ++i) {
    f.session.run("redo");
    EXPECT_EQ(snapshot(f), states[i]) << "redo of " << commands[i - 1];
  }
  EXPECT_EQ(f.error("redo"), "there is nothing to redo");

  const unsigned seed = test::random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  int at = last;
  for (int i = 0; i < 40; ++i) {
    const int to = static_cast<int>(random() % (commands.size() + 1));
    if (to < at) f.session.run("undo " + std::to_string(at - to));
    if (to > at) f.session.run("redo " + std::to_string(to - at));
    at = to;
    EXPECT_EQ(snapshot(f), states[at]);
  }
}

TEST(Undo, a_later_command_ends_redo_and_a_failed_one_does_not) {
  Fixture f;
  f.session.run("create brick x 1 interval 2; refine hex 1; undo");
  EXPECT_NE(f.error("refine hex 99"), "no error");
  f.session.run("quality volume all; list; redo; undo");
  f.session.run("nodeset 1 node 1");
  EXPECT_EQ(f.error("redo"), "there is nothing to redo");
  EXPECT_EQ(f.error("undo 3"), "only 2 commands can be undone");
  EXPECT_EQ(f.last().column, 6);
  f.session.run("undo 2");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 0);
}

TEST(Undo, a_failed_command_leaves_nothing_to_undo) {
  Fixture f;
  f.session.run("create brick x 1 interval 2; nodeset 1 node 1");
  EXPECT_NE(f.error("nodeset 2 remove node 3"), "no error");
  EXPECT_NE(f.error("import mesh 'none.msh'"), "no error");
  f.session.run("undo");
  EXPECT_TRUE(f.session.meshed().mesh.node_sets.empty());
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 8);
}

TEST(Undo, a_step_costs_what_changed_and_not_the_mesh) {
  Fixture f;
  f.session.run("create brick x 1 interval 40");
  const std::size_t mesh_bytes = bytes_of(f.session.meshed());
  ASSERT_GT(mesh_bytes, 5000000u);
  f.session.run("nodeset 1 curve 1");  // 41 nodes
  EXPECT_LT(last_step_bytes(f), 3000u);
  const Vec3* points = f.session.meshed().mesh.points.data();
  f.session.run("nodeset 1 surface 1; undo; redo; undo");
  EXPECT_EQ(f.session.meshed().mesh.points.data(), points) << "a change of sets must not copy the mesh";
  f.session.run("nodeset 2 node all; nodeset 2 remove node 7");
  EXPECT_LT(last_step_bytes(f), 3000u);
  f.session.run("refine hex 100");
  EXPECT_LT(last_step_bytes(f), mesh_bytes / 40);
  f.session.run("smooth hex in node 30000 iterations 2");
  EXPECT_LT(last_step_bytes(f), mesh_bytes / 100);
  f.session.run("undo");
  f.output.clear();
  f.session.run("list undo");
  EXPECT_EQ(f.output.back().rfind("together ", 0), 0u);
}

TEST(Undo, memory_is_limited_and_undo_can_be_switched_off) {
  Fixture f;
  f.session.run("create brick x 1 interval 20; refine hex 1; refine hex 400; refine hex 4000; set undo limit 0.01");
  f.output.clear();
  f.session.run("list undo");
  EXPECT_LT(f.output.size(), 6u);
  EXPECT_NE(f.output.back().find("at most 10 kB"), std::string::npos) << f.output.back();
  f.session.run("set undo limit 0; refine hex 6000");
  EXPECT_EQ(f.error("undo"), "there is nothing to undo");
  f.session.run("set undo limit 100; refine hex 6100; set undo off");
  EXPECT_EQ(f.error("undo"), "undo is switched off: 'set undo on' keeps what later commands change");
  f.session.run("refine hex 6200; set undo on; refine hex 6300");
  const Index after_eleven = [&] {
    f.session.run("undo");
    return f.session.meshed().mesh.n_hexes();
  }();
  EXPECT_GT(after_eleven, 8000);
  EXPECT_EQ(f.error("undo"), "there is nothing to undo");
}

TEST(Undo, commands_of_a_journal_are_undone_one_by_one) {
  const auto journal = test::written("a.jou", "create brick x 1 interval 2\nrefine hex 1\n");
  Fixture f;
  f.session.run("playback '" + journal.string() + "'; undo");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 8);
}

TEST(ArrayDelta, makes_one_array_from_another) {
  const unsigned seed = test::random_seed();
  std::mt19937 random(seed);
  for (int run = 0; run < 3000; ++run) {
    std::vector<Index> from(random() % 40), to;
    for (Index& x : from) x = static_cast<Index>(random() % 100);
    for (const Index x : from) {
      if (random() % 8 == 0) to.push_back(static_cast<Index>(random() % 100));
      if (random() % 8) to.push_back(random() % 16 ? x : x + 1);
    }
    for (std::size_t n = random() % 9; n > 3; --n) to.push_back(-1);
    const ArrayDelta delta(from, to);
    EXPECT_EQ(delta.apply(from), to) << "seed " << seed;
    EXPECT_EQ(delta.empty(), from == to);
  }
}

TEST(ArrayDelta, is_small_for_what_refinement_and_smoothing_do) {
  std::vector<Index> from(10000);
  for (std::size_t i = 0; i < from.size(); ++i) from[i] = static_cast<Index>(i);
  const auto bytes = [&](const std::vector<Index>& to) {
    const ArrayDelta there(from, to), back(to, from);
    EXPECT_EQ(there.apply(from), to);
    EXPECT_EQ(back.apply(to), from);
    return std::max(there.bytes(), back.bytes());
  };
  std::vector<Index> split = from;  // some gone, others at the end
  split.erase(split.begin() + 500, split.begin() + 510);
  split.erase(split.begin() + 7000);
  for (int i = 0; i < 50; ++i) split.push_back(20000 + i);
  EXPECT_LT(bytes(split), 400u);
  std::vector<Index> moved = from;
  for (int i = 0; i < 10; ++i) moved[i * 900 + 3] = -i - 1;
  EXPECT_LT(bytes(moved), 500u);
  EXPECT_EQ(bytes(from), 0u);
  EXPECT_LT(bytes({}), 10100 * sizeof(Index));
}

}  // namespace
}  // namespace hextwist
