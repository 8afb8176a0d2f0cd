// Cuts a patch out of a mesh, with all that is known of it.
#include <algorithm>
#include <bit>
#include <cstdint>

#include "hextwist/base/sorted.h"
#include "hextwist/patch/patch.h"

namespace hextwist {
namespace {

/// Some nodes of a mesh, numbered in ascending order: a bit for each node of the mesh, and sums of bits.
class NodeNumbers {
 public:
  NodeNumbers(const Mesh& mesh, std::span<const Index> hexes)
      : bits_(mesh.points.size() / width + 1), before_(bits_.size()) {
    for (const Index h : hexes)
      for (const Index n : mesh.hexes[h]) bits_[word(n)] |= bit(n);
    for (std::size_t w = 1; w < bits_.size(); ++w) before_[w] = before_[w - 1] + std::popcount(bits_[w - 1]);
  }
  std::vector<Index> nodes() const {
    std::vector<Index> list;
    list.reserve(static_cast<std::size_t>(before_.back()) + static_cast<std::size_t>(std::popcount(bits_.back())));
    for (std::size_t w = 0; w < bits_.size(); ++w)
      for (std::uint64_t rest = bits_[w]; rest; rest &= rest - 1)
        list.push_back(static_cast<Index>(w * width) + std::countr_zero(rest));
    return list;
  }
  /// Of a node that is one of them.
  Index operator[](Index node) const {
    return before_[word(node)] + std::popcount(bits_[word(node)] & (bit(node) - 1));
  }

 private:
  static constexpr std::size_t width = 64;
  static std::size_t word(Index node) { return static_cast<std::size_t>(node) / width; }
  static std::uint64_t bit(Index node) { return std::uint64_t{1} << (static_cast<std::size_t>(node) % width); }
  std::vector<std::uint64_t> bits_;
  std::vector<Index> before_;  // per word: how many stand in lower ones
};

/// Positions in `wanted` of the items that both lists have. Cheap where `wanted` is short.
std::vector<Index> common(const std::vector<Index>& list, std::span<const Index> wanted) {
  std::vector<Index> result;
  auto at = list.begin();
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    at = std::lower_bound(at, list.end(), wanted[i]);
    if (at == list.end()) break;
    if (*at == wanted[i]) result.push_back(static_cast<Index>(i));
  }
  return result;
}

/// Calls use(place in the list, the side with its hex as a position in `hexes`) for the sides of these hexes.
template <class Use>
void for_each_side(const std::vector<Side>& sides, std::span<const Index> hexes, const Use& use) {
  auto at = sides.begin();
  for (std::size_t i = 0; i < hexes.size(); ++i) {
    at = std::lower_bound(at, sides.end(), Side{hexes[i], 0});
    for (; at != sides.end() && at->hex == hexes[i]; ++at)
      use(static_cast<std::size_t>(at - sides.begin()), Side{static_cast<Index>(i), at->face});
  }
}

Association association_of(const Association& whole, const Patch& patch) {
  Association part;
  if (whole.empty()) return part;
  part.node_owner = items_at(whole.node_owner, patch.nodes);
  part.node_parameters = items_at(whole.node_parameters, patch.nodes);
  part.hex_volume = items_at(whole.hex_volume, patch.hexes);
  auto at = whole.curve_edges.begin();
  for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
    at = std::lower_bound(at, whole.curve_edges.end(), Edge{patch.nodes[i], 0});
    for (; at != whole.curve_edges.end() && (*at)[0] == patch.nodes[i]; ++at)
      if (const Index other = patch.local_node((*at)[1]); other >= 0) {
        part.curve_edges.push_back({static_cast<Index>(i), other});
        part.edge_curve.push_back(whole.edge_curve[static_cast<std::size_t>(at - whole.curve_edges.begin())]);
      }
  }
  for_each_side(whole.surface_faces, patch.hexes, [&](std::size_t place, Side side) {
    part.surface_faces.push_back(side);
    part.face_surface.push_back(whole.face_surface[place]);
  });
  return part;
}

}  // namespace

Index Patch::local_node(Index node) const {
  const auto found = std::ranges::lower_bound(nodes, node);
  return found != nodes.end() && *found == node ? static_cast<Index>(found - nodes.begin()) : -1;
}

Patch make_patch(const MeshedModel& whole, std::vector<Index> hexes) {
  Patch patch;
  patch.hexes = std::move(hexes);
  const NodeNumbers number(whole.mesh, patch.hexes);
  patch.nodes = number.nodes();
  Mesh& mesh = patch.meshed.mesh;
  mesh.points = items_at(whole.mesh.points, patch.nodes);
  mesh.hexes = items_at(whole.mesh.hexes, patch.hexes);
  for (Hex& hex : mesh.hexes)
    for (Index& n : hex) n = number[n];
  for (const Block& block : whole.mesh.blocks)
    mesh.blocks.push_back({block.id, block.name, common(block.hexes, patch.hexes)});
  for (const NodeSet& set : whole.mesh.node_sets)
    mesh.node_sets.push_back({set.id, set.name, common(set.nodes, patch.nodes)});
  for (const SideSet& set : whole.mesh.side_sets) {
    SideSet& part = mesh.side_sets.emplace_back(SideSet{set.id, set.name, {}});
    for_each_side(set.sides, patch.hexes, [&](std::size_t, Side side) { part.sides.push_back(side); });
  }
  for (const Field& field : whole.mesh.fields)
    mesh.fields.push_back({field.name, field.on, field.components,
                           items_at(field.values, field.on == Field::On::node ? patch.nodes : patch.hexes,
                                    static_cast<std::size_t>(field.components))});
  patch.meshed.model = whole.model;
  patch.meshed.association = association_of(whole.association, patch);
  return patch;
}

}  // namespace hextwist
