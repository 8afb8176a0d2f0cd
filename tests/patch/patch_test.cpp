// A request run in a patch gives what it gives over the whole mesh, to the bit.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "hextwist/base/sorted.h"
#include "hextwist/geom/occ/model.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/validate/validate.h"
#include "hextwist/patch/neighbours.h"
#include "hextwist/patch/patch_refine.h"
#include "hextwist/patch/refine_known.h"
#include "hextwist/sizing/plan.h"
#include "support/grids.h"
#include "support/meshed.h"
#include "support/same_meshed.h"
#include "support/seed.h"

namespace hextwist::test {
namespace {

/// While it lives.
struct Rule {
  Rule(Index least_mesh, Index part) { patch_rule = {least_mesh, part}; }
  ~Rule() { patch_rule = before; }
  const PatchRule before = patch_rule;
};
constexpr Index never = std::numeric_limits<Index>::max();

void expect_same(const Summary& a, const Summary& b) {
  EXPECT_EQ(a.count, b.count);
  EXPECT_EQ(a.average, b.average);
  EXPECT_EQ(a.std_dev, b.std_dev);
  EXPECT_EQ(a.min, b.min);
  EXPECT_EQ(a.max, b.max);
  EXPECT_EQ(a.min_hex, b.min_hex);
  EXPECT_EQ(a.max_hex, b.max_hex);
}

void expect_same(const Report& a, const Report& b) {
  EXPECT_EQ(a.hexes_before, b.hexes_before);
  EXPECT_EQ(a.hexes_after, b.hexes_after);
  EXPECT_EQ(a.nodes_before, b.nodes_before);
  EXPECT_EQ(a.nodes_after, b.nodes_after);
  EXPECT_EQ(a.filled_hexes, b.filled_hexes);
  expect_same(a.shape_before, b.shape_before);
  expect_same(a.shape_after, b.shape_after);
  expect_same(a.scaled_jacobian_before, b.scaled_jacobian_before);
  expect_same(a.scaled_jacobian_after, b.scaled_jacobian_after);
  EXPECT_EQ(a.off_cad.max, b.off_cad.max);
  EXPECT_EQ(a.off_cad.node, b.off_cad.node);
  EXPECT_EQ(a.off_cad.owner, b.off_cad.owner);
  EXPECT_EQ(a.volume_before, b.volume_before);
  EXPECT_EQ(a.volume_after, b.volume_after);
  ASSERT_EQ(a.off_nodes.size(), b.off_nodes.size());
  for (std::size_t i = 0; i < a.off_nodes.size(); ++i) {
    EXPECT_EQ(a.off_nodes[i].node, b.off_nodes[i].node);
    EXPECT_EQ(a.off_nodes[i].owner, b.off_nodes[i].owner);
    EXPECT_EQ(a.off_nodes[i].distance, b.off_nodes[i].distance);
  }
  EXPECT_EQ(a.violations.size(), b.violations.size());
  ASSERT_EQ(a.sizes.has_value(), b.sizes.has_value());
  if (a.sizes) {
    EXPECT_EQ(a.sizes->n_passes, b.sizes->n_passes);
    EXPECT_EQ(a.sizes->hexes, b.sizes->hexes);
    EXPECT_EQ(a.sizes->ratio, b.sizes->ratio);
    EXPECT_EQ(a.sizes->n_coarser, b.sizes->n_coarser);
    EXPECT_EQ(a.sizes->n_finer, b.sizes->n_finer);
    EXPECT_EQ(a.sizes->n_much_finer, b.sizes->n_much_finer);
    EXPECT_EQ(a.sizes->unmet, b.sizes->unmet);
    ASSERT_EQ(a.sizes->moved.has_value(), b.sizes->moved.has_value());
    if (a.sizes->moved) {
      EXPECT_EQ(a.sizes->moved->met(), b.sizes->moved->met());
    }
    EXPECT_EQ(a.sizes->directions.has_value(), b.sizes->directions.has_value());
    if (a.sizes->directions && b.sizes->directions) {
      EXPECT_EQ(a.sizes->directions->n_longer, b.sizes->directions->n_longer);
      EXPECT_EQ(a.sizes->directions->n_shorter, b.sizes->directions->n_shorter);
    }
  }
  EXPECT_EQ(a.notices, b.notices);
}

/// Ids with gaps, overlapping blocks, sets and fields, by chance.
void decorate(MeshedModel& meshed, std::mt19937& random) {
  Mesh& mesh = meshed.mesh;
  const auto count_up = [&](std::size_t n) {
    std::vector<std::int64_t> ids(n);
    std::int64_t id = 5;
    for (std::int64_t& i : ids) i = id += 1 + static_cast<std::int64_t>(random() % 3);
    return ids;
  };
  mesh.node_ids = random() % 2 ? count_up(mesh.points.size()) : std::vector<std::int64_t>{};
  mesh.hex_ids = random() % 2 ? count_up(mesh.hexes.size()) : std::vector<std::int64_t>{};
  const auto some = [&](Index n, unsigned out_of) {
    std::vector<Index> chosen;
    for (Index i = 0; i < n; ++i)
      if (random() % out_of != 0) chosen.push_back(i);
    return chosen;
  };
  mesh.blocks = {{7, "many", some(mesh.n_hexes(), 10)}, {8, "half", some(mesh.n_hexes(), 2)}, {9, "", {}}};
  mesh.node_sets = {{1, "nodes", some(mesh.n_nodes(), 20)}, {2, "", some(mesh.n_nodes(), 2)}};
  mesh.side_sets = {{3, "sides", {}}};
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (int f = 0; f < 6; ++f)
      if (random() % 3 == 0) mesh.side_sets[0].sides.push_back({h, f});
  Field on_nodes{"displacement", Field::On::node, 3, {}}, on_hexes{"pressure", Field::On::hex, 2, {}};
  for (std::size_t i = 0; i < 3 * mesh.points.size(); ++i) on_nodes.values.push_back(static_cast<double>(random()));
  for (std::size_t i = 0; i < 2 * mesh.hexes.size(); ++i) on_hexes.values.push_back(static_cast<double>(random()));
  mesh.fields = {on_nodes, on_hexes};
}

double mean_edge(const Mesh& mesh) {
  double sum = 0;
  const Edges all = edges(mesh);
  for (const auto& [a, b] : all.nodes) sum += (mesh.points[a] - mesh.points[b]).norm();
  return sum / static_cast<double>(all.nodes.size());
}

Request random_request(const MeshedModel& meshed, std::mt19937& random) {
  const auto one_of = [&](int n) { return static_cast<Index>(random() % static_cast<unsigned>(n)); };
  Request request;
  request.target.kind = static_cast<EntityKind>(one_of(one_of(3) ? 6 : 8));  // few large ones
  const Mesh& mesh = meshed.mesh;
  Index n = 0;
  switch (request.target.kind) {
    case EntityKind::node:
      n = mesh.n_nodes();
      break;
    case EntityKind::edge:
      n = static_cast<Index>(edges(mesh).nodes.size());
      break;
    case EntityKind::face:
      n = static_cast<Index>(faces(mesh).nodes.size());
      break;
    case EntityKind::hex:
      n = mesh.n_hexes();
      break;
    default:
      n = meshed.model->count(static_cast<int>(request.target.kind) - static_cast<int>(EntityKind::vertex));
  }
  const bool is_cad = request.target.kind >= EntityKind::vertex;
  for (Index i = one_of(3); i >= 0 && n > 0; --i) request.target.ids.push_back(one_of(n) + is_cad);
  sort_unique(request.target.ids);
  const bool is_large =
      request.target.kind == EntityKind::surface || request.target.kind == EntityKind::volume;  // it takes long
  request.how = Cuts{1 + (!is_large && one_of(3) == 0)};
  if (const Index depth = one_of(5); depth < 3) request.target.depth = depth;
  if (one_of(6) == 0) {
    request.target.depth.reset();
    request.target.radius = 0.05 * box(mesh).diagonal() * (1 + one_of(3));
  }
  if (one_of(4) == 0) request.method = static_cast<Method>(one_of(4));
  if (!is_large && one_of(3) == 0) {
    // Sizes that cut what they are wished for once or twice, and grow fast, so that it stays small.
    const bool is_wide = request.target.radius || request.target.depth.value_or(0) > 1;
    Sizes sizes{.size = mean_edge(mesh) / (1.5 + one_of(is_wide ? 2 : 4))};
    if (one_of(2) == 0) sizes.bias = 1.5 + 0.5 * one_of(4);
    if (one_of(4) == 0) sizes.max_passes = 1 + one_of(2);
    request.how = sizes;
    if (request.method == Method::parallel && request.target.depth == 0) request.method = Method::automatic;
    if (one_of(4) == 0) request.transition = Transition::regular;
  }
  if (one_of(2) == 0) request.concave = Concave::fill;
  request.finish.smooth = !is_large && one_of(3) == 0;
  request.finish.dry_run = one_of(8) == 0;
  if (one_of(4) == 0)
    for (int i = 0; i < 20; ++i) request.finish.fixed.push_back(one_of(mesh.n_nodes()));
  return request;
}

std::string text_of(const Request& r) {
  std::string text(name(r.target.kind));
  for (const Index t : r.target.ids) text += " " + std::to_string(t);
  if (const auto* sizes = std::get_if<Sizes>(&r.how))
    text += " size " + std::to_string(*sizes->size) + " bias " + std::to_string(sizes->bias) + " max_passes " +
            std::to_string(sizes->max_passes) + (r.transition == Transition::regular ? " regular" : "");
  else
    text += " numsplit " + std::to_string(std::get<Cuts>(r.how).numsplit);
  if (r.target.depth) text += " depth " + std::to_string(*r.target.depth);
  if (r.target.radius) text += " radius " + std::to_string(*r.target.radius);
  return text + " " + name(r.method) + (r.concave == Concave::fill ? " fill" : "") +
         (r.finish.smooth ? " smooth" : "") + (r.finish.dry_run ? " dry_run" : "");
}

int n_sizes_in_patches = 0;  // requests for sizes that cut something

/// Whether a patch was used, after checking that it makes no difference.
bool expect_same_both_ways(const MeshedModel& meshed, const Measured& known, const Request& request) {
  SCOPED_TRACE(text_of(request));
  const auto result = [&](Index least_mesh, std::string& error) -> std::optional<RefineResult> {
    const Rule rule(least_mesh, 1);
    try {
      return refine(meshed, known, request);
    } catch (const Error& e) {
      error = e.what();
      return std::nullopt;
    }
  };
  std::string error, patch_error;
  const auto whole = result(never, error), patch = result(0, patch_error);
  EXPECT_EQ(error, patch_error);
  if (!whole || !patch) return false;
  EXPECT_TRUE(same_bits(whole->refined, patch->refined));
  EXPECT_EQ(whole->origin, patch->origin);
  expect_same(whole->report, patch->report);
  if (patch->report.sizes && !patch->report.sizes->hexes.empty()) {
    const auto& seconds = patch->report.seconds;
    n_sizes_in_patches += std::ranges::find(seconds, "patch", &StageTime::stage) != seconds.end();
  }
  return std::ranges::find(patch->report.seconds, "splice", &StageTime::stage) != patch->report.seconds.end();
}

/// Requests by chance until so many were run in patches.
void expect_same_for(MeshedModel meshed, int n_wanted, std::mt19937& random) {
  int n_used = 0, n_tried = 0;
  for (; n_used < n_wanted && n_tried < 6 * n_wanted; ++n_tried) {
    decorate(meshed, random);
    n_used += expect_same_both_ways(meshed, measured(meshed), random_request(meshed, random));
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(n_used, 0) << "of " << n_tried;
}

TEST(patch, lists_the_curve_edges_of_its_own_hexes_only) {
  const unsigned seed = random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const MeshedModel meshed = shipped("inclusion");
  int n_elsewhere = 0;  // both nodes here, the hexes elsewhere
  for (int i = 0; i < 200; ++i) {
    std::vector<Index> hexes;
    for (Index h = 0; h < meshed.mesh.n_hexes(); ++h)
      if (random() % 8 == 0) hexes.push_back(h);
    const Patch patch = make_patch(meshed, hexes);
    std::vector<Edge> mine;
    for (const Hex& hex : patch.meshed.mesh.hexes)
      for (int e = 0; e < n_hex_edges; ++e) {
        const Index a = patch.nodes[hex[edge_corner(e, 0)]], b = patch.nodes[hex[edge_corner(e, 1)]];
        mine.push_back({std::min(a, b), std::max(a, b)});
      }
    sort_unique(mine);
    const Association &whole = meshed.association, &part = patch.meshed.association;
    std::vector<std::pair<Edge, int>> expected, listed;
    for (std::size_t e = 0; e < whole.curve_edges.size(); ++e) {
      const auto [a, b] = whole.curve_edges[e];
      if (std::ranges::binary_search(mine, whole.curve_edges[e]))
        expected.emplace_back(whole.curve_edges[e], whole.edge_curve[e]);
      else
        n_elsewhere += patch.local_node(a) >= 0 && patch.local_node(b) >= 0;
    }
    ASSERT_EQ(part.curve_edges.size(), part.edge_curve.size());
    for (std::size_t e = 0; e < part.curve_edges.size(); ++e) {
      const auto [a, b] = part.curve_edges[e];
      listed.push_back({{patch.nodes[a], patch.nodes[b]}, part.edge_curve[e]});
    }
    EXPECT_TRUE(listed == expected);
  }
  EXPECT_GT(n_elsewhere, 0);
}

TEST(patch, requests_by_chance_on_grids_give_what_they_give_over_the_whole_mesh) {
  const unsigned seed = random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  expect_same_for(brick(11, 10, 12), 12, random);
  MeshedModel mixed = brick(30, 8, 3);
  mixed.mesh = shuffled(mixed.mesh, random);
  mixed.association = associate(mixed.mesh, *mixed.model).association;
  expect_same_for(mixed, 12, random);
  // Hexes that are long in one direction, here and there in others: what is cut for that may begin far away.
  MeshedModel graded = brick(16, 6, 6);
  for (Vec3& p : graded.mesh.points) p.y() *= p.y() > 0 ? 0.2 : 1;
  FacetResult skin = associate_with_own_skin(graded.mesh);
  graded.model = skin.model;
  graded.association = std::move(skin.association);
  expect_same_for(graded, 8, random);
  EXPECT_GT(n_sizes_in_patches, 0);
}

TEST(patch, requests_by_chance_on_shipped_models_give_what_they_give_over_the_whole_mesh) {
  const unsigned seed = random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models")) {
    if (entry.path().extension() != ".msh") continue;
    SCOPED_TRACE(entry.path());
    expect_same_for(shipped(entry.path().stem().string()), 2, random);
  }
}

TEST(patch, requests_by_chance_on_real_cad_and_foreign_meshes_give_what_they_give_over_the_whole_mesh) {
  const auto folder = data_folder();
  if (folder.empty()) GTEST_SKIP() << "the folder of real CAD and meshes is not here";
  const unsigned seed = random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (const std::string name : {"two_material", "bracket_fillet", "sphere7"}) {
    SCOPED_TRACE(name);
    MeshedModel meshed{
        read_mesh(folder / "cad" / (name + "_1k.msh")).mesh, read_cad(folder / "cad" / (name + ".brep")).model, {}};
    meshed.association = associate(meshed.mesh, *meshed.model).association;
    expect_same_for(std::move(meshed), 3, random);
  }
  for (const char* name : {"swivel2_7494.mesh", "mastodon_model_1.e", "moebius_rot1_r1.vtk"}) {
    SCOPED_TRACE(name);
    MeshedModel meshed{read_mesh(folder / "mesh" / name).mesh, nullptr, {}};
    repair_orientation(meshed.mesh);
    FacetResult skin = associate_with_own_skin(meshed.mesh);
    meshed.model = skin.model;
    meshed.association = std::move(skin.association);
    expect_same_for(std::move(meshed), 3, random);
  }
}

TEST(patch, without_a_model_it_is_used_too_and_then_verified_from_scratch) {
  std::mt19937 random(1);
  MeshedModel meshed{grid(20, 20, 20), nullptr, {}};
  decorate(meshed, random);
  Request request{.target = {.kind = EntityKind::hex, .ids = {4210}}};
  request.finish.smooth = true;
  EXPECT_TRUE(expect_same_both_ways(meshed, measured(meshed), request));
}

TEST(patch, it_grows_where_filling_goes_on_beyond_its_rings) {
  // Two rows of hexes that meet in an L, on a plate: filling makes a square of them.
  MeshedModel meshed = brick(60, 60, 2);
  Request request{.target = {.kind = EntityKind::hex}, .concave = Concave::fill};
  for (Index i = 20; i < 40; ++i) {
    request.target.ids.push_back(i + 60 * 20);
    request.target.ids.push_back(20 + 60 * i);
  }
  sort_unique(request.target.ids);
  EXPECT_TRUE(expect_same_both_ways(meshed, measured(meshed), request));
}

TEST(patch, requests_that_look_farther_than_their_target_do_not_use_one) {
  const MeshedModel meshed = brick(12, 12, 12);
  const auto local = [&](Request request) { return plan(meshed, request).reach.has_value(); };
  const Request hex{.target = {.kind = EntityKind::hex, .ids = {0}}},
      curve{.target = {.kind = EntityKind::curve, .ids = {1}}};
  EXPECT_TRUE(local(hex));
  EXPECT_TRUE(local(curve));
  const auto with = [&](Request request, auto change) {
    change(request);
    return request;
  };
  EXPECT_FALSE(local(with(hex, [](Request& r) { r.method = Method::parallel; })));
  EXPECT_TRUE(local(with(curve, [](Request& r) { r.method = Method::parallel; })));
  EXPECT_FALSE(local(with(curve, [](Request& r) { r.method = Method::parallel, r.target.depth = 1; })));
  EXPECT_FALSE(local(with(curve, [](Request& r) { r.method = Method::parallel, r.target.radius = 1; })));
  EXPECT_FALSE(local(with(curve, [](Request& r) { r.how = Sizes{.size = 0.1}; })));
  EXPECT_FALSE(local(with(curve, [](Request& r) { r.how = Layers{}; })));
  EXPECT_FALSE(local(with(hex, [](Request& r) { r.how = AcrossSheets{.edges = {0}}; })));
  EXPECT_FALSE(local({.target = {.kind = EntityKind::volume, .ids = {1}}}));
  EXPECT_FALSE(local({.target = {.kind = EntityKind::surface, .ids = {1}}, .how = Thickness{}}));
  // Nor large changes and small meshes, and nor is anything done before errors are found.
  const Measured known = measured(meshed);
  const Rule rule(0, 8);
  EXPECT_FALSE(refine_patch(meshed, known, curve, {}).has_value());
  EXPECT_FALSE(refine_patch(brick(3, 3, 3), known, hex, {}).has_value());
  EXPECT_THROW(refine(meshed, known, with(hex, [](Request& r) { r.target.ids = {100000}; })), Error);
}

/// Per node its hexes, as asked for and as they are.
void expect_neighbours_of(const Mesh& mesh, const Neighbours& neighbours) {
  const CompressedRows lists = node_hexes(mesh);
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    std::vector<Index> found;
    neighbours.hexes_at({&n, 1}, found);
    std::ranges::sort(found);
    ASSERT_TRUE(std::ranges::equal(found, lists[n])) << n;
  }
}

TEST(splice, neighbours_follow_the_mesh_there_and_back) {
  const unsigned seed = random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const Rule rule(0, 1);
  MeshedModel meshed = brick(7, 6, 5);
  decorate(meshed, random);
  Neighbours neighbours(meshed.mesh);
  std::vector<MeshedModel> states = {meshed};
  std::vector<std::unique_ptr<const Splice>> done;
  for (int i = 0; i < 40; ++i) {
    if (!done.empty() && random() % 3 == 0) {
      done.back()->make_room(meshed, false);
      done.back()->apply(meshed, false);
      ASSERT_TRUE(neighbours.apply(*done.back(), false));
      done.pop_back();
      states.pop_back();
      ASSERT_TRUE(same_bits(meshed, states.back()));
    } else {
      Request request{.target = {.kind = EntityKind::hex}};
      request.target.ids = {static_cast<Index>(random() % meshed.mesh.hexes.size())};
      request.finish.smooth = random() % 4 == 0;
      auto made = refine_patch(meshed, measured(meshed), request, {});
      ASSERT_TRUE(made.has_value());
      EXPECT_GT(made->splice->bytes(), 1000u);
      states.push_back(spliced(meshed, *made->splice));
      made->splice->make_room(meshed, true);
      made->splice->apply(meshed, true);
      ASSERT_TRUE(neighbours.apply(*made->splice, true));
      done.push_back(std::move(made->splice));
      ASSERT_TRUE(same_bits(meshed, states.back()));
    }
    expect_neighbours_of(meshed.mesh, neighbours);
  }
  // A list that was made later does not know what was there before.
  if (done.empty()) return;
  Neighbours later(meshed.mesh);
  EXPECT_FALSE(later.apply(*done.back(), false));
}

TEST(extremes, know_who_is_next_when_the_extremes_are_cut) {
  const Mesh mesh = grid(30, 30, 30);
  std::mt19937 random(3);
  std::vector<double> values(mesh.hexes.size());
  for (double& value : values) value = static_cast<double>(random() % 5000);
  for (const bool largest : {false, true}) {
    ExtremeList list = extremes(mesh, values, largest);
    std::vector<std::pair<double, std::int64_t>> all;
    for (Index h = 0; h < mesh.n_hexes(); ++h) all.emplace_back(largest ? -values[h] : values[h], hex_id(mesh, h));
    std::ranges::sort(all);
    for (int round = 0; round < 100 && !list.empty(); ++round) {
      ASSERT_TRUE(std::ranges::equal(list, std::span(all).first(list.size()))) << round;
      // Some of the best and some others go, some come.
      std::vector<std::int64_t> gone;
      for (int i = 0; i < 30; ++i) gone.push_back(all[random() % (i % 2 ? 100 : all.size())].second);
      std::ranges::sort(gone);
      std::erase_if(all, [&](const auto& item) { return std::ranges::binary_search(gone, item.second); });
      ExtremeList come;
      for (int i = 0; i < 5; ++i)
        come.emplace_back((largest ? -1.0 : 1.0) * static_cast<double>(random() % 5000), 100000 + 5 * round + i);
      all.insert(all.end(), come.begin(), come.end());
      std::ranges::sort(all);
      list = changed(list, gone, come);
    }
  }
}

TEST(patch, a_cancelled_one_is_cancelled) {
  const MeshedModel meshed = brick(12, 12, 12);
  const Rule rule(0, 1);
  int n_calls = 0;
  EXPECT_THROW(refine(meshed, measured(meshed), {.target = {.kind = EntityKind::hex, .ids = {800}}},
                      [&](const char*, double) { return ++n_calls < 3; }),
               Cancelled);
}

}  // namespace
}  // namespace hextwist::test
