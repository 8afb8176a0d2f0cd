// A mesh that is read in slices and joined part by part.
#pragma once

#include "io/io_support.h"

namespace hextwist::test {

/// Blocks that do not overlap, sets, fields.
inline Mesh sliceable(unsigned seed, bool gaps, const std::array<int, 3>& n) {
  Mesh mesh = rich_mesh(seed, gaps, n);
  std::vector<std::uint8_t> has(mesh.hexes.size(), 0);
  for (Block& block : mesh.blocks) std::erase_if(block.hexes, [&](Index h) { return has[h]++ > 0; });
  return mesh;
}

}  // namespace hextwist::test
