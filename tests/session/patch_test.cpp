// Small refinements that change the mesh of a session in place: nobody can tell.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <regex>

#include "hextwist/patch/patch.h"
#include "hextwist/sizing/targets.h"
#include "session/session_fixture.h"
#include "support/meshed.h"
#include "support/same_meshed.h"
#include "support/seed.h"

namespace hextwist::test {
namespace {

constexpr PatchRule always{0, 1}, never{std::numeric_limits<Index>::max(), 1};

/// Puts the rule back that it found.
struct Rule {
  explicit Rule(const PatchRule& rule) { patch_rule = rule; }
  ~Rule() { patch_rule = before; }
  const PatchRule before = patch_rule;
};

std::string without_times(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  // Seconds differ, and so does what undo takes.
  return std::regex_replace(text, std::regex(", [0-9.e+-]+ s\n|\\([0-9.]+ (bytes|kB|MB)\\)|together .*\n"), "\n");
}

void expect_same_row(const QualityRow& a, const QualityRow& b) {
  EXPECT_EQ(std::tie(a.count, a.min, a.max, a.average, a.std_dev, a.min_hex, a.max_hex),
            std::tie(b.count, b.min, b.max, b.average, b.std_dev, b.min_hex, b.max_hex));
}

void expect_same_state(const MeshState& a, const MeshState& b) {
  EXPECT_EQ(std::tie(a.hexes, a.nodes, a.volume), std::tie(b.hexes, b.nodes, b.volume));
  expect_same_row(a.shape, b.shape);
  expect_same_row(a.scaled_jacobian, b.scaled_jacobian);
}

/// Cubes of two volumes that meet in stairs, without CAD.
MeshedModel stairs(int nx, int ny, int nz) {
  Mesh mesh = grid(nx, ny, nz);
  mesh.blocks = {{1, "one", {}}, {2, "two", {}}};
  const std::vector<Vec3> middle = centroids(mesh);
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    mesh.blocks[std::lround(middle[h].x() + middle[h].y()) / 3 % 2 == 0].hexes.push_back(h);
  Fixture f;
  f.session.take(mesh, nullptr);
  return f.session.meshed();
}

/// Two sessions that do the same, one of them without patches.
struct Pair {
  Fixture patched, plain;
  int n_in_place = 0;

  explicit Pair(const MeshedModel& meshed) {
    for (Fixture* one : {&patched, &plain}) one->session.take(meshed.mesh, meshed.model);
  }
  void expect_same() const {
    if (patched.session.meshed().model) {
      EXPECT_TRUE(same_bits(patched.session.meshed(), plain.session.meshed()));
    }
    const CommandRecord &a = patched.last(), &b = plain.last();
    expect_same_state(a.before, b.before);
    expect_same_state(a.after, b.after);
    EXPECT_EQ(std::tie(a.ok, a.error, a.filled_hexes, a.notices, a.off_cad.max, a.off_cad.node, a.off_cad_node),
              std::tie(b.ok, b.error, b.filled_hexes, b.notices, b.off_cad.max, b.off_cad.node, b.off_cad_node));
    EXPECT_EQ(without_times(patched.output), without_times(plain.output));
  }
  void run(const std::string& command) {
    SCOPED_TRACE(command);
    const MeshedModel* const before = &patched.session.meshed();
    const Index n_before = before->mesh.n_hexes();
    std::string error;
    {
      const Rule rule(always);
      error = patched.error(command);
    }
    n_in_place += before == &patched.session.meshed() && before->mesh.n_hexes() != n_before;
    const Rule rule(never);
    EXPECT_EQ(error, plain.error(command));
    expect_same();
  }
};

/// Smaller than what is there, here and there.
std::string random_sizes(const Mesh& mesh, std::mt19937& random) {
  if (mesh.n_hexes() == 0) return "redo";  // the taking of the mesh was undone
  const auto below = [&](int n) { return static_cast<Index>(random() % static_cast<unsigned>(n)); };
  const std::string targets[] = {"vertex " + std::to_string(1 + below(8)), "curve " + std::to_string(1 + below(12)),
                                 "hex " + std::to_string(hex_id(mesh, below(mesh.n_hexes()))),
                                 "node " + std::to_string(node_id(mesh, below(mesh.n_nodes())))};
  const std::string words[] = {" method parallel", " method single", " transition nested", " concave fill",
                               " depth 0",         " depth 1",       " max_passes 2"};
  const std::string target = targets[below(4)];
  const bool is_hex = target.starts_with("hex");
  std::string word = below(3) ? "" : words[below(7)];
  if (is_hex && word == " depth 0") word.clear();
  return "refine " + target + (is_hex && !below(2) ? " " + std::to_string(hex_id(mesh, below(mesh.n_hexes()))) : "") +
         word + " size " + std::to_string(box(mesh).diagonal() / (35 + below(mesh.n_hexes() < 20000 ? 60 : 1))) +
         (below(2) ? "" : " bias " + std::to_string(1.5 + 0.5 * below(3))) +
         (word.empty() && !below(4) ? " transition regular" : "") + (below(4) ? "" : " smooth");
}

std::string random_command(const Mesh& mesh, std::mt19937& random) {
  if (mesh.n_hexes() == 0) return "redo";  // the taking of the mesh was undone
  const auto below = [&](int n) { return static_cast<Index>(random() % static_cast<unsigned>(n)); };
  const auto hex = [&] { return std::to_string(hex_id(mesh, below(mesh.n_hexes()))); };
  const auto node = [&] { return std::to_string(node_id(mesh, below(mesh.n_nodes()))); };
  const auto options = [&] {
    return std::string(below(4) ? "" : " numsplit 2") + (below(4) ? "" : " depth 1") + (below(4) ? "" : " smooth") +
           (below(4) ? "" : " concave fill") + (below(12) ? "" : " dry_run");
  };
  switch (below(18)) {
    case 17:
      return random_sizes(mesh, random);
    case 0:
      return "undo";
    case 1:
      return "undo " + std::to_string(1 + below(3));
    case 2:
      return "redo";
    case 3:
      return "redo " + std::to_string(1 + below(2));
    case 4:
      return "block " + std::to_string(1 + below(3)) + " hex " + hex() + " " + hex();
    case 5:
      return "nodeset " + std::to_string(1 + below(3)) + " node " + node() + " " + node();
    case 6:
      return "sideset " + std::to_string(1 + below(3)) + " surface " + std::to_string(1 + below(6));
    case 7:
      return "list undo";
    case 8:
      return "smooth hex " + hex();
    case 9:
      return "refine curve " + std::to_string(1 + below(14)) + options();
    case 10:
      return "refine vertex " + std::to_string(1 + below(9)) + options();
    case 11:
      return "refine node " + node() + options();
    case 12:
      return "refine edge " + std::to_string(1 + below(500)) + options();
    default:
      return "refine hex " + hex() + (below(2) ? "" : " " + hex()) + options();
  }
}

TEST(PatchedSession, does_what_one_without_patches_does) {
  const unsigned seed = random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (MeshedModel meshed : {brick(13, 12, 12), shipped("inclusion")}) {
    meshed.mesh.fields.push_back({"number", Field::On::hex, 1, std::vector<double>(meshed.mesh.hexes.size(), 3)});
    Pair pair(meshed);
    std::shared_ptr<const MeshedModel> held;
    MeshedModel as_it_was;
    for (int i = 0; i < 50 && !testing::Test::HasFailure(); ++i) {
      if (random() % 10 == 0) {  // a program looks at the mesh
        held = pair.patched.session.share();
        as_it_was = *held;
      }
      if (random() % 10 == 0) {
        if (held) {
          EXPECT_TRUE(same_bits(*held, as_it_was));
        }
        held = nullptr;
      }
      pair.run(random_command(pair.plain.session.meshed().mesh, random));
    }
    EXPECT_GT(pair.n_in_place, 0);
  }
}

/// What levels are made for: finer and coarser at several places, again and again.
std::string random_level_command(const Mesh& mesh, std::mt19937& random) {
  if (mesh.n_hexes() == 0) return "redo";  // the taking of the mesh was undone
  const auto below = [&](int n) { return static_cast<Index>(random() % static_cast<unsigned>(n)); };
  const auto hex = [&](Index from) { return std::to_string(hex_id(mesh, from + below(mesh.n_hexes() - from))); };
  const auto any = [&] { return hex(below(2) ? 0 : mesh.n_hexes() / 2); };  // rather the newer ones
  switch (below(12)) {
    case 0:
      return "undo";
    case 1:
      return "redo";
    case 2:
      return "refine node " + std::to_string(node_id(mesh, below(mesh.n_nodes()))) + " depth 1";
    case 3:
      return "node fixed node " + std::to_string(node_id(mesh, below(mesh.n_nodes())));
    case 4:
      return "smooth hex " + any();
    case 5:
    case 6:
      return "coarsen hex " + hex(mesh.n_hexes() / 2) + (below(2) ? "" : " levels 3");
    case 7:
      return "coarsen vertex " + std::to_string(1 + below(8));
    case 8:
      return below(4) ? "refine hex " + any() + " numsplit 2" : "coarsen hex all levels 9";
    default:
      return "refine hex " + any() + (below(3) ? "" : " " + any()) + (below(4) ? "" : " smooth") +
             (below(9) ? "" : " dry_run");
  }
}

void check_levels(unsigned seed, bool with_sizes) {
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  int n_in_place = 0;  // in small models much changes each time, and then all is verified
  for (MeshedModel meshed : {brick(16, 15, 15), shipped("inclusion"), shipped("bracket"), stairs(12, 11, 10)}) {
    meshed.mesh.fields.push_back({"number", Field::On::hex, 1, std::vector<double>(meshed.mesh.hexes.size(), 3)});
    std::vector<double> heat;
    for (const Vec3& p : meshed.mesh.points) heat.push_back(p.x() + 2 * p.y());
    meshed.mesh.fields.push_back({"heat", Field::On::node, 1, heat});
    meshed.mesh.node_sets.push_back({7, "some", {0, 5, 9}});
    Pair pair(meshed);
    pair.run("nodeset 8 volume 1");
    pair.run("nodeset 9 surface 1 to 3");
    for (int i = 0; i < 40 && !testing::Test::HasFailure(); ++i)
      pair.run(with_sizes && i % 7 == 3 ? random_sizes(pair.plain.session.meshed().mesh, random)
                                        : random_level_command(pair.plain.session.meshed().mesh, random));
    n_in_place += pair.n_in_place;
    pair.run("coarsen hex all levels 9");
    pair.run("undo");
  }
  EXPECT_GT(n_in_place, 0);
}

TEST(PatchedSession, makes_levels_that_one_without_patches_makes) {
  check_levels(random_seed(), false);
  check_levels(random_seed(), true);
}

/// A face between two volumes is a side of the lower hex, which may be outside of a patch that ends in between.
TEST(PatchedSession, ends_between_volumes) {
  Fixture finer;
  const MeshedModel inclusion = shipped("inclusion");
  finer.session.take(inclusion.mesh, inclusion.model);
  finer.session.run("refine volume all");
  Pair pair(finer.session.meshed());
  pair.run("refine node 340 depth 2 smooth");
  for (Index hex = 0; hex < pair.plain.session.meshed().mesh.n_hexes() && !testing::Test::HasFailure(); hex += 200) {
    pair.run("refine hex " + std::to_string(hex_id(pair.plain.session.meshed().mesh, hex)));
    if (pair.plain.last().ok) pair.run("undo");
  }
  EXPECT_GT(pair.n_in_place, 0);
}

/// A patch of a base may have no hex of a volume at an edge where that volume begins.
TEST(PatchedSession, keeps_members_of_node_sets_where_it_ends) {
  Fixture f;
  f.session.take(stairs(18, 17, 16).mesh, nullptr);
  f.session.run("nodeset 1 volume 1; nodeset 2 surface 1 to 20");
  std::mt19937 random(random_seed());
  const Rule small(always);
  for (int i = 0; i < 12; ++i) {
    const Mesh& mesh = f.session.meshed().mesh;
    std::string ids;
    for (int k = 0; k < 3; ++k)
      ids += " " + std::to_string(hex_id(mesh, static_cast<Index>(random() % mesh.hexes.size())));
    f.session.run("refine hex" + ids);
    f.session.run("nodeset 11 volume 1; nodeset 12 surface 1 to 20");
    const std::vector<NodeSet>& sets = f.session.meshed().mesh.node_sets;
    ASSERT_EQ(sets[0].nodes, sets[2].nodes) << ids;
    ASSERT_EQ(sets[1].nodes, sets[3].nodes) << ids;
    f.session.run("undo 2");
  }
}

/// Nothing is wished for within a patch, and the transition of a cell outside reaches into it.
TEST(PatchedSession, keeps_transitions_of_cells_outside_where_it_takes_all_back) {
  Fixture f;
  f.session.run("create brick x 16 y 2 z 2 interval 16 2 2");
  for (int apart = 2; apart < 12; ++apart)
    for (int vertex = 1; vertex <= 8 && !testing::Test::HasFailure(); ++vertex) {
      SCOPED_TRACE(apart);
      Pair pair(f.session.meshed());
      pair.run("refine hex 1");
      pair.run("refine hex " + std::to_string(1 + apart));
      pair.run("coarsen vertex " + std::to_string(vertex));
      pair.run("refine hex 16");
    }
}

/// A cell that others need stays cut when it is given up, and is wished for no longer.
TEST(PatchedSession, forgets_wishes_that_change_nothing) {
  check_levels(2223630803, false);
}

TEST(PatchedSession, is_as_it_was_after_a_command_that_is_cancelled_or_fails) {
  Fixture f;
  const MeshedModel meshed = brick(14, 13, 12);
  f.session.take(meshed.mesh, meshed.model);
  const Rule rule(always);
  f.session.run("refine hex 200");
  const MeshedModel before = f.session.meshed();
  f.go_on = false;
  EXPECT_EQ(f.error("refine hex 100"), "cancelled");
  EXPECT_EQ(f.error("undo"), "cancelled");

  f.go_on = true;
  EXPECT_TRUE(same_bits(f.session.meshed(), before));
  // Whoever is told of a result may throw.
  SessionCallbacks throws;
  throws.output = [](const std::string&) { throw Error("no paper"); };
  f.session.set_callbacks(throws);
  for (const char* command : {"refine hex 100", "undo"}) {
    EXPECT_EQ(f.error(command), "no paper");
    EXPECT_TRUE(same_bits(f.session.meshed(), before));
  }
  f.session.set_callbacks({});
  f.session.run("undo");
  EXPECT_TRUE(same_bits(f.session.meshed(), MeshedModel{meshed.mesh, meshed.model, f.session.meshed().association}));
}

// (Of whole hexes too, when the base of their levels is kept already.)
TEST(PatchedSession, changes_the_mesh_in_place_also_in_a_journal) {
  const auto journal = written("small.jou", "refine node 100\nrefine node 200\nundo\nrefine node 9\n");
  Fixture f;
  const MeshedModel meshed = brick(14, 13, 12);
  f.session.take(meshed.mesh, meshed.model);
  const Rule rule(always);
  const MeshedModel* const before = &f.session.meshed();
  f.session.run("playback \"" + journal.string() + "\"");
  EXPECT_EQ(before, &f.session.meshed());
  EXPECT_GT(before->mesh.n_hexes(), 14 * 13 * 12 + 15);
  f.session.run("undo; undo");
  EXPECT_EQ(before->mesh.n_hexes(), 14 * 13 * 12);
}

TEST(PatchedSession, sizes_that_are_met_change_nothing_and_keep_the_levels) {
  Fixture f;
  f.session.run("create brick x 1 interval 30; refine hex 5000 numsplit 1");
  const MeshedModel before = f.session.meshed();
  for (const char* command : {"refine curve 1 size 0.1 bias 1.3", "refine volume all size 0.5",
                              "refine surface 2 size 0.05 depth 1", "refine vertex 3 size 0.04",
                              "refine hex 5000 to 6000 size 0.1", "refine volume 1 sizing_function \"0.05 + x*x\""}) {
    SCOPED_TRACE(command);
    f.session.run(command);
    EXPECT_TRUE(test::same_bits(f.session.meshed(), before));
    const CommandRecord& record = f.last();
    EXPECT_EQ(record.sizes.passes, 0);
    EXPECT_GT(record.sizes.hexes, 0);
    EXPECT_EQ(record.sizes.coarser, 0);
    EXPECT_EQ(record.after.shape.min, record.before.shape.min);
  }
  f.session.run("undo 6");
  EXPECT_TRUE(test::same_bits(f.session.meshed(), before));
  f.session.run("redo 6; refine hex 1 numsplit 1; coarsen hex all levels 3");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 27000);
  // One hex too large by a hair is cut.
  f.session.run("refine curve 1 size 0.0192");
  EXPECT_GT(f.session.meshed().mesh.n_hexes(), 27000);
}

}  // namespace
}  // namespace hextwist::test
