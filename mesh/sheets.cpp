#include "hextwist/mesh/sheets.h"

#include <algorithm>
#include <array>

#include "hextwist/base/union_find.h"
#include "hextwist/mesh/loose_topology.h"

namespace hextwist {
namespace {

/// Lists from pairs (list, item) that `pairs` hands to its argument in ascending order of items, twice.
template <class Pairs>
CompressedRows collect(Index n_lists, Pairs pairs) {
  CompressedRows lists;
  lists.first.assign(n_lists + 1, 0);
  pairs([&](Index list, Index) { ++lists.first[list + 1]; });
  for (Index i = 0; i < n_lists; ++i) lists.first[i + 1] += lists.first[i];
  lists.items.resize(lists.first.back());
  std::vector<Index> next(lists.first.begin(), lists.first.end() - 1);
  pairs([&](Index list, Index item) { lists.items[next[list]++] = item; });
  return lists;
}

}  // namespace

Sheets sheets(const Mesh& mesh, const Edges& edges) {
  const auto n_edges = static_cast<Index>(edges.nodes.size());
  std::vector<Index> parent = singletons(n_edges);
  parallel_ranges(mesh.n_hexes(), [&](Index begin, Index end) {
    for (Index h = begin; h < end; ++h)
      for (int axis = 0; axis < 3; ++axis)
        for (int k = 1; k < 4; ++k) join(parent, edges.of_hex[h][4 * axis], edges.of_hex[h][4 * axis + k]);
  });

  Sheets result;
  result.of_edge.resize(n_edges);
  Index n_sheets = 0;
  for (Index e = 0; e < n_edges; ++e)  // a root comes before the rest of its tree
    result.of_edge[e] = parent[e] == e ? n_sheets++ : result.of_edge[find_root(parent, e)];

  result.edges = collect(n_sheets, [&](auto put) {
    for (Index e = 0; e < n_edges; ++e) put(result.of_edge[e], e);
  });
  const auto sheets_of = [&](Index h) {
    return std::array{sheet_of(result, edges, h, 0), sheet_of(result, edges, h, 1), sheet_of(result, edges, h, 2)};
  };
  result.hexes = collect(n_sheets, [&](auto put) {
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      const auto [x, y, z] = sheets_of(h);
      put(x, h);
      if (y != x) put(y, h);
      if (z != x && z != y) put(z, h);
    }
  });
  result.n_self_crossings.assign(n_sheets, 0);
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    const auto [x, y, z] = sheets_of(h);
    if (x == y || x == z)
      ++result.n_self_crossings[x];
    else if (y == z)
      ++result.n_self_crossings[y];
  }
  result.n_self_touches.assign(n_sheets, 0);
  for (const auto& [a, b] : loose_faces(mesh).faces.sides) {
    if (b.hex < 0) continue;
    const Index sheet = sheet_of(result, edges, a.hex, a.face / 2);
    if (sheet == sheet_of(result, edges, b.hex, b.face / 2)) ++result.n_self_touches[sheet];
  }
  return result;
}

std::vector<std::uint8_t> in_sheets_of(const Edges& edges, std::span<const Index> hexes, std::span<const Index> seeds) {
  std::vector<Index> parent = singletons(static_cast<Index>(edges.nodes.size()));
  for (const Index h : hexes)
    for (int e = 0; e < 12; ++e) join(parent, edges.of_hex[h][e & ~3], edges.of_hex[h][e]);
  std::vector<std::uint8_t> result(parent.size(), 0);
  for (const Index e : seeds) result[find_root(parent, e)] = 1;
  parallel_each(result.size(), [&](std::size_t e) {
    const Index root = find_root(parent, static_cast<Index>(e));
    if (root != static_cast<Index>(e)) result[e] = result[root];
  });
  return result;
}

}  // namespace hextwist
