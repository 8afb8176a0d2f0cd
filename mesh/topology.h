// Edges, faces and incidences of a mesh, derived on demand.
//
// Guarantees:
//  1. edges are sorted by (lower node, higher node), faces by (lowest node, diagonal node, lower neighbour), so their
//     numbers depend on the mesh alone, not on threads; a user's edge and face ids are these numbers + 1;
//  2. a face is stored with its nodes in bit-frame order of its first hex (the lowest index), see corners.h;
//  3. every list is flat: the items of x are items[first[x]] .. items[first[x + 1]].
#pragma once

#include <array>
#include <span>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace HEXTWIST_API hextwist {

using Edge = std::array<Index, 2>;  ///< nodes, lower first
using Quad = std::array<Index, 4>;  ///< nodes; bit frame or cycle, as the context says

/// Lists of varying length in two arrays.
struct CompressedRows {
  std::vector<Index> first;  ///< n + 1
  std::vector<Index> items;  ///< of all lists, one after the other
  /// List i of 0 .. size() - 1; valid while the arrays are left alone.
  std::span<const Index> operator[](Index i) const {
    return {items.data() + first[i], static_cast<std::size_t>(first[i + 1] - first[i])};
  }
  /// Number of lists.
  Index size() const { return static_cast<Index>(first.size()) - 1; }
};

/// All edges of a mesh, each once.
struct Edges {
  std::vector<Edge> nodes;                    ///< per edge, sorted
  std::vector<std::array<Index, 12>> of_hex;  ///< per hex: edges in the order of corners.h
  std::vector<Index> first_of_node;           ///< n_nodes + 1: edges whose lower node is i
};
/// All faces of a mesh, each once.
struct Faces {
  std::vector<Quad> nodes;                   ///< per face, bit frame of sides[face][0]
  std::vector<std::array<Side, 2>> sides;    ///< per face: its one or two hexes (hex -1: none)
  std::vector<std::array<Index, 6>> of_hex;  ///< per hex: faces in the order of corners.h
  std::vector<Index> first_of_node;          ///< n_nodes + 1: faces whose lowest node is i
};

/// The edges of a mesh. Throws Error naming the first hex that names a node that does not exist. Hexes may otherwise be
/// as bad as they like (a node named twice, ...): what such a mesh gives is deterministic.
Edges edges(const Mesh& mesh);
/// The faces of a mesh. Throws as edges(), and Error naming three hexes when they share one face.
Faces faces(const Mesh& mesh);

/// Edge between two nodes, in any order; -1 when there is none. Any integers may be asked for.
Index find_edge(const Edges& edges, Index a, Index b);
/// Face with four nodes, in any order; -1 when there is none. Any integers may be asked for.
Index find_face(const Faces& faces, const Quad& nodes);

/// Hexes around each node, ascending (a hex that names a node twice stands twice). Throws as edges().
CompressedRows node_hexes(const Mesh& mesh);
/// Hexes around each edge, ascending (a hex that names a node twice may stand twice).
CompressedRows edge_hexes(const Edges& edges, Index n_hexes);

/// Sides with no hex behind them, ascending by (hex, face).
std::vector<Side> boundary_sides(const Faces& faces);

/// The sides that these quads (any corner order) are, one per quad: the side of the hex with the lower index where
/// there are two; hex -1 where no hex has such a face.
std::vector<Side> find_sides(const Mesh& mesh, std::span<const Quad> quads);

}  // namespace hextwist
