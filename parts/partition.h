// Which part each hex of a mesh goes to.
#pragma once

#include <string_view>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace hextwist {

enum class PartitionBy {
  scotch,  ///< few faces between parts, sizes within 5%: SCOTCH (Pellegrini and Roman, 1996), where it was built in
  slabs,   ///< equal counts, one behind the other along the longest side of the mesh's box
  boxes,   ///< equal counts, halves of halves, each along the longest side of its box
  ids,     ///< equal counts in the order of ids
  random   ///< equal counts, hexes of each part anywhere: the worst that there is, for tests
};

/// Is SCOTCH built in?
bool has_scotch();

/// Per hex its part, 0 .. n_parts - 1, each at least once; but for SCOTCH the same for the same mesh. Throws Error when
/// there are fewer hexes than parts, or SCOTCH is wished for and not there.
std::vector<int> partition(const Mesh& mesh, int n_parts, PartitionBy by);

/// "scotch", "slabs", "boxes", "ids", "random"; empty: the first that is built in.
PartitionBy partition_by(std::string_view word);

}  // namespace hextwist
