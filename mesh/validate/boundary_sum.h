// The boundary of hexes as one number: whether two sets of hexes have the same one is told by a single walk, without
// lists of faces.
#pragma once

#include <cstdint>
#include <span>

#include "hextwist/mesh/mesh.h"

namespace hextwist {

/// A number for a side of a hex, made of its four nodes, their order around it and the way they turn: the same face
/// seen from the hex behind has the negative. Otherwise numbers of different sides are as good as drawn at random.
std::uint64_t side_number(const Hex& hex, int face);

/// The sum over all sides of these hexes. What two hexes share drops out, so it is the sum over the boundary (that of a
/// chain in homology): two sets of hexes with the same sum have the same boundary, or one chance in 2^64 has come true.
/// The same for any number of threads.
std::uint64_t boundary_sum(std::span<const Hex> hexes);
std::uint64_t boundary_sum(std::span<const Hex> hexes, std::span<const Index> of);

}  // namespace hextwist
