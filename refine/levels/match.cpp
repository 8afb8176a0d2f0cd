// All lists of a level are sorted in a way that does not depend on what else is refined (node numbers only ever get
// compared), so everything here is merging.
#include "hextwist/refine/levels/match.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <tuple>

#include "hextwist/base/parallel.h"
#include "hextwist/refine/templates/split_table.h"

namespace hextwist {
namespace {

/// Calls same(i, j) for equal keys of two lists of which the first, where it has keys, and the second ascend. has(i): false where i has none.
template <class Has, class KeyNow, class KeyBefore, class Same>
void merge_keys(std::size_t n_now, std::size_t n_before, const Has& has, const KeyNow& key_now,
                const KeyBefore& key_before, const Same& same) {
  std::size_t j = 0;
  for (std::size_t i = 0; i < n_now && j < n_before; ++i) {
    if (!has(i)) continue;
    const auto key = key_now(i);
    while (j < n_before && key_before(j) < key) ++j;
    if (j < n_before && key_before(j) == key) same(i, j);
  }
}

void match_pass(const LevelPass& now, const LevelPass& before, std::vector<Index>& old_node) {
  const Lineage& a = now.lineage;
  const Lineage& b = before.lineage;
  const auto set = [&](Index first, Index old_first, std::size_t n) {
    for (std::size_t s = 0; s < n; ++s) old_node[first + s] = old_first + static_cast<Index>(s);
  };
  const auto old = [&](Index node) { return old_node[node]; };
  merge_keys(
      a.edges.size(), b.edges.size(), [&](std::size_t i) { return old(a.edges[i].a) >= 0 && old(a.edges[i].b) >= 0; },
      [&](std::size_t i) { return std::pair(old(a.edges[i].a), old(a.edges[i].b)); },
      [&](std::size_t j) { return std::pair(b.edges[j].a, b.edges[j].b); },
      [&](std::size_t i, std::size_t j) {
        set(a.edges[i].first_node, b.edges[j].first_node, a.table->edge[a.edges[i].code].at.size());
      });
  merge_keys(
      a.faces.size(), b.faces.size(),
      [&](std::size_t i) { return std::ranges::all_of(a.faces[i].corners, [&](Index n) { return old(n) >= 0; }); },
      [&](std::size_t i) {
        const Quad& c = a.faces[i].corners;
        return std::tuple(old(c[0]), old(c[3]), old(c[1]));
      },
      [&](std::size_t j) {
        const Quad& c = b.faces[j].corners;
        return std::tuple(c[0], c[3], c[1]);
      },
      [&](std::size_t i, std::size_t j) {
        if (a.faces[i].code == b.faces[j].code)
          set(a.faces[i].first_node, b.faces[j].first_node, a.table->face[a.faces[i].code].at.size());
      });
  merge_keys(
      now.cell.size(), before.cell.size(), [](std::size_t) { return true; }, [&](std::size_t i) { return now.cell[i]; },
      [&](std::size_t j) { return before.cell[j]; },
      [&](std::size_t i, std::size_t j) {
        if (a.hexes[i].code == b.hexes[j].code)
          set(a.hexes[i].first_node, b.hexes[j].first_node, a.table->hex(a.hexes[i].code).inside.size());
      });
}

/// A leaf that the other mesh does not have, with its hexes (they follow each other).
struct Leaf {
  CellNumber begin, end;  // its cells of the finest level of both meshes
  Index first, n;
};

/// Leaves with a hex for which changed(hex), in the order of `begin`.
template <class Changed>
std::vector<Leaf> changed_leaves(const LevelPieces& pieces, int finest, const Changed& changed) {
  std::vector<CellNumber> weight(static_cast<std::size_t>(finest) + 1, 1);  // of a cell of that level
  for (std::size_t level = weight.size() - 1; level-- > 0;) weight[level] = weight[level + 1] * n_cell_children;
  std::vector<Leaf> leaves;
  for (int block = 0; block < pieces.n_levels(); ++block)
    for (Index h = pieces.first[block]; h < pieces.first[block + 1]; ++h) {
      if (!changed(h)) continue;
      const LevelPieces::Leaf of = pieces.leaf(block, h);
      const CellNumber begin = of.cell * weight[of.level];
      if (!leaves.empty() && leaves.back().begin == begin && leaves.back().first + leaves.back().n == h)
        ++leaves.back().n;
      else
        leaves.push_back({begin, begin + weight[of.level], h, 1});
    }
  std::ranges::sort(leaves, {}, &Leaf::begin);
  return leaves;
}

}  // namespace

std::vector<Index> matching_nodes(const LevelStack& now, const LevelStack& before, Index n_base_nodes) {
  const Index n_nodes = now.empty() ? n_base_nodes : now.back()->n_nodes;
  std::vector<Index> old_node(static_cast<std::size_t>(n_nodes), -1);
  std::size_t n_same = 0;  // passes that are the very same
  while (n_same < now.size() && n_same < before.size() && now[n_same] == before[n_same]) ++n_same;
  std::iota(old_node.begin(), old_node.begin() + (n_same == 0 ? n_base_nodes : now[n_same - 1]->n_nodes), 0);
  for (std::size_t k = n_same; k < now.size() && k < before.size(); ++k) match_pass(*now[k], *before[k], old_node);
  return old_node;
}

LevelOrigin level_origin(const LevelPieces& now, const LevelPieces& before) {
  LevelOrigin origin;
  origin.kind.assign(now.cell.size(), HexOrigin::same);
  origin.at.assign(now.cell.size(), -1);
  std::vector<std::uint8_t> stays(before.cell.size(), 0);
  for (int block = 0; block < std::min(now.n_levels(), before.n_levels()); ++block) {
    const Index a = now.first[block], b = before.first[block];
    merge_keys(
        now.first[block + 1] - a, before.first[block + 1] - b, [](std::size_t) { return true; },
        [&](std::size_t i) { return std::pair(now.cell[a + i], now.at[a + i]); },
        [&](std::size_t j) { return std::pair(before.cell[b + j], before.at[b + j]); },
        [&](std::size_t i, std::size_t j) {
          origin.at[a + i] = b + static_cast<Index>(j);
          stays[b + j] = 1;
        });
  }

  // All else: leaves of one mesh that are cut, or cut otherwise, in the other. Both lists cover the same cells.
  const int finest = std::max(now.n_levels(), before.n_levels());
  const std::vector<Leaf> fresh = changed_leaves(now, finest, [&](Index h) { return origin.at[h] < 0; });
  const std::vector<Leaf> gone = changed_leaves(before, finest, [&](Index h) { return !stays[h]; });
  origin.several.first = {0};
  std::size_t i = 0, j = 0;
  while (i < fresh.size()) {
    assert(j < gone.size() && fresh[i].begin == gone[j].begin);
    const CellNumber end = std::max(fresh[i].end, gone[j].end);
    const std::size_t first = j;
    Index n_gone = 0;
    for (; j < gone.size() && gone[j].begin < end; ++j) n_gone += gone[j].n;
    const bool one = n_gone == 1;
    if (!one) {
      auto& items = origin.several.items;
      for (std::size_t g = first; g < j; ++g)
        for (Index h = gone[g].first; h < gone[g].first + gone[g].n; ++h) items.push_back(h);
      std::sort(items.begin() + origin.several.first.back(), items.end());
      origin.several.first.push_back(static_cast<Index>(items.size()));
    }
    for (; i < fresh.size() && fresh[i].begin < end; ++i)
      for (Index h = fresh[i].first; h < fresh[i].first + fresh[i].n; ++h) {
        origin.kind[h] = one ? HexOrigin::finer : HexOrigin::coarser;
        origin.at[h] = one ? gone[first].first : origin.several.size() - 1;
      }
  }
  return origin;
}

}  // namespace hextwist
