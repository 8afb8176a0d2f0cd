// Where everything in a refined mesh came from.
#pragma once

#include <memory>
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

}  // namespace hextwist
