// Hex sheets: all edges reachable from one by stepping across quads to the opposite edge, and the hexes they run
// through (the elements on one twist plane, Harris et al. section 3).
#pragma once

#include <vector>

#include "hextwist/mesh/topology.h"

namespace hextwist {

struct Sheets {
  std::vector<Index> of_edge;  ///< per edge: sheet, numbered by their lowest edge
  Lists edges;                 ///< per sheet: its edges, ascending
  Lists hexes;                 ///< per sheet: its hexes, ascending, each once even where the sheet crosses itself
  std::vector<Index> n_self_crossings;  ///< per sheet: hexes that it runs through in two or three directions
  std::vector<Index> n_self_touches;    ///< per sheet: hex faces in it whose both opposite hexes are also in it without
                                        ///< crossing there: the sheet lies against itself
};

Sheets sheets(const Mesh& mesh, const Edges& edges);

}  // namespace hextwist
