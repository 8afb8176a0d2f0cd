// A mesh with middle nodes: hexes of 20 or 27 nodes, made from hexes of 8 on their model when somebody wants them.
//
// Middle nodes of edges on curves and surfaces, and of faces on surfaces, are put on those. The displacement fades into
// the mesh along parallel edges, so that thin layers at a curved boundary bend with it; faces and centres inside are
// blended from their edges (transfinite). Where a hex would not be positive everywhere (jacobian.h), its middle nodes
// are moved towards the straight places until it is: by a half, by three quarters, all the way.
//
// Guarantees:
//  1. corners are those of the mesh, and so are their numbers; middle nodes follow behind: of edges in the order of
//     edges(), then of faces() and of hexes where hexes have 27 nodes;
//  2. every hex that is not straight has a Jacobian that is positive everywhere;
//  3. a mesh on straight edges and plane faces gets exactly the straight middles.
#pragma once

#include <span>
#include <string>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/meshed_model.h"
#include "hextwist/mesh/second_order/jacobian.h"
#include "hextwist/mesh/second_order/middle_nodes.h"
#include "hextwist/mesh/topology.h"

namespace HEXTWIST_API hextwist {

struct SecondOrder {
  int nodes_per_hex = 20;  ///< or 27
  /// With the middle nodes among its points, node sets (those that have all corners around them) and nodal fields (the
  /// mean of those corners); hexes are named by their corners.
  Mesh mesh;
  Association association;  ///< the same, with owners of the middle nodes
  Index n_corners = 0;
  Edges edges;
  Faces faces;
  // What was straightened.
  std::vector<Index> straightened;  ///< hexes, ascending
  Index n_off = 0;                  ///< middle nodes that are off the curve or surface that owns them
  Index worst = -1;                 ///< the farthest of them
  double farthest = 0;              ///< its distance, model units

  Index edge_middle(Index edge) const { return n_corners + edge; }
  Index face_middle(Index face) const { return n_corners + static_cast<Index>(edges.nodes.size()) + face; }
  Index hex_middle(Index hex) const { return face_middle(static_cast<Index>(faces.nodes.size())) + hex; }
  /// Of the edge between two corners; of the face of four, in any order. -1 where there is none.
  Index middle_between(Index a, Index b) const;
  Index middle_of(const Quad& corners) const;
  /// Middle nodes of a hex: 12 edges, 6 faces, itself, in the order of corners.h.
  std::array<Index, 19> middles(Index hex) const;
};

/// nodes_per_hex: 20 or 27. Without an association, or a model, all is straight.
SecondOrder second_order(const Mesh& mesh, const Association& association, const Model* model, int nodes_per_hex);

/// Where its middles are, by corners. And those of a mesh on a curved skin, of its boundary: for a skin of its own
/// elsewhere; nothing where the model is no curved skin.
MiddleNodes middle_nodes(const SecondOrder& mesh);
MiddleNodes skin_middles(const MeshedModel& meshed);

/// What was straightened in one line; empty where nothing was.
std::string straightened_text(const SecondOrder& mesh);

/// A hex of it, for jacobian.h.
QuadraticHex quadratic_hex(const SecondOrder& mesh, Index hex);

/// Places of the middles of edges and faces (corners.h) in a QuadraticHex, and of corners.
constexpr int quadratic_corner(int c) {
  return 2 * (c & 1) + 6 * (c >> 1 & 1) + 18 * (c >> 2 & 1);
}
constexpr int quadratic_edge(int edge) {
  return (quadratic_corner(edge_corner(edge, 0)) + quadratic_corner(edge_corner(edge, 1))) / 2;
}
constexpr int quadratic_face(int face) {
  return (quadratic_corner(face_corner(face, 0)) + quadratic_corner(face_corner(face, 3))) / 2;
}
inline constexpr int quadratic_centre = 13;

}  // namespace hextwist
