// The second step of the combination technique (Harris, Benzley, Owen, section 5.4): after the nodes of the target have
// been enclosed at a third, trisect the hexes around its edges and faces, but only in the directions of its edges.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/mesh/topology.h"

namespace hextwist {

/// Mesh edges and faces to refine along. A face brings its four edges along.
struct CombinationTarget {
  std::vector<Index> nodes;  ///< ascending: all that are to be enclosed, those of the edges and faces included
  std::vector<Edge> edges;   ///< lower node first, ascending: those that are targets by themselves
  std::vector<Quad> faces;   ///< corners in bit-frame order (0-1 and 0-2 are edges)
};

/// Trisecting codes for a mesh in which the target's nodes have been enclosed: all nodes of the hexes that have a
/// target edge or a target face are marked; an edge is cut when both its ends are and its sheet is that of a target
/// edge.
std::vector<std::uint16_t> combination_codes(const Mesh& mesh, const CombinationTarget& target);

}  // namespace hextwist
