// A mesh on its model with its nodes and hexes in another order.
#pragma once

#include "hextwist/mesh/meshed_model.h"

namespace hextwist {

/// order: per place of the result, the index now; a permutation, or empty for the order as it is. Groups, fields and
/// association follow; ids stay with their places in the arrays (they ascend), so the caller sets them.
/// inner_surfaces: those that can have faces between two hexes, ascending; null: all.
MeshedModel reordered(const MeshedModel& meshed, std::span<const Index> node_order, std::span<const Index> hex_order,
                      const std::vector<int>* inner_surfaces = nullptr);

/// Surfaces that have faces between two hexes, ascending. corners: node_corners() of the mesh.
std::vector<int> inner_surfaces(const MeshedModel& meshed, const CompressedRows& corners);

}  // namespace hextwist
