// A model made of the skin of a mesh, for meshes that have no CAD: the same interface, facets instead of splines.
//
// A facet is the bilinear patch of a quad, not a pair of triangles: corners, edges and all points where a refinement
// puts the children of the quad lie exactly on it, and areas and volumes are those of the trilinear hexes.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "hextwist/geom/model.h"

namespace hextwist {

/// Which piece of the facet model each piece of the skin became.
struct FacetClassification {
  std::vector<int> quad_surface;                   ///< per quad: surface id
  std::vector<std::array<std::int32_t, 2>> edges;  ///< feature edges (a < b), lexicographic
  std::vector<int> edge_curve;                     ///< per feature edge: curve id
  std::vector<std::int32_t> vertex_nodes;          ///< per vertex id - 1: node
};

/// How the skin is divided, when that is known: from a program that tags its elements, say.
struct FacetLabels {
  std::span<const int> quads;                          ///< per quad
  std::span<const std::array<std::int32_t, 2>> edges;  ///< on curves: (a < b), lexicographic
  std::span<const int> edge_labels;                    ///< per edge
  std::span<const std::int32_t> vertices;              ///< nodes, ascending
};

/// Middles of edges and faces, for skins of hexes of second order. Those that are not named are straight, and faces
/// what their edges say.
struct FacetMiddles {
  std::span<const std::array<std::int32_t, 2>> edges;  ///< (a < b), lexicographic
  std::span<const Vec3> edge_points;                   ///< per edge
  std::span<const std::array<std::int32_t, 4>> faces;  ///< nodes ascending, lexicographic
  std::span<const Vec3> face_points;                   ///< per face

  Vec3 middle(std::span<const Vec3> points, std::int32_t a, std::int32_t b) const;
};

struct FacetModelOptions {
  /// An edge whose two quads' normals differ by more than this is a feature, a node where two features turn by more
  /// is a vertex. Degrees, 0..180.
  double feature_angle = 35;
  /// Instead of angles: features are where the quads' labels differ and the labelled edges, vertices where edges'
  /// labels change and the labelled ones, besides what features and vertices are in any case. Null: by angles.
  const FacetLabels* labels = nullptr;
  /// The skin is curved: facets are biquadratic patches, curves quadratic between nodes, angles those of their normals
  /// and tangents. Null: straight.
  const FacetMiddles* middles = nullptr;
};

struct FacetImport {
  std::shared_ptr<const Model> model;
  FacetClassification classification;
};

/// points: all nodes of the mesh. quads: its skin and the interfaces between its volumes, each once, corners in
/// cyclic order, seen from outside counter-clockwise with respect to quad_volumes[i][0].
/// quad_volumes: per quad the volume behind it and the one in front (0: none); 1-based, contiguous.
/// Features: edges at an angle, edges where more or fewer than two quads meet, edges between quads with different
/// volumes. Vertices: nodes where other than two features meet, where two meet at an angle or the surfaces beside
/// them change, where two parts of the skin touch in the node alone, and cone tips.
/// Surfaces are numbered by their first quad, curves by their lowest edge, vertices by their node.
///
/// Curves are straight between nodes; their parameter is the arc length, from the end from which their lowest edge
/// runs to its higher node. Closed curves are periodic, whether they have a vertex (where they start) or not (they
/// start at their lowest node). Surface parameters: u = 2 * facet + s, v = t with s, t in [0, 1] on the facet.
/// With middles all of that holds of the curved facets; the parameter of a curve is its length up to a node, between
/// nodes it goes on evenly in the parameter of the segment. Types: "quadratic curve", "quadratic facets".
/// Types: "vertex", "polyline", "facets", "volume"; tolerance() is 0; names are "".
/// project() is global with and without seeds: a seed only makes it faster, so one that is far off does no harm.
/// Throws Error when the angle is out of range.
FacetImport facet_model(std::span<const Vec3> points, std::span<const std::array<std::int32_t, 4>> quads,
                        std::span<const std::array<int, 2>> quad_volumes, const FacetModelOptions& options = {});

/// What a skin was made of: from the same, the same model is made, bit for bit. Positions are those among `points`.
struct FacetSource {
  std::vector<Vec3> points;  ///< of nodes of the skin, in the order of the mesh
  std::vector<std::array<std::int32_t, 4>> quads;
  std::vector<std::array<int, 2>> quad_volumes;
  double feature_angle = 35;
  bool has_labels = false;
  std::vector<int> quad_labels;
  std::vector<std::array<std::int32_t, 2>> labelled_edges;
  std::vector<int> edge_labels;
  std::vector<std::int32_t> labelled_vertices;
  bool has_middles = false;
  std::vector<std::array<std::int32_t, 2>> middle_edges;
  std::vector<Vec3> edge_points;
  std::vector<std::array<std::int32_t, 4>> middle_faces;
  std::vector<Vec3> face_points;
};
/// Null where the model is none of facets.
const FacetSource* facet_source(const Model& model);
/// Throws Error where positions are none of the points or lengths differ.
FacetImport facet_model(const FacetSource& source);

}  // namespace hextwist
