// What both directions of the exchange with Gmsh need.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "hextwist/mesh/corners.h"
#include "hextwist/sizing/report.h"

namespace hextwist::gmsh_detail {

/// The ids of an element's nodes, ascending, 0 where there are fewer than four.
inline std::array<std::int64_t, 4> element_key(const Mesh& mesh, std::span<const Index> nodes) {
  std::array<std::int64_t, 4> key{};
  for (std::size_t n = 0; n < std::min(nodes.size(), key.size()); ++n) {
    std::size_t at = n;
    const std::int64_t id = node_id(mesh, nodes[n]);
    for (; at > 0 && key[at - 1] > id; --at) key[at] = key[at - 1];
    key[at] = id;
  }
  return key;
}

/// Nodes of the i-th face on a surface, counter-clockwise seen from outside of the surface's volume, of the lower one
/// where there are two: the same sense all over a surface.
Quad surface_cycle(const MeshedModel& meshed, std::size_t i);

/// Per edge on a curve: does it run along the curve from its lower to its higher node?
std::vector<char> runs_along_curves(const MeshedModel& meshed);

}  // namespace hextwist::gmsh_detail
