#include "hextwist/refine/plans/combine.h"

#include <algorithm>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/sheets.h"
#include "hextwist/refine/marks.h"

namespace hextwist {
namespace {

Edge ordered(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

Quad sorted(Quad quad) {
  std::ranges::sort(quad);
  return quad;
}

std::array<Edge, 4> edges_of(const Quad& quad) {
  return {ordered(quad[0], quad[1]), ordered(quad[0], quad[2]), ordered(quad[1], quad[3]), ordered(quad[2], quad[3])};
}

/// Hexes with an uncut target edge, or with a target face that has one.
std::vector<Index> hexes_at_target(const Mesh& mesh, const CombinationTarget& target, std::span<const Edge> uncut) {
  const auto is_uncut = [&](const Edge& edge) { return std::ranges::binary_search(uncut, edge); };
  std::vector<Edge> wanted_edges;
  std::ranges::copy_if(target.edges, std::back_inserter(wanted_edges), is_uncut);
  std::vector<Quad> wanted_faces;
  for (const Quad& quad : target.faces)
    if (std::ranges::any_of(edges_of(quad), is_uncut)) wanted_faces.push_back(sorted(quad));
  std::ranges::sort(wanted_faces);

  std::vector<std::uint8_t> is_target(mesh.points.size(), 0);
  for (const Edge& edge : wanted_edges) is_target[edge[0]] = is_target[edge[1]] = 1;
  for (const Quad& quad : wanted_faces)
    for (const Index n : quad) is_target[n] = 1;
  std::vector<Index> result;
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    const Hex& hex = mesh.hexes[h];
    if (std::ranges::count_if(hex, [&](Index n) { return is_target[n] != 0; }) < 2) continue;
    bool touches = false;
    for (int e = 0; e < n_hex_edges && !touches; ++e)
      touches = std::ranges::binary_search(wanted_edges, ordered(hex[edge_corner(e, 0)], hex[edge_corner(e, 1)]));
    for (int f = 0; f < n_hex_faces && !touches; ++f)
      touches = std::ranges::binary_search(wanted_faces, sorted(face_nodes(hex, f)));
    if (touches) result.push_back(h);
  }
  return result;
}

}  // namespace

std::vector<Edge> target_edges(const CombinationTarget& target) {
  std::vector<Edge> result = target.edges;
  for (const Quad& quad : target.faces) std::ranges::copy(edges_of(quad), std::back_inserter(result));
  sort_unique(result);
  return result;
}

std::vector<std::uint16_t> combination_codes(const Mesh& mesh, const CombinationTarget& target,
                                             std::span<const Edge> uncut) {
  const std::vector<Index> region = hexes_at_target(mesh, target, uncut);
  if (region.empty()) return std::vector<std::uint16_t>(mesh.hexes.size(), 0);
  const Edges all = edges(mesh);
  std::vector<std::uint8_t> in_region(all.nodes.size(), 0);
  for (const Index h : region)
    for (const Index edge : all.of_hex[h]) in_region[edge] = 1;
  std::vector<Index> seeds;
  for (const Edge& edge : uncut)
    if (const Index i = find_edge(all, edge[0], edge[1]); i >= 0 && in_region[i]) seeds.push_back(i);
  return trisect_codes(all, in_sheets_of(all, region, seeds));
}

}  // namespace hextwist
