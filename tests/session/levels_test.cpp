// Levels in a session: any number of refinements in any order keep the quality of one, and can be taken back.
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "hextwist/base/same_bits.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/refine/levels/level_origin.h"
#include "hextwist/sizing/targets.h"
#include "session_fixture.h"
#include "support/checkers.h"
#include "support/meshed.h"
#include "support/same_meshed.h"
#include "support/seed.h"

namespace hextwist {
namespace {

using test::Fixture;

double worst(const Mesh& mesh) {
  return summarize(quality(Metric::scaled_jacobian, mesh)).min;
}

const Mesh& mesh_of(const Fixture& f) {
  return f.session.meshed().mesh;
}
std::string error_of(Fixture& f, const std::string& text) {
  try {
    f.session.run(text);
  } catch (const CommandError& error) {
    return error.message();
  }
  return "";
}

/// On unit cubes, whole hexes: the worst of all 256 ways to mark the corners of a cube.
constexpr double least_on_cubes = 0.405;

void run_ok(Fixture& f, const std::string& text) {
  SCOPED_TRACE(text);
  f.session.run(text);
  EXPECT_TRUE(test::conformal(mesh_of(f)));
  EXPECT_TRUE(test::uninverted(mesh_of(f)));
}

TEST(SessionLevels, repeated_cuts_of_one_hex_are_as_good_as_the_first) {
  const Index n_hexes[] = {271, 3113, 32127};
  for (int n = 1; n <= 3; ++n) {
    Fixture f;
    run_ok(f, "create brick x 5 interval 5; refine hex 63 numsplit " + std::to_string(n));
    EXPECT_EQ(mesh_of(f).n_hexes(), n_hexes[n - 1]);
    EXPECT_GE(worst(mesh_of(f)), 0.477);
  }
}

TEST(SessionLevels, nested_transitions_are_cut_again) {
  Fixture f;
  run_ok(f, "create brick x 5 interval 5; refine hex 63 numsplit 2 transition nested");
  EXPECT_EQ(mesh_of(f).n_hexes(), 1765);
  EXPECT_LT(worst(mesh_of(f)), 0.4);  // 0.067 before low hexes are lifted
}

TEST(SessionLevels, several_levels_of_what_lies_at_an_entity_go_at_once) {
  for (const char* kind : {"surface 1", "curve 1", "vertex 1"}) {
    Fixture f;
    run_ok(f, "create brick x 8 interval 8; refine " + std::string(kind) + " depth 1 numsplit 2");
    run_ok(f, "coarsen " + std::string(kind) + " levels 2");
    EXPECT_EQ(mesh_of(f).n_hexes(), 512) << kind;
  }
}

TEST(SessionLevels, commands_one_after_the_other_keep_the_quality_of_one) {
  const unsigned seed = test::random_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  for (int round = 0; round < 6; ++round) {
    Fixture f;
    f.session.run("create brick x 4 y 4 z 3 interval 4 4 3");
    const MeshedModel base = f.session.meshed();
    for (int step = 0; step < 5 && mesh_of(f).n_hexes() < 20000; ++step) {
      const auto any = [&](int n) { return std::to_string(1 + random() % static_cast<unsigned>(n)); };
      const std::string hex =
          std::to_string(hex_id(mesh_of(f), static_cast<Index>(random() % mesh_of(f).hexes.size())));
      const std::string commands[] = {"refine hex " + hex,
                                      "refine curve " + any(12) + " depth 1",
                                      "refine surface " + any(6) + " depth 1",
                                      "refine vertex " + any(8) + " radius 1",
                                      "coarsen hex " + hex,
                                      "coarsen surface " + any(6)};
      const std::string& command = commands[step == 0 ? random() % 4 : random() % 6];
      if (f.session.meshed().mesh.hexes == base.mesh.hexes && command.starts_with("coarsen")) continue;
      SCOPED_TRACE(command);
      std::string failed = error_of(f, command);
      if (command.find("radius") != std::string::npos && !failed.empty()) continue;  // no centroid that near
      EXPECT_EQ(failed, "");
      EXPECT_GE(worst(mesh_of(f)), least_on_cubes);
      EXPECT_TRUE(test::conformal(mesh_of(f)));
    }
    // What was refined may have been taken back already: then nothing can become coarser, and that is an error.
    if (mesh_of(f).hexes != base.mesh.hexes) f.session.run("coarsen hex all levels 9");
    EXPECT_TRUE(test::same_bits(base, f.session.meshed())) << "round " << round;
  }
}

TEST(SessionLevels, undo_brings_levels_back) {
  Fixture f;
  run_ok(f, "create brick x 5 interval 5; refine hex 63; refine hex 126 to 130");
  const MeshedModel two = f.session.meshed();
  run_ok(f, "undo 2; redo 2");
  EXPECT_TRUE(test::same_bits(two, f.session.meshed()));
  run_ok(f, "refine hex 200 to 220; undo");
  EXPECT_TRUE(test::same_bits(two, f.session.meshed()));
  run_ok(f, "refine hex in surface 1");
  EXPECT_GE(worst(mesh_of(f)), least_on_cubes);
  run_ok(f, "coarsen volume all levels 9");
  EXPECT_EQ(mesh_of(f).n_hexes(), 125);
}

TEST(SessionLevels, what_is_no_level_makes_a_new_base_and_says_so) {
  for (const std::string command : {"refine curve 1", "refine sheet node 1 2", "refine surface 1 direction layers 2",
                                    "refine volume all numsplit 1", "nodeset 7 node 5 6"}) {
    SCOPED_TRACE(command);
    Fixture f;
    f.session.run("create brick x 5 interval 5; refine hex 63; " + command);
    EXPECT_EQ(f.session.records().back().notices.back(),
              "levels end here: this mesh is the base of what is refined from now on");
    const Index n = mesh_of(f).n_hexes();
    EXPECT_EQ(
        error_of(f, "coarsen hex all"),
        "no hex can become coarser: this mesh is the base, nothing was refined by levels since (levels come of whole "
        "hexes, 'depth 1' or more, and 'transition regular'; depth 0, sheets and one into eight make a new base)");
    f.session.run("refine hex in vertex 1; coarsen hex all");
    EXPECT_EQ(mesh_of(f).n_hexes(), n);
  }
}

TEST(SessionLevels, come_back_with_undo_of_what_ended_them) {
  for (const std::string command :
       {"refine curve 1", "block 1 name \"steel\"", "block 2 hex 1 to 9", "delete block 1", "nodeset 7 node 5 6",
        "sideset 7 surface 2", "block 2 hex 1 to 9; nodeset 7 node 5 6"}) {
    SCOPED_TRACE(command);
    Fixture f;
    run_ok(f, "create brick x 5 interval 5; refine hex 63");
    const MeshedModel fine = f.session.meshed();
    const std::string n_steps = std::to_string(1 + std::ranges::count(command, ';'));
    run_ok(f, command + "; undo " + n_steps);
    EXPECT_TRUE(test::same_bits(fine, f.session.meshed()));
    run_ok(f, "redo " + n_steps + "; undo " + n_steps + "; coarsen hex all");
    EXPECT_EQ(mesh_of(f).n_hexes(), 125);
  }
}

TEST(SessionLevels, of_more_hexes_than_are_allowed_are_refused_in_a_patch_too_and_written_all_the_same) {
  const auto file = test::folder() / "limited.levels";
  Fixture f;
  run_ok(f, "create brick x 30 interval 30; refine hex 13516");
  const Index n = mesh_of(f).n_hexes();
  const std::string refine = "refine hex 100", limit = "set max_hexes " + std::to_string(n + 10);
  run_ok(f, limit);
  for (const std::string& more : {refine, refine + " dry_run"})
    EXPECT_NE(error_of(f, more).find("more than the " + std::to_string(n + 10) + " that are allowed"),
              std::string::npos);
  EXPECT_EQ(mesh_of(f).n_hexes(), n);
  run_ok(f, "set max_hexes 1000; export levels \"" + file.string() + "\"; coarsen hex all");
  EXPECT_EQ(mesh_of(f).n_hexes(), 27000);
  f.session.run("set max_hexes 0");  // it holds for the process
}

TEST(SessionLevels, the_combination_keeps_its_quality_over_splits) {
  double of_curve = 0, of_surface = 0;
  for (const int n : {1, 2, 3}) {
    Fixture f;
    run_ok(f, "create brick x 5 interval 5; refine curve 1 numsplit " + std::to_string(n));
    if (n == 1) of_curve = worst(mesh_of(f));
    EXPECT_GE(worst(mesh_of(f)), std::min(of_curve, least_on_cubes) - 1e-9) << n;
    run_ok(f, "undo; refine surface 1 numsplit " + std::to_string(n));
    if (n == 1) of_surface = worst(mesh_of(f));
    EXPECT_GE(worst(mesh_of(f)), std::min(of_surface, least_on_cubes) - 1e-9) << n;
    run_ok(f, "undo; refine edge 50 60 numsplit " + std::to_string(n));
  }
}

TEST(SessionLevels, smoothing_lies_over_the_levels) {
  Fixture f;
  run_ok(f, "create brick x 6 interval 6; refine hex 90 smooth");
  const MeshedModel smoothed = f.session.meshed();
  run_ok(f, "refine hex 1");
  const Mesh& mesh = mesh_of(f);
  // Far from what is new, nodes are where they were smoothed to.
  Index n_moved = 0;
  for (Index n = 0; n < smoothed.mesh.n_nodes(); ++n) {
    const Index now = find_node(mesh, node_id(smoothed.mesh, n));
    ASSERT_GE(now, 0);
    n_moved += mesh.points[now] != smoothed.mesh.points[n];
  }
  EXPECT_EQ(n_moved, 0);
  run_ok(f, "coarsen hex all levels 2");
  EXPECT_EQ(mesh_of(f).n_hexes(), 216);
  run_ok(f, "refine hex 90; smooth hex all");
  const double smooth_worst = worst(mesh_of(f));
  EXPECT_GT(smooth_worst, 0.477);
  run_ok(f, "refine hex in surface 1; undo; refine hex 200 smooth; undo");
  EXPECT_EQ(worst(mesh_of(f)), smooth_worst);
}

/// Nodes that smoothing had moved go back where hexes change; those beside them are lifted together with them.
TEST(SessionLevels, are_as_good_where_a_mesh_was_smoothed_before) {
  const MeshedModel plate = test::shipped("plate_quarter");
  for (const std::string hex : {"47", "118", "208"}) {
    SCOPED_TRACE(hex);
    Fixture f;
    f.session.take(plate.mesh, plate.model);
    run_ok(f, "refine hex 100; smooth volume all; refine hex " + hex);
    const double smoothed_before = worst(mesh_of(f));
    run_ok(f, "undo 2; refine hex " + hex);
    EXPECT_GE(smoothed_before, 0.9 * worst(mesh_of(f)));
  }
}

TEST(SessionLevels, fixed_nodes_that_smoothing_had_moved_are_told_where_hexes_are_cut) {
  const MeshedModel plate = test::shipped("plate_quarter");
  Fixture f;
  f.session.take(plate.mesh, plate.model);
  const auto n_told = [&] {
    return std::ranges::count_if(f.session.records().back().notices, [](const std::string& line) {
      return line.ends_with("stay where they had been moved to: what is cut around has been placed without that");
    });
  };
  run_ok(f, "refine hex 100; smooth volume all; node in surface 2 position fixed; refine surface 2 depth 1");
  EXPECT_EQ(n_told(), 1);
  run_ok(f, "undo; node all position free; refine surface 2 depth 1");
  EXPECT_EQ(n_told(), 0);
}

TEST(SessionLevels, fixed_nodes_stay_where_they_are_and_are_known_by_id) {
  Fixture f;
  run_ok(f, "create brick x 5 interval 5; refine hex 63; node in hex 140 150 position fixed");
  const MeshedModel before = f.session.meshed();
  const std::vector<std::int64_t> fixed = f.session.ids("node", "in hex 140 150");
  run_ok(f, "refine hex in surface 1; refine hex 300 smooth; coarsen surface 1");
  for (const std::int64_t id : fixed) {
    const Index now = find_node(mesh_of(f), id), then = find_node(before.mesh, id);
    if (now < 0) continue;
    EXPECT_EQ(mesh_of(f).points[now], before.mesh.points[then]) << id;
  }
}

TEST(SessionLevels, sizes_are_met_without_bad_shapes) {
  Fixture f;
  run_ok(f,
         "create brick x 10 interval 10; refine volume all sizing_function "
         "\"0.1 + 0.5 * abs(sqrt(x*x + y*y + z*z) - 2)\"");
  EXPECT_GE(worst(mesh_of(f)), least_on_cubes);
  EXPECT_LT(mesh_of(f).n_hexes(), 90000);
  EXPECT_EQ(f.session.records().back().sizes.coarser, 0);
}

/// Cells that sizes cut at some corners only go as others do, one level at a time.
TEST(SessionLevels, what_sizes_made_can_be_coarsened_back_to_the_base) {
  for (const std::string command :
       {"refine hex 1 size 0.4", "refine curve 1 size 0.3 method single",
        "refine curve 2 size 0.1 bias 1.5 transition regular", "refine volume all sizing_function '0.2+0.4*abs(x)'",
        "refine vertex 3 size 0.05 bias 1.3 transition regular"}) {
    SCOPED_TRACE(command);
    Fixture f;
    f.session.run("create brick x 4 interval 4");
    const Mesh base = mesh_of(f);
    f.session.run(command);
    ASSERT_GT(mesh_of(f).n_hexes(), base.n_hexes());
    for (int step = 0; step < 8 && mesh_of(f).hexes != base.hexes; ++step) {
      const Index n_before = mesh_of(f).n_hexes();
      f.session.run("coarsen hex all");
      EXPECT_LT(mesh_of(f).n_hexes(), n_before);
      EXPECT_GE(worst(mesh_of(f)), least_on_cubes);
    }
    EXPECT_EQ(mesh_of(f).hexes, base.hexes);
    EXPECT_EQ(mesh_of(f).points, base.points);
  }
}

TEST(SessionLevels, wished_sizes_of_a_solver_make_coarser_too) {
  Fixture f;
  f.session.run("create brick x 4 interval 4");
  const Mesh base = mesh_of(f);
  f.session.run("refine hex 1 22");
  const auto adapt = [&](double size) {
    return f.session.adapt(std::vector<double>(mesh_of(f).hexes.size(), size), AdaptOptions()).report.hexes_after;
  };
  EXPECT_GT(adapt(0.4), 1000);
  EXPECT_EQ(adapt(1), base.n_hexes());
  EXPECT_EQ(mesh_of(f).points, base.points);
}

/// One size per hex is a sample of something that may be smooth: a limit above how fast it grows changes nothing.
TEST(SessionLevels, wished_sizes_that_grow_slowly_are_met_alike_with_a_bias) {
  Fixture f, limited;
  const auto adapt = [](Fixture& one, double bias) {
    std::vector<double> sizes;
    for (const Vec3& middle : centroids(mesh_of(one))) sizes.push_back(0.25 + 0.2 * (middle - Vec3(-3, -3, -3)).norm());
    one.session.adapt(sizes, {.bias = bias});
  };
  for (Fixture* one : {&f, &limited}) one->session.run("create brick x 6 interval 6");
  for (int round = 0; round < 3; ++round) {
    adapt(f, 1);
    adapt(limited, 1.5);
    EXPECT_EQ(mesh_of(limited).hexes, mesh_of(f).hexes);
  }
  EXPECT_GT(mesh_of(f).n_hexes(), 216);
}

TEST(SessionLevels, changes_of_a_solver_go_both_ways_with_fields) {
  Fixture f;
  f.session.run("create brick x 4 interval 4");
  MeshedModel meshed = f.session.meshed();
  Field linear{"linear", Field::On::node, 1, {}}, load{"load", Field::On::hex, 1, {}};
  const auto value = [](const Vec3& p) { return 3 * p.x() - 2 * p.y() + 0.5 * p.z() + 1; };
  for (const Vec3& p : meshed.mesh.points) linear.values.push_back(value(p));
  load.values.assign(meshed.mesh.hexes.size(), 2.5);
  meshed.mesh.fields = {linear, load};
  f.session.take(std::move(meshed), true);
  const MeshedModel base = f.session.meshed();
  std::mt19937 random(7);
  for (int step = 0; step < 20; ++step) {
    SCOPED_TRACE(step);
    const Mesh before = mesh_of(f);
    const std::vector<std::uint8_t> level = [&] {
      std::vector<std::uint8_t> all(before.hexes.size());
      const std::vector<int> is = test::levels(before);
      std::ranges::copy(is, all.begin());
      return all;
    }();
    std::vector<std::int8_t> changes(before.hexes.size());
    for (std::size_t h = 0; h < changes.size(); ++h)
      changes[h] = static_cast<std::int8_t>(level[h] < 2 && random() % 40 == 0 ? 1 : random() % 3 ? -1 : 0);
    const AdaptOutcome outcome = f.session.adapt(changes, {.extensive = {"load"}});
    const Mesh& now = mesh_of(f);
    EXPECT_GE(worst(now), least_on_cubes);
    ASSERT_EQ(outcome.came_from.kind.size(), now.hexes.size());
    double sum = 0;
    for (Index h = 0; h < now.n_hexes(); ++h) {
      sum += now.fields[1].values[h];
      if (outcome.came_from.kind[h] == HexOrigin::same) {
        EXPECT_EQ(hex_id(now, h), hex_id(before, outcome.origin[h]));
      }
    }
    EXPECT_NEAR(sum, 2.5 * 64, 1e-9);
    for (Index n = 0; n < now.n_nodes(); ++n) EXPECT_NEAR(now.fields[0].values[n], value(now.points[n]), 1e-9);
  }
  f.session.adapt(std::vector<std::int8_t>(mesh_of(f).hexes.size(), -2));
  EXPECT_EQ(mesh_of(f).hexes, base.mesh.hexes);
  EXPECT_EQ(mesh_of(f).points, base.mesh.points);
}

/// Finer at the bore of the bracket in the layer of its hexes (4 thick) that the plane at x is in, coarser elsewhere.
/// By the middles of hexes: nodes between layers may have moved a little to where their hexes are better.
void follow_plane(Session& session, double x, int n_levels) {
  const auto layer = [](double at) { return std::floor(at / 4); };
  for (int call = 0; call < 8; ++call) {
    const Mesh& mesh = session.meshed().mesh;
    const auto level = std::ranges::find(mesh.fields, "level", &Field::name);
    std::vector<std::int8_t> changes(mesh.hexes.size(), -1);
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      double near = 1e9;
      for (const Index n : mesh.hexes[h])
        near = std::min(near, std::hypot(mesh.points[n].y(), mesh.points[n].z() - 50));
      const double is = level == mesh.fields.end() ? 0 : level->values[h];
      if (layer(test::centroid(mesh, h).x()) == layer(x) && near < 10.1) changes[h] = is < n_levels ? 1 : 0;
    }
    const AdaptOutcome outcome = session.adapt(changes);
    if (std::ranges::all_of(outcome.came_from.kind, [](HexOrigin kind) { return kind == HexOrigin::same; })) return;
  }
}

TEST(SessionLevels, a_front_along_the_bore_of_the_bracket_leaves_nothing_behind) {
  const MeshedModel base = test::shipped("bracket");
  for (const int n_levels : {1, 2}) {
    Session session;
    session.take(base, true);
    for (int step = 0; step < 10; ++step) {
      SCOPED_TRACE(std::to_string(n_levels) + " levels, step " + std::to_string(step));
      const Mesh before = session.meshed().mesh;
      const double x = 0.4 + 0.8 * step;
      follow_plane(session, x, n_levels);
      const MeshedModel& now = session.meshed();
      Session fresh;
      fresh.take(base, true);
      follow_plane(fresh, x, n_levels);
      EXPECT_LE(now.mesh.n_hexes(), fresh.meshed().mesh.n_hexes() * 1.05);
      EXPECT_GT(now.mesh.n_hexes(), base.mesh.n_hexes());
      EXPECT_GE(worst(now.mesh), 0.9 * worst(fresh.meshed().mesh));
      EXPECT_TRUE(test::conformal(now.mesh));
      EXPECT_TRUE(test::uninverted(now.mesh));
      EXPECT_LE(off_model(now.mesh, now.association, *now.model).max_relative, 1e-9);
      // What has its id is what it was.
      for (Index n = 0; n < now.mesh.n_nodes(); ++n) {
        const Index old = find_node(before, node_id(now.mesh, n));
        if (old >= 0 && old < base.mesh.n_nodes()) {
          EXPECT_TRUE(same_bits(now.mesh.points[n], before.points[old]));
        }
      }
    }
    session.run("coarsen hex all levels 9");
    EXPECT_EQ(session.meshed().mesh.hexes, base.mesh.hexes);
  }
}

TEST(SessionLevels, are_written_and_read_so_that_another_run_goes_on) {
  for (const char* part : {"", "cam", "inclusion"}) {
    SCOPED_TRACE(part);
    Fixture f;
    const auto begin = [&](Session& session) {
      if (*part) session.take(test::shipped(part), true);
    };
    if (*part)
      begin(f.session);
    else
      f.session.run("create brick x 5 interval 5");
    const MeshedModel base = f.session.meshed();
    f.session.run("refine hex 63; refine hex in surface 1; refine curve 2 depth 1 smooth; coarsen surface 1");
    const std::string file = (test::folder() / ("part" + std::string(part) + ".levels")).string();
    const std::string mesh = (test::folder() / ("part" + std::string(part) + ".vtu")).string();
    f.session.run("export levels \"" + file + "\" overwrite; export vtk \"" + mesh + "\" overwrite");

    Fixture other;
    begin(other.session);
    if (!*part) other.session.run("create brick x 5 interval 5");
    other.session.import_mesh(mesh);
    other.session.run("import levels \"" + file + "\"");
    EXPECT_TRUE(test::same_bits({f.session.meshed().mesh, other.session.meshed().model, f.session.meshed().association},
                                other.session.meshed()));
    // Both go on alike.
    for (Fixture* one : {&f, &other}) one->session.run("refine hex in vertex 1; coarsen curve 2");
    EXPECT_EQ(f.session.meshed().mesh, other.session.meshed().mesh);
    other.session.run("coarsen hex all levels 9");
    EXPECT_EQ(other.session.meshed().mesh.hexes, base.mesh.hexes);
    EXPECT_EQ(other.session.meshed().mesh.points, base.mesh.points);

    // Of another mesh, damaged, and none at all.
    EXPECT_NE(error_of(other, "refine hex in vertex 1; import levels \"" + file + "\"").find("another mesh"),
              std::string::npos);
    std::string bytes;
    {
      std::ifstream in(file, std::ios::binary);
      bytes.assign(std::istreambuf_iterator<char>(in), {});
    }
    std::mt19937 random(5);
    for (int i = 0; i < 200; ++i) {
      std::string broken = bytes;
      if (i % 2)
        broken.resize(random() % bytes.size());
      else
        for (int k = 0; k < 3; ++k)
          broken[broken.size() - 1 - random() % 20000 % broken.size()] ^= static_cast<char>(1 + random() % 255);
      const auto damaged = test::folder() / "damaged.levels";
      std::ofstream(damaged, std::ios::binary) << broken;
      Fixture reader;
      begin(reader.session);
      if (!*part) reader.session.run("create brick x 5 interval 5");
      reader.session.run("reset block");
      const MeshedModel before = reader.session.meshed();
      error_of(reader, "import levels \"" + damaged.string() + "\"");  // refused, or a place that is rounded
      EXPECT_TRUE(test::conformal(reader.session.meshed().mesh));
    }
  }
  Fixture bare;
  bare.session.run("create brick x 2 interval 2");
  EXPECT_EQ(error_of(bare, "export levels \"nothing.levels\""), "there are no levels to export: this mesh is a base");
}

/// Nodes of the base that smoothing had moved are back when all is coarse again, also where its hexes are poor: what
/// lifts corners is for new nodes.
TEST(SessionLevels, a_poor_base_comes_back_from_smoothing) {
  Fixture f;
  f.session.import_mesh(std::string(HEXTWIST_SOURCE_DIR) + "/models/cylinder.msh");
  f.session.run("refine curve 1");
  const MeshedModel base = f.session.meshed();
  f.session.run("refine hex 1000 smooth");
  f.session.run("coarsen hex all levels 9");
  EXPECT_TRUE(test::same_bits(base, f.session.meshed()));
}

/// Without CAD the base may lie on the skin of a mesh before it, whose facets and numbers it does not tell.
TEST(SessionLevels, on_the_skin_of_a_mesh_that_is_no_more_are_written_and_read) {
  const std::string models = std::string(HEXTWIST_SOURCE_DIR) + "/models/";
  const std::array<std::array<const char*, 2>, 6> cases = {{{"l_block", "refine curve 1"},
                                                            {"notched_cube", "refine volume all"},
                                                            {"cam", "refine sheet edge 5"},
                                                            {"cylinder", "refine curve 1"},
                                                            {"cylinder", "smooth volume all"},
                                                            {"cylinder", "set feature_angle 10"}}};
  for (const auto& [name, first] : cases) {
    SCOPED_TRACE(name + std::string(": ") + first);
    Fixture f;
    const bool is_setting = std::string(first).starts_with("set");
    if (is_setting) f.session.run(first);
    f.session.import_mesh(models + name + ".msh");
    if (!is_setting) f.session.run(first);
    const Mesh base = f.session.meshed().mesh;
    const std::string refine = "refine hex " + std::to_string(hex_id(base, base.n_hexes() / 2));
    const std::string refine_more = "refine node " + std::to_string(node_id(base, 0)) + " depth 1";
    const std::string file = (test::folder() / "skin.levels").string();
    f.session.run(refine + "; refine node " + std::to_string(node_id(base, 0)) + " depth 1; export levels \"" + file +
                  "\" overwrite");

    Fixture other;
    other.session.run("import levels \"" + file + "\"");
    EXPECT_TRUE(test::same_bits({f.session.meshed().mesh, other.session.meshed().model, f.session.meshed().association},
                                other.session.meshed()));
    for (Fixture* one : {&f, &other}) one->session.run(refine_more + " smooth; coarsen curve 2");
    EXPECT_TRUE(test::same_bits({f.session.meshed().mesh, other.session.meshed().model, f.session.meshed().association},
                                other.session.meshed()));
    other.session.run("coarsen hex all levels 9");
    EXPECT_EQ(other.session.meshed().mesh.hexes, base.hexes);
    EXPECT_EQ(other.session.meshed().mesh.points, base.points);

    // Damaged anywhere: refused, or another place.
    if (is_setting) continue;
    std::string bytes;
    {
      std::ifstream in(file, std::ios::binary);
      bytes.assign(std::istreambuf_iterator<char>(in), {});
    }
    std::mt19937 random(7);
    for (int i = 0; i < 8; ++i) {
      std::string broken = bytes;
      broken[random() % broken.size()] ^= static_cast<char>(1 + random() % 255);
      const auto damaged = test::folder() / "damaged.levels";
      std::ofstream(damaged, std::ios::binary) << broken;
      Fixture reader;
      error_of(reader, "import levels \"" + damaged.string() + "\"");
      EXPECT_TRUE(test::conformal(reader.session.meshed().mesh));
    }
  }
}

TEST(SessionLevels, what_cannot_be_is_refused) {
  Fixture f;
  EXPECT_TRUE(error_of(f, "coarsen hex all").starts_with("there is no mesh to coarsen; read one"));
  f.session.run("create brick x 3 interval 3");
  EXPECT_EQ(
      error_of(f, "coarsen hex all"),
      "no hex can become coarser: this mesh is the base, nothing was refined by levels since (levels come of whole "
      "hexes, 'depth 1' or more, and 'transition regular'; depth 0, sheets and one into eight make a new base)");
  f.session.run("refine hex 14");
  EXPECT_EQ(error_of(f, "coarsen hex 14 sum \"nothing\""), "hex 14 does not exist; hexes are 1 to 192");
  EXPECT_EQ(error_of(f, "coarsen hex all sum \"nothing\""), "there is no field 'nothing' of hexes");
  EXPECT_EQ(error_of(f, "coarsen hex all sum \"no\" \"nothing\""), "there is no field 'no' of hexes");
  const std::vector<std::int8_t> finer(mesh_of(f).hexes.size(), 1);
  EXPECT_THROW(f.session.adapt(finer, {.extensive = {"Mass"}}), CommandError);
  EXPECT_NE(error_of(f, "refine hex all numsplit 8").find("memory"), std::string::npos);
}

}  // namespace
}  // namespace hextwist
