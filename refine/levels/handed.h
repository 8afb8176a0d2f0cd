// What every hex of a levelled mesh is, in the order in which the mesh is handed out.
#pragma once

#include "hextwist/refine/levels/stack.h"

namespace hextwist {

/// Hexes of the base that are not cut come first, in its order; behind them pieces of cells, those that have been there
/// longer first. So there is nothing to say of the first ones but which are missing.
struct HandedHexes {
  Index n_base = 0;                   ///< hexes of the base
  std::vector<Index> cut;             ///< those that are no more, ascending
  std::vector<CellNumber> cell;       ///< per piece: the cell that was cut, as in LevelPieces
  std::vector<std::uint32_t> origin;  ///< per piece: block << 28 | code << 16 | place among the children of that code

  Index n_whole() const { return n_base - static_cast<Index>(cut.size()); }
  Index n_hexes() const { return n_whole() + static_cast<Index>(cell.size()); }
  /// Of piece i, which is hex n_whole() + i.
  int block(std::size_t piece) const { return static_cast<int>(origin[piece] >> 28); }
  LevelPieces::Leaf leaf_of_piece(std::size_t piece) const;
  LevelPieces::Leaf leaf(Index hex) const;
  /// The hex of the base that a hex lies in.
  Index root(Index hex) const;
  Index root_of_piece(std::size_t piece) const;
};

/// hex_order: per place of the mesh handed out, the place level by level; empty: the same.
HandedHexes handed_hexes(const LevelPieces& pieces, std::span<const Index> hex_order, Index n_base);
/// The inverse: per place handed out, the place level by level. Empty: the same.
std::vector<Index> hex_order(const HandedHexes& hexes);

/// The hex of the base that a cell lies in.
Index root_of(LevelPieces::Leaf leaf);

}  // namespace hextwist
