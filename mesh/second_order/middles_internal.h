// Where the middle nodes of a mesh belong, before it is one of second order.
#pragma once

#include "hextwist/mesh/second_order/second_order.h"

namespace hextwist::detail {

/// Displacements of middle nodes of edges from halfway between their ends, and of faces from the blend of their edges.
struct Displacements {
  std::vector<Owner> edge_owner, face_owner;
  std::vector<Vec3> edge, face;            ///< zero where straight
  std::vector<double> edge_far, face_far;  ///< how far the owner is where that is too far to go, else 0
  std::vector<Parameters> edge_parameters, face_parameters;
};

/// Owners of edges and faces: curve, surface, or the volume around.
void find_owners(const Mesh& mesh, const Association& association, const Edges& edges, const Faces& faces,
                 Displacements& out);
/// Puts the middles of edges on curves and surfaces there, and lets that fade inwards.
void displace_edges(const Mesh& mesh, const Association& association, const Model& model, const Edges& edges,
                    Displacements& out);
/// Puts the middles of faces on surfaces there, once the edges are known.
void displace_faces(const Mesh& mesh, const Association& association, const Model& model, const Edges& edges,
                    const Faces& faces, Displacements& out);

Vec3 halfway(const Mesh& mesh, const Edge& edge);
/// Blend of a face of a hex from its corners and the middles of its edges: middle(edge) is the place of one.
template <class Middle>
Vec3 blended(const Mesh& mesh, const Edges& edges, const Side& side, Middle&& middle) {
  Vec3 sum = Vec3::Zero();
  for (int j = 0; j < 4; ++j) {
    sum += 0.5 * middle(edges.of_hex[side.hex][face_edge(side.face, j)]);
    sum -= 0.25 * mesh.points[mesh.hexes[side.hex][face_corner(side.face, j)]];
  }
  return sum;
}

}  // namespace hextwist::detail
