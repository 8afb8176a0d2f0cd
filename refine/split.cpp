#include "hextwist/refine/split.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

namespace hextwist {
namespace {

constexpr int grain = 1024;

template <typename Body>
void for_each_index(std::size_t n, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, grain), [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
  });
}

/// An occurrence of an edge or face in a cut hex. Items are counted along the cut hexes: 12 (or 6) for each.
struct Occurrence {
  std::uint64_t key;  // the other nodes: which edge or face of the bucket's node it is
  Index item;
};

/// Gives equal edges (or faces) one number: bucket by lowest node, sort each bucket, count.
/// of_hex: number per item, -1 where there is nothing. Returns the lowest item of each number.
template <std::size_t n_per_hex, typename Key>
std::vector<Index> number_shared(std::size_t n_cut, Index n_nodes, const Key& key,
                                 std::vector<std::array<Index, n_per_hex>>& of_hex) {
  // key(item) -> {lowest node, key}, lowest node -1: nothing there
  std::vector<Index> first(static_cast<std::size_t>(n_nodes) + 1, 0);
  of_hex.resize(n_cut);
  for_each_index(n_cut, [&](std::size_t i) {
    for (std::size_t item = i * n_per_hex; item < (i + 1) * n_per_hex; ++item) {
      const Index lowest = key(item).first;
      of_hex[i][item - i * n_per_hex] = -1;
      if (lowest >= 0) std::atomic_ref(first[lowest + 1]).fetch_add(1, std::memory_order_relaxed);
    }
  });
  for (Index n = 0; n < n_nodes; ++n) first[n + 1] += first[n];
  std::vector<Occurrence> occurrences(first[n_nodes]);
  for_each_index(n_cut, [&](std::size_t i) {
    for (std::size_t item = i * n_per_hex; item < (i + 1) * n_per_hex; ++item) {
      const auto [lowest, other] = key(item);
      if (lowest < 0) continue;
      const Index at = std::atomic_ref(first[lowest]).fetch_add(1, std::memory_order_relaxed);
      occurrences[at] = {other, static_cast<Index>(item)};
    }
  });
  // Each start has moved to its end: bucket n is now [first[n - 1], first[n]).
  std::vector<Index> n_distinct(static_cast<std::size_t>(n_nodes) + 1, 0);
  for_each_index(n_nodes, [&](std::size_t n) {
    const auto begin = occurrences.begin() + (n ? first[n - 1] : 0), end = occurrences.begin() + first[n];
    if (begin == end) return;
    std::sort(begin, end, [](const Occurrence& a, const Occurrence& b) {
      return a.key != b.key ? a.key < b.key : a.item < b.item;
    });
    Index count = 1;
    for (auto at = begin + 1; at < end; ++at) count += at->key != (at - 1)->key;
    n_distinct[n + 1] = count;
  });
  for (Index n = 0; n < n_nodes; ++n) n_distinct[n + 1] += n_distinct[n];
  std::vector<Index> representative(n_distinct[n_nodes]);
  for_each_index(n_nodes, [&](std::size_t n) {
    Index number = n_distinct[n] - 1;
    const Index begin = n ? first[n - 1] : 0;
    for (Index at = begin; at < first[n]; ++at) {
      if (at == begin || occurrences[at].key != occurrences[at - 1].key)
        representative[++number] = occurrences[at].item;
      const std::size_t item = occurrences[at].item;
      of_hex[item / n_per_hex][item % n_per_hex] = number;
    }
  });
  return representative;
}

/// The cut hexes with what their codes bring.
struct CutList {
  std::vector<Index> hex;
  std::vector<const HexTemplate*> of;  // template per cut hex
};

CutList cut_hexes(const SplitTable& table, std::span<const std::uint16_t> codes) {
  CutList cut;
  for (std::size_t h = 0; h < codes.size(); ++h)
    if (codes[h]) {
      cut.hex.push_back(static_cast<Index>(h));
      cut.of.push_back(&table.hex(codes[h]));
    }
  return cut;
}

Index checked(std::int64_t n) {
  if (n > std::numeric_limits<Index>::max())
    throw Error("the refined mesh would have " + std::to_string(n) + " nodes or hexes, more than 2147483647");
  return static_cast<Index>(n);
}

/// Numbers of the edges on cut hexes; lineage.edges gets their nodes.
void number_edges(std::span<const Hex> hexes, const CutList& cut, const SplitTable& table, Split& split,
                  std::int64_t& n_nodes) {
  Lineage& lineage = split.lineage;
  const auto ends = [&](std::size_t item) {
    const std::size_t e = item % n_hex_edges;
    const Hex& hex = hexes[cut.hex[item / n_hex_edges]];
    return std::array{hex[edge_corner(static_cast<int>(e), 0)], hex[edge_corner(static_cast<int>(e), 1)]};
  };
  const auto key = [&](std::size_t item) {
    if (cut.of[item / n_hex_edges]->edge_code[item % n_hex_edges] == 0) return std::pair{Index{-1}, std::uint64_t{0}};
    const auto [a, b] = ends(item);
    return std::pair{std::min(a, b), static_cast<std::uint64_t>(std::max(a, b))};
  };
  const auto representative = number_shared(cut.hex.size(), lineage.n_old_nodes, key, split.hex_edges);
  lineage.edges.resize(representative.size());
  for (std::size_t i = 0; i < lineage.edges.size(); ++i) {
    const std::size_t item = representative[i];
    const auto [a, b] = ends(item);
    std::uint16_t code = cut.of[item / n_hex_edges]->edge_code[item % n_hex_edges];
    if (a > b) code = table.edge[code].reversed;
    lineage.edges[i] = {std::min(a, b), std::max(a, b), static_cast<Index>(n_nodes), cut.hex[item / n_hex_edges], code};
    n_nodes = checked(n_nodes + static_cast<std::int64_t>(table.edge[code].at.size()));
  }
}

/// Numbers of the faces on cut hexes that get nodes inside; lineage.faces gets their nodes.
void number_faces(std::span<const Hex> hexes, const CutList& cut, const SplitTable& table, Split& split,
                  std::int64_t& n_nodes) {
  Lineage& lineage = split.lineage;
  const auto key = [&](std::size_t item) {
    const int f = static_cast<int>(item % n_hex_faces);
    const std::size_t i = item / n_hex_faces;
    if (table.face[cut.of[i]->face_code[f]].at.empty()) return std::pair{Index{-1}, std::uint64_t{0}};
    const auto nodes = face_nodes(hexes[cut.hex[i]], f);
    const int symmetry = face_symmetry(nodes);
    const auto turned = [&](int k) { return nodes[turned_corner(symmetry, k)]; };
    return std::pair{turned(0), static_cast<std::uint64_t>(turned(3)) << 32 | static_cast<std::uint32_t>(turned(1))};
  };
  const auto representative = number_shared(cut.hex.size(), lineage.n_old_nodes, key, split.hex_faces);
  lineage.faces.resize(representative.size());
  for (std::size_t i = 0; i < lineage.faces.size(); ++i) {
    const std::size_t item = representative[i];
    const int f = static_cast<int>(item % n_hex_faces);
    const Index hex = cut.hex[item / n_hex_faces];
    const auto nodes = face_nodes(hexes[hex], f);
    const int symmetry = face_symmetry(nodes);
    CutFace& face = lineage.faces[i];
    face.side = {hex, f};
    for (int k = 0; k < 4; ++k) face.corners[k] = nodes[turned_corner(symmetry, k)];
    face.code = table.face[cut.of[item / n_hex_faces]->face_code[f]].turned[symmetry];
    face.first_node = static_cast<Index>(n_nodes);
    n_nodes = checked(n_nodes + static_cast<std::int64_t>(table.face[face.code].at.size()));
  }
}

}  // namespace

Index Split::cut_index(Index old_hex) const {
  const auto found = std::ranges::lower_bound(lineage.hexes, old_hex, {}, &CutHex::hex);
  assert(found != lineage.hexes.end() && found->hex == old_hex);
  return static_cast<Index>(found - lineage.hexes.begin());
}

Split split(std::span<const Hex> hexes, Index n_nodes, std::shared_ptr<const SplitTable> table,
            std::span<const std::uint16_t> codes) {
  assert(codes.size() == hexes.size());
  Split result;
  Lineage& lineage = result.lineage;
  lineage.n_old_nodes = n_nodes;
  lineage.n_old_hexes = static_cast<Index>(hexes.size());
  lineage.table = table;
  const CutList cut = cut_hexes(*table, codes);

  // Count: new nodes on edges, on faces, in hexes; children.
  std::int64_t node = n_nodes;
  number_edges(hexes, cut, *table, result, node);
  number_faces(hexes, cut, *table, result, node);
  const Index n_kept = lineage.n_old_hexes - static_cast<Index>(cut.hex.size());
  std::int64_t child = n_kept;
  lineage.hexes.resize(cut.hex.size());
  for (std::size_t i = 0; i < cut.hex.size(); ++i) {
    lineage.hexes[i] = {cut.hex[i], static_cast<Index>(child), static_cast<Index>(node), codes[cut.hex[i]]};
    child = checked(child + static_cast<std::int64_t>(cut.of[i]->children.size()));
    node = checked(node + static_cast<std::int64_t>(cut.of[i]->inside.size()));
  }
  result.n_nodes = static_cast<Index>(node);

  // Fill: kept hexes, then children.
  result.hexes.resize(child);
  result.first_child.resize(hexes.size());
  lineage.parent.resize(child);
  Index kept = 0;
  for (std::size_t h = 0; h < hexes.size(); ++h) {
    if (codes[h]) continue;
    result.hexes[kept] = hexes[h];
    lineage.parent[kept] = static_cast<Index>(h);
    result.first_child[h] = kept++;
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cut.hex.size(), 64), [&](const auto& range) {
    std::vector<Index> local;
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const HexTemplate& of = *cut.of[i];
      const Hex& hex = hexes[cut.hex[i]];
      local.resize(std::max<std::size_t>(local.size(), table->inside_node(static_cast<int>(of.inside.size()))));
      std::ranges::copy(hex, local.begin());
      for (int e = 0; e < n_hex_edges; ++e) {
        const Index number = result.hex_edges[i][e];
        if (number < 0) continue;
        const CutEdge& shared = lineage.edges[number];
        const int n = static_cast<int>(table->edge[shared.code].at.size());
        const bool backwards = hex[edge_corner(e, 0)] > hex[edge_corner(e, 1)];
        assert((backwards ? table->edge[shared.code].reversed : shared.code) == of.edge_code[e]);
        for (int s = 0; s < n; ++s) local[table->edge_node(e, s)] = shared.first_node + (backwards ? n - 1 - s : s);
      }
      for (int f = 0; f < n_hex_faces; ++f) {
        const Index number = result.hex_faces[i][f];
        if (number < 0) continue;
        const FacePattern& pattern = table->face[of.face_code[f]];
        const int symmetry = face_symmetry(face_nodes(hex, f));
        assert(pattern.turned[symmetry] == lineage.faces[number].code);
        const auto& turned_slot = pattern.turned_slot[symmetry];
        for (std::size_t s = 0; s < turned_slot.size(); ++s)
          local[table->face_node(f, static_cast<int>(s))] = lineage.faces[number].first_node + turned_slot[s];
      }
      for (std::size_t s = 0; s < of.inside.size(); ++s)
        local[table->inside_node(static_cast<int>(s))] = lineage.hexes[i].first_node + static_cast<Index>(s);
      const Index first = lineage.hexes[i].first_child;
      result.first_child[cut.hex[i]] = first;
      for (std::size_t c = 0; c < of.children.size(); ++c) {
        Hex& new_hex = result.hexes[first + c];
        for (int corner = 0; corner < 8; ++corner) new_hex[corner] = local[of.children[c][corner]];
        lineage.parent[first + c] = cut.hex[i];
      }
    }
  });
  return result;
}

}  // namespace hextwist
