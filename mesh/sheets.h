// Hex sheets: all edges reachable from one by stepping across quads to the opposite edge, and the hexes they run
// through (the elements on one twist plane, Harris et al. section 3).
//
// A hex has three directions, each with four parallel edges; these belong to one sheet, which runs through the hex
// across that direction. So three sheets run through every hex, or one sheet runs through it twice or three times.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/mesh/topology.h"

namespace hextwist {

struct Sheets {
  std::vector<Index> of_edge;  ///< per edge: sheet, numbered by their lowest edge
  CompressedRows edges;        ///< per sheet: its edges, ascending
  CompressedRows hexes;        ///< per sheet: its hexes, ascending, each once even where the sheet crosses itself
  std::vector<Index> n_self_crossings;  ///< per sheet: hexes that it runs through in two or three directions
  std::vector<Index> n_self_touches;    ///< per sheet: faces that it runs along on both sides, so that it lies against
                                        ///< itself there: the edges leaving the face into either hex are in the sheet
  Index size() const { return edges.size(); }
};

/// Sheets of a mesh with its edges. Independent of threads.
Sheets sheets(const Mesh& mesh, const Edges& edges);

/// The sheet that runs through a hex across direction axis (0..2); its edges there are 4 * axis .. 4 * axis + 3.
inline Index sheet_of(const Sheets& sheets, const Edges& edges, Index hex, int axis) {
  return sheets.of_edge[edges.of_hex[hex][4 * axis]];
}

/// Per edge 1 where, among these hexes alone, it is in one sheet with one of the seeds (edges); else 0.
std::vector<std::uint8_t> in_sheets_of(const Edges& edges, std::span<const Index> hexes, std::span<const Index> seeds);

}  // namespace hextwist
