// Hands everything that was known of an old mesh on to its refinement: ids, blocks, sets, fields, association.
#pragma once

#include "hextwist/mesh/association/association.h"
#include "hextwist/refine/split.h"

namespace hextwist {

/// The refined mesh with its new nodes at their template places in straight-sided parents, and its association, new
/// nodes without parameters.
///
/// Guarantees:
///  1. children of a hex belong to its blocks and its volume; they have its values of hex fields;
///  2. children of a side belong to its side sets; children of a face on surface 7, their new edges and their inner
///     nodes are on surface 7; children of an edge on curve 3 are on curve 3;
///  3. a new node belongs to a node set by the rule of node_sets.h; nodal fields are interpolated (linear, bilinear,
///     trilinear), those of whole numbers taken from the nearest;
///  4. ids: old ones stay, new ones follow the highest old one in array order.
/// old_association may be empty; the result's then is too. The split is consumed: its hexes move into the mesh.
struct Carried {
  Mesh mesh;
  Association association;
};
Carried carry(const Mesh& old_mesh, const Association& old_association, Split& split);

/// Values per old node, and what the new nodes have as these do of nodal fields.
std::vector<Vec3> carried_points(const std::vector<Vec3>& of_old_nodes, const Mesh& old_mesh, const Split& split);

}  // namespace hextwist
