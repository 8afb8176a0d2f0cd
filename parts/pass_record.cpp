#include "hextwist/parts/pass_record.h"

#include <algorithm>
#include <limits>

#include "hextwist/refine/templates/split_table.h"

namespace hextwist {
namespace {

/// Adds up what follows each other and belongs to the same old node.
template <class Cut, class NodeOf, class Count>
std::vector<BroughtBy> by_node(const std::vector<Cut>& cut_ones, std::span<const std::uint8_t> ring_of_node,
                               const NodeOf& node_of, const Count& count) {
  std::vector<BroughtBy> rows;
  for (const Cut& cut : cut_ones) {
    const Index node = node_of(cut);
    if (rows.empty() || rows.back().old != node) rows.push_back({node, cut.first_node, 0, 0, 0, ring_of_node[node]});
    rows.back().n += count(cut);
  }
  return rows;
}

}  // namespace

void keep_rings(PassRecord& record, int n_rings) {
  for (auto* rows : {&record.edges, &record.faces, &record.hexes})
    std::erase_if(*rows, [&](const BroughtBy& row) { return row.ring > n_rings; });
}

void PassRecorder::record(const Turn& turn, const Lineage& lineage, std::span<const Hex> hexes_before,
                          std::span<const std::uint8_t> filled) {
  const SplitTable& table = *lineage.table;
  std::vector<std::uint8_t> ring_of_node(static_cast<std::size_t>(lineage.n_old_nodes),
                                         std::numeric_limits<std::uint8_t>::max());
  for (std::size_t h = 0; h < hexes_before.size(); ++h)
    for (const Index n : hexes_before[h]) ring_of_node[n] = std::min(ring_of_node[n], ring_[h]);

  PassRecord record;
  record.turn = turn;
  record.n_old_nodes = lineage.n_old_nodes;
  record.n_old_hexes = lineage.n_old_hexes;
  record.n_hexes = static_cast<Index>(lineage.parent.size());
  record.n_nodes = lineage.n_old_nodes;
  const auto n_on_edge = [&](const CutEdge& edge) { return static_cast<Index>(table.edge[edge.code].at.size()); };
  const auto n_in_face = [&](const CutFace& face) { return static_cast<Index>(table.face[face.code].at.size()); };
  for (const CutEdge& edge : lineage.edges) record.n_nodes += n_on_edge(edge);
  for (const CutFace& face : lineage.faces) record.n_nodes += n_in_face(face);
  record.edges = by_node(
      lineage.edges, ring_of_node, [](const CutEdge& edge) { return edge.a; }, n_on_edge);
  record.faces = by_node(
      lineage.faces, ring_of_node, [](const CutFace& face) { return face.corners[0]; }, n_in_face);

  std::vector<std::uint8_t> ring(lineage.parent.size());
  std::vector<std::uint64_t> history(lineage.parent.size());
  for (Index h = 0; h < record.n_hexes; ++h) {
    ring[h] = ring_[lineage.parent[h]];
    history[h] = history_[lineage.parent[h]];
  }
  for (const CutHex& cut : lineage.hexes) {
    const HexTemplate& of = table.hex(cut.code);
    const auto n_inside = static_cast<Index>(of.inside.size()), n_children = static_cast<Index>(of.children.size());
    record.n_nodes += n_inside;
    record.hexes.push_back({cut.hex, cut.first_node, n_inside, cut.first_child, n_children, ring_[cut.hex]});
    std::uint64_t made = history_[cut.hex];
    for (const int part : {turn.round + 1, turn.step, turn.part}) mix(made, static_cast<std::uint64_t>(part));
    mix(made, cut.code);
    if (!filled.empty())
      for (const Index n : hexes_before[cut.hex]) mix(made, filled[n]);
    for (Index i = 0; i < n_children; ++i) {
      history[cut.first_child + i] = made;
      mix(history[cut.first_child + i], static_cast<std::uint64_t>(i));
    }
  }
  const Index n_kept = lineage.n_old_hexes - static_cast<Index>(lineage.hexes.size());
  for (Index h = 0; h < n_kept; ++h) record.kept.push_back({lineage.parent[h], h});
  ring_ = std::move(ring);
  history_ = std::move(history);
  records.push_back(std::move(record));
}

}  // namespace hextwist
