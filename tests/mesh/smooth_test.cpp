// Smoothing keeps its promises, whatever it is given.
#include <tbb/global_control.h>

#include "hextwist/mesh/neighbourhood.h"

#include "smooth_fixtures.h"
#include "support/checkers.h"

namespace hextwist::test {
namespace {

constexpr SmoothScheme schemes[] = {SmoothScheme::mean_ratio, SmoothScheme::condition_number, SmoothScheme::laplacian,
                                    SmoothScheme::untangle};

TEST(Smooth, brings_perturbed_grids_back_to_cubes) {
  std::mt19937 random(11);
  for (const SmoothScheme scheme : {SmoothScheme::mean_ratio, SmoothScheme::condition_number}) {
    Mesh mesh = shuffled(grid(6, 5, 4), random);
    const Mesh perfect = mesh;
    shake(mesh, 0.2, random);
    SmoothOptions options;
    options.scheme = scheme;
    const SmoothReport report = smooth_inside(mesh, options);
    EXPECT_LT(report.shape_before.min, 0.8);
    EXPECT_GT(min_shape(mesh), 0.9999) << name(scheme);
    EXPECT_TRUE(report.converged) << name(scheme);
    EXPECT_EQ(report.n_nodes, 5 * 4 * 3);
    EXPECT_EQ(mesh.hexes, perfect.hexes);
  }
}

TEST(Smooth, never_lowers_the_smallest_shape_or_scaled_jacobian_or_inverts_a_hex) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    Mesh start = seed % 3 == 0 ? pinwheel(3 + static_cast<int>(seed % 4), 3, 4) : shuffled(grid(5, 5, 5), random);
    start.points[0] += Vec3(0.2, 0.1, 0.3);
    shake(start, 0.06 * seed, random);
    const auto before = min_corner_jacobian(start);
    for (const SmoothScheme scheme : schemes) {
      Mesh mesh = start;
      SmoothOptions options;
      options.scheme = scheme;
      options.iterations = static_cast<int>(seed * 3 % 20);
      const SmoothReport report = smooth_inside(mesh, options);
      EXPECT_GE(report.shape_after.min, report.shape_before.min) << name(scheme);
      EXPECT_GE(min_shape(mesh), min_shape(start)) << name(scheme);
      const double least = std::min(0.9, min_scaled_jacobian(start));
      if (least > 0) {
        EXPECT_GE(min_scaled_jacobian(mesh), least) << name(scheme);
      }
      const auto after = min_corner_jacobian(mesh);
      for (std::size_t h = 0; h < after.size(); ++h)
        if (before[h] > 0) {
          ASSERT_GT(after[h], 0) << name(scheme) << " inverted hex " << h;
        }
      EXPECT_LE(report.sweeps, options.iterations);
    }
  }
}

TEST(Smooth, repairs_tangled_grids) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    std::mt19937 random(seed);
    Mesh mesh = shuffled(grid(8, 7, 6), random);
    shake(mesh, 0.25 * (seed + 1), random);
    SmoothOptions options;
    options.scheme = SmoothScheme::untangle;
    const SmoothReport report = smooth_inside(mesh, options);
    EXPECT_GT(report.inverted_before, 10) << "seed " << seed;
    EXPECT_TRUE(report.not_repaired.empty()) << "seed " << seed;
    EXPECT_TRUE(uninverted(mesh)) << "seed " << seed;
  }
}

TEST(Smooth, names_the_hexes_that_it_could_not_repair) {
  // A hex whose own skin is inside out stays inverted; those around it stay as sound as they were.
  Mesh mesh = grid(4, 4, 4);
  std::swap(mesh.points[0], mesh.points[1]);
  std::mt19937 random(5);
  shake(mesh, 0.1, random);
  const auto before = min_corner_jacobian(mesh);
  const SmoothReport report = smooth_inside(mesh);
  ASSERT_FALSE(report.not_repaired.empty());
  EXPECT_EQ(report.not_repaired.front(), 0);
  const auto after = min_corner_jacobian(mesh);
  std::vector<Index> inverted;
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    if (!(after[h] > 0)) inverted.push_back(h);
    if (before[h] > 0) {
      EXPECT_GT(after[h], 0) << h;
    }
  }
  EXPECT_EQ(report.not_repaired, inverted);
}

TEST(Smooth, moves_only_what_it_may) {
  std::mt19937 random(3);
  Mesh start = grid(6, 6, 6);
  shake(start, 0.2, random);
  for (const SmoothScheme scheme : schemes) {
    Mesh mesh = start;
    SmoothOptions options;
    options.scheme = scheme;
    options.nodes = nodes_inside(start, with_layers(start, std::vector<Index>{86}, 1));
    ASSERT_EQ(options.nodes->size(), 8u);
    options.fixed = {options.nodes->front()};
    const SmoothReport report = smooth_inside(mesh, options);
    EXPECT_EQ(report.n_nodes, 7);
    for (Index i = 0; i < mesh.n_nodes(); ++i)
      if (!std::ranges::binary_search(*options.nodes, i) || i == options.fixed[0]) {
        EXPECT_EQ(mesh.points[i], start.points[i]);
      }
    if (scheme != SmoothScheme::untangle) {
      EXPECT_NE(mesh.points, start.points) << name(scheme);
    }
  }
}

TEST(Smooth, gives_the_same_bits_for_any_number_of_threads) {
  std::mt19937 random(7);
  Mesh start = shuffled(grid(16, 15, 14), random);
  shake(start, 0.45, random);
  for (const SmoothScheme scheme : schemes) {
    std::vector<Vec3> first;
    for (const std::size_t threads : {1, 2, 8}) {
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
      Mesh mesh = start;
      SmoothOptions options;
      options.scheme = scheme;
      options.iterations = 12;
      smooth_inside(mesh, options);
      if (first.empty())
        first = mesh.points;
      else
        EXPECT_EQ(mesh.points, first) << name(scheme) << ", " << threads << " threads";
    }
  }
}

TEST(Smooth, lets_the_skin_move_when_allowed) {
  std::mt19937 random(9);
  Mesh mesh = grid(3, 3, 3);
  for (Vec3& p : mesh.points) p.x() *= 1.5;
  SmoothOptions options;
  options.free_boundary = true;
  EXPECT_EQ(smooth_inside(mesh, options).n_nodes, 64);
  EXPECT_GT(min_shape(mesh), 0.999);
}

TEST(Smooth, stops_when_told_and_keeps_what_it_reached) {
  std::mt19937 random(2);
  Mesh mesh = grid(6, 6, 6);
  shake(mesh, 0.2, random);
  const double before = min_shape(mesh);
  Association nothing;
  int calls = 0;
  const SmoothReport report = smooth(mesh, nothing, nullptr, {}, [&](const char* stage, double fraction) {
    EXPECT_STREQ(stage, "shape");
    EXPECT_GT(fraction, 0);
    return ++calls < 2;
  });
  EXPECT_TRUE(report.stopped);
  EXPECT_EQ(report.sweeps, 2);
  EXPECT_GT(min_shape(mesh), before);
}

TEST(Smooth, records_a_history_that_ends_where_the_mesh_does) {
  std::mt19937 random(2);
  Mesh mesh = pinwheel(5, 4, 4);
  shake(mesh, 0.3, random);
  SmoothOptions options;
  options.record_history = true;
  const SmoothReport report = smooth_inside(mesh, options);
  ASSERT_EQ(report.history.size(), static_cast<std::size_t>(report.sweeps) + 1);
  EXPECT_EQ(report.history.front().min_shape, report.shape_before.min);
  EXPECT_EQ(report.history.back().node_updates, report.node_updates);
}

TEST(Smooth, does_nothing_without_nodes_or_iterations) {
  std::mt19937 random(2);
  Mesh mesh = grid(3, 3, 3);
  shake(mesh, 0.2, random);
  const Mesh before = mesh;
  SmoothOptions options;
  options.iterations = 0;
  smooth_inside(mesh, options);
  EXPECT_EQ(mesh, before);
  options = {};
  options.nodes.emplace();
  const SmoothReport report = smooth_inside(mesh, options);
  EXPECT_EQ(mesh, before);
  EXPECT_EQ(report.n_nodes, 0);
  EXPECT_EQ(report.shape_before.count, 0);
}

TEST(Smooth, refuses_options_out_of_range) {
  Mesh mesh = grid(2, 2, 2);
  const auto refusal = [&](auto change) -> std::string {
    SmoothOptions options;
    change(options);
    try {
      smooth_inside(mesh, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal([](auto& o) { o.iterations = -1; }), "smooth: iterations must not be negative, not -1");
  EXPECT_EQ(refusal([](auto& o) { o.tolerance = 0; }), "smooth: tolerance must be positive and finite, not 0.000000");
  EXPECT_EQ(refusal([](auto& o) { o.average_loss = NAN; }), "smooth: average_loss is not a number");
  EXPECT_EQ(refusal([](auto& o) { o.nodes = {27}; }), "smooth: no node with index 27 in a mesh of 27 nodes");
  EXPECT_EQ(refusal([](auto& o) { o.fixed = {-1}; }), "smooth: no node with index -1 in a mesh of 27 nodes");
}

TEST(SmoothScheme, goes_by_its_name) {
  for (const SmoothScheme scheme : schemes) EXPECT_EQ(smooth_scheme(name(scheme)), scheme);
  EXPECT_EQ(smooth_scheme("Mean_Ratio"), SmoothScheme::mean_ratio);
  try {
    smooth_scheme("magic");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "unknown smoothing scheme 'magic': known are mean ratio, condition number, laplacian, untangle");
  }
}

TEST(HexBand, grows_layer_by_layer) {
  const Mesh mesh = grid(7, 7, 7);
  const std::vector<Index> middle = {3 + 7 * (3 + 7 * 3)};
  for (int layers = 0; layers <= 4; ++layers) {
    const int side = std::min(7, 1 + 2 * layers);
    const auto band = with_layers(mesh, middle, layers);
    EXPECT_EQ(band.size(), static_cast<std::size_t>(side * side * side));
    EXPECT_TRUE(std::ranges::is_sorted(band));
    const int inner = side == 7 ? 8 : side - 1;
    EXPECT_EQ(nodes_inside(mesh, band).size(), static_cast<std::size_t>(inner * inner * inner));
  }
}

}  // namespace
}  // namespace hextwist::test
