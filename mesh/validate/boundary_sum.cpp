#include "hextwist/mesh/validate/boundary_sum.h"

#include <array>
#include <atomic>

#include "hextwist/base/mixed.h"
#include "hextwist/base/parallel.h"
#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

std::uint64_t number_of_node(Index node) {
  return mixed(static_cast<std::uint64_t>(node));
}

/// r: of the nodes, in a cycle. Turned by one, both sums are exchanged and so is what is said of them: all three bits
/// but one change places or sign, which leaves their parity. In the other direction one of them changes.
std::uint64_t number_of_cycle(std::uint64_t r0, std::uint64_t r1, std::uint64_t r2, std::uint64_t r3) {
  const std::uint64_t one = r0 + r2, other = r1 + r3;
  const std::uint64_t size = mixed((one | 1) * (other | 1));  // a product of odd numbers loses no bits
  const bool turns = ((r0 < r2) ^ (r1 < r3) ^ (one < other)) != 0;
  return turns ? size : -size;
}

std::uint64_t sum_of_sides(const Hex& hex) {
  std::array<std::uint64_t, 8> r;
  for (int c = 0; c < n_hex_corners; ++c) r[c] = number_of_node(hex[c]);
  std::uint64_t sum = 0;
  for (int face = 0; face < n_hex_faces; ++face) {
    const auto cycle = face_cycle(face);
    sum += number_of_cycle(r[cycle[0]], r[cycle[1]], r[cycle[2]], r[cycle[3]]);
  }
  return sum;
}

template <class HexOf>
std::uint64_t sum_of(std::size_t n, const HexOf& hex_of) {
  std::atomic<std::uint64_t> sum = 0;
  parallel_ranges(static_cast<Index>(n), [&](Index begin, Index end) {
    std::uint64_t part = 0;
    for (Index i = begin; i < end; ++i) part += sum_of_sides(hex_of(i));
    sum += part;
  });
  return sum;
}

}  // namespace

std::uint64_t side_number(const Hex& hex, int face) {
  const auto nodes = face_node_cycle(hex, face);
  return number_of_cycle(number_of_node(nodes[0]), number_of_node(nodes[1]), number_of_node(nodes[2]),
                         number_of_node(nodes[3]));
}

std::uint64_t boundary_sum(std::span<const Hex> hexes) {
  return sum_of(hexes.size(), [&](Index h) -> const Hex& { return hexes[h]; });
}
std::uint64_t boundary_sum(std::span<const Hex> hexes, std::span<const Index> of) {
  return sum_of(of.size(), [&](Index i) -> const Hex& { return hexes[of[i]]; });
}

}  // namespace hextwist
