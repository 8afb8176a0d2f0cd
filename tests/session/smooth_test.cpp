// smooth, node ... position, schemes, and meshes that come in tangled.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

#include "hextwist/io/io.h"
#include "hextwist/mesh/quality/quality.h"
#include "session/session_fixture.h"
#include "support/checkers.h"
#include "support/seed.h"

namespace hextwist {

using test::Fixture, test::folder;

namespace {

/// Moves nodes inside by up to `amount` of their unit cells.
Mesh shaken_grid(int n, double amount, unsigned seed) {
  Mesh mesh = test::grid(n, n, n);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> by(-amount, amount);
  for (Vec3& p : mesh.points) {
    const bool inside = (p.array() > 0).all() && (p.array() < n).all();
    if (inside) p += Vec3(by(random), by(random), by(random));
  }
  return mesh;
}

TEST(SmoothCommand, improves_shapes_and_stays_on_the_model) {
  for (const char* scheme :
       {"", " scheme mean ratio", " scheme condition number", " scheme laplacian", " scheme mean_ratio"}) {
    Fixture f;
    f.session.take(shaken_grid(5, 0.3, 1), nullptr);
    f.session.run(std::string("smooth volume all") + scheme + "; check");
    const CommandRecord& record = f.session.records().at(0);
    EXPECT_GE(record.after.shape.min, record.before.shape.min) << scheme;
    EXPECT_GT(record.after.shape.average, record.before.shape.average + 0.05) << scheme;
    EXPECT_LT(record.off_cad.max_relative, 1e-9);
    EXPECT_NE(f.output.at(0).find("smallest shape"), std::string::npos);
  }
}

/// Runs `refine` on a cube whose nodes are all fixed: none of them may move.
void expect_fixed_nodes_stay(const std::string& how, const std::function<void(Session&)>& refine) {
  SCOPED_TRACE(how);
  Fixture f;
  f.session.run("create brick x 4 interval 4; node all position fixed");
  const std::vector<Vec3> before = f.session.meshed().mesh.points;
  refine(f.session);
  const std::vector<Vec3>& after = f.session.meshed().mesh.points;
  EXPECT_GT(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(after[i], before[i]) << i;
}

TEST(SmoothCommand, nodes_fixed_stay_in_every_way_to_refine) {
  for (const std::string how :
       {"hex 22 depth 0 graded", "hex 22 depth 0", "hex 22 numsplit 2", "curve 1", "curve 1 depth 1 numsplit 2",
        "curve 1 method parallel", "hex 22 23 26 method parallel", "vertex 1 radius 1.5", "curve 1 size 0.3",
        "curve 1 size 0.3 bias 1.5", "surface 1 depth 1 size 0.5", "volume all sizing_function \"0.2 + abs(x) / 3\"",
        "surface 1 direction thickness", "surface 1 direction layers 3 growth 1.5"})
    expect_fixed_nodes_stay(how, [&](Session& session) { session.run("refine " + how + " smooth"); });
  expect_fixed_nodes_stay("sheet", [](Session& session) { session.run("refine sheet edge 30 smooth"); });
  expect_fixed_nodes_stay("adapt by flags", [](Session& session) {
    std::vector<std::uint8_t> flags(64);
    flags[21] = 1;
    session.adapt(flags, {.smooth = true});
  });
  expect_fixed_nodes_stay("adapt by sizes", [](Session& session) {
    std::vector<double> sizes(64, 1);
    sizes[21] = 0.3;
    session.adapt(sizes, {.smooth = true});
  });
  expect_fixed_nodes_stay("adapt with nodes of its own", [](Session& session) {
    session.run("node all position free");
    std::vector<std::uint8_t> flags(64);
    flags[21] = 1;
    AdaptOptions options{.smooth = true};
    for (Index n = 0; n < session.meshed().mesh.n_nodes(); ++n) options.fixed.push_back(n);
    session.adapt(flags, options);
  });
}

TEST(SmoothCommand, moves_the_nodes_of_the_entities_only) {
  for (const char* target : {"hex 1 to 20", "surface 1", "curve 1", "node 40 to 60", "block 1", "nodeset 2",
                             "sideset 3", "volume 1", "edge 1 to 30", "face 1 to 30", "sheet 1", "vertex 1"}) {
    Mesh mesh = shaken_grid(4, 0.3, 2);
    mesh.blocks.push_back({1, "", {0, 1, 2, 3}});
    mesh.node_sets.push_back({2, "", {30, 31, 32, 37}});
    mesh.side_sets.push_back({3, "", {{0, 1}, {7, 5}}});
    Fixture f;
    f.session.take(mesh, nullptr);
    f.session.run(std::string("nodeset 9 ") + (std::string(target).starts_with("sheet") ? "node in " : "") + target);
    const std::vector<Index> allowed = f.session.meshed().mesh.node_sets.back().nodes;
    const std::vector<Vec3> before = f.session.meshed().mesh.points;
    f.session.run(std::string("smooth ") + target);
    const std::vector<Vec3>& after = f.session.meshed().mesh.points;
    for (Index i = 0; i < static_cast<Index>(after.size()); ++i)
      EXPECT_TRUE(after[i] == before[i] || std::ranges::binary_search(allowed, i)) << target << " node " << i;
  }
}

TEST(SmoothCommand, fixed_nodes_stay_in_smoothing_and_refining) {
  Fixture f;
  f.session.take(shaken_grid(5, 0.35, 3), nullptr);
  f.session.run("node 80 to 120 position fixed; node 90 position free; list node 80; list node 90");
  EXPECT_TRUE(f.output.at(2).ends_with(", fixed")) << f.output.at(2);
  EXPECT_FALSE(f.output.at(3).ends_with(", fixed"));
  const std::vector<Vec3> before = f.session.meshed().mesh.points;
  const auto expect_fixed = [&](const char* when) {
    const std::vector<Vec3>& after = f.session.meshed().mesh.points;
    for (Index i = 79; i < 120; ++i) EXPECT_TRUE(i == 89 || after[i] == before[i]) << when << " node " << i + 1;
  };
  f.session.run("smooth volume all");
  expect_fixed("smooth");
  EXPECT_NE(f.session.meshed().mesh.points[89], before[89]);
  f.session.run("refine hex in node 100 smooth");
  expect_fixed("refine smooth");
  f.session.run("smooth volume all; list node 80");
  expect_fixed("smooth after refining");
  EXPECT_TRUE(f.output.back().ends_with(", fixed"));
  f.session.run("node all position free; smooth volume all; list node 80");
  EXPECT_FALSE(f.output.back().ends_with(", fixed"));
  EXPECT_NE(f.session.meshed().mesh.points[80], before[80]);
  f.session.run("undo 2; list node 80");
  EXPECT_TRUE(f.output.back().ends_with(", fixed"));
  f.session.run("node all position fixed; smooth volume all");
  EXPECT_EQ(f.notices.back(), "no node can move there: all are fixed or on vertices");
}

TEST(SmoothCommand, boundary_fixed_moves_nodes_inside_only) {
  Mesh mesh = shaken_grid(4, 0.3, 4);
  for (Vec3& p : mesh.points)
    if (p.z() == 0 && p.x() > 0 && p.x() < 4 && p.y() > 0 && p.y() < 4) p.x() += 0.4;
  Fixture f;
  f.session.take(mesh, nullptr);
  f.session.run("smooth volume all boundary fixed");
  for (Index i = 0; i < mesh.n_nodes(); ++i)
    EXPECT_TRUE(mesh.points[i].z() != 0 || f.session.meshed().mesh.points[i] == mesh.points[i]) << i;
  const double fixed = f.last().after.shape.average;
  f.session.run("undo; smooth volume all boundary slide");
  EXPECT_GT(f.last().after.shape.average, fixed);
  EXPECT_LT(f.last().off_cad.max_relative, 1e-9);
}

TEST(SmoothCommand, entities_remember_their_schemes) {
  Fixture f, g;
  for (Fixture* each : {&f, &g}) each->session.take(shaken_grid(4, 0.3, 5), nullptr);
  f.session.run("volume 1 smooth scheme laplacian; smooth volume 1");
  g.session.run("smooth volume 1 scheme laplacian");
  EXPECT_EQ(f.session.meshed().mesh.points, g.session.meshed().mesh.points);
  EXPECT_NE(f.output.at(0).find("1 volume: 'smooth' uses laplacian"), std::string::npos);
  f.session.run("undo 2; smooth volume 1");
  g.session.run("undo; smooth volume 1 scheme mean ratio");
  EXPECT_EQ(f.session.meshed().mesh.points, g.session.meshed().mesh.points);
  f.session.run("surface all smooth scheme equipotential; curve 1 smooth scheme untangle; smooth surface 1");
  EXPECT_NE(f.notices.at(0).find("there is no scheme 'equipotential' here"), std::string::npos);
}

TEST(SmoothCommand, iterations_end_it_early_and_it_says_so) {
  Fixture f;
  f.session.run("create brick x 2 interval 6; refine hex 5 40");
  f.session.run("smooth volume all iterations 2");
  EXPECT_NE(f.output.back().find(" 2 sweeps"), std::string::npos);
  EXPECT_NE(f.output.back().find("more sweeps could still improve it"), std::string::npos) << f.output.back();
  f.session.run("smooth volume all scheme untangle");
  EXPECT_EQ(f.notices.back(), "no hex is inverted: there is nothing to untangle");
}

TEST(SmoothCommand, can_be_cancelled_at_any_sweep) {
  for (int calls = 1;; ++calls) {
    Session session;
    session.take(shaken_grid(5, 0.35, 7), nullptr);
    int left = calls;
    SessionCallbacks callbacks;
    callbacks.progress = [&](const char*, double) { return --left > 0; };
    session.set_callbacks(callbacks);
    const MeshedModel* before = &session.meshed();
    const Mesh copy = session.meshed().mesh;
    bool cancelled = false;
    try {
      session.run("smooth volume all");
    } catch (const CommandError& error) {
      EXPECT_EQ(error.message(), "cancelled");
      cancelled = true;
    }
    if (!cancelled) {
      EXPECT_GT(calls, 5);
      break;
    }
    EXPECT_EQ(&session.meshed(), before);
    EXPECT_EQ(session.meshed().mesh, copy);
    EXPECT_THROW(session.run("undo"), CommandError);
  }
}

TEST(SmoothCommand, needs_a_mesh) {
  Fixture f;
  EXPECT_TRUE(f.error("smooth volume all").starts_with("there is no mesh to smooth; read one"));
  EXPECT_NE(f.error("node 1 position fixed"), "no error");
}

TEST(Tangled, a_mesh_with_inverted_hexes_is_untangled_with_a_notice) {
  Fixture f;
  f.session.take(shaken_grid(6, 1.2, 8), nullptr);
  EXPECT_TRUE(test::uninverted(f.session.meshed().mesh));
  ASSERT_EQ(f.notices.size(), 1u);
  EXPECT_NE(f.notices[0].find(" were inverted (hex "), std::string::npos) << f.notices[0];
  EXPECT_NE(f.notices[0].find("): untangled, "), std::string::npos) << f.notices[0];
  // The same through a file, and refused when that is asked for.
  const auto file = folder() / "a.msh";
  write_mesh(file, shaken_grid(6, 1.2, 8), nullptr);
  f.session.run("import mesh '" + file.string() + "'; check");
  EXPECT_EQ(f.last().n_violations, 0);
  EXPECT_NE(f.error("set untangle off; import mesh '" + file.string() + "'").find("violations, the first: "),
            std::string::npos);
  EXPECT_GT(f.last().n_violations, 1);
}

TEST(Tangled, nodes_on_surfaces_slide_where_nodes_inside_are_not_enough) {
  // A node of the skin goes over its neighbour.
  Mesh mesh = test::grid(4, 4, 4);
  const auto node = std::ranges::find_if(mesh.points, [](const Vec3& p) { return p == Vec3(2, 2, 0); });
  *node = Vec3(3.3, 2.2, 0);
  const Index i = static_cast<Index>(node - mesh.points.begin());
  Fixture f;
  f.session.take(mesh, nullptr);
  EXPECT_TRUE(test::uninverted(f.session.meshed().mesh));
  EXPECT_LT(std::abs(f.session.meshed().mesh.points[i].z()), 1e-12);
  EXPECT_NE(f.session.meshed().mesh.points[i], mesh.points[i]);
  f.session.run("check");
}

TEST(Tangled, what_cannot_be_repaired_is_refused_with_ids) {
  // The boundary itself is turned: a corner of the box goes through it.
  Mesh mesh = test::grid(2, 2, 2);
  mesh.points[0] = Vec3(5, 5, 5);
  Fixture f;
  f.session.run("create brick x 1 interval 1");
  try {
    f.session.take(mesh, nullptr);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("hex 1"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("untangling did not help"), std::string::npos) << error.what();
  }
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 1);
}

/// Corners are lifted without being asked; what is asked for must not end below that.
TEST(Smoothing, of_a_refinement_leaves_no_corner_lower_than_without) {
  constexpr double low = 0.3, rounding = 1e-6;
  const unsigned seed = test::random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const auto least = [](const Fixture& f) {
    return summarize(quality(Metric::scaled_jacobian, f.session.meshed().mesh)).min;
  };
  int n_low = 0;
  for (int i = 0; i < 40; ++i) {
    const double thickness = std::array{0.2, 0.5, 1.0, 2.5, 5.0}[random() % 5];
    const std::string target = std::array{"surface ", "curve ", "vertex ", "hex "}[random() % 4] +
                               std::to_string(1 + random() % 6) + (random() % 3 ? "" : " numsplit 2");
    SCOPED_TRACE(target + " of " + std::to_string(thickness));
    Fixture plain, smoothed;
    for (Fixture* f : {&plain, &smoothed})
      f->session.run("create brick x 5 y 5 z " + std::to_string(thickness) + " interval 5");
    plain.session.run("refine " + target);
    smoothed.session.run("refine " + target + " smooth");
    n_low += least(plain) < low;
    EXPECT_GE(least(smoothed), std::min(low, least(plain)) - rounding);
  }
  EXPECT_GT(n_low, 5);
}

}  // namespace
}  // namespace hextwist
