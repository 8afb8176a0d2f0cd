// From entities of one kind to those of another: down to what they are made of, up to what is made of them, across to
// the CAD and to groups. Everything but CAD to CAD goes through flags on mesh entities of some dimension.

#include <algorithm>

#include "hextwist/command/select/selection.h"
#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

using Flags = std::vector<char>;

Index n_entities(const Selector& selector, int dim) {
  return count(selector, static_cast<EntityKind>(dim));
}

/// The edges of a face, through its first hex.
std::array<Index, 4> edges_of_face(const Selector& selector, Index face) {
  const Side side = selector.topology.faces().sides[face][0];
  const auto& of_hex = selector.topology.edges().of_hex[side.hex];
  std::array<Index, 4> result;
  for (int j = 0; j < 4; ++j) result[j] = of_hex[face_edge(side.face, j)];
  return result;
}

/// Calls f(entity of the lower dimension) for everything that an entity is made of.
template <class F>
void for_each_part(const Selector& selector, int dim, Index entity, int part_dim, F f) {
  const auto all = [&](const auto& parts) {
    for (const Index part : parts) f(part);
  };
  if (dim == 3 && part_dim == 0) all(selector.meshed.mesh.hexes[entity]);
  if (dim == 3 && part_dim == 1) all(selector.topology.edges().of_hex[entity]);
  if (dim == 3 && part_dim == 2) all(selector.topology.faces().of_hex[entity]);
  if (dim == 2 && part_dim == 0) all(selector.topology.faces().nodes[entity]);
  if (dim == 2 && part_dim == 1) all(edges_of_face(selector, entity));
  if (dim == 1 && part_dim == 0) all(selector.topology.edges().nodes[entity]);
}

/// Flags on entities of one dimension to flags on another.
Flags moved(const Selector& selector, const Flags& flags, int from, int to) {
  if (from == to) return flags;
  Flags result(n_entities(selector, to), 0);
  const Index n = n_entities(selector, std::max(from, to));
  for (Index i = 0; i < n; ++i) {
    if (to < from && flags[i]) for_each_part(selector, from, i, to, [&](Index part) { result[part] = 1; });
    if (to > from) for_each_part(selector, to, i, from, [&](Index part) { result[i] |= flags[part]; });
  }
  return result;
}

/// Per mesh entity of a dimension that lies on CAD of the same dimension: calls f(entity, id of the CAD entity).
template <class F>
void for_each_owned(const Selector& selector, int dim, F f) {
  const Association& association = selector.meshed.association;
  switch (dim) {
    case 0:
      for (std::size_t i = 0; i < association.node_owner.size(); ++i)
        if (association.node_owner[i].dim == 0) f(static_cast<Index>(i), association.node_owner[i].id);
      break;
    case 1:
      for (std::size_t i = 0; i < association.curve_edges.size(); ++i) {
        const auto [a, b] = association.curve_edges[i];
        if (const Index edge = find_edge(selector.topology.edges(), a, b); edge >= 0)
          f(edge, association.edge_curve[i]);
      }
      break;
    case 2:
      for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
        const Side side = association.surface_faces[i];
        f(selector.topology.faces().of_hex[side.hex][side.face], association.face_surface[i]);
      }
      break;
    default:
      for (std::size_t i = 0; i < association.hex_volume.size(); ++i)
        if (association.hex_volume[i] > 0) f(static_cast<Index>(i), association.hex_volume[i]);
  }
}

/// Calls f(mesh entity) for the members of a group or sheet.
template <class F>
void for_each_member(const Selector& selector, EntityKind kind, Index group, F f) {
  const Mesh& mesh = selector.meshed.mesh;
  switch (kind) {
    case EntityKind::block:
      for (const Index hex : mesh.blocks[group].hexes) f(hex);
      break;
    case EntityKind::nodeset:
      for (const Index node : mesh.node_sets[group].nodes) f(node);
      break;
    case EntityKind::sideset:
      for (const Side side : mesh.side_sets[group].sides) f(selector.topology.faces().of_hex[side.hex][side.face]);
      break;
    case EntityKind::sheet:
      for (const Index edge : selector.topology.sheets().edges[group]) f(edge);
      break;
    default:
      f(group);
  }
}

std::vector<Index> flagged(const Flags& flags) {
  std::vector<Index> result;
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (flags[i]) result.push_back(static_cast<Index>(i));
  return result;
}

/// Calls f(kind, positions) for each kind of which a group has members.
template <class F>
void for_each_kind_in(const Selector& selector, Index group, F f) {
  for (int k = 0; k < n_entity_kinds; ++k) {
    const auto kind = static_cast<EntityKind>(k);
    if (kind == EntityKind::group) continue;
    const std::vector<Index> inside = members(selector, selector.groups[group], kind);
    if (!inside.empty()) f(kind, inside);
  }
}

void flag_in_group(const Selector& selector, Index group, EntityKind to, Flags& result) {
  const std::vector<Index> own = members(selector, selector.groups[group], to);
  for (const Index i : own) result[i] = 1;
  if (!own.empty()) return;
  for_each_kind_in(selector, group, [&](EntityKind kind, const std::vector<Index>& inside) {
    for (const Index i : related(selector, kind, inside, to)) result[i] = 1;
  });
}

/// Does the group have one of the entities, or, having none of their kind, anything that lies in them?
bool group_touches(const Selector& selector, Index group, EntityKind from, const std::vector<Index>& positions) {
  Flags inside(count(selector, from), 0);
  flag_in_group(selector, group, from, inside);
  return std::ranges::any_of(positions, [&](Index i) { return inside[i]; });
}

}  // namespace

std::vector<Index> related(const Selector& selector, EntityKind from, const std::vector<Index>& positions,
                           EntityKind to) {
  Flags result(count(selector, to), 0);
  if (from == to) {
    for (const Index i : positions) result[i] = 1;
    return flagged(result);
  }
  if (from == EntityKind::group) {
    for (const Index group : positions) flag_in_group(selector, group, to, result);
    return flagged(result);
  }
  if (to == EntityKind::group) {
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] = group_touches(selector, static_cast<Index>(i), from, positions);
    return flagged(result);
  }
  if (is_cad(from) && is_cad(to)) {
    for (const Index i : positions) {
      for (const int id : selector.meshed.model->adjacent({dimension(from), i + 1}, dimension(to))) result[id - 1] = 1;
    }
  } else if (selector.meshed.mesh.n_hexes() > 0) {
    Flags flags(n_entities(selector, dimension(from)), 0);
    if (is_cad(from)) {
      Flags wanted(count(selector, from), 0);
      for (const Index i : positions) wanted[i] = 1;
      for_each_owned(selector, dimension(from), [&](Index entity, int id) { flags[entity] |= wanted[id - 1]; });
    } else {
      for (const Index i : positions) for_each_member(selector, from, i, [&](Index entity) { flags[entity] = 1; });
    }
    flags = moved(selector, flags, dimension(from), dimension(to));
    if (is_cad(to))
      for_each_owned(selector, dimension(to), [&](Index entity, int id) { result[id - 1] |= flags[entity]; });
    else
      for (std::size_t i = 0; i < result.size(); ++i)
        for_each_member(selector, to, static_cast<Index>(i), [&](Index entity) { result[i] |= flags[entity]; });
  }
  return flagged(result);
}

}  // namespace hextwist
