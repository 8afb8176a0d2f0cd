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

/// Calls same(i, j) for equal keys of two lists of which the first, where it has keys, and the second ascend. has(i):
/// false where i has none.
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

/// Cells of the finest level of two meshes that a cell of any level holds.
class CellRanges {
 public:
  struct Range {
    CellNumber begin, end;
  };
  explicit CellRanges(int finest) : weight_(static_cast<std::size_t>(finest) + 1, 1) {
    for (std::size_t level = weight_.size() - 1; level-- > 0;) weight_[level] = weight_[level + 1] * n_cell_children;
  }
  Range operator()(const LevelPieces::Leaf& leaf) const {
    const CellNumber weight = weight_[leaf.level];
    return {leaf.cell * weight, (leaf.cell + 1) * weight};
  }

 private:
  std::vector<CellNumber> weight_;
};

/// A leaf of before that is no more, or is cut otherwise now; its hexes follow each other.
struct GoneLeaf {
  CellRanges::Range cells;
  Index first, n;
  Index row = -1;  // of LevelOrigin::several
};

std::vector<GoneLeaf> gone_leaves(const LevelPieces& before, const std::vector<std::uint8_t>& stays,
                                  const CellRanges& range) {
  std::vector<GoneLeaf> leaves;
  for (int block = 0; block < before.n_levels(); ++block)
    for (Index h = before.first[block]; h < before.first[block + 1]; ++h) {
      if (stays[h]) continue;
      const CellRanges::Range cells = range(before.leaf(block, h));
      if (!leaves.empty() && leaves.back().cells.begin == cells.begin && leaves.back().first + leaves.back().n == h)
        ++leaves.back().n;
      else
        leaves.push_back({cells, h, 1});
    }
  std::ranges::sort(leaves, {}, [](const GoneLeaf& leaf) { return leaf.cells.begin; });
  return leaves;
}

/// A row of all hexes of these leaves.
Index add_row(std::span<const GoneLeaf> leaves, CompressedRows& rows) {
  for (const GoneLeaf& leaf : leaves)
    for (Index h = leaf.first; h < leaf.first + leaf.n; ++h) rows.items.push_back(h);
  std::sort(rows.items.begin() + rows.first.back(), rows.items.end());
  rows.first.push_back(static_cast<Index>(rows.items.size()));
  return rows.size() - 1;
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

CompressedRows rows_of(const LevelOrigin& origin) {
  CompressedRows rows{{0}, {}};
  for (Index h = 0; h < static_cast<Index>(origin.kind.size()); ++h) {
    const std::span<const Index> before = origin.before(h);
    rows.items.insert(rows.items.end(), before.begin(), before.end());
    rows.first.push_back(static_cast<Index>(rows.items.size()));
  }
  return rows;
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

  // All else is in leaves of one mesh that are cut, or cut otherwise, in the other: the larger of both decides.
  const CellRanges range(std::max(now.n_levels(), before.n_levels()) - 1);
  std::vector<GoneLeaf> gone = gone_leaves(before, stays, range);
  origin.several.first = {0};
  for (int block = 0; block < now.n_levels(); ++block) {
    std::array<std::size_t, 2> last{};  // whole cells and pieces of a block each ascend
    Index row = -1;
    CellNumber begin_of_row = -1;
    for (Index h = now.first[block]; h < now.first[block + 1]; ++h) {
      if (origin.at[h] >= 0) continue;
      const LevelPieces::Leaf leaf = now.leaf(block, h);
      const CellRanges::Range cells = range(leaf);
      std::size_t& j = last[leaf.level == block];
      while (j + 1 < gone.size() && gone[j + 1].cells.begin <= cells.begin) ++j;
      GoneLeaf& over = gone[j];
      assert(over.cells.begin <= cells.begin);
      if (over.cells.end >= cells.end && over.n == 1) {
        origin.kind[h] = HexOrigin::finer;
        origin.at[h] = over.first;
        continue;
      }
      if (over.cells.end >= cells.end) {
        if (over.row < 0) over.row = add_row({&over, 1}, origin.several);
        row = over.row;
        begin_of_row = -1;
      } else if (begin_of_row != cells.begin) {
        std::size_t end = j;
        while (end < gone.size() && gone[end].cells.begin < cells.end) ++end;
        row = add_row({&over, end - j}, origin.several);
        begin_of_row = cells.begin;
      }
      origin.kind[h] = HexOrigin::coarser;
      origin.at[h] = row;
    }
  }
  return origin;
}

}  // namespace hextwist
