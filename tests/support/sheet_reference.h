// Sheet-by-sheet insertion exactly as section 4.4 of the paper tells it: the reference that the one-pass engine must
// equal on targets without concave places. One direction at a time, on the evolving mesh, with maps and no table.
#pragma once

#include <random>

#include "hextwist/mesh/mesh.h"

namespace hextwist::test {

struct SheetReference {
  Mesh mesh;
  /// Per node: lies on an edge or face of the original mesh (not inside one of its hexes).
  std::vector<char> on_skeleton;
};

/// marked: node marks of the target hexes, already free of concave places (asserted by a thrown std::logic_error).
/// The sheets are processed in a random order. No sheet may cross itself.
SheetReference insert_sheet_by_sheet(const Mesh& mesh, std::vector<char> marked, double depth, std::mt19937& random);

}  // namespace hextwist::test
