// Parts of validate() that are algorithms of their own.
#pragma once

#include <span>
#include <tuple>
#include <vector>

#include "hextwist/mesh/loose_topology.h"

namespace hextwist {

/// Groups of two or more finite points that chains of steps no longer than tolerance connect; members ascending,
/// groups by first member.
std::vector<std::vector<Index>> near_points(std::span<const Vec3> points, double tolerance);

/// A node of the skin that lies inside an edge or face of a skin quad whose hex does not have it.
struct HangingNode {
  Index node = -1;
  Index hex = -1;
  Edge edge = {-1, -1};    ///< the ends of the edge that it is in, ascending; {-1, -1} when in the face
  bool is_joined = false;  ///< the mesh hangs together there; else a crack or contact is between

  auto operator<=>(const HangingNode&) const = default;
  auto key() const { return std::tie(node, hex, edge); }
};
/// All of them, each once, ascending by all but the last. skin: the boundary sides of a mesh of sound hexes, or some of
/// them: all that lie on each other.
std::vector<HangingNode> hanging_nodes(const Mesh& mesh, std::span<const Side> skin);
/// Quicker: false where none of them is joined. True: there may be one.
bool may_have_joined_nodes(const Mesh& mesh, std::span<const Side> skin);
/// Whether one of them is.
bool has_joined_nodes(const Mesh& mesh, std::span<const Side> skin);

/// Whether the hexes from `first` on have eight different nodes each that exist.
bool are_on_eight_nodes(const Mesh& mesh, Index first = 0);

/// Faces with the same lowest node, sorted: whether hexes fit together at them (loose_topology.h); sides with nothing
/// behind go to the end of the skin. (Two hexes on the same eight nodes don't fit together: they lie on the same side
/// of their faces, in another order, or one of them is inverted.)
bool faces_are_sound(std::span<const FaceUse> uses, std::vector<Side>& skin);

/// What has_only_warnings() asks, all but hanging nodes. skin gets the sides with nothing behind, ascending (when
/// true). known_valid: that all hexes are valid (validity.h) has been found out already.
bool is_sound_without_skin(const Mesh& mesh, std::vector<Side>& skin, bool known_valid = false);
/// The same, keeping what it made.
struct SoundTopology {
  CompressedRows corners;  ///< node_corners()
  Faces faces;
};
bool is_sound_without_skin(const Mesh& mesh, std::vector<Side>& skin, SoundTopology& topology);

/// Whether two hexes turn alike around a face that they share: then they lie on the same side of it, or one of them is
/// mirrored. Face f of hex a and face g of hex b have the same nodes in the same cyclic order, up to direction.
bool turn_alike(const Hex& a, int f, const Hex& b, int g);

}  // namespace hextwist
