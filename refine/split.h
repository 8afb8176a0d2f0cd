// Replaces every hex by its template: pure combinatorics, no coordinate is read.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "hextwist/refine/lineage.h"
#include "hextwist/refine/split_table.h"

namespace hextwist {

/// The new connectivity. Guarantees: those of Lineage (lineage.h); conformal if the input is; the same for any number
/// of threads.
struct Split {
  Index n_nodes = 0;               ///< old and new
  std::vector<Hex> hexes;          ///< all of the new mesh
  std::vector<Index> first_child;  ///< per old hex: its index now, or that of its first child
  Lineage lineage;

  bool is_cut(Index old_hex) const {  ///< kept hexes come first, so a child never has a lower index than they
    return first_child[old_hex] >= static_cast<Index>(lineage.n_old_hexes) - static_cast<Index>(lineage.hexes.size());
  }
};

/// codes: one per hex, 0 to leave it alone. Precondition (asserted): hexes that share an edge or face agree on its
/// code. Throws Error when the result has more than 2^31 - 1 nodes or hexes.
///
/// Cost: a few passes over flat arrays, proportional to the cut hexes plus one sweep over hexes and nodes.
Split split(std::span<const Hex> hexes, Index n_nodes, std::shared_ptr<const SplitTable> table,
            std::span<const std::uint16_t> codes);

}  // namespace hextwist
