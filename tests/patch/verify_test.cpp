// Verifying a small change where it is, against verifying everything.
#include "hextwist/patch/refine_known.h"

#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <span>

#include "hextwist/geom/occ/model.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/primitives.h"
#include "support/grids.h"
#include "support/meshed.h"
#include "support/seed.h"

namespace hextwist::test {
namespace {

MeshedModel ball() {
  MeshedModel result{mesh_sphere({10}, {4, 5}), cad_sphere({10}).model, {}};
  result.association = associate(result.mesh, *result.model).association;
  return result;
}
MeshedModel brick(int n) {
  MeshedModel result{mesh_brick({1, 1, 1}, {n, n, n}), cad_brick({1, 1, 1}).model, {}};
  result.association = associate(result.mesh, *result.model).association;
  return result;
}

void expect_same(const Summary& a, const Summary& b) {
  EXPECT_EQ(a.count, b.count);
  EXPECT_EQ(a.min, b.min);
  EXPECT_EQ(a.max, b.max);
  EXPECT_EQ(a.min_hex, b.min_hex);
  EXPECT_EQ(a.max_hex, b.max_hex);
  EXPECT_NEAR(a.average, b.average, 1e-13);
  EXPECT_NEAR(a.std_dev, b.std_dev, 1e-10);
}

/// Both ways of refining give the same mesh and say the same of it. Returns the result.
RefineResult refined_both_ways(const MeshedModel& input, const Measured& known, const Request& request) {
  const RefineResult all = refine(input, request), change = refine(input, known, request);
  EXPECT_EQ(all.refined.mesh, change.refined.mesh);
  expect_same(all.report.shape_before, change.report.shape_before);
  expect_same(all.report.shape_after, change.report.shape_after);
  expect_same(all.report.scaled_jacobian_after, change.report.scaled_jacobian_after);
  EXPECT_NEAR(all.report.volume_after, change.report.volume_after, 1e-12 * all.report.volume_after);
  EXPECT_EQ(all.report.off_cad.max, change.report.off_cad.max);
  EXPECT_EQ(all.report.off_cad.node, change.report.off_cad.node);
  EXPECT_EQ(all.report.violations.size(), change.report.violations.size());
  return change;
}

TEST(verify, a_series_of_small_changes_is_reported_as_if_everything_had_been_measured) {
  const unsigned seed = random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (MeshedModel meshed : {ball(), brick(12)}) {
    Measured known = measured(meshed);
    for (int step = 0; step < 6; ++step) {
      Request request;
      request.target.kind = step == 5 ? EntityKind::node : EntityKind::hex;
      request.target.ids = {static_cast<Index>(random() % meshed.mesh.hexes.size())};
      request.method = step % 2 && request.target.kind == EntityKind::hex ? Method::parallel : Method::automatic;
      request.finish.smooth = step == 3;
      RefineResult result = refined_both_ways(meshed, known, request);
      ASSERT_TRUE(result.report.violations.empty());
      known = measured_after(result.report);
      meshed = std::move(result.refined);
    }
  }
}

TEST(verify, curves_and_surfaces_of_a_shipped_model_are_reported_alike) {
  const std::filesystem::path folder = std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models";
  MeshedModel bracket;
  bracket.model = read_cad(folder / "bracket_fillet.brep").model;
  bracket.mesh = read_mesh(folder / "bracket_fillet.msh").mesh;
  bracket.association = associate(bracket.mesh, *bracket.model).association;
  const Measured known = measured(bracket);
  for (Index id = 1; id <= bracket.model->count(0); id += 5) {
    Request request;
    request.target.kind = EntityKind::vertex;
    request.target.ids = {id};
    refined_both_ways(bracket, known, request);
  }
}

TEST(verify, new_nodes_on_one_side_of_a_crack_are_no_fault) {
  // The cube is cut half-way through: nodes of the plane x = 0, y < 0 are doubled. One side of the crack may get nodes
  // that the other has not.
  constexpr int n = 12;
  Mesh mesh = mesh_brick({1, 1, 1}, {n, n, n});
  const Index n_old = mesh.n_nodes();
  std::vector<Index> twin(n_old, -1);
  for (Index i = 0; i < n_old; ++i)
    if (const Vec3 p = mesh.points[i]; std::abs(p.x()) < 1e-9 && p.y() < -1e-9) {
      twin[i] = mesh.n_nodes();
      mesh.points.push_back(p);
    }
  Index at_crack = -1;
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    const Hex hex = mesh.hexes[h];
    Vec3 centre = Vec3::Zero();
    for (const Index i : hex) centre += mesh.points[i] / 8;
    if (centre.x() < 0) continue;
    for (Index& i : mesh.hexes[h])
      if (twin[i] >= 0) i = twin[i];
    if (hex != mesh.hexes[h] && std::abs(centre.z()) < 0.1 && centre.y() < -0.2) at_crack = h;
  }
  ASSERT_GE(at_crack, 0);
  const FacetResult skin = associate_with_own_skin(mesh);
  const MeshedModel input{mesh, skin.model, skin.association};
  Request request;
  request.target.ids = {at_crack};
  const RefineResult result = refined_both_ways(input, measured(input), request);
  EXPECT_TRUE(result.report.violations.empty()) << result.report.violations.front().text;
}

/// Results of these requests, broken in all ways, are reported alike by the change and from scratch.
void expect_broken_told_alike(const MeshedModel& input, std::span<const Request> requests, std::mt19937& random) {
  const Measured known = measured(input);
  const std::int64_t last_old = hex_id(input.mesh, input.mesh.n_hexes() - 1);
  for (const Request& request : requests) {
    const MeshedModel sound = refine(input, known, request).refined;
    // New hexes have the ids that follow the old ones.
    Index first_new = sound.mesh.n_hexes();
    while (first_new > 0 && hex_id(sound.mesh, first_new - 1) > last_old) --first_new;
    ASSERT_LT(first_new, sound.mesh.n_hexes());
    const auto any_new = [&] {
      const Index n = sound.mesh.n_hexes() - first_new;
      return first_new + static_cast<Index>(random() % static_cast<unsigned>(n));
    };
    int n_found = 0;
    for (int round = 0; round < 60; ++round) {
      MeshedModel broken = sound;
      Mesh& mesh = broken.mesh;
      Hex& hex = mesh.hexes[any_new()];
      switch (round % 5) {
        case 0:  // inverted, or folded
          std::swap(hex[random() % 8], hex[random() % 8]);
          break;
        case 1:  // a node that it does not have: sides with nothing behind
          hex[random() % 8] = static_cast<Index>(random() % mesh.points.size());
          break;
        case 2:  // two hexes in one place
          hex = mesh.hexes[any_new()];
          break;
        case 3:  // torn: a node is doubled for one hex
          mesh.points.push_back(mesh.points[hex[0]]);
          broken.association.node_owner.push_back(broken.association.node_owner[hex[0]]);
          broken.association.node_parameters.push_back(broken.association.node_parameters[hex[0]]);
          hex[0] = mesh.n_nodes() - 1;
          break;
        default:  // a new node far away
          mesh.points[input.mesh.n_nodes() + static_cast<Index>(random() % 8)] = {0.3, 0.2, 0.1};
      }
      Report change, all;
      verify(input, &known, broken, nullptr, change);
      verify(input, nullptr, broken, nullptr, all);
      ASSERT_EQ(change.violations.size(), all.violations.size()) << "round " << round;
      for (std::size_t i = 0; i < all.violations.size(); ++i)
        EXPECT_EQ(change.violations[i].text, all.violations[i].text) << "round " << round;
      n_found += !all.violations.empty();
    }
    EXPECT_GT(n_found, 30);
  }
}

Request of(EntityKind kind, Index id, std::optional<int> depth = std::nullopt) {
  Request request;
  request.target.kind = kind;
  request.target.ids = {id};
  if (depth) request.target.depth = depth;
  return request;
}

TEST(verify, a_broken_result_is_reported_as_if_everything_had_been_looked_at) {
  const unsigned seed = random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const Request requests[] = {of(EntityKind::hex, 0), of(EntityKind::hex, 5),             // at a corner, at an edge
                              of(EntityKind::hex, 6 + 12 * (6 + 12 * 6)),                 // inside
                              of(EntityKind::surface, 1, 1), of(EntityKind::volume, 1)};  // much of it, all of it
  expect_broken_told_alike(brick(12), requests, random);
}

TEST(verify, so_it_is_where_volumes_meet) {
  const unsigned seed = random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const MeshedModel input = shipped("inclusion");
  std::vector<Request> requests;
  for (int round = 0; round < 4; ++round)
    requests.push_back(of(EntityKind::hex, static_cast<Index>(random() % input.mesh.hexes.size())));
  for (Index id = 1; id <= input.model->count(2); id += 3) requests.push_back(of(EntityKind::surface, id, 0));
  requests.push_back(of(EntityKind::volume, 1));
  expect_broken_told_alike(input, requests, random);
}

}  // namespace
}  // namespace hextwist::test
