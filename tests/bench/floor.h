// What no general program can beat: the same bytes as split() and carry() write, by hand into fresh memory, for a
// structured result.
#pragma once

#include "hextwist/refine/split.h"

namespace hextwist::bench {

struct Emitted {
  Split split;  ///< all arrays of their true sizes; hexes as they should be, node ids counted through the grid
  /// What carry() adds: points, ids and one block; empty when not asked for.
  std::vector<Vec3> points;
  std::vector<std::int64_t> hex_ids;
  std::vector<Index> block;
};
/// cube(n) with every edge in `pieces`.
Emitted emit_structured(int n, int pieces, bool with_mesh);

}  // namespace hextwist::bench
