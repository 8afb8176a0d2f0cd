// A mesh elsewhere, and parts of a mesh.
#pragma once

#include <span>

#include "hextwist/geom/similarity.h"
#include "hextwist/mesh/meshed_model.h"

namespace hextwist {

/// Where a side or corner is in the order of corners after move() with a mirror, which swaps the ends of the last axis.
constexpr int mirrored_face(int face) {
  return face >= 4 ? face ^ 1 : face;
}
constexpr int mirrored_corner(int corner) {
  return corner ^ 4;
}

/// Moves all nodes. A mirror turns the hexes right again; side sets stay the same sides. Fields stay as they are.
void move(Mesh& mesh, const Similarity& similarity);
/// The lists of an association of that mesh. Parameters of nodes are not known afterwards.
void move(Association& association, const Similarity& similarity);

/// These hexes (ascending) with their nodes, ids and owners, and of blocks, sets and fields what belongs to them;
/// groups of which nothing is left are left out. `results` goes on with them.
MeshedModel part_of(const MeshedModel& meshed, std::span<const Index> hexes);

}  // namespace hextwist
