// A mesh on its model with its nodes and hexes in another order.
#pragma once

#include "hextwist/mesh/meshed_model.h"

namespace hextwist {

/// order: per place of the result, the index now; a permutation, or empty for the order as it is. Groups, fields and
/// association follow; ids stay with their places in the arrays (they ascend), so the caller sets them.
MeshedModel reordered(const MeshedModel& meshed, std::span<const Index> node_order, std::span<const Index> hex_order);

}  // namespace hextwist
