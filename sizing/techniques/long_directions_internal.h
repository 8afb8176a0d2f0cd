// Hexes that are too long in some directions only: these are cut first, across their sheets.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/sizing/fields/size_field.h"

namespace hextwist {

/// Whether a tenth or more of the hexes of the zone (a byte per hex) that are to be cut at all need so many cuts more
/// in one direction than in another to come within a factor sqrt(3) of the wish.
bool are_uneven(const Mesh& mesh, std::span<const std::uint8_t> in_zone, const SizeField& wish, int by);
/// The same of counts, which parts of a mesh add up.
struct UnevenHexes {
  std::int64_t n_cut = 0, n_uneven = 0;
  explicit operator bool() const { return n_uneven > 0 && 10 * n_uneven >= n_cut; }
};
UnevenHexes uneven_hexes(const Mesh& mesh, std::span<const std::uint8_t> in_zone, const SizeField& wish, int by);

/// So many hexes of the zone need more cuts in one direction than in another: where the cuts of these begin.
Index count_uneven(const Mesh& mesh, std::span<const std::uint8_t> in_zone, const SizeField& wish);

/// Masks for trisect_table(), one per hex of the mesh; empty: no hex of the zone (a byte per hex) needs more cuts in
/// one direction than in another to come within a factor sqrt(3) of the wish.
std::vector<std::uint16_t> cuts_of_long_directions(const Mesh& mesh, std::span<const std::uint8_t> in_zone,
                                                   const SizeField& wish);

}  // namespace hextwist
