#include "hextwist/refine/marks.h"

#include <algorithm>
#include <array>

#include "hextwist/base/parallel.h"
#include "hextwist/refine/templates/trisect.h"

namespace hextwist {
namespace {

/// What a marking needs: the paper's templates, or for an L or U on a face, or for a concave direction, more.
enum class Marking : std::uint8_t { convex, corner, concave };

struct CornerTable {
  std::array<std::uint16_t, 256> edges;
  std::array<Marking, 256> marking;
};

const CornerTable& corner_table() {
  static const CornerTable table = [] {
    CornerTable made;
    for (int corners = 0; corners < 256; ++corners) {
      made.edges[corners] = static_cast<std::uint16_t>(edge_mask_of_corners(corners));
      made.marking[corners] = is_concave_in_a_direction(made.edges[corners]) ? Marking::concave
                              : is_convex(made.edges[corners])               ? Marking::convex
                                                                             : Marking::corner;
    }
    return made;
  }();
  return table;
}

}  // namespace

std::vector<std::uint16_t> trisect_codes(std::span<const Hex> hexes, std::span<const std::uint8_t> marked) {
  const CornerTable& table = corner_table();
  std::vector<std::uint16_t> codes(hexes.size());
  parallel_each(
      hexes.size(), [&](std::size_t h) { codes[h] = table.edges[corner_mask(hexes[h], marked)]; }, 4096);
  return codes;
}

std::vector<std::uint16_t> trisect_codes(const Edges& edges, std::span<const std::uint8_t> cut) {
  std::vector<std::uint16_t> codes(edges.of_hex.size());
  parallel_each(codes.size(), [&](std::size_t h) {
    int code = 0;
    for (int e = 0; e < 12; ++e) code |= cut[edges.of_hex[h][e]] << e;
    codes[h] = static_cast<std::uint16_t>(code);
  });
  return codes;
}

Index fill_concave(const Mesh& mesh, std::span<std::uint8_t> marked, std::vector<std::uint8_t>* rounds) {
  const CornerTable& table = corner_table();
  const auto state = [&](Index h) { return table.marking[corner_mask(mesh.hexes[h], marked)]; };
  const auto hexes_with = [&](Marking wanted) {
    std::vector<Index> found;
    for (Index h = 0; h < mesh.n_hexes(); ++h)
      if (state(h) >= wanted) found.push_back(h);
    return found;
  };
  const auto n_full = [&] {
    return std::ranges::count_if(mesh.hexes, [&](const Hex& hex) { return corner_mask(hex, marked) == 255; });
  };
  std::vector<Index> rest = hexes_with(Marking::corner);
  if (rest.empty()) return 0;

  const auto n_before = n_full();
  const CompressedRows hexes_of_node = node_hexes(mesh);
  std::vector<Index> worklist;
  std::uint8_t round = 1;
  if (rounds) rounds->assign(marked.size(), 0);
  const auto mark_all_nodes = [&](Index h) {
    for (const Index n : mesh.hexes[h]) {
      if (marked[n]) continue;
      marked[n] = 1;
      if (rounds) (*rounds)[n] = round;
      for (const Index neighbour : hexes_of_node[n])
        if (state(neighbour) == Marking::concave) worklist.push_back(neighbour);
    }
  };
  // A direction once concave stays so until all eight nodes are marked, so the order of the worklist does not matter.
  // An L may still become a full face: those have to wait until the worklist is empty, and go all at once.
  worklist = hexes_with(Marking::concave);
  while (true) {
    while (!worklist.empty()) {
      const Index h = worklist.back();
      worklist.pop_back();
      if (state(h) == Marking::concave) mark_all_nodes(h);
    }
    rest = hexes_with(Marking::corner);
    if (rest.empty()) return static_cast<Index>(n_full() - n_before);
    round = static_cast<std::uint8_t>(round == 255 ? 1 : round + 1);
    for (const Index h : rest) mark_all_nodes(h);
  }
}

}  // namespace hextwist
