#include <limits>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/io/format.h"
#include "hextwist/mesh/corners.h"

namespace hextwist::io {
namespace {

/// Items with their nodes ascending, listed by lowest node: hexes then find theirs without a map.
template <std::size_t n>
struct ByLowestNode {
  std::vector<std::array<Index, n>> sorted;
  CompressedRows of_node;
  std::vector<char> marked;  // nodes of items

  ByLowestNode(std::span<const std::array<Index, n>> items, Index n_nodes) : sorted(items.begin(), items.end()) {
    of_node.first.assign(static_cast<std::size_t>(n_nodes) + 2, 0);
    marked.assign(static_cast<std::size_t>(n_nodes), 0);
    for (auto& nodes : sorted) {
      for (const Index node : nodes) marked[node] = 1;
      std::ranges::sort(nodes);
      ++of_node.first[nodes[0] + 2];
    }
    for (std::size_t i = 2; i < of_node.first.size(); ++i) of_node.first[i] += of_node.first[i - 1];
    of_node.items.resize(items.size());
    for (std::size_t i = 0; i < sorted.size(); ++i)
      of_node.items[of_node.first[sorted[i][0] + 1]++] = static_cast<Index>(i);
    of_node.first.pop_back();
  }

  /// False where no item can be one of this hex: the quick answer, for most hexes.
  bool near(const Hex& hex) const {
    int n_marked = 0;
    for (const Index node : hex) n_marked += marked[node];
    return n_marked >= static_cast<int>(n);
  }
  /// Calls f(item) for every item with these nodes.
  template <class F>
  void find(std::array<Index, n> nodes, F&& f) const {
    const Index lowest = std::ranges::min(nodes);
    const auto candidates = of_node[lowest];
    if (candidates.empty()) return;
    std::ranges::sort(nodes);
    for (const Index i : candidates)
      if (sorted[i] == nodes) f(i);
  }
};

}  // namespace

std::vector<Side> oriented_sides(const Mesh& mesh, std::span<const Quad> cycles, std::vector<Side>* lower) {
  if (lower) lower->clear();
  if (cycles.empty()) return {};
  const ByLowestNode<4> quads(cycles, mesh.n_nodes());
  // Per quad the lowest 6 * hex + face from which its cycle turns outwards, and inwards.
  constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();
  struct Candidates {
    std::int64_t outwards = none, inwards = none;
  };
  std::vector<Candidates> best(cycles.size());
  parallel_ranges(mesh.n_hexes(), [&](Index begin, Index end) {
    for (Index h = begin; h < end; ++h) {
      if (!quads.near(mesh.hexes[h])) continue;
      for (int f = 0; f < n_hex_faces; ++f) {
        const Quad outward = face_node_cycle(mesh.hexes[h], f);
        quads.find(outward, [&](Index q) {
          Candidates& of_quad = best[q];
          const bool same = turn_the_same_way(cycles[q], outward);
          atomic_min(same ? of_quad.outwards : of_quad.inwards, std::int64_t{6} * h + f);
        });
      }
    }
  });
  const auto side = [](std::int64_t candidate) {
    return candidate == none ? Side{}
                             : Side{static_cast<Index>(candidate / 6), static_cast<std::int32_t>(candidate % 6)};
  };
  std::vector<Side> sides(cycles.size());
  if (lower) lower->resize(cycles.size());
  for (std::size_t q = 0; q < cycles.size(); ++q) {
    const auto [outwards, inwards] = best[q];
    sides[q] = side(outwards != none ? outwards : inwards);
    if (lower) (*lower)[q] = side(std::min(outwards, inwards));
  }
  return sides;
}

std::vector<Side> lower_sides(const Mesh& mesh, std::span<const Side> sides) {
  if (sides.empty()) return {};
  std::vector<Quad> quads(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) quads[i] = face_nodes(mesh.hexes[sides[i].hex], sides[i].face);
  return find_sides(mesh, quads);
}

PlannedSides plan_sides(const Mesh& mesh, const Association& association) {
  PlannedSides plan;
  std::vector<Side> in_sets;
  for (const SideSet& set : mesh.side_sets) in_sets.insert(in_sets.end(), set.sides.begin(), set.sides.end());
  sort_unique(in_sets);
  // The sides in sets by the side of the lower hex, which is how surface faces are named.
  const auto lower = lower_sides(mesh, in_sets);
  std::vector<std::pair<Side, Side>> of_lower(in_sets.size());
  for (std::size_t i = 0; i < in_sets.size(); ++i) of_lower[i] = {lower[i], in_sets[i]};
  std::ranges::sort(of_lower);
  std::vector<std::pair<Side, int>> all;
  for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
    const Side face = association.surface_faces[i];
    auto at = std::ranges::lower_bound(of_lower, face, {}, &std::pair<Side, Side>::first);
    if (at == of_lower.end() || at->first != face) all.emplace_back(face, association.face_surface[i]);
    for (; at != of_lower.end() && at->first == face; ++at) all.emplace_back(at->second, association.face_surface[i]);
  }
  std::ranges::sort(all);
  const std::size_t n_owned = all.size();
  for (const Side& side : in_sets) {
    if (position_in(std::span(all).first(n_owned), side, &std::pair<Side, int>::first) < 0) all.emplace_back(side, 0);
  }
  std::ranges::sort(all);
  for (const auto& [side, id] : all) {
    plan.sides.push_back(side);
    plan.surface.push_back(id);
  }
  for (const SideSet& set : mesh.side_sets) {
    auto& to = plan.members.emplace_back();
    for (const Side& side : set.sides) to.push_back(position_in(plan.sides, side));
  }
  return plan;
}

std::vector<char> are_edges(const Mesh& mesh, std::span<const Edge> pairs) {
  if (pairs.empty()) return {};
  const ByLowestNode<2> edges(pairs, mesh.n_nodes());
  std::vector<char> found(pairs.size(), 0);
  parallel_ranges(mesh.n_hexes(), [&](Index begin, Index end) {
    for (Index h = begin; h < end; ++h) {
      if (!edges.near(mesh.hexes[h])) continue;
      for (int e = 0; e < n_hex_edges; ++e)
        edges.find({mesh.hexes[h][edge_corner(e, 0)], mesh.hexes[h][edge_corner(e, 1)]},
                   [&](Index i) { std::atomic_ref<char>(found[i]).store(1, std::memory_order_relaxed); });
    }
  });
  return found;
}

void derive_owners(std::vector<Owner>& owners, int dim, std::span<const Index> element_nodes,
                   std::span<const int> ids) {
  const std::size_t n_nodes = std::size_t{1} << dim;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] <= 0) continue;
    for (const Index n : element_nodes.subspan(i * n_nodes, n_nodes)) {
      Owner& node = owners[n];
      if (node.dim != dim)
        node = {dim, ids[i]};
      else if (node.id != ids[i])
        node.id = 0;  // several: cleared below
    }
  }
  for (Owner& node : owners)
    if (node.dim == dim && node.id == 0) node = {};
}

void tidy(Association& tags) {
  const auto by = [](auto& items, auto& ids) {
    std::vector<std::size_t> order(items.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(items[i], ids[i]); });
    auto old_items = items;
    auto old_ids = ids;
    items.clear();
    ids.clear();
    for (const std::size_t i : order) {
      if (!items.empty() && items.back() == old_items[i]) continue;
      items.push_back(old_items[i]);
      ids.push_back(old_ids[i]);
    }
  };
  by(tags.curve_edges, tags.edge_curve);
  by(tags.surface_faces, tags.face_surface);
  const bool silent = tags.curve_edges.empty() && tags.surface_faces.empty() &&
                      std::ranges::none_of(tags.node_owner, [](Owner owner) { return static_cast<bool>(owner); }) &&
                      std::ranges::none_of(tags.hex_volume, [](int volume) { return volume != 0; });
  if (silent) tags = {};
}

}  // namespace hextwist::io
