#include "hextwist/refine/combine.h"

#include <algorithm>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/sheets.h"

namespace hextwist {
namespace {

Edge ordered(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

Quad sorted(Quad quad) {
  std::ranges::sort(quad);
  return quad;
}

}  // namespace

std::vector<std::uint16_t> combination_codes(const Mesh& mesh, const CombinationTarget& target) {
  std::vector<std::uint16_t> codes(mesh.hexes.size(), 0);
  if (target.edges.empty() && target.faces.empty()) return codes;
  std::vector<Quad> target_faces;
  for (const Quad& quad : target.faces) target_faces.push_back(sorted(quad));
  std::ranges::sort(target_faces);

  // Mark the nodes of the hexes at the target.
  std::vector<std::uint8_t> is_target(mesh.points.size(), 0), marked(mesh.points.size(), 0);
  for (const Index n : target.nodes) is_target[n] = 1;
  for (const Hex& hex : mesh.hexes) {
    if (std::ranges::count_if(hex, [&](Index n) { return is_target[n] != 0; }) < 2) continue;
    bool touches = false;
    for (int e = 0; e < n_hex_edges && !touches; ++e)
      touches = std::ranges::binary_search(target.edges, ordered(hex[edge_corner(e, 0)], hex[edge_corner(e, 1)]));
    for (int f = 0; f < n_hex_faces && !touches; ++f)
      touches = std::ranges::binary_search(target_faces, sorted(face_nodes(hex, f)));
    if (touches)
      for (const Index n : hex) marked[n] = 1;
  }

  // Cut only across the sheets of the target's edges.
  const Edges all = edges(mesh);
  const Sheets of = sheets(mesh, all);
  std::vector<std::uint8_t> is_cut_sheet(of.size(), 0);
  const auto take = [&](Index a, Index b) {
    if (const Index edge = find_edge(all, a, b); edge >= 0) is_cut_sheet[of.of_edge[edge]] = 1;
  };
  for (const Edge& edge : target.edges) take(edge[0], edge[1]);
  for (const Quad& quad : target.faces) {
    take(quad[0], quad[1]);
    take(quad[0], quad[2]);
  }
  for (std::size_t h = 0; h < codes.size(); ++h) {
    const Hex& hex = mesh.hexes[h];
    for (int e = 0; e < n_hex_edges; ++e)
      if (marked[hex[edge_corner(e, 0)]] && marked[hex[edge_corner(e, 1)]] &&
          is_cut_sheet[of.of_edge[all.of_hex[h][e]]])
        codes[h] = static_cast<std::uint16_t>(codes[h] | 1 << e);
  }
  return codes;
}

}  // namespace hextwist
