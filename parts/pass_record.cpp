#include "hextwist/parts/pass_record.h"

#include <algorithm>

#include "hextwist/refine/templates/enclose.h"
#include "hextwist/refine/templates/split_table.h"
#include "hextwist/refine/templates/trisect.h"

namespace hextwist {
namespace {

/// Adds up what follows each other and belongs to the same old node.
template <class Cut, class NodeOf, class Count>
std::vector<BroughtBy> by_node(const std::vector<Cut>& cut_ones, std::span<const std::uint8_t> is_own_node,
                               const NodeOf& node_of, const Count& count) {
  std::vector<BroughtBy> rows;
  for (const Cut& cut : cut_ones) {
    const Index node = node_of(cut);
    if (!is_own_node[node]) continue;
    if (rows.empty() || rows.back().old != node) rows.push_back({node, cut.first_node});
    rows.back().n += count(cut);
  }
  return rows;
}

PassRecord::Kind kind_of(const SplitTable* table) {
  if (table == trisect_table().get()) return PassRecord::Kind::trisect;
  if (table == enclose_table(EncloseAt::third).get() || table == enclose_table(EncloseAt::half).get())
    return PassRecord::Kind::enclose;
  return PassRecord::Kind::other;
}

}  // namespace

void PassRecorder::record(const Lineage& lineage, std::span<const Hex> hexes_before) {
  const SplitTable& table = *lineage.table;
  std::vector<std::uint8_t> is_own_node(static_cast<std::size_t>(lineage.n_old_nodes), 0);
  for (std::size_t h = 0; h < hexes_before.size(); ++h)
    if (is_own_[h])
      for (const Index n : hexes_before[h]) is_own_node[n] = 1;

  PassRecord record;
  record.kind = kind_of(lineage.table.get());
  record.n_old_nodes = lineage.n_old_nodes;
  record.n_old_hexes = lineage.n_old_hexes;
  record.n_hexes = static_cast<Index>(lineage.parent.size());
  record.n_nodes = lineage.n_old_nodes;
  const auto n_on_edge = [&](const CutEdge& edge) { return static_cast<Index>(table.edge[edge.code].at.size()); };
  const auto n_in_face = [&](const CutFace& face) { return static_cast<Index>(table.face[face.code].at.size()); };
  for (const CutEdge& edge : lineage.edges) record.n_nodes += n_on_edge(edge);
  for (const CutFace& face : lineage.faces) record.n_nodes += n_in_face(face);
  record.edges = by_node(
      lineage.edges, is_own_node, [](const CutEdge& edge) { return edge.a; }, n_on_edge);
  record.faces = by_node(
      lineage.faces, is_own_node, [](const CutFace& face) { return face.corners[0]; }, n_in_face);
  for (const CutHex& cut : lineage.hexes) {
    const HexTemplate& of = table.hex(cut.code);
    const auto n_inside = static_cast<Index>(of.inside.size());
    record.n_nodes += n_inside;
    if (is_own_[cut.hex])
      record.hexes.push_back(
          {cut.hex, cut.first_node, n_inside, cut.first_child, static_cast<Index>(of.children.size())});
  }
  const Index n_kept = lineage.n_old_hexes - static_cast<Index>(lineage.hexes.size());
  std::vector<std::uint8_t> is_own(lineage.parent.size());
  for (Index h = 0; h < record.n_hexes; ++h) {
    is_own[h] = is_own_[lineage.parent[h]];
    if (is_own[h] && h < n_kept) record.kept.push_back({lineage.parent[h], h});
  }
  is_own_ = std::move(is_own);
  records.push_back(std::move(record));
}

}  // namespace hextwist
