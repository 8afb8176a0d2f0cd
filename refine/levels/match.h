// What two levelled meshes of one base have in common, and where the hexes of one are in the other.
#pragma once

#include "hextwist/mesh/topology.h"
#include "hextwist/refine/levels/stack.h"

namespace hextwist {

/// Per node of the mesh of `now`: the same node in that of `before`, -1 where it was not there. A node is the same when
/// it lies at the same place of the same edge, of the same face with the same cuts, or of the same cell with the same
/// cuts.
std::vector<Index> matching_nodes(const LevelStack& now, const LevelStack& before, Index n_base_nodes);

/// How a hex came about in a step. The smallest cell that is a leaf before or after decides:
enum class HexOrigin : std::uint8_t {
  same,     ///< the same hex, with the same nodes
  finer,    ///< lies in one hex of before that is no more
  coarser,  ///< the cell that it is, or is a piece of, was several hexes before
};

/// Per hex of the mesh now. Every hex of before is named by what came of it, and by nothing else.
struct LevelOrigin {
  std::vector<HexOrigin> kind;
  std::vector<Index> at;   ///< same, finer: the hex before; coarser: a row of `several`
  CompressedRows several;  ///< hexes before that fill the cell, ascending; pieces of one cell share a row

  std::span<const Index> before(Index hex) const {
    return kind[hex] == HexOrigin::coarser ? several[at[hex]] : std::span(&at[hex], 1);
  }
  bool operator==(const LevelOrigin&) const = default;
};
LevelOrigin level_origin(const LevelPieces& now, const LevelPieces& before);

}  // namespace hextwist
