// Which CAD entity owns each node, boundary edge and boundary face of a mesh.
//
// Nodes alone are not enough: an edge whose two ends lie on one curve may be a chord across a thin part.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "hextwist/geom/model.h"
#include "hextwist/mesh/topology.h"

namespace hextwist {

/// Guarantees of a complete association (one made by associate() or carried through a refinement):
///  1. every node has an owner; nodes inside a volume are owned by it;
///  2. curve_edges are exactly the mesh edges that lie on curves; every node of one is owned by the curve or by a
///     vertex of it;
///  3. surface_faces are exactly the boundary faces and the faces between different volumes; every node of one is
///     owned by the surface, a curve or a vertex of it. A face between two volumes stands once, as a side of the hex
///     with the lower index;
///  4. parameters of a node on a curve (t) or surface (u, v) give its point.
/// One read from a file may be partial (owner "nobody", lists short).
struct Association {
  std::vector<Owner> node_owner;            ///< per node
  std::vector<Parameters> node_parameters;  ///< per node; NaN where unknown or not on a curve or surface
  std::vector<Edge> curve_edges;            ///< lower node first; ascending
  std::vector<int> edge_curve;              ///< per curve edge: curve id
  std::vector<Side> surface_faces;          ///< ascending
  std::vector<int> face_surface;            ///< per surface face: surface id
  std::vector<int> hex_volume;              ///< per hex: volume id, 0 unknown

  bool empty() const { return node_owner.empty(); }
};

struct AssociateOptions {
  /// A boundary node may lie this far from its entity, relative to the model size.
  double relative_tolerance = 1e-5;
  /// Start from the tags in the file where it has them.
  bool use_tags = true;
};

/// The association and what was noticed while it was made (tags that were wrong or missing and were rebuilt: counts
/// and first ids), one line each.
struct AssociateResult {
  Association association;
  std::vector<std::string> notices;
  double max_distance = 0;  ///< largest distance of a boundary node from its owner, model units
  Index worst_node = -1;
};

/// Builds a complete association of a valid mesh with a model, from tags that are checked against the geometry, or
/// from geometry alone (boundary faces to surfaces by point and normal, edges between different surfaces to curves,
/// corners to vertices; DESIGN section 4). tags may be null or partial.
/// Throws Error naming the worst node, its distance and the entity when the mesh does not lie on the model.
AssociateResult associate(const Mesh& mesh, const Model& model, const Association* tags,
                          const AssociateOptions& options = {});

/// A facet model of the mesh's own skin, and the association with it. Volumes: the blocks where they partition the
/// mesh, else one.
struct FacetResult {
  std::shared_ptr<const Model> model;
  Association association;
};
struct SkinOptions {
  double feature_angle = 35;  ///< degrees
};
FacetResult associate_with_own_skin(const Mesh& mesh, const SkinOptions& options = {});

/// Owner queries both ways. what: 0 nodes, 1 edges, 2 faces, 3 hexes.
Owner owner_of_node(const Association& association, Index node);
/// Curve if the edge lies on one, else the surface of its boundary faces, else the volume.
Owner owner_of_edge(const Association& association, const Mesh& mesh, const Edges& edges, const Faces& faces,
                    Index edge);
Owner owner_of_face(const Association& association, const Faces& faces, Index face);
/// Nodes whose owner is the entity; with closure also those of the entities that bound it (a surface's curves and
/// vertices). Ascending.
std::vector<Index> nodes_owned_by(const Association& association, Owner entity);
std::vector<Index> nodes_on(const Association& association, const Model& model, Owner entity);

/// Distance of boundary nodes (owners of dimension 0..2) from their owners.
struct OffModel {
  double max = 0;           ///< model units
  double max_relative = 0;  ///< divided by the model size
  Index node = -1;          ///< the worst, -1 when no node is on the boundary
  Owner owner;
};
OffModel off_model(const Mesh& mesh, const Association& association, const Model& model);

/// Every broken promise of a complete association (see above), one line each.
std::vector<std::string> check_association(const Mesh& mesh, const Association& association, const Model& model);

}  // namespace hextwist
