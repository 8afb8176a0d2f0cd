// From marked nodes to codes of the trisecting pass, and the closing of concave places.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/mesh/topology.h"

namespace hextwist {

/// The marked corners of a hex as bits. marked: one byte per node, 0 or 1.
inline int corner_mask(const Hex& hex, std::span<const std::uint8_t> marked) {
  int mask = 0;
  for (int c = 0; c < 8; ++c) mask |= marked[hex[c]] << c;
  return mask;
}

/// One code per hex: an edge is cut when both its nodes are marked. marked: one byte per node, 0 or 1.
std::vector<std::uint16_t> trisect_codes(std::span<const Hex> hexes, std::span<const std::uint8_t> marked);
/// The same from the cut edges. cut: one byte per edge, 0 or 1.
std::vector<std::uint16_t> trisect_codes(const Edges& edges, std::span<const std::uint8_t> cut);

/// Concave filling (section 4.3): a hex that is concave in a direction gets all its nodes marked, until there is none;
/// then all hexes that still have an L or U on a face (three marked corners, say) do, and so on until the paper's
/// templates suffice everywhere. Only ever adds marks; the result does not depend on the order. Returns how many hexes
/// became fully marked. rounds: per node the round in which it was marked, 0: before; empty where there was nothing to
/// do.
Index fill_concave(const Mesh& mesh, std::span<std::uint8_t> marked, std::vector<std::uint8_t>* rounds = nullptr);

}  // namespace hextwist
