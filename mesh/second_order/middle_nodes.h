// The middle nodes of a second-order mesh as geometry: where the middle of an edge and of a face lies.
//
// They are known by the corners around them, so that hexes may be renumbered or turned. Those of a file that was read
// are the shape of a mesh that has no CAD (association.h); they are made anew when a mesh is written (second_order.h).
#pragma once

#include <array>
#include <vector>

#include "hextwist/mesh/topology.h"

namespace HEXTWIST_API hextwist {

/// Middles of edges and faces by the corners around them. Nothing is said of those that are not listed.
struct MiddleNodes {
  int nodes_per_hex = 8;    ///< 8: there are none; 20: of edges; 27: of edges, faces and hexes (those are not kept)
  std::vector<Edge> edges;  ///< lower node first; ascending
  std::vector<Vec3> edge_points;  ///< per edge, model units
  std::vector<Quad> faces;        ///< nodes ascending; ascending
  std::vector<Vec3> face_points;  ///< per face, model units

  /// Is no middle known?
  bool empty() const { return edges.empty() && faces.empty(); }
};

/// Nodes of a face as MiddleNodes::faces has them.
Quad ascending(Quad nodes);

}  // namespace hextwist
