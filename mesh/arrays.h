// One visitor over all arrays of a mesh and its association, by what they are per.
//
// What cuts meshes out, splices, compares, copies, counts or hands them out is written once over it. So a new array is
// a member of Mesh or Association, and a line here.
#pragma once

#include <algorithm>
#include <cassert>
#include <concepts>
#include <string>
#include <string_view>

#include "hextwist/mesh/association/association.h"

namespace hextwist {

/// What an array has items for, or what the items of a list name.
enum class Per { node, hex };

/// What nodes and hexes get that a refinement makes (refine/carry.cpp).
enum class Fresh {
  inherited,  ///< nodes: interpolated between the old nodes that they lie between; hexes: what their parent has; sides
              ///< and hexes of lists: those that make up the old ones; nodes of lists: refine/node_sets.h
  nearest,    ///< the same, but nodes: what the nearest of these has
  id,         ///< numbers that follow the highest old one
  blank,      ///< what T{} is, unless a rule of its own knows better
  own         ///< by a rule of its own: what the refinement is about
};

struct ArrayTag {
  std::string_view name;  ///< for programs in other languages
  Per per = Per::node;
  Fresh fresh = Fresh::inherited;
  std::size_t width = 1;         ///< array items per node or hex
  std::string_view values = {};  ///< name of the values beside a list
  std::string_view field = {};   ///< of those arrays of which there are several: which
  int id = -1;                   ///< the same, of groups

  bool is_one_of_several() const { return id >= 0 || !field.empty(); }
  /// "points", "blocks/3", "node_fields/heat".
  std::string full_name() const {
    if (!is_one_of_several()) return std::string(name);
    return std::string(name) + "/" + (id >= 0 ? std::to_string(id) : std::string(field));
  }
};

/// An ascending list of nodes, hexes, edges or sides; values beside its items, null where it has none.
template <class Items, class Values>
struct ListOf {
  Items& items;
  Values* values;
};
template <class T>
concept IsList = requires(T& list) {
  list.items;
  list.values;
};
template <class Items>
ListOf<Items, std::vector<int>> list_of(Items& items) {
  return {items, nullptr};
}
template <class Items, class Values>
ListOf<Items, Values> list_of(Items& items, Values& values) {
  return {items, &values};
}

/// The node or hex that an item of a list names first: lists ascend by it.
inline auto& first_named(auto& item) {
  using Item = std::remove_cvref_t<decltype(item)>;
  if constexpr (std::same_as<Item, Index>)
    return item;
  else if constexpr (std::same_as<Item, Side>)
    return item.hex;
  else
    return item[0];
}
/// Renames all nodes or hexes that an item of a list, or a hex, names.
template <class Item, class Number>
void rename(Item& item, const Number& number) {
  if constexpr (requires { item.size(); })
    for (Index& n : item) n = number(n);
  else
    first_named(item) = number(first_named(item));
}

/// Members of groups and values of fields.
inline auto& items_of(auto& group) {
  if constexpr (requires { group.hexes; })
    return group.hexes;
  else if constexpr (requires { group.nodes; })
    return group.nodes;
  else if constexpr (requires { group.sides; })
    return group.sides;
  else
    return group.values;
}

/// Gives a mesh the groups and fields of another, still without members and values, and what it has no arrays for.
inline void copy_heads(const Mesh& from, Mesh& to) {
  const auto copy = [](const auto& groups, auto& heads) {
    heads.clear();
    for (const auto& group : groups) {
      heads.push_back({});
      if constexpr (requires { group.id; })
        heads.back() = {group.id, group.name, {}};
      else
        heads.back() = {group.name, group.on, group.components, {}, group.integer};
      if constexpr (requires { group.meant; }) heads.back().meant = group.meant;
    }
  };
  copy(from.blocks, to.blocks);
  copy(from.node_sets, to.node_sets);
  copy(from.side_sets, to.side_sets);
  copy(from.fields, to.fields);
  to.others = from.others;
  to.results = from.results;
}

namespace arrays_internal {

/// The list's group that is this one, looked for where it should be first; an empty one where a constant list has none.
template <class Groups, class Group>
auto& same_group(Groups& groups, const Group& group, std::size_t place) {
  const auto same = [&](const Group& other) {
    if constexpr (requires { group.id; })
      return other.id == group.id;
    else
      return other.on == group.on && other.name == group.name;
  };
  if (place < groups.size() && same(groups[place])) return groups[place];
  const auto found = std::ranges::find_if(groups, same);
  if constexpr (std::is_const_v<Groups>) {
    static const Group none;
    if (found == groups.end()) return none;
  }
  assert(found != groups.end());
  return *found;
}

/// Calls use(group, the same of the other lists...) for each group of the first list.
template <class Use, class First, class... Others>
void for_each_group(const Use& use, First& first, Others&... others) {
  for (std::size_t i = 0; i < first.size(); ++i) use(first[i], same_group(others, first[i], i)...);
}

template <class T, class Wanted>
concept Is = std::same_as<std::remove_const_t<T>, Wanted>;

}  // namespace arrays_internal

/// Calls f(tag, list of each mesh as ListOf...) for blocks, node sets and side sets: those of the first mesh. The
/// others have the same ones; constant ones need not, and have empty lists then.
template <class F, arrays_internal::Is<Mesh>... M>
void for_each_set(const F& f, M&... mesh) {
  const auto lists = [&](std::string_view name, Per per) {
    return [&f, name, per](auto& first, auto&... others) {
      f(ArrayTag{.name = name, .per = per, .id = first.id}, list_of(items_of(first)), list_of(items_of(others))...);
    };
  };
  arrays_internal::for_each_group(lists("blocks", Per::hex), mesh.blocks...);
  arrays_internal::for_each_group(lists("node_sets", Per::node), mesh.node_sets...);
  arrays_internal::for_each_group(lists("side_sets", Per::hex), mesh.side_sets...);
}

/// Calls f(tag, array of each mesh...) for arrays per node or hex and f(tag, list of each as ListOf...) for lists.
/// Arrays that need not be there are empty where they are not. Groups and fields are those of the first mesh, as above.
template <class F, arrays_internal::Is<Mesh>... M>
void for_each_array(const F& f, M&... mesh) {
  f(ArrayTag{"points", Per::node}, mesh.points...);
  f(ArrayTag{"bit_hexes", Per::hex, Fresh::own}, mesh.hexes...);
  f(ArrayTag{"node_ids", Per::node, Fresh::id}, mesh.node_ids...);
  f(ArrayTag{"hex_ids", Per::hex, Fresh::id}, mesh.hex_ids...);
  for_each_set(f, mesh...);
  const auto field = [&](auto& first, auto&... others) {
    const bool on_nodes = first.on == Field::On::node;
    f(ArrayTag{.name = on_nodes ? "node_fields" : "hex_fields",
               .per = on_nodes ? Per::node : Per::hex,
               .fresh = first.integer ? Fresh::nearest : Fresh::inherited,
               .width = static_cast<std::size_t>(first.components),
               .field = first.name},
      first.values, others.values...);
  };
  arrays_internal::for_each_group(field, mesh.fields...);
  f(ArrayTag{"file_hexes", Per::hex}, mesh.file_hexes...);
}
template <class F, arrays_internal::Is<Association>... A>
void for_each_array(const F& f, A&... of) {
  f(ArrayTag{"node_owners", Per::node, Fresh::blank}, of.node_owner...);
  f(ArrayTag{"node_parameters", Per::node, Fresh::blank}, of.node_parameters...);
  f(ArrayTag{"hex_volumes", Per::hex}, of.hex_volume...);
  f(ArrayTag{.name = "curve_edges", .fresh = Fresh::own, .values = "edge_curves"},
    list_of(of.curve_edges, of.edge_curve)...);
  f(ArrayTag{.name = "surface_sides", .per = Per::hex, .fresh = Fresh::own, .values = "quad_surfaces"},
    list_of(of.surface_faces, of.face_surface)...);
}
/// Those of meshes with their associations: MeshedModel.
template <class F, class... M>
requires(requires { &M::mesh, &M::association; } && ...) void for_each_array(const F& f, M&... meshed) {
  for_each_array(f, meshed.mesh...);
  for_each_array(f, meshed.association...);
}

/// f(tag, array...) for lists too, first the items and then the values.
template <class F>
auto lists_apart(const F& f) {
  return [f](const ArrayTag& tag, auto&&... of) {
    if constexpr ((IsList<decltype(of)> && ...)) {
      f(tag, of.items...);
      if (tag.values.empty()) return;
      ArrayTag beside = tag;
      beside.name = tag.values;
      f(beside, *of.values...);
    } else {
      f(tag, of...);
    }
  };
}

/// Bytes of all items of a Mesh, an Association or both.
template <class Arrays>
std::size_t bytes_of_arrays(const Arrays& arrays) {
  std::size_t bytes = 0;
  for_each_array(lists_apart([&](const ArrayTag&, const auto& array) { bytes += array.size() * sizeof(array[0]); }),
                 arrays);
  return bytes;
}

}  // namespace hextwist
