// Cuts a patch out of a mesh, with all that is known of it.
#include <algorithm>

#include "hextwist/base/ranked_bits.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/arrays.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/others.h"
#include "hextwist/patch/patch.h"

namespace hextwist {
namespace {

/// Calls use(place in the list, position in `wanted`) for the items that name one of these first. Cheap where `wanted`
/// is short.
template <class Item, class Use>
void for_each_naming(const std::vector<Item>& list, std::span<const Index> wanted, const Use& use) {
  const auto name = [](const Item& item) { return first_named(item); };
  auto at = list.begin();
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    at = std::ranges::lower_bound(at, list.end(), wanted[i], {}, name);
    if (at == list.end()) return;
    for (; at != list.end() && first_named(*at) == wanted[i]; ++at)
      use(static_cast<std::size_t>(at - list.begin()), static_cast<Index>(i));
  }
}

/// Fills the arrays of a patch from those of the whole.
struct CutOut {
  const Patch& patch;
  const RankedBits& number;  // of its nodes

  const std::vector<Index>& wanted(const ArrayTag& tag) const {
    return tag.per == Per::node ? patch.nodes : patch.hexes;
  }
  template <class T>
  void operator()(const ArrayTag& tag, const std::vector<T>& whole, std::vector<T>& part) const {
    if (tag.fresh == Fresh::id || whole.empty()) return;
    part = items_at(whole, wanted(tag), tag.width);
    if constexpr (std::same_as<T, Hex>)
      for (Hex& hex : part) rename(hex, [&](Index n) { return number[n]; });
  }
  template <IsList Whole, IsList Part>
  void operator()(const ArrayTag& tag, const Whole& whole, const Part& part) const {
    for_each_naming(whole.items, wanted(tag), [&](std::size_t place, Index i) {
      auto item = whole.items[place];
      first_named(item) = i;
      if constexpr (std::same_as<decltype(item), Edge>)
        if ((item[1] = patch.local_node(item[1])) < 0) return;
      part.items.push_back(item);
      if (whole.values) part.values->push_back((*whole.values)[place]);
    });
  }
};

/// The same, and frees each array of the whole when the part has its own: but for ids, which a patch does not have.
struct TakeOut {
  const CutOut& cut_out;

  template <class T>
  void operator()(const ArrayTag& tag, std::vector<T>& whole, std::vector<T>& part) const {
    cut_out(tag, whole, part);
    if (tag.fresh != Fresh::id) std::vector<T>().swap(whole);
  }
  template <IsList Whole, IsList Part>
  void operator()(const ArrayTag& tag, const Whole& whole, const Part& part) const {
    cut_out(tag, whole, part);
    std::remove_cvref_t<decltype(whole.items)>().swap(whole.items);
    if (whole.values) std::remove_cvref_t<decltype(*whole.values)>().swap(*whole.values);
  }
};

/// Leaves out curve edges of which a patch has both nodes, but no hex: such an edge runs past its border. In a base
/// they would stay where the whole has cut them.
void leave_out_edges_elsewhere(const Mesh& mesh, Association& association) {
  const std::vector<Edge>& listed = association.curve_edges;
  if (listed.empty()) return;
  std::vector<std::uint8_t> is_end(mesh.points.size(), 0), is_here(listed.size(), 0);
  for (const auto& [a, b] : listed) is_end[a] = is_end[b] = 1;
  for (const Hex& hex : mesh.hexes)
    for (int e = 0; e < n_hex_edges; ++e) {
      const auto [a, b] = std::minmax(hex[edge_corner(e, 0)], hex[edge_corner(e, 1)]);
      if (!is_end[a] || !is_end[b]) continue;
      if (const Index i = position_in(listed, Edge{a, b}); i >= 0) is_here[i] = 1;
    }
  const auto keep = [&](auto& list) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < list.size(); ++i)
      if (is_here[i]) list[n++] = list[i];
    list.resize(n);
  };
  keep(association.edge_curve);
  keep(association.curve_edges);
}

}  // namespace

Index Patch::local_node(Index node) const {
  const auto found = std::ranges::lower_bound(nodes, node);
  return found != nodes.end() && *found == node ? static_cast<Index>(found - nodes.begin()) : -1;
}

namespace {

/// Whole: const, or not where it is used up.
template <class Whole>
Patch patch_of(Whole& whole, std::vector<Index> hexes) {
  Patch patch;
  patch.hexes = std::move(hexes);
  RankedBits number(whole.mesh.points.size());
  for (const Index h : patch.hexes)
    for (const Index n : whole.mesh.hexes[h]) number.set(n);
  number.finish();
  patch.nodes = number.list();
  patch.meshed.model = whole.model;
  copy_heads(whole.mesh, patch.meshed.mesh);
  patch.meshed.mesh.others = nullptr;
  const CutOut cut_out{patch, number};
  if constexpr (std::is_const_v<Whole>)
    for_each_array(cut_out, whole, patch.meshed);
  else
    for_each_array(TakeOut{cut_out}, whole, patch.meshed);
  leave_out_edges_elsewhere(patch.meshed.mesh, patch.meshed.association);
  return patch;
}

}  // namespace

Patch make_patch(const MeshedModel& whole, std::vector<Index> hexes) {
  return patch_of(whole, std::move(hexes));
}

Patch take_patch(MeshedModel& whole, std::vector<Index> hexes) {
  return patch_of(whole, std::move(hexes));
}

bool touch_others(const Mesh& mesh, std::span<const Index> hexes) {
  if (!mesh.others) return false;
  const std::vector<std::uint8_t> is_theirs = nodes_of_others(mesh);
  return std::ranges::any_of(hexes, [&](Index h) { return has_marked_corner(mesh.hexes[h], is_theirs); });
}

void set_ids(const Mesh& whole, const Patch& patch, Mesh& part) {
  for (const Index n : patch.nodes) part.node_ids.push_back(node_id(whole, n));
  for (const Index h : patch.hexes) part.hex_ids.push_back(hex_id(whole, h));
}

}  // namespace hextwist
