// Which new nodes join a node set.
#pragma once

#include <vector>

#include "hextwist/mesh/association/association.h"
#include "hextwist/refine/split.h"

namespace hextwist {

/// Per node set its nodes after a refinement, ascending. A new node joins a set where the edge, face or hex that it
/// splits (or a face or hex around that edge or face) is part of the set. Part of it is one that has all its nodes in
/// the set and
///  1. lies on a curve or surface, or in a volume, that the set is meant to hold (mesh/association/meant.h); or
///  2. has a node that its curve, surface or volume owns itself: the set then covers a part of that entity. An edge
///     within a volume that leaves a surface along which the set goes on is none of those: it leads across the solid,
///     and is in the set where a whole face or hex is.
/// Without an association: all nodes are in the set. now: of the refined mesh, owners of nodes filled in.
std::vector<std::vector<Index>> carried_node_sets(const Mesh& old_mesh, const Association& old, const Split& split,
                                                  const Association& now);

}  // namespace hextwist
