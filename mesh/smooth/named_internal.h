// What the user named keeps its shape when nodes move: faces inside the mesh that bound blocks or belong to side sets
// and node sets, and lines and points of node sets, where no CAD entity owns them already.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "hextwist/mesh/smooth/smooth.h"

namespace hextwist {

/// Directions in which a node must not move: unit vectors at right angles to each other. One: it slides in a plane,
/// two: along a line, three: it stays.
struct Hold {
  int n = 0;
  std::array<Vec3, 3> normal = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};

  /// One direction more, unless it lies within those there are (sine of the angle below 1e-5: coordinates of files).
  void add(const Vec3& direction);
};

struct Holds {
  std::vector<Index> of_node;  ///< per node of the mesh: position in `list`, -1: none; empty: no node has one
  std::vector<Hold> list;
};

/// Of the nodes that may move (one byte per node). Named are
///  - faces between hexes of different blocks (any of overlapping ones; hexes of no block count as one), and between
///    different values of the hex fields keep_jumps;
///  - faces with a hex on both sides in a side set; those whose four nodes are in a node set, unless all nodes of the
///    hexes on both sides are;
///  - edges between nodes of a node set that lie on no such face and in no such hex; other nodes of it stay;
///  - edges at which a side set on the CAD ends within a surface.
/// Faces and nodes on entities of the association are left to these, but a node there that a named face reaches is held
/// by it too. Where such faces lie in one plane around a node it may slide there, where they meet at an angle along the
/// line, at their rim along the rim; where that bends it stays.
Holds named_holds(const Mesh& mesh, const Association& association, std::span<const std::uint8_t> may_move,
                  std::span<const std::string> keep_jumps = {});

}  // namespace hextwist
