// Everything here is flat: a list of the cut hexes, one walk along their nodes that numbers edges and faces (each
// belongs to its lowest node), prefix sums that number what is new, and one walk along the cut hexes that writes the
// children.
#include "hextwist/refine/split.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "hextwist/base/large_array.h"
#include "hextwist/base/memory.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/loose_topology.h"

namespace hextwist {
namespace {

/// The cut hexes with what their codes bring.
struct CutList {
  std::vector<Index> hex;
  std::vector<const HexTemplate*> of;  ///< template per cut hex
  /// Their nodes, renumbered in the same order without those that no cut hex has, when these are many.
  std::span<const Hex> nodes;
  Index n_nodes = 0;
  std::vector<Hex> own_nodes;  ///< what `nodes` is of, unless all hexes are cut
};

CutList cut_hexes(std::span<const Hex> hexes, Index n_nodes, const SplitTable& table,
                  std::span<const std::uint16_t> codes) {
  CutList cut;
  cut.hex = indices_where(static_cast<Index>(codes.size()), [&](Index h) { return codes[h] != 0; });
  resize_for_overwrite(cut.of, cut.hex.size());
  parallel_each(cut.hex.size(), [&](std::size_t i) { cut.of[i] = &table.hex(codes[cut.hex[i]]); });
  cut.nodes = hexes;
  cut.n_nodes = n_nodes;
  if (cut.hex.size() == hexes.size()) return cut;
  resize_for_overwrite(cut.own_nodes, cut.hex.size());
  cut.nodes = cut.own_nodes;
  parallel_each(cut.hex.size(), [&](std::size_t i) { cut.own_nodes[i] = hexes[cut.hex[i]]; });
  if (cut.hex.size() > static_cast<std::size_t>(n_nodes) / 100) return cut;
  std::vector<Index> used;
  for (const Hex& hex : cut.own_nodes) used.insert(used.end(), hex.begin(), hex.end());
  sort_unique(used);
  for (Hex& hex : cut.own_nodes)
    for (Index& node : hex) node = position_in(used, node);
  cut.n_nodes = static_cast<Index>(used.size());
  return cut;
}

/// What hex_edges and hex_faces hold until edges and faces have their numbers: 0 for nothing, else the rank among the
/// edges (faces) of the same lowest node, and whether this is the first hex that has it.
constexpr Index ranked(Index rank, bool first) {
  return 2 * rank + (first ? 1 : 2);
}
constexpr Index rank_of(Index entry) {
  return (entry - 1) / 2;
}
constexpr bool is_first(Index entry) {
  return entry % 2 != 0;
}

/// Ranks the different edges (or faces) that belong to one node by their other nodes: the key.
template <class Key>
class Ranking {
 public:
  /// n: of how many uses there may be before finish().
  void begin(std::size_t n) {
    if (n > uses_.size()) {
      uses_.resize(n);
      keys_.resize(n);
      ranks_.resize(n);
    }
    n_uses_ = n_keys_ = 0;
  }
  /// entry: where the rank of this use goes. Uses come in the order of hexes.
  void add(const Key& key, Index& entry) {
    std::size_t at = 0;
    while (at < n_keys_ && keys_[at] != key) ++at;
    uses_[n_uses_++] = {&entry, at, at == n_keys_};
    if (at == n_keys_) keys_[n_keys_++] = key;
  }
  /// Writes all entries; returns how many different keys there were.
  Index finish() {
    for (std::size_t i = 0; i < n_keys_; ++i) {
      Index rank = 0;
      for (std::size_t j = 0; j < n_keys_; ++j) rank += keys_[j] < keys_[i];
      ranks_[i] = rank;
    }
    for (std::size_t i = 0; i < n_uses_; ++i) *uses_[i].entry = ranked(ranks_[uses_[i].key], uses_[i].first);
    return static_cast<Index>(n_keys_);
  }

 private:
  struct Use {
    Index* entry = nullptr;
    std::size_t key = 0;
    bool first = false;
  };
  std::vector<Use> uses_;
  std::vector<Key> keys_;
  std::vector<Index> ranks_;
  std::size_t n_uses_ = 0, n_keys_ = 0;
};

/// Which face of its lowest node: the node across and the lower neighbour.
constexpr std::uint64_t face_key(Index diagonal, Index low) {
  return static_cast<std::uint64_t>(diagonal) << 32 | static_cast<std::uint32_t>(low);
}

/// How many nodes each code puts on an edge, or in a face.
template <class Pattern>
std::vector<Index> n_nodes_of(const std::vector<Pattern>& patterns) {
  std::vector<Index> n;
  n.reserve(patterns.size());
  for (const Pattern& pattern : patterns) n.push_back(static_cast<Index>(pattern.at.size()));
  return n;
}

/// Starts of the edges and faces of each node, and the totals.
struct Starts {
  std::vector<Index> edges, faces;
};

/// Walks along the nodes; hex_edges and hex_faces get ranks.
Starts rank_edges_and_faces(const CutList& cut, const SplitTable& table, Split& split) {
  const CompressedRows corners = node_corners(cut.nodes, cut.n_nodes);
  const std::vector<Index> n_on_edge = n_nodes_of(table.edge), n_in_face = n_nodes_of(table.face);
  Starts starts;
  resize_for_overwrite(starts.edges, static_cast<std::size_t>(cut.n_nodes) + 1);
  resize_for_overwrite(starts.faces, static_cast<std::size_t>(cut.n_nodes) + 1);
  starts.edges.back() = starts.faces.back() = 0;
  resize_large(split.hex_edges, cut.hex.size());
  resize_large(split.hex_faces, cut.hex.size());
  parallel_ranges(cut.n_nodes, [&](Index begin, Index end) {
    Ranking<Index> edges;
    Ranking<std::uint64_t> faces;
    for (Index node = begin; node < end; ++node) {
      edges.begin(3 * corners[node].size());
      faces.begin(3 * corners[node].size());
      for (const Index corner : corners[node]) {
        const Index i = corner >> 3;
        const int c = corner & 7;
        const Hex& hex = cut.nodes[i];
        const HexTemplate& of = *cut.of[i];
        const std::array<Index, 3> next = {hex[c ^ 1], hex[c ^ 2], hex[c ^ 4]};
        for (int axis = 0; axis < 3; ++axis) {
          const int e = edge_between(c, c ^ 1 << axis);
          if (next[axis] > node && n_on_edge[of.edge_code[e]] > 0) edges.add(next[axis], split.hex_edges[i][e]);
          const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
          if (next[u] < node || next[v] < node) continue;
          const int f = 2 * axis + (c >> axis & 1);
          if (const Index diagonal = hex[c ^ 1 << u ^ 1 << v]; diagonal > node && n_in_face[of.face_code[f]] > 0)
            faces.add(face_key(diagonal, std::min(next[u], next[v])), split.hex_faces[i][f]);
        }
      }
      starts.edges[node] = edges.finish();
      starts.faces[node] = faces.finish();
    }
  });
  checked_count(counts_to_starts(starts.edges));
  checked_count(counts_to_starts(starts.faces));
  return starts;
}

CutEdge cut_edge(const SplitTable& table, const Hex& hex, Index h, int e, std::uint8_t code) {
  const Index a = hex[edge_corner(e, 0)], b = hex[edge_corner(e, 1)];
  if (a < b) return {a, b, -1, h, code};
  return {b, a, -1, h, table.edge[code].reversed};
}

/// Written in place: a copy would wait for its own writes.
void describe_face(const SplitTable& table, const Hex& hex, Side side, std::uint16_t code, CutFace& face) {
  const auto nodes = face_nodes(hex, side.face);
  const int symmetry = face_symmetry(nodes);
  face.side = side;
  for (int k = 0; k < 4; ++k) face.corners[k] = nodes[turned_corner(symmetry, k)];
  face.code = table.face[code].turned[symmetry];
}

/// Turns ranks into numbers, and has the first hex of each edge and face describe it.
void number_edges_and_faces(std::span<const Hex> hexes, const CutList& cut, const SplitTable& table,
                            const Starts& starts, Split& split) {
  Lineage& lineage = split.lineage;
  resize_for_overwrite(lineage.edges, static_cast<std::size_t>(starts.edges.back()));
  resize_for_overwrite(lineage.faces, static_cast<std::size_t>(starts.faces.back()));
  parallel_each(cut.hex.size(), [&](std::size_t i) {
    const Index h = cut.hex[i];
    for (int e = 0; e < n_hex_edges; ++e) {
      Index& entry = split.hex_edges[i][e];
      const Index found = entry;
      if (found == 0) {
        entry = -1;
        continue;
      }
      const Index lowest = std::min(cut.nodes[i][edge_corner(e, 0)], cut.nodes[i][edge_corner(e, 1)]);
      entry = starts.edges[lowest] + rank_of(found);
      if (is_first(found)) lineage.edges[entry] = cut_edge(table, hexes[h], h, e, cut.of[i]->edge_code[e]);
    }
    for (int f = 0; f < n_hex_faces; ++f) {
      Index& entry = split.hex_faces[i][f];
      const Index found = entry;
      if (found == 0) {
        entry = -1;
        continue;
      }
      entry = starts.faces[std::ranges::min(face_nodes(cut.nodes[i], f))] + rank_of(found);
      if (is_first(found)) describe_face(table, hexes[h], {h, f}, cut.of[i]->face_code[f], lineage.faces[entry]);
    }
  });
}

/// Numbers new nodes: edges, faces, hexes; and children. Returns how many hexes there will be.
Index number_nodes_and_children(const CutList& cut, std::span<const std::uint16_t> codes, Split& split) {
  Lineage& lineage = split.lineage;
  const std::vector<Index> n_on_edge = n_nodes_of(lineage.table->edge), n_in_face = n_nodes_of(lineage.table->face);
  const auto number = [](auto& cut_ones, std::int64_t node, const std::vector<Index>& n_nodes_of_code) {
    return running_sums(
        static_cast<Index>(cut_ones.size()), node, [&](Index i) { return n_nodes_of_code[cut_ones[i].code]; },
        [&](Index i, std::int64_t first) { cut_ones[i].first_node = static_cast<Index>(first); });
  };
  const std::int64_t in_faces = number(lineage.edges, lineage.n_old_nodes, n_on_edge);
  const std::int64_t in_hexes = number(lineage.faces, in_faces, n_in_face);
  const auto n_cut = static_cast<Index>(cut.hex.size());
  resize_for_overwrite(lineage.hexes, cut.hex.size());
  split.n_nodes = checked_count(running_sums(
      n_cut, in_hexes, [&](Index i) { return std::ssize(cut.of[i]->inside); },
      [&](Index i, std::int64_t first) {
        lineage.hexes[i] = {cut.hex[i], 0, static_cast<Index>(first), codes[cut.hex[i]]};
      }));
  return checked_count(running_sums(
      n_cut, lineage.n_old_hexes - n_cut, [&](Index i) { return std::ssize(cut.of[i]->children); },
      [&](Index i, std::int64_t first) { lineage.hexes[i].first_child = static_cast<Index>(first); }));
}

/// Hexes that are not cut move together, in their order.
void fill_kept(std::span<const Hex> hexes, const CutList& cut, Split& split) {
  parallel_ranges(
      static_cast<Index>(hexes.size()),
      [&](Index begin, Index end) {
        auto next_cut = std::ranges::lower_bound(cut.hex, begin);
        for (Index h = begin; h < end; ++h) {
          const Index run_end = next_cut == cut.hex.end() ? end : std::min(end, *next_cut);
          const auto n_cut_before = static_cast<Index>(next_cut - cut.hex.begin());
          std::copy(hexes.begin() + h, hexes.begin() + run_end, split.hexes.begin() + (h - n_cut_before));
          for (; h < run_end; ++h) {
            split.lineage.parent[h - n_cut_before] = h;
            split.first_child[h] = h - n_cut_before;
          }
          if (next_cut != cut.hex.end()) ++next_cut;
        }
      },
      1 << 14);
}

/// Children: the nodes of each template looked up, then its hexes written.
void fill_children(std::span<const Hex> hexes, const CutList& cut, const SplitTable& table, Split& split) {
  Lineage& lineage = split.lineage;
  const std::vector<Index> n_on_edge = n_nodes_of(table.edge);
  parallel_ranges(
      static_cast<Index>(cut.hex.size()),
      [&](Index begin, Index end) {
        std::vector<Index> local;  // node of each local number of the template
        for (Index i = begin; i < end; ++i) {
          const HexTemplate& of = *cut.of[i];
          const Hex& hex = hexes[cut.hex[i]];
          local.resize(std::max<std::size_t>(local.size(), table.inside_node(static_cast<int>(of.inside.size()))));
          std::ranges::copy(hex, local.begin());
          for (int e = 0; e < n_hex_edges; ++e) {
            const Index number = split.hex_edges[i][e];
            if (number < 0) continue;
            const CutEdge& shared = lineage.edges[number];
            const int n = n_on_edge[shared.code];
            const bool backwards = hex[edge_corner(e, 0)] > hex[edge_corner(e, 1)];
            assert((backwards ? table.edge[shared.code].reversed : shared.code) == of.edge_code[e]);
            for (int s = 0; s < n; ++s) local[table.edge_node(e, s)] = shared.first_node + (backwards ? n - 1 - s : s);
          }
          for (int f = 0; f < n_hex_faces; ++f) {
            const Index number = split.hex_faces[i][f];
            if (number < 0) continue;
            const FacePattern& pattern = table.face[of.face_code[f]];
            const int symmetry = face_symmetry(face_nodes(hex, f));
            assert(pattern.turned[symmetry] == lineage.faces[number].code);
            const auto& turned_slot = pattern.turned_slot[symmetry];
            for (std::size_t s = 0; s < turned_slot.size(); ++s)
              local[table.face_node(f, static_cast<int>(s))] = lineage.faces[number].first_node + turned_slot[s];
          }
          for (std::size_t s = 0; s < of.inside.size(); ++s)
            local[table.inside_node(static_cast<int>(s))] = lineage.hexes[i].first_node + static_cast<Index>(s);
          const Index first = lineage.hexes[i].first_child;
          split.first_child[cut.hex[i]] = first;
          for (std::size_t c = 0; c < of.children.size(); ++c) {
            Hex& new_hex = split.hexes[first + c];
            for (int corner = 0; corner < 8; ++corner) new_hex[corner] = local[of.children[c][corner]];
            lineage.parent[first + c] = cut.hex[i];
          }
        }
      },
      64);
}

}  // namespace

Index checked_count(std::int64_t n) {
  if (n > std::numeric_limits<Index>::max())
    throw Error("the refined mesh would have " + std::to_string(n) + " nodes or hexes, more than 2147483647");
  return static_cast<Index>(n);
}

Index Split::cut_index(Index old_hex) const {
  const Index at = position_in(lineage.hexes, old_hex, &CutHex::hex);
  assert(at >= 0);
  return at;
}

Split split(std::span<const Hex> hexes, Index n_nodes, std::shared_ptr<const SplitTable> table,
            std::span<const std::uint16_t> codes) {
  assert(codes.size() == hexes.size());
  Split result;
  Lineage& lineage = result.lineage;
  lineage.n_old_nodes = n_nodes;
  lineage.n_old_hexes = static_cast<Index>(hexes.size());
  lineage.table = std::move(table);
  const SplitTable& templates = *lineage.table;
  const CutList cut = cut_hexes(hexes, n_nodes, templates, codes);
  number_edges_and_faces(hexes, cut, templates, rank_edges_and_faces(cut, templates, result), result);
  const Index n_hexes = number_nodes_and_children(cut, codes, result);
  check_memory(n_hexes, result.n_nodes);
  resize_for_overwrite(result.hexes, static_cast<std::size_t>(n_hexes));
  resize_for_overwrite(lineage.parent, static_cast<std::size_t>(n_hexes));
  resize_for_overwrite(result.first_child, hexes.size());
  fill_kept(hexes, cut, result);
  fill_children(hexes, cut, templates, result);
  return result;
}

}  // namespace hextwist
