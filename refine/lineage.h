// Where everything in a refined mesh came from.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "hextwist/mesh/topology.h"

namespace hextwist {

struct SplitTable;  // split_table.h: the templates of a pass, and what the codes below mean

/// An edge of the old mesh that got new nodes, numbered from its lower node to its higher one.
struct CutEdge {
  Index a, b;          ///< old nodes, a < b
  Index first_node;    ///< new nodes first_node, ... in the direction from a to b
  Index hex;           ///< old hex with the lowest index that has it
  std::uint16_t code;  ///< edge code seen from a: SplitTable says how many nodes, and where
};

/// A face of the old mesh that got new nodes inside.
struct CutFace {
  Side side;     ///< where it was: the old hex with the lowest index that has it
  Quad corners;  ///< old nodes, bit frame turned so that corners[0] is the lowest, corners[1] < corners[2]
  Index first_node;
  std::uint16_t code;  ///< face code in that frame; SplitTable says how many nodes lie inside, and where
};

/// A hex of the old mesh that was split.
struct CutHex {
  Index hex;          ///< old
  Index first_child;  ///< new hexes first_child, ...
  Index first_node;   ///< new nodes strictly inside
  std::uint16_t code;
};

/// Guarantees:
///  1. total: every new hex has exactly one parent, every new node lies on exactly one cut edge, face or hex;
///  2. old nodes keep their index; hexes that were not split come first, in their old order, then the children,
///     in the order of their parents;
///  3. new nodes: those on edges, ordered by (a, b); then those on faces, ordered by (lowest node, diagonal node,
///     lower neighbour); then those in hexes, by hex.
struct Lineage {
  Index n_old_nodes = 0;
  Index n_old_hexes = 0;
  std::shared_ptr<const SplitTable> table;
  std::vector<CutEdge> edges;
  std::vector<CutFace> faces;
  std::vector<CutHex> hexes;
  std::vector<Index> parent;  ///< per new hex: old hex
};

/// An edge of the old mesh among those that got new nodes; null where it got none.
const CutEdge* find_cut_edge(const Lineage& lineage, const Edge& old_edge);
/// How many it got.
Index n_new_nodes(const Lineage& lineage, const CutEdge& edge);

/// Calls use(edge) for the edges that an edge of the old mesh has become, from its lower node to its higher one; for
/// itself where it was not cut. All have their lower node first.
template <class Use>
void for_each_child_edge(const Lineage& lineage, const Edge& old_edge, const Use& use) {
  const CutEdge* cut = find_cut_edge(lineage, old_edge);
  const Index n = cut ? n_new_nodes(lineage, *cut) : 0;
  Index from = old_edge[0];
  for (Index s = 0; s <= n; ++s) {
    const Index to = s == n ? old_edge[1] : cut->first_node + s;
    use(Edge{std::min(from, to), std::max(from, to)});
    from = to;
  }
}

/// Children of these hexes, ascending; of a hex that was not cut, itself.
std::vector<Index> children_of(const Lineage& lineage, std::span<const Index> old_hexes);

}  // namespace hextwist
