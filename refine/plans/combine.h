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

/// Edges of the target, those of its faces included; ascending.
std::vector<Edge> target_edges(const CombinationTarget& target);

/// Trisecting codes for a mesh in which the target's nodes have been enclosed. uncut: the target_edges() that no
/// enclosing has cut, ascending. All nodes are marked of the hexes that have a target edge among these, or a target
/// face with one of these; an edge is cut when both its ends are and, within those hexes, it is opposite in a quad (of
/// one that is opposite, ...) to one of these.
std::vector<std::uint16_t> combination_codes(const Mesh& mesh, const CombinationTarget& target,
                                             std::span<const Edge> uncut);

}  // namespace hextwist
