#include "hextwist/refine/marks.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>

#include "hextwist/mesh/topology.h"
#include "hextwist/refine/trisect.h"

namespace hextwist {
namespace {

struct CornerTable {
  std::array<std::uint16_t, 256> edges;
  std::array<bool, 256> concave;
};

const CornerTable& corner_table() {
  static const CornerTable table = [] {
    CornerTable made;
    for (int corners = 0; corners < 256; ++corners) {
      made.edges[corners] = static_cast<std::uint16_t>(edge_mask_of_corners(corners));
      made.concave[corners] = !is_convex(made.edges[corners]);
    }
    return made;
  }();
  return table;
}

int corner_mask(const Hex& hex, std::span<const std::uint8_t> marked) {
  int mask = 0;
  for (int c = 0; c < n_hex_corners; ++c) mask |= (marked[hex[c]] != 0) << c;
  return mask;
}

}  // namespace

std::vector<std::uint16_t> trisect_codes(std::span<const Hex> hexes, std::span<const std::uint8_t> marked) {
  const CornerTable& table = corner_table();
  std::vector<std::uint16_t> codes(hexes.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, hexes.size(), 4096), [&](const auto& range) {
    for (std::size_t h = range.begin(); h != range.end(); ++h) codes[h] = table.edges[corner_mask(hexes[h], marked)];
  });
  return codes;
}

Index fill_concave(const Mesh& mesh, std::span<std::uint8_t> marked) {
  const CornerTable& table = corner_table();
  const auto is_concave = [&](Index h) { return table.concave[corner_mask(mesh.hexes[h], marked)]; };
  const auto n_full = [&] {
    Index count = 0;
    for (const Hex& hex : mesh.hexes) count += corner_mask(hex, marked) == 255;
    return count;
  };
  std::vector<Index> worklist;
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (is_concave(h)) worklist.push_back(h);
  if (worklist.empty()) return 0;

  const Index n_before = n_full();
  const Lists hexes_of_node = node_hexes(mesh);
  while (!worklist.empty()) {
    const Index h = worklist.back();
    worklist.pop_back();
    if (!is_concave(h)) continue;
    for (const Index n : mesh.hexes[h]) {
      if (marked[n]) continue;
      marked[n] = 1;
      for (const Index neighbour : hexes_of_node[n])
        if (is_concave(neighbour)) worklist.push_back(neighbour);
    }
  }
  return n_full() - n_before;
}

void mark_nodes(std::span<const Hex> hexes, std::span<const Index> targets, std::span<std::uint8_t> marked) {
  for (const Index h : targets)
    for (const Index n : hexes[h]) marked[n] = 1;
}

std::vector<Index> touching_hexes(std::span<const Hex> hexes, std::span<const std::uint8_t> marked) {
  std::vector<Index> result;
  for (std::size_t h = 0; h < hexes.size(); ++h)
    if (corner_mask(hexes[h], marked)) result.push_back(static_cast<Index>(h));
  return result;
}

}  // namespace hextwist
