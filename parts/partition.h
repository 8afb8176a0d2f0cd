// Which part each hex of a mesh goes to.
#pragma once

#include <span>
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

/// The same, but for SCOTCH, of what is known of hexes that are not there all at once: in the order of their ids the
/// sums of their corners, and a box around all of them.
std::vector<int> partition(std::span<const Vec3> middles, const Box& box, int n_parts, PartitionBy by);
/// Sums of corners.
std::vector<Vec3> middles_of(const Mesh& mesh);

/// "scotch", "slabs", "boxes", "ids", "random"; empty: the first that is built in.
PartitionBy partition_by(std::string_view word);

}  // namespace hextwist
