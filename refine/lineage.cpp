#include "hextwist/refine/lineage.h"

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/refine/templates/split_table.h"

namespace hextwist {

const CutEdge* find_cut_edge(const Lineage& lineage, const Edge& old_edge) {
  const Index at = position_in(lineage.edges, old_edge, [](const CutEdge& cut) { return Edge{cut.a, cut.b}; });
  return at < 0 ? nullptr : &lineage.edges[at];
}

Index n_new_nodes(const Lineage& lineage, const CutEdge& edge) {
  return static_cast<Index>(lineage.table->edge[edge.code].at.size());
}

std::vector<Index> children_of(const Lineage& lineage, std::span<const Index> old_hexes) {
  std::vector<std::uint8_t> wanted(static_cast<std::size_t>(lineage.n_old_hexes), 0);
  for (const Index h : old_hexes) wanted[h] = 1;
  return indices_where(static_cast<Index>(lineage.parent.size()),
                       [&](Index h) { return wanted[lineage.parent[h]] != 0; });
}

}  // namespace hextwist
