#include "hextwist/session/array_delta_internal.h"

#include <algorithm>

#include "hextwist/base/same_bits.h"

namespace hextwist {
namespace {

/// What to do where the two arrays differ.
enum class Walk {
  replace,  ///< step on in both: values changed
  insert,   ///< step on in `to`: it has items that `from` has not
  drop,     ///< step on in `from`: it has items that `to` has not
};

/// Calls piece(begin of fresh items in `to`, their number, begin of kept items in `from`, their number) until it
/// returns false.
template <class T, class F>
void walk(Walk how, const std::vector<T>& from, const std::vector<T>& to, F piece) {
  std::size_t i = 0, j = 0;
  while (j < to.size()) {
    const std::size_t fresh = j;
    std::size_t ahead = i;
    const auto differ = [&] { return ahead >= from.size() || !same_bits(from[ahead], to[j]); };
    if (how == Walk::drop) {
      while (ahead < from.size() && differ()) ++ahead;
      if (ahead == from.size()) {
        j = to.size();  // the rest is new
      } else {
        i = ahead;
      }
    } else {
      for (; j < to.size() && differ(); ++j)
        if (how == Walk::replace) ++ahead;
      i = ahead;
    }
    const std::size_t n_fresh = j - fresh, kept = std::min(i, from.size()), begin = j;
    while (j < to.size() && i < from.size() && same_bits(from[i], to[j])) ++i, ++j;
    if (!piece(fresh, n_fresh, kept, j - begin)) return;
  }
}

template <class T>
std::size_t cost(Walk how, const std::vector<T>& from, const std::vector<T>& to, std::size_t limit) {
  std::size_t result = 0;
  walk(how, from, to, [&](std::size_t, std::size_t n_fresh, std::size_t, std::size_t) {
    result += sizeof(typename ArrayDelta<T>::Piece) + n_fresh * sizeof(T);
    return result < limit;
  });
  return result;
}

}  // namespace

template <class T>
ArrayDelta<T>::ArrayDelta(const std::vector<T>& from, const std::vector<T>& to) : same_(same_bits(from, to)) {
  if (same_) return;
  Walk best = Walk::replace;
  std::size_t least = static_cast<std::size_t>(-1);
  for (const Walk how : {Walk::replace, Walk::insert, Walk::drop})
    if (const std::size_t bytes = cost(how, from, to, least); bytes < least) {
      least = bytes;
      best = how;
    }
  std::size_t n_pieces = 0, n_fresh = 0;
  walk(best, from, to, [&](std::size_t, std::size_t fresh, std::size_t, std::size_t) {
    ++n_pieces;
    n_fresh += fresh;
    return true;
  });
  pieces_.reserve(n_pieces);
  fresh_.reserve(n_fresh);
  walk(best, from, to, [&](std::size_t first_fresh, std::size_t n, std::size_t first, std::size_t n_kept) {
    const auto begin = to.begin() + static_cast<std::ptrdiff_t>(first_fresh);
    fresh_.insert(fresh_.end(), begin, begin + static_cast<std::ptrdiff_t>(n));
    pieces_.push_back({n, first, n_kept});
    return true;
  });
}

template <class T>
std::vector<T> ArrayDelta<T>::apply(const std::vector<T>& from) const {
  if (same_) return from;
  std::size_t size = 0;
  for (const Piece& piece : pieces_) size += piece.n_fresh + piece.n_kept;
  std::vector<T> result;
  result.reserve(size);
  auto fresh = fresh_.begin();
  for (const Piece& piece : pieces_) {
    result.insert(result.end(), fresh, fresh + static_cast<std::ptrdiff_t>(piece.n_fresh));
    fresh += static_cast<std::ptrdiff_t>(piece.n_fresh);
    const auto kept = from.begin() + static_cast<std::ptrdiff_t>(piece.first);
    result.insert(result.end(), kept, kept + static_cast<std::ptrdiff_t>(piece.n_kept));
  }
  return result;
}

template class ArrayDelta<Index>;
template class ArrayDelta<std::int64_t>;
template class ArrayDelta<double>;
template class ArrayDelta<Vec3>;
template class ArrayDelta<Hex>;
template class ArrayDelta<Side>;
template class ArrayDelta<Owner>;
template class ArrayDelta<Parameters>;
template class ArrayDelta<Edge>;

namespace {

// The same words for all kinds of groups.
auto& items(auto& block) requires requires {
  block.hexes;
}
{ return block.hexes; }
auto& items(auto& set) requires requires {
  set.nodes;
}
{ return set.nodes; }
auto& items(auto& set) requires requires {
  set.sides;
}
{ return set.sides; }
auto& items(auto& field) requires requires {
  field.values;
}
{ return field.values; }
bool same_group(const Field& a, const Field& b) {
  return a.name == b.name && a.on == b.on;
}
bool same_group(const auto& a, const auto& b) {
  return a.id == b.id;
}
bool same_head(const Field& a, const Field& b) {
  return same_group(a, b) && a.components == b.components;
}
bool same_head(const auto& a, const auto& b) {
  return a.id == b.id && a.name == b.name;
}
Field head(const Field& field) {
  return {field.name, field.on, field.components, {}};
}
template <class Group>
Group head(const Group& group) {
  return {group.id, group.name, {}};
}

template <class Group, class Item>
GroupsDelta<Group, Item> groups_delta(const std::vector<Group>& from, const std::vector<Group>& to) {
  GroupsDelta<Group, Item> result;
  result.same = std::ranges::equal(
      from, to, [](const Group& a, const Group& b) { return same_head(a, b) && same_bits(items(a), items(b)); });
  if (result.same) return result;
  for (const Group& group : to) {
    const auto found = std::ranges::find_if(from, [&](const Group& other) { return same_group(other, group); });
    const std::vector<Item> nothing;
    const bool known = found != from.end();
    result.entries.push_back({head(group), known ? static_cast<Index>(found - from.begin()) : -1,
                              ArrayDelta<Item>(known ? items(*found) : nothing, items(group))});
  }
  return result;
}

template <class Group, class Item>
std::vector<Group> apply(const GroupsDelta<Group, Item>& delta, const std::vector<Group>& from) {
  if (delta.same) return from;
  std::vector<Group> result;
  for (const auto& entry : delta.entries) {
    result.push_back(entry.group);
    items(result.back()) = entry.items.apply(entry.from < 0 ? std::vector<Item>() : items(from[entry.from]));
  }
  return result;
}

template <class Group, class Item>
std::size_t bytes_of(const GroupsDelta<Group, Item>& delta) {
  std::size_t bytes = 0;
  for (const auto& entry : delta.entries) bytes += sizeof(entry) + entry.group.name.size() + entry.items.bytes();
  return bytes;
}
}  // namespace

std::size_t bytes_of(const Association& a) {
  return bytes_of(a.node_owner) + bytes_of(a.node_parameters) + bytes_of(a.curve_edges) + bytes_of(a.edge_curve) +
         bytes_of(a.surface_faces) + bytes_of(a.face_surface) + bytes_of(a.hex_volume);
}
std::size_t bytes_of(const SetsDelta& delta) {
  return bytes_of(delta.blocks) + bytes_of(delta.node_sets) + bytes_of(delta.side_sets);
}

SetsDelta sets_delta(const Mesh& from, const Mesh& to) {
  return {groups_delta<Block, Index>(from.blocks, to.blocks),
          groups_delta<NodeSet, Index>(from.node_sets, to.node_sets),
          groups_delta<SideSet, Side>(from.side_sets, to.side_sets)};
}

Mesh sets_after(const SetsDelta& delta, const Mesh& from) {
  Mesh result;
  result.blocks = apply(delta.blocks, from.blocks);
  result.node_sets = apply(delta.node_sets, from.node_sets);
  result.side_sets = apply(delta.side_sets, from.side_sets);
  return result;
}

std::size_t bytes_of(const MeshedModel& meshed) {
  const Mesh& mesh = meshed.mesh;
  std::size_t bytes = bytes_of(mesh.points) + bytes_of(mesh.hexes) + bytes_of(mesh.node_ids) + bytes_of(mesh.hex_ids);
  for (const Block& block : mesh.blocks) bytes += bytes_of(block.hexes);
  for (const NodeSet& set : mesh.node_sets) bytes += bytes_of(set.nodes);
  for (const SideSet& set : mesh.side_sets) bytes += bytes_of(set.sides);
  for (const Field& field : mesh.fields) bytes += bytes_of(field.values);
  return bytes + bytes_of(meshed.association);
}

MeshedDelta MeshedDelta::between(const MeshedModel& from, const MeshedModel& to) {
  const Association &a = from.association, &b = to.association;
  return {{from.mesh.points, to.mesh.points},     {from.mesh.hexes, to.mesh.hexes},
          {from.mesh.node_ids, to.mesh.node_ids}, {from.mesh.hex_ids, to.mesh.hex_ids},
          sets_delta(from.mesh, to.mesh),         groups_delta<Field, double>(from.mesh.fields, to.mesh.fields),
          {a.node_owner, b.node_owner},           {a.node_parameters, b.node_parameters},
          {a.curve_edges, b.curve_edges},         {a.edge_curve, b.edge_curve},
          {a.surface_faces, b.surface_faces},     {a.face_surface, b.face_surface},
          {a.hex_volume, b.hex_volume},           to.model};
}

MeshedModel MeshedDelta::apply(const MeshedModel& from) const {
  const Association& a = from.association;
  MeshedModel result{sets_after(sets, from.mesh), model, {}};
  result.mesh.points = points.apply(from.mesh.points);
  result.mesh.hexes = hexes.apply(from.mesh.hexes);
  result.mesh.node_ids = node_ids.apply(from.mesh.node_ids);
  result.mesh.hex_ids = hex_ids.apply(from.mesh.hex_ids);
  result.mesh.fields = hextwist::apply(fields, from.mesh.fields);
  result.association = {node_owner.apply(a.node_owner),       node_parameters.apply(a.node_parameters),
                        curve_edges.apply(a.curve_edges),     edge_curve.apply(a.edge_curve),
                        surface_faces.apply(a.surface_faces), face_surface.apply(a.face_surface),
                        hex_volume.apply(a.hex_volume)};
  return result;
}

std::size_t MeshedDelta::bytes() const {
  return points.bytes() + hexes.bytes() + node_ids.bytes() + hex_ids.bytes() + bytes_of(sets) + bytes_of(fields) +
         node_owner.bytes() + node_parameters.bytes() + curve_edges.bytes() + edge_curve.bytes() +
         surface_faces.bytes() + face_surface.bytes() + hex_volume.bytes();
}

}  // namespace hextwist
