#include "hextwist/refine/plans/eight.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <optional>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/origin.h"
#include "hextwist/refine/plans/eight_internal.h"
#include "hextwist/refine/templates/enclose.h"
#include "hextwist/refine/templates/trisect.h"

namespace hextwist {
namespace {

constexpr int max_cuts_outside = 3;  // of one edge
/// Regions so near to each other that their marks together have no template are enclosed one after the other, but in
/// no more than so many rounds.
constexpr std::size_t max_groups = 4;

/// Tells the unions of the regions' nodes and hexes from the rest of the mesh, and holds the marks of one region.
struct Surroundings {
  const Mesh& mesh;
  CompressedRows around;             ///< hexes around each node
  std::vector<std::uint8_t> target;  ///< per hex
  std::vector<std::uint8_t> fixed;   ///< per node: in some region
  std::vector<std::uint32_t> marks;  ///< per node: bit p, pass p; all 0 between regions
  std::vector<Index> local;          ///< per node: its number in the region at hand, -1

  Surroundings(const Mesh& all, std::span<const Index> targets)
      : mesh(all),
        around(node_hexes(all)),
        target(all.hexes.size(), 0),
        fixed(all.points.size(), 0),
        marks(all.points.size(), 0),
        local(all.points.size(), -1) {
    for (const Index h : targets) target[h] = 1;
    mark_nodes(all.hexes, targets, fixed);
  }

  /// Hexes of no region around the nodes; ascending.
  std::vector<Index> outside(std::span<const Index> nodes) const {
    std::vector<Index> result;
    for (const Index n : nodes)
      for (const Index h : around[n])
        if (!target[h]) result.push_back(h);
    sort_unique(result);
    return result;
  }
  int mask(const Hex& hex, int pass) const {
    int result = 0;
    for (int c = 0; c < n_hex_corners; ++c) result |= static_cast<int>(marks[hex[c]] >> pass & 1) << c;
    return result;
  }
};

/// Sets Surroundings::local.
RegionMesh region_mesh(Surroundings& all, std::vector<Index> hexes) {
  RegionMesh region;
  region.hexes = std::move(hexes);
  region.nodes = nodes_of_hexes(all.mesh, region.hexes);
  for (std::size_t i = 0; i < region.nodes.size(); ++i) all.local[region.nodes[i]] = static_cast<Index>(i);
  region.mesh.points.resize(region.nodes.size(), Vec3::Zero());
  for (const Index h : region.hexes) {
    Hex& hex = region.mesh.hexes.emplace_back();
    for (int c = 0; c < n_hex_corners; ++c) hex[c] = all.local[all.mesh.hexes[h][c]];
  }
  region.edges = edges(region.mesh);
  region.faces = faces(region.mesh);
  region.sheets = sheets(region.mesh, region.edges);
  return region;
}

/// Of a marking of a pass and its opposite, true when the opposite touches fewer hexes outside, then fewer nodes of
/// such hexes. The marking leaves the lowest node alone.
bool wants_opposite(const Surroundings& all, const SheetPasses& passes, int pass, std::span<const Index> outside) {
  const auto side = [&](Index node) -> int {  // 0 or 1 in the region, else -1
    const Index i = all.local[node];
    return i < 0 ? -1 : static_cast<int>(passes.marks[i] >> pass & 1);
  };
  std::array<Index, 2> n_hexes = {0, 0}, n_nodes = {0, 0};
  for (const Index h : outside) {
    std::array<Index, 2> n = {0, 0};
    for (const Index node : all.mesh.hexes[h])
      if (const int s = side(node); s >= 0) ++n[s];
    for (int s = 0; s < 2; ++s) {
      n_hexes[s] += n[s] > 0;
      n_nodes[s] += n[s];
    }
  }
  return std::array{n_hexes[1], n_nodes[1]} > std::array{n_hexes[0], n_nodes[0]};
}

/// The smallest marking with a template that has these marks and leaves fixed corners as they are; -1 when there is
/// none. Of several, the one that adds the lowest nodes.
int smallest_closed(const Hex& hex, int mask, int fixed) {
  int best = -1;
  std::vector<Index> best_added, added;
  for (int m = 0; m < 256; ++m) {
    if ((m & mask) != mask || ((m ^ mask) & fixed) != 0 || !is_box_marking(m)) continue;
    added.clear();
    for (int c = 0; c < n_hex_corners; ++c)
      if ((m ^ mask) >> c & 1) added.push_back(hex[c]);
    std::ranges::sort(added);
    if (best >= 0 && std::pair(added.size(), added) >= std::pair(best_added.size(), best_added)) continue;
    best = m;
    best_added = added;
  }
  return best;
}

/// Adds marks outside of all regions until every hex has a template. Returns false where that can't be, or once more
/// than `limit` were added.
bool close_outside(Surroundings& all, int pass, std::vector<Index> hexes, std::size_t limit,
                   std::vector<Index>& added_nodes) {
  while (!hexes.empty()) {
    std::vector<Index> added;
    for (const Index h : hexes) {
      const Hex& hex = all.mesh.hexes[h];
      const int mask = all.mask(hex, pass);
      if (is_box_marking(mask)) continue;
      const int closed = smallest_closed(hex, mask, corner_mask(hex, all.fixed));
      if (closed < 0) return false;
      for (int c = 0; c < n_hex_corners; ++c)
        if ((closed ^ mask) >> c & 1) added.push_back(hex[c]);
    }
    sort_unique(added);
    for (const Index n : added) all.marks[n] |= 1U << pass;
    added_nodes.insert(added_nodes.end(), added.begin(), added.end());
    if (added_nodes.size() > limit) return false;
    hexes = all.outside(added);
  }
  return true;
}

/// Marks of all passes together, as they stand in EightPlan::passes; regions far enough from each other share them.
struct Group {
  std::vector<std::vector<std::uint8_t>> passes;

  /// The region's marks fit in: with them every hex still has a template, and no edge is cut too often.
  bool takes(const Surroundings& all, std::span<const Index> touched) const {
    for (const Index h : touched) {
      const Hex& hex = all.mesh.hexes[h];
      std::array<std::uint32_t, n_hex_corners> bits;
      for (int c = 0; c < n_hex_corners; ++c) {
        bits[c] = all.marks[hex[c]];
        for (std::size_t p = 0; p < passes.size(); ++p) bits[c] |= std::uint32_t{passes[p][hex[c]]} << p;
      }
      for (int p = 0; p < max_region_passes; ++p) {
        int mask = 0;
        for (int c = 0; c < n_hex_corners; ++c) mask |= static_cast<int>(bits[c] >> p & 1) << c;
        if (!is_box_marking(mask)) return false;
      }
      for (int e = 0; e < n_hex_edges; ++e)
        if (std::popcount(bits[edge_corner(e, 0)] ^ bits[edge_corner(e, 1)]) > max_cuts_outside) return false;
    }
    return true;
  }
  void add(const Surroundings& all, std::span<const Index> nodes, int n_passes) {
    passes.resize(std::max(passes.size(), static_cast<std::size_t>(n_passes)),
                  std::vector<std::uint8_t>(all.mesh.points.size(), 0));
    for (const Index n : nodes)
      for (std::size_t p = 0; p < passes.size(); ++p) passes[p][n] = passes[p][n] != 0 || (all.marks[n] >> p & 1) != 0;
  }
};

/// Sheets that would cross each other in hexes outside if these were in the region. Where sheets in one pass do that,
/// such a hex may have no template, at an irregular edge on the region's side for one.
std::vector<std::pair<Index, Index>> crossing_outside(const Surroundings& all, const RegionMesh& region,
                                                      std::span<const Index> outside) {
  std::vector<std::pair<Index, Index>> pairs;
  for (const Index h : outside) {
    std::array<std::vector<Index>, 3> of_axis;
    for (int e = 0; e < n_hex_edges; ++e) {
      const Index a = all.local[all.mesh.hexes[h][edge_corner(e, 0)]];
      const Index b = all.local[all.mesh.hexes[h][edge_corner(e, 1)]];
      const Index edge = a < 0 || b < 0 ? -1 : find_edge(region.edges, a, b);
      if (edge >= 0) of_axis[e >> 2].push_back(region.sheets.of_edge[edge]);
    }
    for (int axis = 0; axis < 3; ++axis)
      for (const Index a : of_axis[axis])
        for (const Index b : of_axis[(axis + 1) % 3])
          if (a != b) pairs.emplace_back(std::min(a, b), std::max(a, b));
  }
  sort_unique(pairs);
  return pairs;
}

/// Marks a region: those of its nodes, and outside where that needs closing. Returns all marked or fixed nodes,
/// ascending; nothing, and no marks, with the reason where it can't be.
std::optional<std::vector<Index>> mark_region(Surroundings& all, const RegionMesh& region, const SheetPasses& passes,
                                              std::span<const Index> outside, EightRegion& found) {
  std::vector<Index> touched = region.nodes;
  const auto fail = [&](const char* reason) {
    for (const Index n : touched) all.marks[n] = 0;
    found.reason = reason;
    return std::nullopt;
  };
  found.n_added_nodes = 0;
  for (int p = 0; p < passes.n_passes; ++p) {
    const auto mark = [&](bool opposite) {
      for (std::size_t i = 0; i < region.nodes.size(); ++i) {
        std::uint32_t& marks = all.marks[region.nodes[i]];
        marks = (marks & ~(1U << p)) | ((passes.marks[i] >> p & 1) ^ std::uint32_t{opposite}) << p;
      }
    };
    const std::size_t limit = region.nodes.size() / 2 - static_cast<std::size_t>(found.n_added_nodes);
    const bool preferred = wants_opposite(all, passes, p, outside);
    std::vector<Index> added;
    const auto close = [&](bool opposite) {
      for (const Index n : added) all.marks[n] &= ~(1U << p);
      added.clear();
      mark(opposite);
      return close_outside(all, p, {outside.begin(), outside.end()}, limit, added);
    };
    bool closed = close(preferred);
    const bool too_many = added.size() > limit;
    if (!closed) closed = close(!preferred);
    touched.insert(touched.end(), added.begin(), added.end());
    if (!closed)
      return fail(too_many ? "concave sides would need more than half as many nodes again to be filled"
                           : "a hex between its sides would have no template");
    found.n_added_nodes += static_cast<Index>(added.size());
  }
  sort_unique(touched);
  if (!Group{}.takes(all, all.outside(touched))) return fail("edges beside it would be cut more than three times");
  return touched;
}

/// Decides about one region and adds its marks to a group. Returns the sheets that are cut in three, or nothing when
/// the region is trisected, with the reason.
std::optional<std::vector<Index>> halve(Surroundings& all, const RegionMesh& region, std::vector<Group>& groups,
                                        EightRegion& found) {
  const std::vector<Index> outside = all.outside(region.nodes);
  std::vector<Index> in_three;
  const auto attempt = [&](const std::vector<std::pair<Index, Index>>& apart) -> std::optional<std::vector<Index>> {
    const SheetPasses passes = sheet_passes(region, apart);
    found.n_passes = passes.n_passes;
    in_three.clear();
    for (Index s = 0; s < region.sheets.size(); ++s)
      if (passes.of_sheet[s] < 0) in_three.push_back(s);
    found.n_in_three = static_cast<Index>(in_three.size());
    std::vector<char> exact(region.hexes.size(), 1);
    for (const Index s : in_three)
      for (const Index h : region.sheets.hexes[s]) exact[h] = 0;
    found.n_exact = static_cast<Index>(std::ranges::count(exact, 1));
    if (2 * found.n_exact >= found.n_hexes) return mark_region(all, region, passes, outside, found);
    found.reason = "only " + std::to_string(found.n_exact) + " of its hexes could be cut in eight exactly";
    return std::nullopt;
  };
  auto nodes = attempt({});
  if (!nodes) {
    const EightRegion first = found;
    if (const auto apart = crossing_outside(all, region, outside); !apart.empty()) nodes = attempt(apart);
    if (!nodes) found = first;
  }
  if (!nodes) return std::nullopt;

  const std::vector<Index> touched = all.outside(*nodes);
  auto group = std::ranges::find_if(groups, [&](const Group& g) { return g.takes(all, touched); });
  if (group == groups.end() && groups.size() < max_groups) group = groups.insert(groups.end(), Group{});
  const bool takes = group != groups.end();
  if (takes)
    group->add(all, *nodes, found.n_passes);
  else
    found.reason = "it lies too near to other regions";
  for (const Index n : *nodes) all.marks[n] = 0;
  if (!takes) return std::nullopt;
  found.reason.clear();
  return in_three;
}

}  // namespace

EightPlan plan_eight(const Mesh& mesh, std::span<const Index> targets) {
  EightPlan plan;
  Surroundings all(mesh, targets);
  std::vector<Group> groups;
  for (std::vector<Index>& hexes : connected_regions(mesh, targets)) {
    EightRegion& found = plan.regions.emplace_back();
    const RegionMesh region = region_mesh(all, std::move(hexes));
    found.first_hex = region.hexes.front();
    found.n_hexes = static_cast<Index>(region.hexes.size());
    found.n_irregular_edges = count_irregular_edges(region);
    found.n_sheets = region.sheets.size();
    found.n_self_crossing =
        static_cast<Index>(std::ranges::count_if(region.sheets.n_self_crossings, [](Index n) { return n > 0; }));
    found.alone = all.outside(region.nodes).empty();
    if (found.alone) {
      found.eight = true;
      found.n_exact = found.n_hexes;
      plan.alone.insert(plan.alone.end(), region.hexes.begin(), region.hexes.end());
    } else if (const auto in_three = halve(all, region, groups, found)) {
      found.eight = true;
      for (const Index s : *in_three)
        for (const Index e : region.sheets.edges[s]) {
          const auto [a, b] = region.edges.nodes[e];
          plan.thirds.push_back({region.nodes[a], region.nodes[b]});
        }
    } else {
      plan.trisected.insert(plan.trisected.end(), region.hexes.begin(), region.hexes.end());
    }
    for (const Index n : region.nodes) all.local[n] = -1;
  }
  for (Group& group : groups)
    for (auto& pass : group.passes) plan.passes.push_back(std::move(pass));
  std::ranges::sort(plan.alone);
  std::ranges::sort(plan.thirds);
  std::ranges::sort(plan.trisected);
  return plan;
}

void carry_marks(const Lineage& lineage, std::span<const Hex> old_hexes, Index n_nodes,
                 std::vector<std::uint8_t>& marked) {
  marked.resize(n_nodes, 0);
  const auto carry = [&](Index node, const Origin& origin) {
    marked[node] = std::ranges::all_of(origin.nodes(), [&](Index n) { return marked[n] != 0; });
  };
  parallel_each(lineage.edges.size(), [&](std::size_t i) { for_each_node(lineage, lineage.edges[i], carry); });
  parallel_each(lineage.faces.size(), [&](std::size_t i) { for_each_node(lineage, lineage.faces[i], carry); });
  parallel_each(lineage.hexes.size(),
                [&](std::size_t i) { for_each_node(lineage, lineage.hexes[i], old_hexes, carry); });
}

std::vector<std::uint16_t> thirds_codes(const Mesh& mesh, std::span<const Index> region, std::span<const Edge> thirds,
                                        std::span<const std::uint8_t> marked) {
  if (thirds.empty()) return trisect_codes(mesh.hexes, marked);
  const Edges all = edges(mesh);
  std::vector<Index> seeds;
  for (const auto& [a, b] : thirds) seeds.push_back(find_edge(all, a, b));
  std::vector<std::uint8_t> cut = in_sheets_of(all, region, seeds);
  parallel_each(cut.size(), [&](std::size_t e) {
    if (marked[all.nodes[e][0]] && marked[all.nodes[e][1]]) cut[e] = 1;
  });
  return trisect_codes(all, cut);
}

}  // namespace hextwist
