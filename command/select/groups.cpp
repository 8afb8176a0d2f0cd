#include <algorithm>

#include "hextwist/command/select/selection.h"

namespace hextwist {
namespace {

/// Position of an id that a group knows, -1 when it is gone.
Index find_member(const Selector& selector, EntityKind kind, const std::array<std::int64_t, 4>& ids) {
  const Mesh& mesh = selector.meshed.mesh;
  const auto by_id = [&](const auto& list) {
    for (std::size_t i = 0; i < list.size(); ++i)
      if (list[i].id == ids[0]) return static_cast<Index>(i);
    return Index{-1};
  };
  switch (kind) {
    case EntityKind::node:
      return find_node(mesh, ids[0]);
    case EntityKind::hex:
      return find_hex(mesh, ids[0]);
    case EntityKind::edge:
      return find_edge(selector.topology.edges(), find_node(mesh, ids[0]), find_node(mesh, ids[1]));
    case EntityKind::face: {
      Quad nodes;
      for (int k = 0; k < 4; ++k) nodes[k] = find_node(mesh, ids[k]);
      return find_face(selector.topology.faces(), nodes);
    }
    case EntityKind::block:
      return by_id(mesh.blocks);
    case EntityKind::nodeset:
      return by_id(mesh.node_sets);
    case EntityKind::sideset:
      return by_id(mesh.side_sets);
    default:
      return ids[0] <= count(selector, kind) ? static_cast<Index>(ids[0] - 1) : -1;
  }
}

}  // namespace

std::vector<Index> members(const Selector& selector, const Group& group, EntityKind kind) {
  std::vector<Index> result;
  for (const auto& ids : group.members[static_cast<int>(kind)])
    if (const Index i = find_member(selector, kind, ids); i >= 0) result.push_back(i);
  std::ranges::sort(result);
  return result;
}

std::array<std::int64_t, 4> member_of(const Selector& selector, EntityKind kind, Index position) {
  const Mesh& mesh = selector.meshed.mesh;
  std::array<std::int64_t, 4> result = {};
  if (kind == EntityKind::edge || kind == EntityKind::face) {
    for (int k = 0; k < 4; ++k)
      result[k] = node_id(mesh, kind == EntityKind::edge ? selector.topology.edges().nodes[position][k > 0]
                                                         : selector.topology.faces().nodes[position][k]);
    std::ranges::sort(result);
  } else {
    result[0] = id_of(selector, kind, position);
  }
  return result;
}

}  // namespace hextwist
