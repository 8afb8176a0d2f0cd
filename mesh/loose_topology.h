// Topology of meshes that may be broken, for validate() and for the makers of the public arrays.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "hextwist/mesh/topology.h"

namespace hextwist {

/// Throws Error naming the first hex that names a node that does not exist, or when there are too many hexes to count
/// in an Index.
void check_nodes(const Mesh& mesh);

/// Per node: 8 * hex + corner of every place where a hex names it, ascending. Throws as check_nodes().
CompressedRows node_corners(const Mesh& mesh);
/// The same without the check.
CompressedRows node_corners(std::span<const Hex> hexes, Index n_nodes);
/// The same for the nodes begin .. end - 1 alone: the list of node i is [i - begin].
CompressedRows node_corners(std::span<const Hex> hexes, Index begin, Index end);

/// Turns counts into starts: entry i becomes the sum of the counts before i. Returns the sum of all, which may be more
/// than an Index holds; the entries then mean nothing.
std::int64_t counts_to_starts(std::vector<Index>& counts);

/// One use of a face by a hex, at the face's lowest node.
struct FaceUse {
  Index diagonal, low, high;  ///< node across; the two neighbours, lower first
  Index corner;               ///< 8 * hex + corner of the lowest node
  int axis;                   ///< normal axis

  auto key() const { return std::tie(diagonal, low, high); }
  auto operator<=>(const FaceUse&) const = default;
  Side side() const { return {corner >> 3, 2 * axis + (corner >> axis & 1)}; }
};
/// The uses of all faces whose lowest node this is, sorted: those of one face follow each other, by hex.
void collect_faces(std::span<const Hex> hexes, Index node, std::span<const Index> corners, std::vector<FaceUse>& uses);

/// Faces of a mesh that may have faces with more than two hexes: those stand in `more`, ascending by (face, side).
struct LooseFaces {
  Faces faces;
  std::vector<std::pair<Index, Side>> more;
};
LooseFaces loose_faces(const Mesh& mesh);
LooseFaces loose_faces(const Mesh& mesh, const CompressedRows& corners);

}  // namespace hextwist
