// Blocks, node sets and side sets as lists of their own.
#pragma once

#include "hextwist/mesh/entity.h"
#include "hextwist/mesh/mesh.h"

namespace hextwist {

inline Mesh lists_of(const Mesh& mesh) {
  Mesh lists;
  lists.blocks = mesh.blocks;
  lists.node_sets = mesh.node_sets;
  lists.side_sets = mesh.side_sets;
  return lists;
}

/// Calls f with the list of groups of a kind and their members (a pointer to member).
template <class F>
auto with_groups(Mesh& lists, EntityKind kind, F f) {
  switch (kind) {
    case EntityKind::block:
      return f(lists.blocks, &Block::hexes);
    case EntityKind::nodeset:
      return f(lists.node_sets, &NodeSet::nodes);
    default:
      return f(lists.side_sets, &SideSet::sides);
  }
}

}  // namespace hextwist
