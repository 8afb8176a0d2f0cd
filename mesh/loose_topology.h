// Topology of meshes that may be broken, for validate() and for the makers of the public arrays.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "hextwist/mesh/corners.h"
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

/// One use of a face by a hex, at the face's lowest node. In two integers, so that sorting is quick.
struct FaceUse {
  std::uint64_t first;   ///< node across; the lower of the two neighbours
  std::uint64_t second;  ///< the higher one; 6 * hex + face; place of the lowest node in face_nodes(); turns_to_low

  FaceUse() = default;
  /// Nodes around the place of the lowest one: across, at place ^ 1 and at place ^ 2.
  FaceUse(Side side, int place, Index across, Index next, Index above)
      : first(std::uint64_t{static_cast<std::uint32_t>(across)} << 32 |
              static_cast<std::uint32_t>(std::min(next, above))),
        second(static_cast<std::uint64_t>(std::max(next, above)) << 33 |
               static_cast<std::uint64_t>(n_hex_faces * side.hex + side.face) << 3 | std::uint64_t(place) << 1 |
               std::uint64_t{(next < above) == turns_to_next(side.face, place)}) {}

  Index diagonal() const { return static_cast<Index>(first >> 32); }
  Index low() const { return static_cast<Index>(first); }
  Index high() const { return static_cast<Index>(second >> 33); }
  Side side() const {
    const auto number = static_cast<std::uint32_t>(second >> 3 & ((1U << 30) - 1));
    return {static_cast<Index>(number / n_hex_faces), static_cast<int>(number % n_hex_faces)};
  }
  /// face_nodes() of the hex, where this is the lowest node.
  Quad nodes(Index lowest) const {
    const int place = static_cast<int>(second >> 1 & 3);
    const bool next_is_low = turns_to_low() == turns_to_next(side().face, place);
    Quad nodes;
    nodes[place] = lowest;
    nodes[place ^ 1] = next_is_low ? low() : high();
    nodes[place ^ 2] = next_is_low ? high() : low();
    nodes[place ^ 3] = diagonal();
    return nodes;
  }
  /// Seen from outside of the hex, the lower neighbour comes next after the lowest node: of two hexes with a face
  /// between them, for one of them.
  bool turns_to_low() const { return second % 2 != 0; }
  bool is_same_face(const FaceUse& b) const { return first == b.first && second >> 33 == b.second >> 33; }
  auto operator<=>(const FaceUse&) const = default;

 private:
  /// Whether the cycle of corners.h goes from a place to place ^ 1.
  static constexpr bool turns_to_next(int face, int place) {
    const bool outward = ((face & 1) == 1) == (face >> 1 != 1), odd = place == 1 || place == 2;
    return outward != odd;
  }
};
/// The uses of all faces whose lowest node this is, sorted: those of one face follow each other, by hex. Row `node -
/// first_node` of the corners tells where hexes name it; the next rows are expected to be asked for next.
void collect_faces(std::span<const Hex> hexes, const CompressedRows& corners, Index first_node, Index node,
                   std::vector<FaceUse>& uses);
/// Whether hexes fit together at the faces of one node: at most two at each, on different sides; no four nodes joined
/// in two orders.
bool fit_together(std::span<const FaceUse> uses);

/// Faces of a mesh that may have faces with more than two hexes: those stand in `more`, ascending by (face, side).
struct LooseFaces {
  Faces faces;
  bool fit_together = true;  ///< at every node
  std::vector<std::pair<Index, Side>> more;
};
LooseFaces loose_faces(const Mesh& mesh);
LooseFaces loose_faces(const Mesh& mesh, const CompressedRows& corners);

}  // namespace hextwist
