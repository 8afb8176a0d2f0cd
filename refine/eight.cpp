#include "hextwist/refine/eight.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <optional>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/union_find_internal.h"
#include "hextwist/refine/eight_internal.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/origin.h"
#include "hextwist/refine/trisect.h"

namespace hextwist {
namespace {

constexpr int max_cuts_outside = 3;  // of one edge
/// Regions so near to each other that their marks together have no template are enclosed one after the other, but in
/// no more than so many rounds.
constexpr std::size_t max_groups = 4;

/// Tells the unions of the regions' nodes and hexes from the rest of the mesh, and holds the marks of one region.
struct Surroundings {
  const Mesh& mesh;
  Lists around;                      ///< hexes around each node
  std::vector<std::uint8_t> target;  ///< per hex
  std::vector<std::uint8_t> fixed;   ///< per node: in some region
  std::vector<std::uint32_t> marks;  ///< per node: bit p, pass p; all 0 between regions

  Surroundings(const Mesh& all, std::span<const Index> targets)
      : mesh(all),
        around(node_hexes(all)),
        target(all.hexes.size(), 0),
        fixed(all.points.size(), 0),
        marks(all.points.size(), 0) {
    for (const Index h : targets) target[h] = 1;
    mark_nodes(all.hexes, targets, fixed);
  }

  /// Hexes of no region around the nodes; ascending.
  std::vector<Index> outside(std::span<const Index> nodes) const {
    std::vector<Index> result;
    for (const Index n : nodes)
      for (const Index h : around[n])
        if (!target[h]) result.push_back(h);
    std::ranges::sort(result);
    result.erase(std::ranges::unique(result).begin(), result.end());
    return result;
  }
  int mask(const Hex& hex, int pass) const {
    int result = 0;
    for (int c = 0; c < n_hex_corners; ++c) result |= static_cast<int>(marks[hex[c]] >> pass & 1) << c;
    return result;
  }
};

/// Hexes connected by common nodes, by lowest hex.
std::vector<std::vector<Index>> connected(const Mesh& mesh, std::span<const Index> targets) {
  std::vector<Index> parent = singletons(mesh.n_nodes());
  for (const Index h : targets)
    for (int c = 1; c < n_hex_corners; ++c) join(parent, mesh.hexes[h][0], mesh.hexes[h][c]);
  std::vector<std::vector<Index>> result;
  std::vector<Index> number(mesh.points.size(), -1);
  for (const Index h : targets) {
    Index& region = number[find_root(parent, mesh.hexes[h][0])];
    if (region < 0) {
      region = static_cast<Index>(result.size());
      result.emplace_back();
    }
    result[region].push_back(h);
  }
  return result;
}

/// scratch: per node of the whole mesh, any content.
RegionMesh region_mesh(const Mesh& whole, std::vector<Index> hexes, std::vector<Index>& scratch) {
  RegionMesh region;
  region.hexes = std::move(hexes);
  for (const Index h : region.hexes)
    region.nodes.insert(region.nodes.end(), whole.hexes[h].begin(), whole.hexes[h].end());
  std::ranges::sort(region.nodes);
  region.nodes.erase(std::ranges::unique(region.nodes).begin(), region.nodes.end());
  for (std::size_t i = 0; i < region.nodes.size(); ++i) scratch[region.nodes[i]] = static_cast<Index>(i);
  region.mesh.points.resize(region.nodes.size(), Vec3::Zero());
  for (const Index h : region.hexes) {
    Hex& hex = region.mesh.hexes.emplace_back();
    for (int c = 0; c < n_hex_corners; ++c) hex[c] = scratch[whole.hexes[h][c]];
  }
  region.edges = edges(region.mesh);
  region.faces = faces(region.mesh);
  region.sheets = sheets(region.mesh, region.edges);
  return region;
}

/// Of a marking of a pass and its opposite, true when the opposite touches fewer hexes outside, then fewer nodes of
/// such hexes, then leaves the lowest node alone.
bool wants_opposite(const Surroundings& all, const RegionMesh& region, const SheetPasses& passes, int pass,
                    std::span<const Index> outside) {
  const auto side = [&](Index node) -> int {  // 0 or 1 in the region, else -1
    const auto found = std::ranges::lower_bound(region.nodes, node);
    if (found == region.nodes.end() || *found != node) return -1;
    return static_cast<int>(passes.marks[found - region.nodes.begin()] >> pass & 1);
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
  return std::array{n_hexes[1], n_nodes[1], Index(passes.marks[0] >> pass & 1)} >
         std::array{n_hexes[0], n_nodes[0], Index(~passes.marks[0] >> pass & 1)};
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
    std::ranges::sort(added);
    added.erase(std::ranges::unique(added).begin(), added.end());
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

/// Decides about one region and adds its marks to a group. Returns the sheets that are cut in three, or nothing when
/// the region is trisected, with the reason.
std::optional<std::vector<Index>> halve(Surroundings& all, const RegionMesh& region, std::vector<Group>& groups,
                                        EightRegion& found) {
  const SheetPasses passes = sheet_passes(region);
  found.n_passes = passes.n_passes;
  std::vector<Index> in_three;
  for (Index s = 0; s < region.sheets.size(); ++s)
    if (passes.of_sheet[s] < 0) in_three.push_back(s);
  found.n_in_three = static_cast<Index>(in_three.size());
  std::vector<char> exact(region.hexes.size(), 1);
  for (const Index s : in_three)
    for (const Index h : region.sheets.hexes[s]) exact[h] = 0;
  found.n_exact = static_cast<Index>(std::ranges::count(exact, 1));
  if (2 * found.n_exact < found.n_hexes) {
    found.reason = "only " + std::to_string(found.n_exact) + " of its hexes could be cut in eight exactly";
    return std::nullopt;
  }

  const std::vector<Index> outside = all.outside(region.nodes);
  for (std::size_t i = 0; i < region.nodes.size(); ++i) all.marks[region.nodes[i]] = passes.marks[i];
  for (int p = 0; p < passes.n_passes; ++p)
    if (wants_opposite(all, region, passes, p, outside))
      for (const Index n : region.nodes) all.marks[n] ^= 1U << p;
  std::vector<Index> touched_nodes = region.nodes, added;
  const auto forget = [&] {
    for (const Index n : region.nodes) all.marks[n] = 0;
    for (const Index n : touched_nodes) all.marks[n] = 0;
    for (const Index n : added) all.marks[n] = 0;
  };
  for (int p = 0; p < passes.n_passes; ++p) {
    added.clear();
    const std::size_t limit = region.nodes.size() / 2 - static_cast<std::size_t>(found.n_added_nodes);
    if (!close_outside(all, p, outside, limit, added)) {
      found.reason = "hexes beside it would have no template";
      forget();
      return std::nullopt;
    }
    found.n_added_nodes += static_cast<Index>(added.size());
    touched_nodes.insert(touched_nodes.end(), added.begin(), added.end());
  }
  std::ranges::sort(touched_nodes);
  touched_nodes.erase(std::ranges::unique(touched_nodes).begin(), touched_nodes.end());
  const std::vector<Index> touched = all.outside(touched_nodes);
  if (!Group{}.takes(all, touched)) {
    found.reason = "edges beside it would be cut more than three times";
    forget();
    return std::nullopt;
  }
  auto group = std::ranges::find_if(groups, [&](const Group& g) { return g.takes(all, touched); });
  if (group == groups.end() && groups.size() < max_groups) group = groups.insert(groups.end(), Group{});
  if (group == groups.end()) {
    found.reason = "it lies too near to other regions";
    forget();
    return std::nullopt;
  }
  group->add(all, touched_nodes, passes.n_passes);
  forget();
  return in_three;
}

}  // namespace

bool is_box_marking(int mask) {
  if (mask == 0) return true;
  int low = 7, high = 0;
  for (int c = 0; c < n_hex_corners; ++c)
    if (mask >> c & 1) {
      low &= c;
      high |= c;
    }
  return std::popcount(static_cast<unsigned>(mask)) == 1 << std::popcount(static_cast<unsigned>(low ^ high));
}

EightPlan plan_eight(const Mesh& mesh, std::span<const Index> targets) {
  EightPlan plan;
  Surroundings all(mesh, targets);
  std::vector<Group> groups;
  std::vector<Index> scratch(mesh.points.size());
  for (std::vector<Index>& hexes : connected(mesh, targets)) {
    EightRegion& found = plan.regions.emplace_back();
    const RegionMesh region = region_mesh(mesh, std::move(hexes), scratch);
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
  const auto n = static_cast<Index>(all.nodes.size());
  std::vector<Index> sheet = singletons(n);
  for (const Index h : region)
    for (int e = 0; e < n_hex_edges; ++e) join(sheet, all.of_hex[h][e & ~3], all.of_hex[h][e]);
  std::vector<std::uint8_t> is_third(n, 0), cut(n, 0);
  for (const auto& [a, b] : thirds) is_third[find_root(sheet, find_edge(all, a, b))] = 1;
  parallel_each(cut.size(), [&](std::size_t e) {
    const auto [a, b] = all.nodes[e];
    cut[e] = (marked[a] && marked[b]) || is_third[find_root(sheet, static_cast<Index>(e))];
  });
  std::vector<std::uint16_t> codes(mesh.hexes.size());
  parallel_each(codes.size(), [&](std::size_t h) {
    int code = 0;
    for (int e = 0; e < n_hex_edges; ++e) code |= cut[all.of_hex[h][e]] << e;
    codes[h] = static_cast<std::uint16_t>(code);
  });
  return codes;
}

}  // namespace hextwist
