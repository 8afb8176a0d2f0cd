// Forests through many steps: identity, history, origin, fields.
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <numeric>
#include <random>
#include <set>

#include "hextwist/base/memory.h"
#include "hextwist/mesh/loose_topology.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/refine/levels/gradation.h"
#include "hextwist/refine/levels/reorder.h"
#include "refine/levels_fixture.h"
#include "support/association_checkers.h"
#include "support/checkers.h"
#include "support/grids.h"
#include "support/same_meshed.h"

namespace hextwist {
namespace {

using test::Grown;

double smallest_scaled_jacobian(const Mesh& mesh) {
  return summarize(quality(Metric::scaled_jacobian, mesh)).min;
}

bool same_bits(const Vec3& a, const Vec3& b) {
  return std::memcmp(a.data(), b.data(), sizeof a) == 0;
}

/// What a step says of nodes and hexes, against both meshes. Returns how many kept nodes have moved.
int expect_step_kept(const Mesh& before, const LevelStep& step, bool exact) {
  const Mesh& now = step.mesh.mesh;
  int moved = 0;
  for (Index n = 0; n < now.n_nodes(); ++n) {
    const Index old = step.old_node[n];
    if (old < 0) continue;
    EXPECT_EQ(node_id(now, n), node_id(before, old));
    moved +=
        exact ? !same_bits(now.points[n], before.points[old]) : (now.points[n] - before.points[old]).norm() > 1e-12;
  }
  std::vector<double> gone(before.hexes.size(), 0), come(before.hexes.size(), 0);  // volumes at the first old hex
  for (Index h = 0; h < now.n_hexes(); ++h) {
    const auto old = step.origin.before(h);
    EXPECT_TRUE(std::ranges::is_sorted(old, std::less_equal{}));
    EXPECT_EQ(old.size() > 1, step.origin.kind[h] == HexOrigin::coarser);
    come[old[0]] += volume(now, h);
    gone[old[0]] = 0;
    for (const Index other : old) gone[old[0]] += volume(before, other);
    if (step.origin.kind[h] != HexOrigin::same) {
      EXPECT_EQ(find_hex(before, hex_id(now, h)), -1);
      continue;
    }
    EXPECT_EQ(hex_id(now, h), hex_id(before, old[0]));
    for (int c = 0; c < 8; ++c) EXPECT_EQ(step.old_node[now.hexes[h][c]], before.hexes[old[0]][c]);
  }
  double all = 0;
  for (std::size_t h = 0; h < gone.size(); ++h) {
    EXPECT_NEAR(come[h], gone[h], 0.5 * gone[h]) << h;  // on curved CAD, hexes do not quite fill their cell
    all += gone[h];
  }
  EXPECT_NEAR(all, volume(before), 1e-9 * all);
  EXPECT_TRUE(std::ranges::is_sorted(now.hex_ids, std::less_equal{}));
  EXPECT_TRUE(std::ranges::is_sorted(now.node_ids, std::less_equal{}));
  return moved;
}

/// The least quality is that of one pass with random targets: more levels and more steps cost nothing.
struct Walk {
  const char* name;
  double least_quality;
  bool has_splines = false;  ///< whose projections round otherwise in batches of less than four points
};
void PrintTo(const Walk& walk, std::ostream* out) {
  *out << walk.name;
}
class LevelsWalk : public testing::TestWithParam<Walk> {};

TEST_P(LevelsWalk, random_steps_keep_quality_and_identity_and_lead_back_to_the_base) {
  const std::string name = GetParam().name;
  const MeshedModel base = name == "cubes" ? test::brick(4, 4, 4) : test::shipped(name);
  Grown grown(base);
  std::mt19937 random(12);
  double worst = 1;
  int moved = 0;
  for (int i = 0; i < 40; ++i) {
    const Mesh before = grown.mesh.mesh;
    const std::vector<int> levels = grown.levels();
    const std::vector<Index> roots = grown.roots();
    // Some hexes finer, some regions (flags of single pieces would never coarsen) coarser.
    std::vector<int> change(before.hexes.size(), 0), of_root(base.mesh.hexes.size(), 0);
    for (int& level : of_root) level = random() % 4 == 0 ? -1 : 0;
    for (std::size_t h = 0; h < change.size(); ++h) change[h] = of_root[roots[h]];
    for (int j = 0; j < 4; ++j)
      if (const auto h = random() % change.size(); levels[h] < 2) change[h] = 1;
    const LevelStep step = grown.adapt([&](Index h) { return change[h]; });
    moved += expect_step_kept(before, step, !GetParam().has_splines);
    worst = std::min(worst, smallest_scaled_jacobian(grown.mesh.mesh));
    if (i % 10 == 9) {
      EXPECT_TRUE(test::conformal(grown.mesh.mesh));
      EXPECT_TRUE(test::uninverted(grown.mesh.mesh));
      EXPECT_TRUE(test::complete(grown.mesh.mesh, grown.mesh.association, *grown.mesh.model));
      EXPECT_TRUE(test::on_model(grown.mesh.mesh, grown.mesh.association, *grown.mesh.model, 1e-6));
    }
  }
  EXPECT_GE(worst, GetParam().least_quality);
  EXPECT_EQ(moved, 0);
  grown.adapt([](Index) { return -1; });
  grown.adapt([](Index) { return -1; });
  EXPECT_TRUE(test::same_bits(grown.mesh, base));
  EXPECT_TRUE(grown.forest.is_bare());
}
INSTANTIATE_TEST_SUITE_P(Levels, LevelsWalk,
                         testing::Values(Walk{"cubes", 0.405}, Walk{"cam", 0.078}, Walk{"ring_twist", 0.17, true},
                                         Walk{"inclusion", 0.068}),
                         [](const auto& of) { return std::string(of.param.name); });
INSTANTIATE_TEST_SUITE_P(SlowLevels, LevelsWalk,
                         testing::Values(Walk{"bracket", 0.14}, Walk{"pipe_tee", 0.05}, Walk{"sphere", 0.12},
                                         Walk{"curved_plate", 0.12, true}),
                         [](const auto& of) { return std::string(of.param.name); });

/// The mesh of a forest level by level, without ids.
MeshedModel by_level(const Grown& grown) {
  const auto inverse = [](const std::vector<Index>& order) {
    std::vector<Index> result(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) result[order[i]] = static_cast<Index>(i);
    return result;
  };
  const GrownForest& of = *grown.forest.grown;
  MeshedModel result = reordered(grown.mesh, inverse(of.node_order), inverse(of.hex_order));
  result.mesh.node_ids.clear();
  result.mesh.hex_ids.clear();
  return result;
}

TEST(Levels, mesh_depends_on_what_is_refined_and_not_on_the_way_there) {
  for (const char* name : {"cubes", "cam", "inclusion", "ring_twist"}) {
    const MeshedModel base = std::string(name) == "cubes" ? test::brick(4, 4, 4) : test::shipped(name);
    std::mt19937 random(5);
    std::vector<int> target(base.mesh.hexes.size());
    for (int& level : target) level = random() % 20 == 0 ? 1 + static_cast<int>(random() % 2) : 0;
    Grown at_once(base);
    at_once.adapt([&](Index h) { return target[h]; });
    for (int trial = 0; trial < 3; ++trial) {
      Grown wandered(base);
      for (int i = 0; i < 4; ++i) wandered.adapt([&](Index) { return random() % 40 == 0 ? 1 : random() % 2 ? -1 : 0; });
      for (const int stage : {2, 1}) {  // a part of the way there, then all of it
        const std::vector<int> levels = wandered.levels();
        const std::vector<Index> roots = wandered.roots();
        std::vector<std::uint8_t> wanted;
        for (std::size_t h = 0; h < roots.size(); ++h)
          wanted.push_back(static_cast<std::uint8_t>(roots[h] % stage == 0 ? target[roots[h]] : levels[h]));
        wandered.set(wanted);
      }
      EXPECT_TRUE(wandered.forest.wished == at_once.forest.wished);
      EXPECT_TRUE(test::same_bits(by_level(wandered), by_level(at_once))) << name;
    }
  }
}

TEST(Levels, kept_meshes_change_nothing) {
  const MeshedModel base = test::shipped("cam");
  Grown kept(base), afresh(base);
  LevelOptions keep;
  keep.keep_meshes = true;
  std::mt19937 random(5);
  for (int i = 0; i < 6; ++i) {
    std::vector<int> flags(kept.mesh.mesh.hexes.size());
    for (int& flag : flags) flag = random() % 100 == 0 && i < 3 ? 1 : i > 2 && random() % 2 == 0 ? -1 : 0;
    kept.adapt([&](Index h) { return flags[h]; }, keep);
    afresh.adapt([&](Index h) { return flags[h]; });
    ASSERT_TRUE(test::same_bits(kept.mesh, afresh.mesh));
  }
}

TEST(Levels, same_bits_for_any_number_of_threads) {
  const MeshedModel base = test::shipped("cam");
  const auto run = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    Grown grown(base);
    std::mt19937 random(5);
    for (int i = 0; i < 3; ++i) grown.adapt([&](Index) { return random() % 80 == 0 ? 1 : random() % 3 == 0 ? -1 : 0; });
    return grown.mesh;
  };
  const MeshedModel one = run(1);
  EXPECT_TRUE(test::same_bits(one, run(2)));
  EXPECT_TRUE(test::same_bits(one, run(8)));
}

TEST(Levels, linear_nodal_fields_stay_exact_and_hex_fields_keep_what_they_should) {
  MeshedModel base = test::brick(4, 4, 4);
  const auto linear = [](const Vec3& p) { return 1 + p.x() - 2 * p.y() + 0.5 * p.z(); };
  Field nodal{"linear", Field::On::node, 2, {}}, constant{"constant", Field::On::hex, 1, {}},
      material{"material", Field::On::hex, 1, {}}, mass{"mass", Field::On::hex, 1, {}};
  for (const Vec3& p : base.mesh.points) nodal.values.insert(nodal.values.end(), {linear(p), 3 * p.z()});
  for (Index h = 0; h < base.mesh.n_hexes(); ++h) {
    constant.values.push_back(0.1);
    material.values.push_back(0.3 * h);
    mass.values.push_back(1 + h % 7);
  }
  base.mesh.fields = {nodal, constant, material, mass};
  const double all = std::accumulate(mass.values.begin(), mass.values.end(), 0.0);
  Grown grown(base);
  std::mt19937 random(1);
  LevelOptions options;
  options.extensive = {"mass"};
  for (int i = 0; i < 20; ++i) {
    const std::vector<int> levels = grown.levels();
    const std::vector<Index> roots = grown.roots();
    std::vector<int> of_root(base.mesh.hexes.size());
    for (int& level : of_root) level = random() % 4 == 0 ? -1 : random() % 30 == 0 ? 1 : 0;
    grown.adapt([&](Index h) { return levels[h] < 2 || of_root[roots[h]] < 0 ? of_root[roots[h]] : 0; }, options);
    const Mesh& mesh = grown.mesh.mesh;
    ASSERT_TRUE(test::sets_valid(mesh));
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      ASSERT_NEAR(mesh.fields[0].values[2 * n], linear(mesh.points[n]), 1e-13);
      ASSERT_NEAR(mesh.fields[0].values[2 * n + 1], 3 * mesh.points[n].z(), 1e-13);
    }
    const std::vector<Index> roots_now = grown.roots();
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      ASSERT_EQ(mesh.fields[1].values[h], 0.1);
      ASSERT_EQ(mesh.fields[2].values[h], material.values[roots_now[h]]);
    }
    const auto& values = mesh.fields[3].values;
    ASSERT_NEAR(std::accumulate(values.begin(), values.end(), 0.0), all, 1e-9);
  }
  for (int i = 0; i < 2; ++i) grown.adapt([](Index) { return -1; }, options);
  for (Index h = 0; h < base.mesh.n_hexes(); ++h)
    EXPECT_NEAR(grown.mesh.mesh.fields[3].values[h], mass.values[h], 1e-12);
  grown.mesh.mesh.fields[3] = mass;
  EXPECT_TRUE(test::same_bits(grown.mesh, base));
}

TEST(Levels, coarsening_gives_back_what_one_refinement_made) {
  Grown grown(test::brick(5, 5, 5));
  grown.refine({62}, 2);
  const MeshedModel two = grown.mesh;
  EXPECT_EQ(two.mesh.n_hexes(), 3113);
  grown.adapt([](Index) { return -1; });
  EXPECT_EQ(grown.mesh.mesh.n_hexes(), 271);  // cells that only gradation had cut are gone too
  grown.refine(std::vector<Index>(1, 270));   // a piece of the closure: its cell becomes 27
  EXPECT_EQ(grown.forest.grown->marks[0].size(), 2u);
  EXPECT_EQ(grown.forest.grown->stack.size(), 1u);
}

TEST(Levels, marks_at_nodes_alone_are_graded_too) {
  // One marked edge of a cell of level 1 at a corner of its parent: the eight cells there are cut, the edge in three.
  Grown grown(test::brick(4, 4, 4));
  LevelMarks wished(2);
  const CellNumber hex = 21;  // at (1, 1, 1)
  wished[0].add(hex);
  wished[1].add(first_cell_child(hex), 0b11);
  const LevelStep step = change(grown.forest, grown.mesh.mesh, wished);
  EXPECT_EQ(step.forest.grown->marks[0].size(), 8u);
  EXPECT_EQ(step.n_forced, 7);
  EXPECT_TRUE(test::conformal(step.mesh.mesh));
  EXPECT_GE(smallest_scaled_jacobian(step.mesh.mesh), 0.405);
}

TEST(Levels, a_cell_that_is_cut_at_some_corners_is_given_up_by_its_pieces_alone) {
  Grown grown(test::brick(4, 4, 4));
  LevelMarks wished(2);
  const CellNumber hex = 21, child = first_cell_child(hex);
  wished[0].add(hex);
  wished[1].add(child, 0b11);
  const Forest forest = change(grown.forest, grown.mesh.mesh, wished).forest;
  const HandedHexes& hexes = forest.grown->hexes;
  // What is wished for when hexes of that cell, and hexes of others in the same hex of the base, may be coarser.
  const auto wished_after = [&](int of_cell, int of_others) {
    std::vector<std::int8_t> changes(static_cast<std::size_t>(hexes.n_hexes()), 0);
    for (std::size_t i = 0; i < hexes.cell.size(); ++i)
      if (hexes.root_of_piece(i) == static_cast<Index>(hex)) {
        const LevelPieces::Leaf leaf = hexes.leaf_of_piece(i);
        changes[static_cast<std::size_t>(hexes.n_whole()) + i] =
            static_cast<std::int8_t>(leaf.level == 1 && leaf.cell == child ? of_cell : of_others);
      }
    return wishes(forest, changes);
  };
  EXPECT_EQ(wished_after(0, -1), wished);
  LevelMarks whole(1);
  whole[0].add(hex);
  EXPECT_EQ(wished_after(-1, 0), whole);
  EXPECT_EQ(wished_after(-1, -1), whole);  // its pieces are two levels finer than the hex of the base
}

/// Places of the marked corners, in cells of the level; on a mesh of unit cubes, whichever way each of them is turned.
std::set<std::array<long, 3>> marked_places(const Mesh& cubes, const CellMarks& marks, std::size_t level) {
  const double n = std::pow(3, level);
  std::set<std::array<long, 3>> places;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const CellPlace cell = place_of(marks.cell[i], level);
    const Hex& hex = cubes.hexes[cell.root];
    for (int c = 0; c < 8; ++c) {
      if (!(marks.corners[i] >> c & 1)) continue;
      const Vec3 origin = cubes.points[hex[0]];
      Vec3 place = n * origin;
      for (int axis = 0; axis < 3; ++axis)
        place += (cell.at[axis] + (c >> axis & 1)) * (cubes.points[hex[1 << axis]] - origin);
      places.insert({std::lround(place.x()), std::lround(place.y()), std::lround(place.z())});
    }
  }
  return places;
}

TEST(Levels, cells_around_a_marked_place_are_cut_and_no_others) {
  constexpr int n_levels = 3;
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const Mesh mesh = test::shuffled(test::grid(2, 2, 2), random);
    LevelMarks wished(n_levels);
    for (unsigned i = 0; i <= seed % 4; ++i) {
      CellPlace place{static_cast<Index>(random() % mesh.hexes.size()), {}};
      for (Index& at : place.at) at = static_cast<Index>(random() % 9);
      wished.back().add(number_of(place, 9), static_cast<std::uint8_t>(1U << random() % 8));
    }
    normalize(wished.back());
    LevelMarks expected = wished;
    for (std::size_t level = n_levels - 1; level > 0; --level) {
      const auto marked = marked_places(mesh, expected[level], level);
      const auto n_cells = mesh.n_hexes() * static_cast<CellNumber>(std::pow(n_cell_children, level - 1));
      for (CellNumber cell = 0; cell < n_cells; ++cell) {
        CellMarks whole;
        whole.add(cell);
        const auto corners = marked_places(mesh, whole, level - 1);  // ascending: the lowest first, the highest last
        const auto touches = [&](const std::array<long, 3>& place) {
          bool inside = true;
          for (int axis = 0; axis < 3; ++axis)
            inside =
                inside && 3 * (*corners.begin())[axis] <= place[axis] && place[axis] <= 3 * (*corners.rbegin())[axis];
          return inside;
        };
        if (std::ranges::any_of(marked, touches)) expected[level - 1].add(cell);
      }
    }
    EXPECT_TRUE(graded(wished, mesh.hexes, node_corners(mesh)) == expected) << seed;
  }
}

TEST(Levels, marks_on_a_periodic_boundary_get_their_images_and_no_others) {
  const std::array<int, 3> size = {2, 3, 2};
  for (std::size_t level = 0; level < 3; ++level)
    for (int periodic = 1; periodic < 8; ++periodic) {  // bit: along which axes
      std::mt19937 random(static_cast<unsigned>(periodic));
      const Mesh mesh = test::shuffled(test::grid(size[0], size[1], size[2]), random);
      Mirror mirror;
      for (int axis = 0; axis < 3; ++axis) {
        if (!(periodic >> axis & 1)) continue;
        std::vector<NodePair> there, back;
        for (Index a = 0; a < mesh.n_nodes(); ++a)
          for (Index b = 0; b < mesh.n_nodes(); ++b)
            if (mesh.points[b] - mesh.points[a] == size[axis] * Vec3::Unit(axis)) {
              there.push_back({a, b});
              back.push_back({b, a});
            }
        std::ranges::sort(back);
        mirror.images.push_back(there);
        mirror.images.push_back(back);
      }
      const auto n = static_cast<long>(std::pow(3, level));
      CellMarks marks;
      for (int i = 0; i < 12 * n * n; ++i) {
        CellPlace place{static_cast<Index>(random() % mesh.hexes.size()), {}};
        for (Index& at : place.at) at = static_cast<Index>(static_cast<long>(random()) % n);
        marks.add(number_of(place, static_cast<Index>(n)), static_cast<std::uint8_t>(1U << random() % 8));
      }
      normalize(marks);
      auto expected = marked_places(mesh, marks, level);
      for (int axis = 0; axis < 3; ++axis) {
        const long far = size[axis] * n;
        for (auto place : std::set(expected))
          if (periodic >> axis & 1 && place[axis] % far == 0) {
            place[axis] = far - place[axis];
            expected.insert(place);
          }
      }
      const CellMarks before = marks;
      mark_images(marks, level, mesh.hexes, node_corners(mesh), mirror);
      EXPECT_TRUE(united(marks, before) == marks);
      EXPECT_TRUE(marked_places(mesh, marks, level) == expected) << level << ", axes " << periodic;
    }
}

TEST(Levels, surfaces_that_have_faces_between_two_hexes_are_known) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    MeshedModel meshed{test::shuffled(test::grid(3, 2, 2), random), nullptr, {}};
    const Faces all = faces(meshed.mesh);
    std::set<int> expected;
    for (Index h = 0; h < meshed.mesh.n_hexes(); ++h)
      for (int f = 0; f < n_hex_faces; ++f) {
        const auto& sides = all.sides[all.of_hex[h][f]];
        const bool inner = sides[1].hex >= 0;
        if (!(sides[0] == Side{h, f}) || random() % 4 == 0 || (inner && random() % 2 == 0)) continue;
        const int surface = 1 + static_cast<int>(random() % (inner ? 4 : 9));
        meshed.association.surface_faces.push_back(sides[0]);
        meshed.association.face_surface.push_back(surface);
        if (inner) expected.insert(surface);
      }
    EXPECT_EQ(inner_surfaces(meshed, node_corners(meshed.mesh)), std::vector<int>(expected.begin(), expected.end()));
  }
}

TEST(Levels, too_many_levels_are_refused) {
  EXPECT_EQ(max_level(1), 13);
  EXPECT_EQ(max_level(1000000), 8);
  Grown grown(test::brick(1, 1, 1));
  EXPECT_THROW(wishes(grown.forest, std::vector<std::int8_t>{14}), Error);
  EXPECT_THROW(wishes(grown.forest, std::vector<std::int8_t>{1, 1}), Error);
}

TEST(Levels, hexes_that_are_asked_for_are_counted_before_any_is_made) {
  Grown grown(test::brick(2, 1, 1));
  limit_hexes(500);
  try {
    wishes(grown.forest, std::vector<std::int8_t>{2, 1});
    ADD_FAILURE() << "not refused";
  } catch (const TooLarge& error) {
    EXPECT_EQ(std::string(error.what()).find("the refined mesh would have at least 756 hexes"), 0U) << error.what();
  }
  limit_hexes(0);
  EXPECT_NO_THROW(wishes(grown.forest, std::vector<std::int8_t>{2, 1}));
}

}  // namespace
}  // namespace hextwist
