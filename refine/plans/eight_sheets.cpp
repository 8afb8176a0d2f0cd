// Which sheets of a region are halved in which pass, and the marks that do it.
#include <algorithm>
#include <bit>

#include "hextwist/base/mixed.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/refine/plans/eight_internal.h"

namespace hextwist {
namespace {

constexpr int undecided = -2, in_three = -1;

/// Sheets that cross each sheet or have to be kept apart from it, each once.
CompressedRows crossings(const RegionMesh& region, const std::vector<std::pair<Index, Index>>& apart) {
  std::vector<std::pair<Index, Index>> pairs;
  pairs.reserve(6 * region.hexes.size() + 2 * apart.size());
  for (const auto& [a, b] : apart) {
    pairs.emplace_back(a, b);
    pairs.emplace_back(b, a);
  }
  for (Index h = 0; h < region.mesh.n_hexes(); ++h)
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        if (a != b)
          pairs.emplace_back(sheet_of(region.sheets, region.edges, h, a), sheet_of(region.sheets, region.edges, h, b));
  sort_unique(pairs);
  CompressedRows result;
  result.first.assign(region.sheets.size() + 1, 0);
  for (const auto& [sheet, other] : pairs) {
    ++result.first[sheet + 1];
    result.items.push_back(other);
  }
  for (Index s = 0; s < region.sheets.size(); ++s) result.first[s + 1] += result.first[s];
  return result;
}

/// Passes such that sheets that cross are in different ones. Goes from hex to hex across faces, so that the sheet
/// behind a face gets the pass of the one before it wherever that is free.
class Coloring {
 public:
  Coloring(const RegionMesh& region, const std::vector<std::pair<Index, Index>>& apart)
      : region_(region), crossings_(crossings(region, apart)), pass_(region.sheets.size(), undecided) {}

  std::vector<int> run() && {
    const Index n = region_.mesh.n_hexes();
    for (Index s = 0; s < region_.sheets.size(); ++s)
      if (region_.sheets.n_self_crossings[s] > 0) pass_[s] = in_three;
    std::vector<char> seen(n, 0);
    std::vector<Index> queue;
    for (Index seed = 0; seed < n; ++seed) {
      if (seen[seed]) continue;
      seen[seed] = 1;
      queue.assign(1, seed);
      for (int axis = 0; axis < 3; ++axis) decide(sheet(seed, axis), undecided);
      for (std::size_t i = 0; i < queue.size(); ++i)
        for (int f = 0; f < n_hex_faces; ++f) {
          const auto& sides = region_.faces.sides[region_.faces.of_hex[queue[i]][f]];
          const Side other = sides[sides[0].hex == queue[i]];
          if (other.hex < 0 || seen[other.hex]) continue;
          seen[other.hex] = 1;
          queue.push_back(other.hex);
          decide(sheet(other.hex, other.face >> 1), pass_[sheet(queue[i], f >> 1)]);
          for (int axis = 0; axis < 3; ++axis) decide(sheet(other.hex, axis), undecided);
        }
    }
    return std::move(pass_);
  }

 private:
  Index sheet(Index hex, int axis) const { return sheet_of(region_.sheets, region_.edges, hex, axis); }

  void decide(Index sheet, int preferred) {
    if (pass_[sheet] != undecided) return;
    std::uint32_t taken = 0;
    for (const Index other : crossings_[sheet])
      if (pass_[other] >= 0) taken |= 1U << pass_[other];
    const int lowest = std::countr_one(taken);
    const int pass = preferred >= 0 && !(taken >> preferred & 1) ? preferred : lowest;
    pass_[sheet] = pass < max_region_passes ? pass : in_three;
  }

  const RegionMesh& region_;
  const CompressedRows crossings_;
  std::vector<int> pass_;
};

/// A spanning tree over the nodes of the region: the edge to each node's parent, and the order in which it grew.
struct NodeTree {
  std::vector<Index> order;
  std::vector<Index> parent_edge;  ///< -1: the first node
  std::vector<Index> parent;
};

NodeTree node_tree(const RegionMesh& region) {
  const Index n = region.mesh.n_nodes();
  CompressedRows edges;
  edges.first.assign(n + 1, 0);
  for (const auto& [a, b] : region.edges.nodes) {
    ++edges.first[a + 1];
    ++edges.first[b + 1];
  }
  for (Index i = 0; i < n; ++i) edges.first[i + 1] += edges.first[i];
  edges.items.resize(edges.first.back());
  std::vector<Index> next(edges.first.begin(), edges.first.end() - 1);
  for (std::size_t e = 0; e < region.edges.nodes.size(); ++e)
    for (const Index end : region.edges.nodes[e]) edges.items[next[end]++] = static_cast<Index>(e);
  NodeTree tree{{0}, std::vector<Index>(n, -1), std::vector<Index>(n, -1)};
  std::vector<char> seen(n, 0);
  seen[0] = 1;
  for (std::size_t i = 0; i < tree.order.size(); ++i) {
    const Index node = tree.order[i];
    for (const Index e : edges[node]) {
      const auto [a, b] = region.edges.nodes[e];
      const Index other = a == node ? b : a;
      if (seen[other]) continue;
      seen[other] = 1;
      tree.parent_edge[other] = e;
      tree.parent[other] = node;
      tree.order.push_back(other);
    }
  }
  return tree;
}

/// The sum (exclusive or) of a value of the sheets over the way from the first node to each.
template <class T, class Value>
std::vector<T> sums_along(const RegionMesh& region, const NodeTree& tree, const Value& value) {
  std::vector<T> sum(region.mesh.points.size(), 0);
  for (const Index node : tree.order)
    if (tree.parent_edge[node] >= 0)
      sum[node] = sum[tree.parent[node]] ^ value(region.sheets.of_edge[tree.parent_edge[node]]);
  return sum;
}

/// Independent closed ways that cross some sheet an odd number of times: the sheets crossed so, ascending. Simply
/// connected regions have none. Sheets are told apart by 64 random bits each, so that a way is one exclusive or; the
/// marks are checked afterwards.
std::vector<std::vector<Index>> odd_loops(const RegionMesh& region, const NodeTree& tree) {
  const auto bits = [](Index sheet) { return mixed(static_cast<std::uint64_t>(sheet)); };
  const auto sum = sums_along<std::uint64_t>(region, tree, bits);
  std::vector<std::uint64_t> basis;
  std::vector<std::vector<Index>> loops;
  std::vector<char> odd(region.sheets.size(), 0);
  for (std::size_t e = 0; e < region.edges.nodes.size(); ++e) {
    const auto [a, b] = region.edges.nodes[e];
    std::uint64_t way = sum[a] ^ sum[b] ^ bits(region.sheets.of_edge[e]);
    for (const std::uint64_t row : basis) way = std::min(way, way ^ row);
    if (way == 0) continue;
    basis.push_back(way);
    std::ranges::sort(basis, std::greater{});
    std::vector<Index> crossed = {region.sheets.of_edge[e]};
    for (Index node : {a, b})
      for (; tree.parent_edge[node] >= 0; node = tree.parent[node])
        crossed.push_back(region.sheets.of_edge[tree.parent_edge[node]]);
    for (const Index s : crossed) odd[s] ^= 1;
    auto& loop = loops.emplace_back();
    sort_unique(crossed);
    for (const Index s : crossed) {
      if (odd[s]) loop.push_back(s);
      odd[s] = 0;
    }
  }
  return loops;
}

/// Takes sheets out of a pass until every closed way crosses an even number of those left: one for each independent
/// way that has an odd number, the one that runs through the fewest hexes.
void even_out(const RegionMesh& region, const std::vector<std::vector<Index>>& loops, int pass,
              std::vector<int>& of_sheet) {
  std::vector<std::vector<Index>> rows;
  for (const auto& loop : loops) {
    auto& row = rows.emplace_back();
    std::ranges::copy_if(loop, std::back_inserter(row), [&](Index s) { return of_sheet[s] == pass; });
  }
  const auto size = [&](Index s) { return std::pair(region.sheets.hexes[s].size(), s); };
  std::vector<Index> pivot(rows.size(), -1);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (rows[r].empty()) continue;
    pivot[r] = *std::ranges::min_element(rows[r], {}, size);
    for (std::size_t other = 0; other < rows.size(); ++other) {
      if (other == r || !std::ranges::binary_search(rows[other], pivot[r])) continue;
      std::vector<Index> sum;
      std::ranges::set_symmetric_difference(rows[other], rows[r], std::back_inserter(sum));
      rows[other] = std::move(sum);
    }
  }
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (rows[r].size() % 2 == 1) of_sheet[pivot[r]] = in_three;
}

/// Each edge changes the marks of its sheet's pass and no other.
bool is_consistent(const RegionMesh& region, const SheetPasses& passes) {
  for (std::size_t e = 0; e < region.edges.nodes.size(); ++e) {
    const auto [a, b] = region.edges.nodes[e];
    const int pass = passes.of_sheet[region.sheets.of_edge[e]];
    if ((passes.marks[a] ^ passes.marks[b]) != (pass < 0 ? 0U : 1U << pass)) return false;
  }
  return true;
}

}  // namespace

SheetPasses sheet_passes(const RegionMesh& region, const std::vector<std::pair<Index, Index>>& apart) {
  SheetPasses result{Coloring(region, apart).run(), 0, {}};
  const NodeTree tree = node_tree(region);
  if (const auto loops = odd_loops(region, tree); !loops.empty())
    for (int pass = 0; pass < max_region_passes; ++pass) even_out(region, loops, pass, result.of_sheet);
  // Numbers without gaps.
  std::array<int, max_region_passes> number;
  number.fill(in_three);
  for (int& pass : result.of_sheet)
    if (pass >= 0) number[pass] = 0;
  for (int& n : number)
    if (n == 0) n = result.n_passes++;
  for (int& pass : result.of_sheet)
    if (pass >= 0) pass = number[pass];
  result.marks = sums_along<std::uint32_t>(region, tree, [&](Index sheet) {
    const int pass = result.of_sheet[sheet];
    return pass < 0 ? 0U : 1U << pass;
  });
  if (!is_consistent(region, result)) result = {std::vector<int>(region.sheets.size(), in_three), 0, {}};
  return result;
}

Index count_irregular_edges(const RegionMesh& region) {
  std::vector<Index> n_hexes(region.edges.nodes.size(), 0);
  for (const auto& of_hex : region.edges.of_hex)
    for (const Index e : of_hex) ++n_hexes[e];
  for (const Side side : boundary_sides(region.faces))
    for (int j = 0; j < 4; ++j) n_hexes[region.edges.of_hex[side.hex][face_edge(side.face, j)]] = 4;
  return static_cast<Index>(std::ranges::count_if(n_hexes, [](Index n) { return n != 4; }));
}

}  // namespace hextwist
