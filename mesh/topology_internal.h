// Topology of meshes that may be broken, for validate() and for the makers of the public arrays.
#pragma once

#include <utility>
#include <vector>

#include "hextwist/mesh/topology.h"

namespace hextwist {

/// Throws Error naming the first hex that names a node that does not exist, or when there are too many hexes to count
/// in an Index.
void check_nodes(const Mesh& mesh);

/// Per node: 8 * hex + corner of every place where a hex names it, ascending. Throws as check_nodes().
Lists node_corners(const Mesh& mesh);
/// The same without the check.
Lists node_corners(std::span<const Hex> hexes, Index n_nodes);

/// Faces of a mesh that may have faces with more than two hexes: those stand in `more`, ascending by (face, side).
struct LooseFaces {
  Faces faces;
  std::vector<std::pair<Index, Side>> more;
};
LooseFaces loose_faces(const Mesh& mesh);
LooseFaces loose_faces(const Mesh& mesh, const Lists& corners);

}  // namespace hextwist
