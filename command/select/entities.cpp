// The entities of a session by kind: how many there are, and what users call them.
#include "hextwist/command/select/selection.h"

namespace hextwist {

const Edges& DerivedTopology::edges() {
  if (!edges_) edges_ = hextwist::edges(mesh_);
  return *edges_;
}
const Faces& DerivedTopology::faces() {
  if (!faces_) faces_ = hextwist::faces(mesh_);
  return *faces_;
}
const Sheets& DerivedTopology::sheets() {
  if (!sheets_) sheets_ = hextwist::sheets(mesh_, edges());
  return *sheets_;
}

Index count(const Selector& selector, EntityKind kind) {
  const auto& [meshed, topology, groups] = selector;
  if (kind == EntityKind::group) return static_cast<Index>(groups.size());
  if (is_cad(kind)) return meshed.model ? meshed.model->count(dimension(kind)) : 0;
  if (meshed.mesh.n_hexes() == 0) return 0;
  switch (kind) {
    case EntityKind::node:
      return meshed.mesh.n_nodes();
    case EntityKind::edge:
      return static_cast<Index>(topology.edges().nodes.size());
    case EntityKind::face:
      return static_cast<Index>(topology.faces().nodes.size());
    case EntityKind::hex:
      return meshed.mesh.n_hexes();
    case EntityKind::block:
      return static_cast<Index>(meshed.mesh.blocks.size());
    case EntityKind::nodeset:
      return static_cast<Index>(meshed.mesh.node_sets.size());
    case EntityKind::sideset:
      return static_cast<Index>(meshed.mesh.side_sets.size());
    default:
      return topology.sheets().edges.size();
  }
}

std::int64_t id_of(const Selector& selector, EntityKind kind, Index position) {
  const Mesh& mesh = selector.meshed.mesh;
  switch (kind) {
    case EntityKind::node:
      return node_id(mesh, position);
    case EntityKind::hex:
      return hex_id(mesh, position);
    case EntityKind::block:
      return mesh.blocks[position].id;
    case EntityKind::nodeset:
      return mesh.node_sets[position].id;
    case EntityKind::sideset:
      return mesh.side_sets[position].id;
    case EntityKind::group:
      return selector.groups[position].id;
    default:
      return std::int64_t{position} + 1;
  }
}

std::string name_of(const Selector& selector, EntityKind kind, Index position) {
  const Mesh& mesh = selector.meshed.mesh;
  if (is_cad(kind)) return selector.meshed.model->name({dimension(kind), position + 1});
  switch (kind) {
    case EntityKind::block:
      return mesh.blocks[position].name;
    case EntityKind::nodeset:
      return mesh.node_sets[position].name;
    case EntityKind::sideset:
      return mesh.side_sets[position].name;
    case EntityKind::group:
      return selector.groups[position].name;
    default:
      return "";
  }
}

}  // namespace hextwist
