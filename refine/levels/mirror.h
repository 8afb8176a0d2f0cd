// Marks on one side of a periodic boundary, and their images on the other.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "hextwist/mesh/periodic.h"
#include "hextwist/mesh/topology.h"
#include "hextwist/refine/levels/cells.h"

namespace hextwist {

/// Nodes of a base mesh and their images: of each pair both ways.
struct Mirror {
  std::vector<std::vector<NodePair>> images;  ///< each ascending by its first nodes
  std::vector<int> surfaces;                  ///< of the pairs, ascending
};
/// Throws Error where the base does not repeat.
std::shared_ptr<const Mirror> mirror_of(const MeshedModel& base, std::span<const PeriodicPair> pairs);

/// Adds the images of marked corners, and the images of these, until there are no others: the nodes that are marked on
/// a side are then the images of those on the other. marks: normalized, of one level. base_corners: node_corners().
void mark_images(CellMarks& marks, std::size_t level, std::span<const Hex> base_hexes,
                 const CompressedRows& base_corners, const Mirror& mirror);

}  // namespace hextwist
