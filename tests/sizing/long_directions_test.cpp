// Sizes on hexes that are long in some directions: these are cut alone.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/patch/refine.h"
#include "support/analytic_model.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/seed.h"

namespace hextwist {
namespace {

/// A brick of so many hexes of these edges, with its CAD.
MeshedModel bricks(std::array<int, 3> n, const Vec3& edge) {
  MeshedModel result{
      test::grid(n[0], n[1], n[2]), analytic_brick(n[0] * edge.x(), n[1] * edge.y(), n[2] * edge.z()), {}};
  for (Vec3& p : result.mesh.points) p = p.cwiseProduct(edge);
  result.association = associate(result.mesh, *result.model).association;
  return result;
}

RefineResult checked(const MeshedModel& input, const Request& request) {
  RefineResult result = refine(input, request);
  const Mesh& fine = result.refined.mesh;
  EXPECT_TRUE(test::conformal(fine, test::UnusedNodes::allowed));
  EXPECT_TRUE(test::uninverted(fine));
  EXPECT_TRUE(result.report.violations.empty());
  EXPECT_TRUE(result.report.off_nodes.empty());
  EXPECT_NEAR(volume(fine), volume(input.mesh), 1e-9 * volume(input.mesh));
  return result;
}

double worst_scaled_jacobian(const Mesh& mesh) {
  return summarize(quality(Metric::scaled_jacobian, mesh)).min;
}

/// (Some are cut to within sqrt(3) exactly, and nodes at the rim move in the end, so 2.) Of all edges of hexes of
/// bricks, those longer than wished by more than 2, and those that are shorter although the bricks were not: by the
/// axis that they run along.
struct OffEdges {
  int n = 0, n_longer = 0, n_shorter = 0;
};
OffEdges off_edges(const Mesh& mesh, const std::vector<Index>& hexes, const Vec3& brick, double wished) {
  OffEdges result;
  for (const Index h : hexes)
    for (int e = 0; e < n_hex_edges; ++e) {
      const Vec3 along = mesh.points[mesh.hexes[h][edge_corner(e, 1)]] - mesh.points[mesh.hexes[h][edge_corner(e, 0)]];
      int axis = 0;
      along.cwiseAbs().maxCoeff(&axis);
      ++result.n;
      result.n_longer += along.norm() > 2 * wished;
      result.n_shorter += along.norm() < std::min(brick[axis], wished / 2) * 0.999;
    }
  return result;
}

/// 1 x 2 x 0.1: the thickness needs no cut, and where cuts end across it the pieces would be sharp, so they go through.
TEST(long_directions, a_plate_of_thin_layers_is_cut_along_its_faces_alone) {
  const MeshedModel input = bricks({10, 2, 10}, {1, 2, 0.1});
  const Index top = 6;  // z = 1
  const RefineResult result =
      checked(input, {.target = {.kind = EntityKind::surface, .ids = {top}, .depth = 1}, .how = Sizes{.size = 0.25}});
  EXPECT_EQ(result.refined.mesh.n_hexes(), 200 * 3 * 9);
  EXPECT_NEAR(worst_scaled_jacobian(result.refined.mesh), 1, 1e-9);
  EXPECT_EQ(result.report.sizes->met(), 1);
  ASSERT_TRUE(result.report.sizes->directions);
  EXPECT_EQ(result.report.sizes->directions->n_longer, 0);
  EXPECT_EQ(result.report.sizes->directions->n_shorter, static_cast<Index>(result.report.sizes->hexes.size()));
}

TEST(long_directions, hexes_as_long_as_wide_are_cut_as_before) {
  const MeshedModel input = bricks({4, 4, 4}, {1, 1, 1});
  Request request{.target = {.kind = EntityKind::hex, .ids = {21}}, .how = Sizes{.size = 0.2}};
  const RefineResult result = checked(input, request);
  EXPECT_FALSE(result.report.sizes->directions);
}

/// Whatever the proportions and the wish: in the zone edges are no longer than wished by more than sqrt(3), and those
/// that were cut no shorter, but for those at its rim that were moved for better corners of the transition: at least
/// four fifths.
TEST(long_directions, no_direction_is_too_long_and_none_is_cut_without_need) {
  const unsigned seed = test::random_seed();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> proportion(0, 1), share(0.06, 0.2);
  int n_uneven = 0;
  for (int run = 0; run < 8; ++run) {
    const double longest = 6 + 14 * proportion(random);
    const Vec3 edge(longest, std::pow(longest, proportion(random)), 1);
    const double wished = share(random) * edge.maxCoeff();
    SCOPED_TRACE(testing::Message() << edge.transpose() << ", size " << wished);
    const MeshedModel input = bricks({5, 5, 5}, edge);
    std::vector<Index> targets;  // 2 x 2 x 1 or 2 x 2 x 2 hexes
    for (const Index layer : {31, 56})
      if (layer == 31 || run % 2 == 0)
        for (const Index h : {0, 1, 5, 6}) targets.push_back(layer + h);
    const RefineResult result =
        checked(input, {.target = {.kind = EntityKind::hex, .ids = targets}, .how = Sizes{.size = wished}});
    if (!result.report.sizes->directions) continue;
    ++n_uneven;
    const OffEdges off = off_edges(result.refined.mesh, result.report.sizes->hexes, edge, wished);
    EXPECT_LE(off.n_longer + off.n_shorter, 0.2 * off.n);
  }
  EXPECT_GT(n_uneven, 0);
}

}  // namespace
}  // namespace hextwist
