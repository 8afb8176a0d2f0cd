// Refinement beside elements that are no hexes: kept, cut along, or in the way.
#include "support/others.h"

#include "hextwist/refine/others.h"
#include "hextwist/sizing/stop_at.h"
#include "support/analytic_model.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

MeshedModel on_brick(Mesh mesh, int a, int b, int c) {
  MeshedModel result{std::move(mesh), analytic_brick(a, b, c), {}};
  result.association = associate(result.mesh, *result.model).association;
  return result;
}

MeshedModel random_input(std::mt19937& random, const test::Glue& glue = {}) {
  const int a = 2 + static_cast<int>(random() % 2), b = 2 + static_cast<int>(random() % 2), c = 2;
  return on_brick(test::with_others(test::shuffled(test::grid(a, b, c), random), random, glue), a, b, c);
}

Request random_request(const MeshedModel& input, std::mt19937& random) {
  Request request;
  const auto some = [&](Index n, Index first) {
    std::vector<Index> ids;
    for (Index i = 0; i < n; ++i)
      if (random() % 6 == 0) ids.push_back(first + i);
    if (ids.empty()) ids.push_back(first);
    return ids;
  };
  switch (random() % 5) {
    case 0:
      request.target = {EntityKind::node, {input.mesh.hexes[random() % input.mesh.hexes.size()][0]}};
      break;
    case 1:
      request.target = {EntityKind::curve, some(12, 1)};
      break;
    case 2:
      request.target = {EntityKind::surface, some(6, 1)};
      break;
    default:
      request.target = {EntityKind::hex, some(input.mesh.n_hexes(), 0)};
  }
  if (random() % 4 == 0 && !is_solid(request.target.kind)) request.target.depth = 1;
  if (random() % 4 == 0) request.how = Cuts{2};
  if (random() % 5 == 0) request.method = Method::parallel;
  if (random() % 5 == 0) request.transition = Transition::nested;
  if (random() % 5 == 0) request.finish.smooth = true;
  return request;
}

void expect_right(const MeshedModel& input, const RefineResult& result) {
  const Mesh& mesh = result.refined.mesh;
  EXPECT_TRUE(result.report.violations.empty());
  EXPECT_TRUE(test::conformal(mesh, test::UnusedNodes::allowed));
  EXPECT_TRUE(test::uninverted(mesh));
  EXPECT_TRUE(test::others_kept(input.mesh, mesh));
  EXPECT_TRUE(test::others_conformal(input.mesh, mesh));
  EXPECT_EQ(mesh.others->heads, input.mesh.others->heads);
  for (const Index h : {Index{0}, mesh.n_hexes() - 1})
    EXPECT_EQ(std::ranges::count(input.mesh.others->heads->ids, hex_id(mesh, h)), 0);
}

TEST(others, random_ones_are_kept_cut_along_or_named_as_in_the_way) {
  int n_done = 0, n_blocked = 0, n_cut_along = 0, n_stopped = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const MeshedModel input = random_input(random, {.rigid_one_in = seed % 2 ? 12 : 60});
    const Request request = random_request(input, random);
    MeshedModel alone = input;
    alone.mesh.others = nullptr;
    try {
      const RefineResult result = refine(input, request);
      expect_right(input, result);
      ++n_done;
      n_cut_along += result.refined.mesh.others->size() > input.mesh.others->size();
    } catch (const BlockedByOther& blocked) {
      ++n_blocked;
      const std::string what = blocked.what();
      EXPECT_EQ(what.find("hex "), 0u) << what;
      EXPECT_TRUE(what.find("S3") != what.npos || what.find("S4") != what.npos || what.find("C3D") != what.npos)
          << what;
      EXPECT_TRUE(test::has_node_in_rigid_edge(input.mesh, refine(alone, request).refined.mesh)) << what;
      std::vector<std::string> told;
      Request less;
      try {
        less = away_from_others(input, request, 1, told);
      } catch (const BlockedByOther&) {
        throw;
      } catch (const Error&) {
        continue;  // nothing is left, or all volumes
      }
      EXPECT_EQ(told.size(), 1u);
      for (int layers = 1; layers < 5; ++layers) {
        try {
          if (layers > 1) less = away_from_others(input, request, layers, told);
          const RefineResult result = refine(input, less);
          expect_right(input, result);
          EXPECT_GT(result.refined.mesh.n_hexes(), input.mesh.n_hexes());
          ++n_stopped;
          break;
        } catch (const BlockedByOther& again) {
          // One layer is enough where whole hexes are cut once.
          EXPECT_FALSE(less.target.kind == EntityKind::hex && less.method == Method::automatic &&
                       std::get<Cuts>(less.how).numsplit == 1)
              << again.what();
        } catch (const Error&) {
          break;
        }
      }
    }
  }
  EXPECT_GE(n_done, 5);
  EXPECT_GE(n_blocked, 5);
  EXPECT_GE(n_cut_along, 5);
  EXPECT_GE(n_stopped, 2);
}

}  // namespace
}  // namespace hextwist
