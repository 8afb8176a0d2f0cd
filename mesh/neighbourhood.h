// What lies around what: hexes at nodes, layers of hexes around hexes, nodes of hexes, pieces.
//
// Marks are one byte per node of the mesh, 0 or 1. Lists that are returned ascend and have each item once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace hextwist {

/// Is any corner of the hex marked? (In a third of the time that corner_mask() of refine/marks.h takes.)
inline bool has_marked_corner(const Hex& hex, std::span<const std::uint8_t> marked) {
  std::uint8_t any = 0;
  for (const Index n : hex) any |= marked[n];
  return any != 0;
}

/// Marks the nodes of these hexes.
void mark_nodes(std::span<const Hex> hexes, std::span<const Index> targets, std::span<std::uint8_t> marked);
/// Hexes with at least one marked node.
std::vector<Index> touching_hexes(std::span<const Hex> hexes, std::span<const std::uint8_t> marked);

/// Hexes that the nodes touch (1 layer), those that touch them (2), ...
std::vector<Index> layers_around(const Mesh& mesh, std::span<const Index> nodes, int n_layers);
/// The hexes, in any order, and so many layers around them.
std::vector<Index> with_layers(const Mesh& mesh, std::vector<Index> hexes, int n_layers);

/// Nodes of these hexes from first_node on.
std::vector<Index> nodes_of_hexes(const Mesh& mesh, std::span<const Index> hexes, Index first_node = 0);
/// Nodes of these hexes that belong to no other hex: moving them changes nothing outside.
std::vector<Index> nodes_inside(const Mesh& mesh, std::span<const Index> hexes);

/// The regions of these hexes (ascending), connected by common nodes: by lowest hex.
std::vector<std::vector<Index>> connected_regions(const Mesh& mesh, std::span<const Index> hexes);

}  // namespace hextwist
