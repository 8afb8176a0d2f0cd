// The hexes around every node of a mesh, kept through refinements in patches.
#pragma once

#include <span>
#include <vector>

#include "hextwist/patch/splice.h"

namespace hextwist {

/// Hexes are kept by serial numbers: those of the first mesh by index, and on from there with every hex that is made.
/// They stay when indices shift; as kept hexes stay in order and new ones come last, an index is the serial number less
/// the number of lower ones that are gone.
class Neighbours {
 public:
  explicit Neighbours(const Mesh& mesh);

  /// Appends the hexes at these nodes, by index.
  void hexes_at(std::span<const Index> nodes, std::vector<Index>& hexes) const;

  /// Follows the mesh through a splice, forward or back. False: it can't (going back beyond the first mesh; nodes
  /// that are gone), or has grown so much that a new one is smaller; then it is of no use any more. So it is when this
  /// throws.
  bool apply(const Splice& splice, bool forward);

 private:
  struct Range {
    Index first = 0, count = 0;
  };
  void exchange(const std::vector<Hex>& out, const std::vector<Index>& out_serials, const std::vector<Hex>& in,
                const std::vector<Index>& in_serials);

  std::vector<Range> of_node_;  // in items_
  std::vector<Index> items_;    // serial numbers; lists that changed stand at the end, what they were is left behind
  std::size_t n_first_items_ = 0;
  std::vector<Index> gone_;               // serial numbers, ascending
  std::vector<std::vector<Index>> each_;  // the same by splice, to go back
  Index n_serials_ = 0;
  std::vector<Index> place_;  // per node, for exchange(): -1 in between
};

}  // namespace hextwist
