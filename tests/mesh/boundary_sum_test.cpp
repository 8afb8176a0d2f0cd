#include "hextwist/mesh/validate/boundary_sum.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <random>

#include "hextwist/mesh/topology.h"
#include "support/grids.h"
#include "support/seed.h"

namespace hextwist {
namespace {

std::uint64_t sum_of_skin(const Mesh& mesh) {
  std::uint64_t sum = 0;
  for (const Side side : boundary_sides(faces(mesh))) sum += side_number(mesh.hexes[side.hex], side.face);
  return sum;
}

TEST(boundary_sum, a_face_has_opposite_numbers_from_its_two_hexes_and_no_number_twice) {
  const Mesh mesh = test::grid(4, 3, 2);
  const Faces all = faces(mesh);
  std::vector<std::uint64_t> numbers;
  for (const auto& [a, b] : all.sides) {
    const std::uint64_t number = side_number(mesh.hexes[a.hex], a.face);
    numbers.push_back(number);
    if (b.hex >= 0) {
      EXPECT_EQ(number + side_number(mesh.hexes[b.hex], b.face), 0U);
    }
  }
  std::ranges::sort(numbers);
  EXPECT_EQ(std::ranges::adjacent_find(numbers), numbers.end());
}

TEST(boundary_sum, does_not_depend_on_how_a_hex_is_turned_and_changes_sign_where_it_is_mirrored) {
  const Hex hex = {3, 17, 4, 11, 29, 8, 1, 6};
  // All 48 ways to lay a cube on itself: an order of the axes, and directions of them.
  std::array<int, 3> axes = {0, 1, 2};
  int n_turned = 0;
  do {
    for (int flips = 0; flips < 8; ++flips) {
      Hex other;
      for (int c = 0; c < 8; ++c) {
        int from = 0;
        for (int axis = 0; axis < 3; ++axis) from |= (((c ^ flips) >> axis) & 1) << axes[axis];
        other[c] = hex[from];
      }
      const bool odd_order = (axes[0] > axes[1]) ^ (axes[0] > axes[2]) ^ (axes[1] > axes[2]);
      const bool mirrored = odd_order != (((flips ^ (flips >> 1) ^ (flips >> 2)) & 1) != 0);
      const std::uint64_t sum = boundary_sum(std::span(&hex, 1)), turned = boundary_sum(std::span(&other, 1));
      EXPECT_EQ(turned, mirrored ? -sum : sum);
      n_turned += !mirrored;
    }
  } while (std::ranges::next_permutation(axes).found);
  EXPECT_EQ(n_turned, 24);
}

TEST(boundary_sum, is_that_of_the_skin_and_of_nothing_else) {
  const unsigned seed = test::random_seed();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const Mesh mesh = test::grid(6, 5, 4);
  const std::uint64_t skin = sum_of_skin(mesh);
  for (const int n_threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(n_threads));
    EXPECT_EQ(boundary_sum(mesh.hexes), skin);
  }
  const auto any = [&](auto n) { return random() % static_cast<unsigned>(n); };
  for (int round = 0; round < 1000; ++round) {
    std::vector<Hex> broken = mesh.hexes;
    Hex& hex = broken[any(broken.size())];
    const Hex before = hex;
    switch (round % 4) {
      case 0:
        std::swap(hex[any(8)], hex[any(8)]);
        break;
      case 1:
        hex[any(8)] = static_cast<Index>(any(mesh.points.size()));
        break;
      case 2:
        hex = broken[any(broken.size())];
        break;
      default:
        hex[any(8)] = mesh.n_nodes();
    }
    EXPECT_EQ(boundary_sum(broken) == skin, hex == before) << "round " << round;
  }
  // Of some: what the others don't have.
  std::vector<Index> some, others;
  for (Index h = 0; h < mesh.n_hexes(); ++h) (any(2) ? some : others).push_back(h);
  EXPECT_EQ(boundary_sum(mesh.hexes, some) + boundary_sum(mesh.hexes, others), skin);
}

}  // namespace
}  // namespace hextwist
