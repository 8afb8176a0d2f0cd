// The least that reading and writing Exodus II takes: the library's own calls, on arrays that lie as it wants them.
#pragma once

#include <filesystem>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace hextwist::bench {

struct ExodusArrays {
  std::vector<double> x, y, z;
  std::vector<int> nodes;  ///< eight per hex, Exodus' order, counted from 1
  std::vector<int> node_ids, hex_ids;
};
ExodusArrays exodus_arrays(const Mesh& mesh);
/// Coordinates, one block of hexes and both id maps. Throws Error.
void write_exodus_plainly(const std::filesystem::path& file, const ExodusArrays& arrays);
ExodusArrays read_exodus_plainly(const std::filesystem::path& file);

}  // namespace hextwist::bench
