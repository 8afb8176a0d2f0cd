// Replaces every hex by its template: pure combinatorics, no coordinate is read.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "hextwist/refine/lineage.h"
#include "hextwist/refine/templates/split_table.h"

namespace hextwist {

/// The new connectivity. Guarantees: those of Lineage (lineage.h); conformal if the input is; the same for any number
/// of threads.
struct Split {
  Index n_nodes = 0;               ///< old and new
  std::vector<Hex> hexes;          ///< all of the new mesh
  std::vector<Index> first_child;  ///< per old hex: its index now, or that of its first child
  Lineage lineage;
  /// Per cut hex (as in lineage.hexes): where its edges and faces stand in lineage.edges and lineage.faces, -1 for
  /// those that got no nodes.
  std::vector<std::array<Index, n_hex_edges>> hex_edges;
  std::vector<std::array<Index, n_hex_faces>> hex_faces;

  Index n_kept() const { return lineage.n_old_hexes - static_cast<Index>(lineage.hexes.size()); }
  bool is_cut(Index old_hex) const { return first_child[old_hex] >= n_kept(); }
  /// Position of a cut hex in lineage.hexes, hex_edges, hex_faces.
  Index cut_index(Index old_hex) const;
};

/// A number of nodes or hexes as an Index. Throws Error when it does not fit.
Index checked_count(std::int64_t n);

/// codes: one per hex, 0 to leave it alone. Precondition (asserted): hexes that share an edge or face agree on its
/// code. Throws Error when the result has more than 2^31 - 1 nodes or hexes, or takes more memory than there is.
///
/// Cost: a few passes over flat arrays, proportional to the cut hexes plus one sweep over hexes and nodes.
Split split(std::span<const Hex> hexes, Index n_nodes, std::shared_ptr<const SplitTable> table,
            std::span<const std::uint16_t> codes);

}  // namespace hextwist
