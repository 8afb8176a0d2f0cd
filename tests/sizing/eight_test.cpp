// One into eight from request to result: every hex of a structured region gets eight children, and whatever is decided,
// the mesh that comes out is a good one.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <map>
#include <numeric>
#include <random>

#include "hextwist/base/sorted.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/patch/refine.h"
#include "support/analytic_model.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist {
namespace {

using Box = std::array<int, 3>;

MeshedModel on_own_skin(Mesh mesh) {
  MeshedModel result{std::move(mesh), nullptr, {}};
  FacetResult skin = associate_with_own_skin(result.mesh);
  result.model = skin.model;
  result.association = std::move(skin.association);
  return result;
}

std::vector<Index> block(Box size, Box low, Box high) {
  std::vector<Index> hexes;
  for (int k = low[2]; k < high[2]; ++k)
    for (int j = low[1]; j < high[1]; ++j)
      for (int i = low[0]; i < high[0]; ++i) hexes.push_back(i + size[0] * (j + size[1] * k));
  return hexes;
}

/// The promise of any refinement.
RefineResult checked(const MeshedModel& input, Request request, double tolerance = 1e-9) {
  request.method = Method::parallel;
  RefineResult result = refine(input, request);
  const MeshedModel& fine = result.refined;
  EXPECT_TRUE(test::conformal(fine.mesh, test::UnusedNodes::allowed));
  EXPECT_TRUE(test::uninverted(fine.mesh));
  EXPECT_TRUE(test::sets_valid(fine.mesh));
  EXPECT_TRUE(result.report.violations.empty());
  EXPECT_TRUE(result.report.off_nodes.empty());
  EXPECT_LE(result.report.off_cad.max_relative, tolerance);
  const auto broken = check_association(fine.mesh, fine.association, *fine.model);
  EXPECT_TRUE(broken.empty()) << broken.front();
  return result;
}

/// The eight (or n^3) equal children of each target of a grid of unit cubes, found by where they are.
void expect_exact(const Mesh& fine, Box size, const std::vector<Index>& targets, int pieces) {
  std::map<std::array<int, 3>, int> n_children;
  for (Index h = 0; h < fine.n_hexes(); ++h) {
    Vec3 low = fine.points[fine.hexes[h][0]], high = low;
    for (const Index n : fine.hexes[h]) {
      low = low.cwiseMin(fine.points[n]);
      high = high.cwiseMax(fine.points[n]);
    }
    const double edge = 1.0 / pieces;
    if ((high - low - Vec3::Constant(edge)).norm() > 1e-9 || std::abs(volume(fine, h) - edge * edge * edge) > 1e-9)
      continue;
    const Vec3 centre = (low + high) / 2;
    ++n_children[{static_cast<int>(centre.x()), static_cast<int>(centre.y()), static_cast<int>(centre.z())}];
  }
  for (const Index h : targets)
    EXPECT_EQ((n_children[{h % size[0], h / size[0] % size[1], h / size[0] / size[1]}]), pieces * pieces * pieces) << h;
}

TEST(one_into_eight, every_hex_of_a_block_in_a_grid_gets_eight_cubes) {
  const Box size = {7, 7, 7};
  const MeshedModel input{test::grid(7, 7, 7), analytic_brick(7, 7, 7), {}};
  MeshedModel owned = input;
  owned.association = associate(owned.mesh, *owned.model).association;
  for (int p = 1; p <= 3; ++p)
    for (int q = 1; q <= 4; ++q)
      for (int r = 2; r <= 3; ++r)
        for (const Box low : {Box{2, 1, 2}, Box{0, 0, 0}, Box{0, 2, 3}}) {
          SCOPED_TRACE(testing::Message() << p << " " << q << " " << r << " at " << low[0] << low[1] << low[2]);
          const auto targets = block(size, low, {low[0] + p, low[1] + q, low[2] + r});
          const RefineResult result = checked(owned, {.target = {.kind = EntityKind::hex, .ids = targets}});
          EXPECT_NEAR(volume(result.refined.mesh), 343, 1e-9);
          expect_exact(result.refined.mesh, size, targets, 2);
        }
}

/// Hexes that are added around a block of p x q x r hexes, all even, inside a grid: planes of nodes end at its sides.
Index transition(std::array<int, 3> n) {
  Index added = 7 * n[0] * n[1] * n[2];
  for (int a = 0; a < 3; ++a) {
    const int u = n[(a + 1) % 3], v = n[(a + 2) % 3];
    // Beside a face across axis a: 3 by the planes of one direction, of which 2 are cut in 3 by those of the other.
    added += 2 * (7 - 1) * u * v;
    // Beside an edge along axis a: 4 by the planes across it; the others end before the edge.
    added += 4 * (4 - 1) * n[a];
  }
  return added;
}

TEST(one_into_eight, counts_follow_from_the_size_of_a_block_of_even_numbers) {
  const MeshedModel input = on_own_skin(test::grid(8, 8, 8));
  const auto growth = [&](std::array<int, 3> n) {
    const auto targets = block({8, 8, 8}, {2, 2, 2}, {2 + n[0], 2 + n[1], 2 + n[2]});
    return checked(input, {.target = {.kind = EntityKind::hex, .ids = targets}}).refined.mesh.n_hexes() - 512;
  };
  for (const std::array<int, 3> n : {std::array{2, 2, 2}, std::array{2, 4, 2}, std::array{4, 2, 4}})
    EXPECT_EQ(growth(n), transition(n)) << n[0] << n[1] << n[2];
}

TEST(one_into_eight, a_whole_mesh_gets_eight_times_as_many_hexes_structured_or_not) {
  for (const Mesh& mesh : {test::grid(3, 2, 4), test::pinwheel(5, 2, 3), test::ring(2, 5, 1), test::grid(1, 1, 1)}) {
    const MeshedModel input = on_own_skin(mesh);
    Request request{.target = {.kind = EntityKind::hex}};
    request.target.ids.resize(mesh.hexes.size());
    std::iota(request.target.ids.begin(), request.target.ids.end(), 0);
    const RefineResult result = checked(input, request);
    EXPECT_EQ(result.refined.mesh.n_hexes(), 8 * mesh.n_hexes());
    const RefineResult all = checked(input, {.target = {.kind = EntityKind::volume, .ids = {1}}, .how = Cuts{2}});
    EXPECT_EQ(all.refined.mesh.n_hexes(), 64 * mesh.n_hexes());
  }
}

TEST(one_into_eight, a_layer_along_a_side_of_the_mesh_is_halved_without_touching_hexes_beyond_its_neighbours) {
  const MeshedModel input = on_own_skin(test::grid(5, 4, 6));
  const auto layer = block({5, 4, 6}, {0, 0, 0}, {5, 4, 1});
  const RefineResult result = checked(input, {.target = {.kind = EntityKind::hex, .ids = layer}});
  expect_exact(result.refined.mesh, {5, 4, 6}, layer, 2);
  // The plane across the layer lies on the boundary: the hexes above are only those that end the other two.
  EXPECT_EQ(result.refined.mesh.n_hexes(), 120 + 7 * 20 + 20 * (7 - 1));
  for (Index h = 40; h < 120; ++h) EXPECT_GE(find_hex(result.refined.mesh, h + 1), 0);
}

TEST(one_into_eight, numsplit_halves_again) {
  const Box size = {6, 6, 5};
  const MeshedModel input = on_own_skin(test::grid(6, 6, 5));
  const auto targets = block(size, {2, 2, 1}, {5, 4, 3});
  for (const int n : {2, 3}) {
    const RefineResult result = checked(input, {.target = {.kind = EntityKind::hex, .ids = targets}, .how = Cuts{n}});
    expect_exact(result.refined.mesh, size, targets, 1 << n);
    EXPECT_NEAR(volume(result.refined.mesh), 180, 1e-9);
  }
}

double worst_scaled_jacobian(const Mesh& mesh) {
  return summarize(quality(Metric::scaled_jacobian, mesh)).min;
}

/// Boxes in a grid, inside it and at its sides: what one round has, later ones keep. (With an odd number of layers a
/// plane of nodes beside the box is enclosed, whose end has 0.306.)
TEST(one_into_eight, levels_of_halves_have_the_quality_of_one) {
  const Box size = {8, 7, 7};
  const MeshedModel input = on_own_skin(test::grid(8, 7, 7));
  for (const Box n : {Box{1, 1, 1}, Box{2, 2, 2}, Box{3, 2, 3}, Box{4, 2, 2}})
    for (const Box low : {Box{2, 3, 3}, Box{0, 0, 3}}) {
      SCOPED_TRACE(testing::Message() << n[0] << " " << n[1] << " " << n[2] << " at " << low[0] << low[1] << low[2]);
      const auto targets = block(size, low, {low[0] + n[0], low[1] + n[1], low[2] + n[2]});
      const Target target{.kind = EntityKind::hex, .ids = targets};
      const double wanted = std::ranges::all_of(n, [](int layers) { return layers % 2 == 0; }) ? 0.316 : 0.305;
      for (const int numsplit : {1, 2, 3}) {
        const RefineResult result = checked(input, {.target = target, .how = Cuts{numsplit}});
        expect_exact(result.refined.mesh, size, targets, 1 << numsplit);
        EXPECT_GE(worst_scaled_jacobian(result.refined.mesh), wanted) << numsplit;
      }
      const RefineResult by_size = checked(input, {.target = target, .how = Sizes{.size = 1 / 6.0}});  // 2, then 3
      EXPECT_EQ(by_size.report.sizes->met(), 1);
      EXPECT_GE(worst_scaled_jacobian(by_size.refined.mesh), wanted);
    }
}

TEST(one_into_eight, a_nested_transition_cuts_what_is_there) {
  const MeshedModel input = on_own_skin(test::grid(9, 9, 9));
  const auto targets = block({9, 9, 9}, {3, 3, 3}, {5, 5, 5});
  const Request regular{.target = {.kind = EntityKind::hex, .ids = targets}, .how = Cuts{3}};
  Request nested = regular;
  nested.transition = Transition::nested;
  const Mesh fewer = checked(input, nested).refined.mesh, more = checked(input, regular).refined.mesh;
  expect_exact(fewer, {9, 9, 9}, targets, 8);
  EXPECT_LT(fewer.n_hexes(), more.n_hexes());
  EXPECT_LT(worst_scaled_jacobian(fewer), 0.8 * worst_scaled_jacobian(more));
}

TEST(one_into_eight, the_order_of_nodes_and_hexes_does_not_matter_for_the_counts_and_threads_for_nothing) {
  std::mt19937 random(20);
  const Mesh mesh = test::grid(6, 5, 5);
  const MeshedModel plain = on_own_skin(mesh);
  Request request{.target = {.kind = EntityKind::hex, .ids = block({6, 5, 5}, {1, 1, 1}, {4, 3, 4})}};
  const Index expected = checked(plain, request).refined.mesh.n_hexes();
  std::vector<Vec3> centre;
  for (const Index h : request.target.ids) centre.push_back(mesh.points[mesh.hexes[h][0]] + Vec3::Constant(0.5));
  const MeshedModel mixed = on_own_skin(test::shuffled(mesh, random));
  Request same{.target = {.kind = EntityKind::hex}};
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    Vec3 middle = Vec3::Zero();
    for (const Index n : mixed.mesh.hexes[h]) middle += mixed.mesh.points[n] / 8;
    if (std::ranges::any_of(centre, [&](const Vec3& c) { return (c - middle).norm() < 0.1; }))
      same.target.ids.push_back(h);
  }
  ASSERT_EQ(same.target.ids.size(), request.target.ids.size());
  std::vector<Mesh> fine;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    fine.push_back(checked(mixed, same).refined.mesh);
  }
  EXPECT_EQ(fine[0].n_hexes(), expected);
  EXPECT_TRUE(fine[0] == fine[1] && fine[0] == fine[2]);
}

TEST(one_into_eight, any_hexes_of_any_grid_give_a_good_mesh) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Mesh mesh = test::shuffled(seed % 3 == 0   ? test::grid(5, 4, 4)
                                     : seed % 3 == 1 ? test::pinwheel(3 + seed % 4, 3, 3)
                                                     : test::ring(3, 6, seed % 4),
                                     random);
    const MeshedModel input = on_own_skin(mesh);
    Request request{.target = {.kind = EntityKind::hex}};
    const auto share = 1 + random() % 15;
    for (Index h = 0; h < mesh.n_hexes(); ++h)
      if (random() % 16 < share) request.target.ids.push_back(h);
    if (request.target.ids.empty()) continue;
    request.concave = seed % 2 ? Concave::fill : Concave::templates;
    const RefineResult result = checked(input, request);
    // Faces of a twisted ring are not flat: templates round them off.
    EXPECT_NEAR(volume(result.refined.mesh), volume(mesh), (seed % 3 == 2 ? 1e-3 : 1e-9) * volume(mesh));
    // Nothing of a target is left as it was.
    for (const Index h : request.target.ids) EXPECT_LT(find_hex(result.refined.mesh, hex_id(mesh, h)), 0);
    EXPECT_FALSE(result.report.notices.empty());
  }
}

TEST(one_into_eight, a_structured_and_an_unstructured_region_in_one_request) {
  const Mesh mesh = test::ring(9, 8, 1);
  const MeshedModel input = on_own_skin(mesh);
  Request request{.target = {.kind = EntityKind::hex, .ids = {0, 1}}};
  for (int k = 0; k < 8; ++k) request.target.ids.push_back(4 + 9 * (4 + 9 * k));
  sort_unique(request.target.ids);
  const RefineResult result = checked(input, request);
  std::string notices;
  for (const std::string& line : result.report.notices) notices += line + "\n";
  EXPECT_NE(notices.find("2 hexes around hex 1: one into eight (0 irregular edges inside"), std::string::npos)
      << notices;
  EXPECT_NE(notices.find("8 hexes around hex 41: one into 27 (0 irregular edges inside, 1 of 9 sheets crosses itself): "
                         "only 0 of its hexes could be cut in eight exactly"),
            std::string::npos)
      << notices;
}

}  // namespace
}  // namespace hextwist
