// The pieces of plan_eight(): one region by itself.
#pragma once

#include <utility>

#include "hextwist/mesh/sheets.h"
#include "hextwist/refine/plans/eight.h"

namespace hextwist {

/// More passes than this are not tried: sheets that would need one are cut in three.
inline constexpr int max_region_passes = 16;

/// A region as a mesh of its own, without places. Nodes and hexes are numbered anew in the old order.
struct RegionMesh {
  std::vector<Index> hexes;  ///< of the whole mesh, ascending
  std::vector<Index> nodes;  ///< of the whole mesh, ascending
  Mesh mesh;                 ///< hexes of local nodes; points are not set
  Edges edges;
  Faces faces;
  Sheets sheets;
};

/// The passes of a region's sheets.
struct SheetPasses {
  std::vector<int> of_sheet;  ///< per sheet: pass, -1 cut in three
  int n_passes = 0;
  std::vector<std::uint32_t> marks;  ///< per local node: bit p set when marked in pass p (or unmarked, all together)
};
/// apart: pairs of sheets that have to be in different passes though they don't cross in the region.
SheetPasses sheet_passes(const RegionMesh& region, const std::vector<std::pair<Index, Index>>& apart);

/// Edges inside the region with another number of hexes around than four.
Index count_irregular_edges(const RegionMesh& region);

}  // namespace hextwist
