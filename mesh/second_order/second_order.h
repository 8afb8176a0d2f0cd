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

/// A mesh of second order: made by second_order(), kept in no session.
struct SecondOrder {
  int nodes_per_hex = 20;  ///< or 27
  /// With the middle nodes among its points, node sets (those that have all corners around them) and nodal fields (the
  /// mean of those corners); hexes are named by their corners.
  Mesh mesh;
  Association association;  ///< the same, with owners of the middle nodes
  Index n_corners = 0;      ///< nodes below this are those of the mesh of first order, the others are middles
  Edges edges;              ///< of the mesh of first order
  Faces faces;              ///< of the mesh of first order
  // What was straightened.
  std::vector<Index> straightened;  ///< hexes, ascending
  Index n_off = 0;                  ///< middle nodes that are off the curve or surface that owns them
  Index worst = -1;                 ///< the farthest of them
  double farthest = 0;              ///< its distance, model units

  /// The middle node of an edge, by its number in `edges`.
  Index edge_middle(Index edge) const { return n_corners + edge; }
  /// The middle node of a face, by its number in `faces`; with 27 nodes per hex only.
  Index face_middle(Index face) const { return n_corners + static_cast<Index>(edges.nodes.size()) + face; }
  /// The middle node of a hex; with 27 nodes per hex only.
  Index hex_middle(Index hex) const { return face_middle(static_cast<Index>(faces.nodes.size())) + hex; }
  /// The middle node of the edge between two corners, in any order; -1 where there is no edge.
  Index middle_between(Index a, Index b) const;
  /// The middle node of the face of four corners, in any order; -1 where there is no face. With 27 nodes per hex only.
  Index middle_of(const Quad& corners) const;
  /// Middle nodes of a hex: 12 edges, 6 faces, itself, in the order of corners.h. With 20 nodes per hex the first 12
  /// alone exist.
  std::array<Index, 19> middles(Index hex) const;
};

/// nodes_per_hex: 20 or 27. Without an association, or a model, all is straight.
SecondOrder second_order(const Mesh& mesh, const Association& association, const Model* model, int nodes_per_hex);

/// Where its middles are, by corners.
MiddleNodes middle_nodes(const SecondOrder& mesh);
/// Middles of the boundary of a mesh on a curved skin: for a skin of its own elsewhere. Empty where the model is no
/// curved skin.
MiddleNodes skin_middles(const MeshedModel& meshed);

/// What was straightened in one line; empty where nothing was.
std::string straightened_text(const SecondOrder& mesh);

/// A hex of it, for jacobian.h.
QuadraticHex quadratic_hex(const SecondOrder& mesh, Index hex);

/// Place of corner c (0 .. 7, corners.h) in a QuadraticHex.
constexpr int quadratic_corner(int c) {
  return 2 * (c & 1) + 6 * (c >> 1 & 1) + 18 * (c >> 2 & 1);
}
/// Place of the middle of an edge (0 .. 11, corners.h) in a QuadraticHex.
constexpr int quadratic_edge(int edge) {
  return (quadratic_corner(edge_corner(edge, 0)) + quadratic_corner(edge_corner(edge, 1))) / 2;
}
/// Place of the middle of a face (0 .. 5, corners.h) in a QuadraticHex.
constexpr int quadratic_face(int face) {
  return (quadratic_corner(face_corner(face, 0)) + quadratic_corner(face_corner(face, 3))) / 2;
}
inline constexpr int quadratic_centre = 13;  ///< place of the middle of the hex in a QuadraticHex

}  // namespace hextwist
