#include "hextwist/refine/levels/handed.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/refine/templates/trisect.h"

namespace hextwist {
namespace {

constexpr std::uint32_t n_block_bits = 4;
static_assert(n_trisect_codes <= 1 << (32 - 16 - n_block_bits));

/// 27^level, for all levels that there can be (max_level()).
constexpr std::array<CellNumber, 14> powers = [] {
  std::array<CellNumber, 14> result{1};
  for (std::size_t k = 1; k < result.size(); ++k)
    result[k] = k < 13 ? result[k - 1] * n_cell_children : result[k - 1];  // the last one is never asked for
  return result;
}();

}  // namespace

Index root_of(LevelPieces::Leaf leaf) {
  return static_cast<Index>(leaf.level == 13 ? leaf.cell / powers[12] / n_cell_children
                                             : leaf.cell / powers[leaf.level]);
}

LevelPieces::Leaf HandedHexes::leaf_of_piece(std::size_t piece) const {
  const std::uint32_t code = origin[piece] >> 16 & (n_trisect_codes - 1);
  if (code == trisect_all) return {block(piece), first_cell_child(cell[piece]) + (origin[piece] & 0xffff)};
  return {block(piece) - 1, cell[piece]};
}

LevelPieces::Leaf HandedHexes::leaf(Index hex) const {
  if (hex < n_whole()) return {0, before_gaps(cut, hex)};
  return leaf_of_piece(static_cast<std::size_t>(hex - n_whole()));
}

Index HandedHexes::root_of_piece(std::size_t piece) const {
  return root_of({block(piece) - 1, cell[piece]});
}

Index HandedHexes::root(Index hex) const {
  return hex < n_whole() ? before_gaps(cut, hex) : root_of_piece(static_cast<std::size_t>(hex - n_whole()));
}

HandedHexes handed_hexes(const LevelPieces& pieces, std::span<const Index> hex_order, Index n_base) {
  HandedHexes result;
  result.n_base = n_base;
  const Index n_whole = pieces.first[1];
  for (Index b = 0, i = 0; b < n_base; ++b)
    if (i < n_whole && pieces.cell[i] == b)
      ++i;
    else
      result.cut.push_back(b);
  const auto n_pieces = static_cast<std::size_t>(pieces.n_hexes() - n_whole);
  resize_for_overwrite(result.cell, n_pieces);
  resize_for_overwrite(result.origin, n_pieces);
  parallel_each(n_pieces, [&](std::size_t i) {
    const auto place = static_cast<std::size_t>(n_whole) + i;
    const Index from = hex_order.empty() ? static_cast<Index>(place) : hex_order[place];
    const auto block = std::ranges::upper_bound(pieces.first, from) - pieces.first.begin() - 1;
    result.cell[i] = pieces.cell[from];
    result.origin[i] = static_cast<std::uint32_t>(block) << 28 | pieces.at[from];
  });
  return result;
}

std::vector<Index> hex_order(const HandedHexes& hexes) {
  std::vector<Index> by_level(hexes.cell.size());  // pieces as they stand level by level
  std::iota(by_level.begin(), by_level.end(), 0);
  const auto key = [&](Index i) { return std::tuple(hexes.origin[i] >> 28, hexes.cell[i], hexes.origin[i] & 0xffff); };
  if (std::ranges::is_sorted(by_level, {}, key)) return {};
  std::ranges::sort(by_level, {}, key);
  std::vector<Index> order(static_cast<std::size_t>(hexes.n_hexes()));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t j = 0; j < by_level.size(); ++j)
    order[hexes.n_whole() + by_level[j]] = hexes.n_whole() + static_cast<Index>(j);
  return order;
}

}  // namespace hextwist
