// Where the hexes of a mesh come from, when some have become finer and others coarser.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/mesh/topology.h"

namespace HEXTWIST_API hextwist {

/// How a hex came about in a step. The smallest cell that is a leaf before or after decides:
enum class HexOrigin : std::uint8_t {
  same,     ///< the same hex, with the same nodes
  finer,    ///< lies in one hex of before that is no more
  coarser,  ///< the cell that it is, or is a piece of, was several hexes before
};

/// Per hex of the mesh now. Every hex of before is named by what came of it, and by nothing else.
struct LevelOrigin {
  std::vector<HexOrigin> kind;  ///< one per hex
  std::vector<Index> at;        ///< same, finer: the hex before; coarser: a row of `several`
  CompressedRows several;       ///< hexes before that fill the cell, ascending; pieces of one cell share a row

  /// The hexes before that a hex of now lies in or is made of, at least one; valid while this is left alone.
  std::span<const Index> before(Index hex) const {
    return kind[hex] == HexOrigin::coarser ? several[at[hex]] : std::span(&at[hex], 1);
  }
};

/// Hexes before per hex now: rows of their own for all.
CompressedRows rows_of(const LevelOrigin& origin);

}  // namespace hextwist
