#include "hextwist/refine/carry.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "hextwist/base/large_array.h"
#include "hextwist/base/parallel.h"
#include "hextwist/mesh/arrays.h"
#include "hextwist/refine/node_sets.h"
#include "hextwist/refine/origin.h"
#include "hextwist/refine/others.h"

namespace hextwist {
namespace {

/// Calls per_node(new node, its origin) for all new nodes, in parallel.
template <typename Body>
void for_each_new_node(const Mesh& old_mesh, const Lineage& lineage, const Body& per_node) {
  parallel_each(lineage.edges.size(), [&](std::size_t i) { for_each_node(lineage, lineage.edges[i], per_node); });
  parallel_each(lineage.faces.size(), [&](std::size_t i) { for_each_node(lineage, lineage.faces[i], per_node); });
  parallel_each(lineage.hexes.size(),
                [&](std::size_t i) { for_each_node(lineage, lineage.hexes[i], old_mesh.hexes, per_node); });
}

/// Fills ids[first], ... with next, next + 1, ...
void count_on(std::vector<std::int64_t>& ids, std::size_t first, std::int64_t next) {
  parallel_each(ids.size() - first, [&](std::size_t i) { ids[first + i] = next + static_cast<std::int64_t>(i); });
}

/// Old values, and room for those of the new nodes.
template <class T>
std::vector<T> of_old_nodes(const std::vector<T>& old, std::size_t n) {
  std::vector<T> values = copy_large(old, n);
  resize_large(values, n);
  return values;
}

/// Calls use(new side) for the side itself or the sides of the children that make it up.
template <typename Use>
void for_each_child_side(const Split& split, Side old_side, const Use& use) {
  const Index first = split.first_child[old_side.hex];
  if (!split.is_cut(old_side.hex)) return use(Side{first, old_side.face});
  const HexTemplate& of = split.lineage.table->hex(split.lineage.hexes[split.cut_index(old_side.hex)].code);
  for (const ChildSide& child : of.side[old_side.face]) use(Side{first + child.child, child.face});
}

/// The old hexes of an ascending list that were not cut, then the children of those that were: ascending.
std::vector<Index> carried_hexes(const std::vector<Index>& old_hexes, const Split& split) {
  const std::vector<CutHex>& cut = split.lineage.hexes;
  const auto end_of = [&](auto at) {
    return at + 1 == cut.end() ? static_cast<Index>(split.lineage.parent.size()) : std::next(at)->first_child;
  };
  // Calls keep(hex) for the members begin, ... that were not cut and use(entry of cut) for the others.
  const auto for_each_member = [&](Index begin, Index end, const auto& keep, const auto& use) {
    auto at = cut.begin();
    for (Index i = begin; i < end; ++i) {
      const Index h = old_hexes[i];
      if (!split.is_cut(h)) {
        keep(h);
        continue;
      }
      if (at->hex != h) at = std::lower_bound(at, cut.end(), h, [](const CutHex& a, Index hex) { return a.hex < hex; });
      use(at);
      if (at + 1 != cut.end()) ++at;
    }
  };
  struct Place {
    std::size_t kept = 0, child = 0;
  };
  constexpr Index size = 1 << 14;
  const auto n = static_cast<Index>(old_hexes.size());
  std::vector<Place> first(n_chunks(n, size) + 1);
  parallel_chunks(n, size, [&](Index chunk, Index begin, Index end) {
    Place counted;
    for_each_member(
        begin, end, [&](Index) { ++counted.kept; },
        [&](auto at) { counted.child += static_cast<std::size_t>(end_of(at) - at->first_child); });
    first[chunk + 1] = counted;
  });
  for (std::size_t chunk = 1; chunk < first.size(); ++chunk) {
    first[chunk].kept += first[chunk - 1].kept;
    first[chunk].child += first[chunk - 1].child;
  }
  const std::size_t n_kept = first.back().kept;
  std::vector<Index> carried;
  resize_for_overwrite(carried, n_kept + first.back().child);
  parallel_chunks(n, size, [&](Index chunk, Index begin, Index end) {
    Index* kept = carried.data() + first[chunk].kept;
    Index* child = carried.data() + n_kept + first[chunk].child;
    for_each_member(
        begin, end, [&](Index h) { *kept++ = split.first_child[h]; },
        [&](auto at) {
          for (Index c = at->first_child; c < end_of(at); ++c) *child++ = c;
        });
  });
  return carried;
}

/// Sorts what begins with the sides of hexes that were not cut, in order.
template <class List, class SideOf>
void sort_sides(List& list, Index n_kept, const SideOf& side_of) {
  const auto kept_end = std::ranges::stable_partition(list, [&](const auto& item) {
                          return std::invoke(side_of, item).hex < n_kept;
                        }).begin();
  std::ranges::sort(kept_end, list.end(), {}, side_of);
}

std::vector<Side> carried_sides(const std::vector<Side>& old_sides, const Split& split) {
  std::vector<Side> carried;
  for (const Side side : old_sides) for_each_child_side(split, side, [&](Side child) { carried.push_back(child); });
  sort_sides(carried, split.n_kept(), std::identity{});
  return carried;
}

/// Owners of the nodes on cut edges and faces: volume of their hex, unless the face or the edge is on the CAD.
void carry_node_owners(const Association& old, const Split& split, Association& association) {
  const Lineage& lineage = split.lineage;
  const auto set_nodes = [&](Index first, std::size_t n, Owner owner) {
    for (std::size_t s = 0; s < n; ++s) association.node_owner[first + s] = owner;
  };
  const auto n_edge_nodes = [&](const CutEdge& edge) { return lineage.table->edge[edge.code].at.size(); };
  parallel_each(lineage.edges.size(), [&](std::size_t i) {
    const CutEdge& edge = lineage.edges[i];
    set_nodes(edge.first_node, n_edge_nodes(edge), {3, old.hex_volume[edge.hex]});
  });
  parallel_each(lineage.faces.size(), [&](std::size_t i) {
    const CutFace& face = lineage.faces[i];
    set_nodes(face.first_node, lineage.table->face[face.code].at.size(), {3, old.hex_volume[face.side.hex]});
  });
  parallel_each(lineage.hexes.size(), [&](std::size_t i) {
    const CutHex& hex = lineage.hexes[i];
    set_nodes(hex.first_node, lineage.table->hex(hex.code).inside.size(), {3, old.hex_volume[hex.hex]});
  });
  for (std::size_t i = 0; i < old.surface_faces.size(); ++i) {
    const Side side = old.surface_faces[i];
    if (!split.is_cut(side.hex)) continue;
    const Index cut = split.cut_index(side.hex);
    const Owner owner{2, old.face_surface[i]};
    for (int j = 0; j < 4; ++j)
      if (const Index number = split.hex_edges[cut][face_edge(side.face, j)]; number >= 0)
        set_nodes(lineage.edges[number].first_node, n_edge_nodes(lineage.edges[number]), owner);
    if (const Index number = split.hex_faces[cut][side.face]; number >= 0)
      set_nodes(lineage.faces[number].first_node, lineage.table->face[lineage.faces[number].code].at.size(), owner);
  }
}

/// Curve edges and their nodes.
void carry_curve_edges(const Association& old, const Lineage& lineage, Association& association) {
  struct Owned {
    Edge edge;
    int curve;
  };
  std::vector<Owned> owned;
  for (std::size_t i = 0; i < old.curve_edges.size(); ++i) {
    for_each_child_edge(lineage, old.curve_edges[i], [&](const Edge& edge) {
      owned.push_back({edge, old.edge_curve[i]});
      for (const Index node : edge)
        if (node >= lineage.n_old_nodes) association.node_owner[node] = {1, old.edge_curve[i]};
    });
  }
  std::ranges::sort(owned, {}, &Owned::edge);
  for (const Owned& item : owned) {
    association.curve_edges.push_back(item.edge);
    association.edge_curve.push_back(item.curve);
  }
}

void carry_surface_faces(const Association& old, const Split& split, const Mesh& mesh, Association& association) {
  struct Owned {
    Side side;
    int surface;
  };
  std::vector<Owned> owned;
  for (std::size_t i = 0; i < old.surface_faces.size(); ++i)
    for_each_child_side(split, old.surface_faces[i], [&](Side side) { owned.push_back({side, old.face_surface[i]}); });

  // A face inside the mesh is named by the lower hex. Where that one was cut (so its children come last) and the one
  // behind was not, the other side has become the lower one.
  std::vector<std::size_t> uncut;
  std::vector<Quad> quads;
  for (std::size_t i = 0; i < owned.size(); ++i) {
    if (owned[i].side.hex < split.n_kept()) continue;
    const Quad quad = face_nodes(mesh.hexes[owned[i].side.hex], owned[i].side.face);
    if (std::ranges::any_of(quad, [&](Index n) { return n >= split.lineage.n_old_nodes; })) continue;
    uncut.push_back(i);
    quads.push_back(quad);
  }
  const std::vector<Side> sides = find_sides(mesh, quads);
  bool is_other = false;
  for (std::size_t i = 0; i < uncut.size(); ++i)
    if (const Side before = std::exchange(owned[uncut[i]].side, sides[i]); before != sides[i]) is_other = true;
  if (is_other)
    std::ranges::sort(owned, {}, &Owned::side);
  else
    sort_sides(owned, split.n_kept(), &Owned::side);
  association.surface_faces.reserve(owned.size());
  association.face_surface.reserve(owned.size());
  for (const Owned& item : owned) {
    association.surface_faces.push_back(item.side);
    association.face_surface.push_back(item.surface);
  }
}

/// Values of nodes, `width` for each.
template <class T>
std::vector<T> carried_values(const std::vector<T>& old, std::size_t width, Fresh fresh, const Mesh& old_mesh,
                              const Split& split) {
  std::vector<T> now = of_old_nodes(old, static_cast<std::size_t>(split.n_nodes) * width);
  if constexpr (std::same_as<T, double> || std::same_as<T, Vec3>) {
    const auto value = [&](const Origin& origin, int i, std::size_t c) -> const T& {
      return old[static_cast<std::size_t>(origin.node[i]) * width + c];
    };
    if (fresh == Fresh::inherited)
      for_each_new_node(old_mesh, split.lineage, [&](Index node, const Origin& origin) {
        for (std::size_t c = 0; c < width; ++c) {
          T sum{};
          if constexpr (std::same_as<T, Vec3>) sum.setZero();
          for (int i = 0; i < origin.n; ++i) sum += origin.weight[i] * value(origin, i, c);
          now[static_cast<std::size_t>(node) * width + c] = sum;
        }
      });
    if (fresh == Fresh::nearest)
      for_each_new_node(old_mesh, split.lineage, [&](Index node, const Origin& origin) {
        const auto nearest =
            std::max_element(origin.weight.begin(), origin.weight.begin() + origin.n) - origin.weight.begin();
        for (std::size_t c = 0; c < width; ++c)
          now[static_cast<std::size_t>(node) * width + c] = value(origin, static_cast<int>(nearest), c);
      });
  }
  return now;
}

/// Makes the arrays of the refinement from the old ones.
struct Carry {
  const Mesh& old_mesh;
  const Split& split;

  template <class T>
  void operator()(const ArrayTag& tag, const std::vector<T>& old, std::vector<T>& now) const {
    if (tag.fresh == Fresh::own || (old.empty() && tag.fresh != Fresh::id)) return;
    if constexpr (std::same_as<T, std::int64_t>)
      if (tag.fresh == Fresh::id) return tag.per == Per::node ? node_ids(old, now) : hex_ids(old, now);
    const std::size_t width = tag.width;
    if (tag.per == Per::hex) {
      const std::vector<Index>& parent = split.lineage.parent;
      resize_for_overwrite(now, parent.size() * width);
      return parallel_each(parent.size(), [&](std::size_t h) {
        std::copy_n(old.data() + static_cast<std::size_t>(parent[h]) * width, width, now.data() + h * width);
      });
    }
    now = carried_values(old, width, tag.fresh, old_mesh, split);
  }
  void operator()(const ArrayTag& tag, const IsList auto& old, const IsList auto& now) const {
    using Item = std::remove_cvref_t<decltype(old.items[0])>;
    if (tag.fresh == Fresh::own) return;
    if constexpr (std::same_as<Item, Side>)
      now.items = carried_sides(old.items, split);
    else if constexpr (std::same_as<Item, Index>)
      if (tag.per == Per::hex) now.items = carried_hexes(old.items, split);  // node sets come when owners are known
  }

 private:
  /// They stay with the nodes.
  void node_ids(const std::vector<std::int64_t>& old, std::vector<std::int64_t>& now) const {
    if (old.empty()) return;
    now = of_old_nodes(old, static_cast<std::size_t>(split.n_nodes));
    count_on(now, old.size(), old.back() + 1);
  }
  /// Those of hexes that were cut are gone for good.
  void hex_ids(const std::vector<std::int64_t>& old, std::vector<std::int64_t>& now) const {
    const std::vector<Index>& parent = split.lineage.parent;
    if (split.lineage.hexes.empty()) {
      now = old;
      return;
    }
    resize_for_overwrite(now, parent.size());
    parallel_each(split.n_kept(), [&](std::size_t i) { now[i] = hex_id(old_mesh, parent[i]); });
    count_on(now, split.n_kept(), highest_element_id(old_mesh) + 1);
  }
};

}  // namespace

std::vector<Vec3> carried_points(const std::vector<Vec3>& of_old_nodes, const Mesh& old_mesh, const Split& split) {
  return carried_values(of_old_nodes, 1, Fresh::inherited, old_mesh, split);
}

Carried carry(const Mesh& old_mesh, const Association& old_association, Split& split) {
  Carried carried;
  carried.mesh.hexes = std::move(split.hexes);
  copy_heads(old_mesh, carried.mesh);
  const Carry carry_array{old_mesh, split};
  for_each_array(carry_array, old_mesh, carried.mesh);
  carried.mesh.others = carried_others(old_mesh, split, carried.mesh.points, carried.mesh.hexes);
  if (!old_association.empty()) {
    for_each_array(carry_array, old_association, carried.association);
    carry_node_owners(old_association, split, carried.association);
    carry_curve_edges(old_association, split.lineage, carried.association);
    carry_surface_faces(old_association, split, carried.mesh, carried.association);
  }
  std::vector<std::vector<Index>> sets = carried_node_sets(old_mesh, old_association, split, carried.association);
  for (std::size_t i = 0; i < sets.size(); ++i) carried.mesh.node_sets[i].nodes = std::move(sets[i]);
  return carried;
}

}  // namespace hextwist
