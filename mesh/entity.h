// What a command can be about: mesh entities, CAD entities, sets of mesh entities, and groups of any of them.
#pragma once

#include <optional>
#include <string_view>

#include "hextwist/base/export.h"

namespace HEXTWIST_API hextwist {

/// In this order: what follows relies on it.
enum class EntityKind {
  node,     ///< of the mesh, by its id
  edge,     ///< of the mesh, by its number in edges() + 1
  face,     ///< of the mesh, by its number in faces() + 1
  hex,      ///< of the mesh, by its id
  vertex,   ///< of the CAD, or of the skin of the mesh
  curve,    ///< likewise
  surface,  ///< likewise
  volume,   ///< likewise
  block,    ///< named hexes
  nodeset,  ///< named nodes
  sideset,  ///< named sides of hexes
  sheet,    ///< of hexes: the edges that it cuts (AcrossSheets)
  group,    ///< named entities of several kinds
};
inline constexpr int n_entity_kinds = 13;  ///< values of EntityKind are 0 .. 12

/// "node", "edge", ...: the word of the language.
constexpr std::string_view name(EntityKind kind) {
  constexpr std::string_view names[n_entity_kinds] = {"node",    "edge",    "face",   "hex",   "vertex",
                                                      "curve",   "surface", "volume", "block", "nodeset",
                                                      "sideset", "sheet",   "group"};
  return names[static_cast<int>(kind)];
}
/// The kind with exactly this name.
constexpr std::optional<EntityKind> entity_kind(std::string_view word) {
  for (int k = 0; k < n_entity_kinds; ++k)
    if (word == name(static_cast<EntityKind>(k))) return static_cast<EntityKind>(k);
  return std::nullopt;
}
/// "nodes", "edges", ..., "vertices", "hexes".
constexpr std::string_view plural(EntityKind kind) {
  constexpr std::string_view names[n_entity_kinds] = {"nodes",    "edges",    "faces",   "hexes",  "vertices",
                                                      "curves",   "surfaces", "volumes", "blocks", "nodesets",
                                                      "sidesets", "sheets",   "groups"};
  return names[static_cast<int>(kind)];
}

/// May its entities have names?
constexpr bool has_names(EntityKind kind) {
  return (kind >= EntityKind::vertex && kind <= EntityKind::sideset) || kind == EntityKind::group;
}
/// Is it part of the mesh itself: node, edge, face or hex?
constexpr bool is_mesh(EntityKind kind) {
  return kind <= EntityKind::hex;
}
/// Is it part of the model: vertex, curve, surface or volume?
constexpr bool is_cad(EntityKind kind) {
  return kind >= EntityKind::vertex && kind <= EntityKind::volume;
}

/// Dimension of the mesh entities that an entity of this kind stands for: a block for hexes, a side set for faces, a
/// sheet for the edges that it cuts. A group stands for entities of several kinds: -1.
constexpr int dimension(EntityKind kind) {
  constexpr int dimensions[n_entity_kinds] = {0, 1, 2, 3, 0, 1, 2, 3, 3, 0, 2, 1, -1};
  return dimensions[static_cast<int>(kind)];
}

}  // namespace hextwist
