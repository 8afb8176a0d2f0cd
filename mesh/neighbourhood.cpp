#include "hextwist/mesh/neighbourhood.h"

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/union_find.h"

namespace hextwist {

void mark_nodes(std::span<const Hex> hexes, std::span<const Index> targets, std::span<std::uint8_t> marked) {
  for (const Index h : targets)
    for (const Index n : hexes[h]) marked[n] = 1;
}

std::vector<Index> touching_hexes(std::span<const Hex> hexes, std::span<const std::uint8_t> marked) {
  return indices_where(static_cast<Index>(hexes.size()), [&](Index h) { return has_marked_corner(hexes[h], marked); });
}

std::vector<Index> layers_around(const Mesh& mesh, std::span<const Index> nodes, int n_layers) {
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  for (const Index n : nodes) marked[n] = 1;
  return with_layers(mesh, touching_hexes(mesh.hexes, marked), n_layers - 1);
}

std::vector<Index> with_layers(const Mesh& mesh, std::vector<Index> hexes, int n_layers) {
  sort_unique(hexes);
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  for (; n_layers > 0 && static_cast<Index>(hexes.size()) < mesh.n_hexes(); --n_layers) {
    mark_nodes(mesh.hexes, hexes, marked);
    hexes = touching_hexes(mesh.hexes, marked);
  }
  return hexes;
}

std::vector<Index> nodes_of_hexes(const Mesh& mesh, std::span<const Index> hexes, Index first_node) {
  std::vector<Index> nodes;
  nodes.reserve(8 * hexes.size());
  for (const Index h : hexes)
    for (const Index n : mesh.hexes[h])
      if (n >= first_node) nodes.push_back(n);
  return sorted_unique(std::move(nodes));
}

std::vector<Index> nodes_inside(const Mesh& mesh, std::span<const Index> hexes) {
  std::vector<std::uint8_t> in(mesh.hexes.size(), 0), inside(mesh.points.size(), 0);
  for (const Index h : hexes) in[h] = 1;
  mark_nodes(mesh.hexes, hexes, inside);
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (!in[h])
      for (const Index node : mesh.hexes[h]) inside[node] = 0;
  return indices_where(mesh.n_nodes(), [&](Index n) { return inside[n] != 0; });
}

std::vector<std::vector<Index>> connected_regions(const Mesh& mesh, std::span<const Index> hexes) {
  std::vector<Index> parent = singletons(mesh.n_nodes());
  for (const Index h : hexes)
    for (const Index n : mesh.hexes[h]) join(parent, mesh.hexes[h][0], n);
  std::vector<std::vector<Index>> result;
  std::vector<Index> number(mesh.points.size(), -1);
  for (const Index h : hexes) {
    Index& region = number[find_root(parent, mesh.hexes[h][0])];
    if (region < 0) {
      region = static_cast<Index>(result.size());
      result.emplace_back();
    }
    result[region].push_back(h);
  }
  return result;
}

}  // namespace hextwist
