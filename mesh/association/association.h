// Which CAD entity owns each node, boundary edge and boundary face of a mesh.
//
// Nodes alone are not enough: an edge whose two ends lie on one curve may be a chord across a thin part.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "hextwist/geom/model.h"
#include "hextwist/mesh/second_order/middle_nodes.h"
#include "hextwist/mesh/topology.h"

namespace HEXTWIST_API hextwist {

/// Who owns what. Guarantees of a complete association (one made by associate() or carried through a refinement):
///  1. every node of a hex has an owner; nodes inside a volume are owned by it; nodes of no hex have no owner;
///  2. curve_edges are exactly the mesh edges that lie on curves; every node of one is owned by the curve or by a
///     vertex of it;
///  3. surface_faces are exactly the boundary faces, the faces between different volumes, and those inside a volume
///  that
///     lie on a surface embedded in it; every node of one is owned by the surface, a curve or a vertex of it. A face
///     with hexes on both sides stands once, as a side of the hex with the lower index;
///  4. parameters of a node on a curve (t) or surface (u, v) give its point.
/// One read from a file may be partial (nodes without owner, short lists).
struct Association {
  std::vector<Owner> node_owner;            ///< per node
  std::vector<Parameters> node_parameters;  ///< per node; NaN where unknown or not on a curve or surface
  std::vector<Edge> curve_edges;            ///< lower node first; ascending
  std::vector<int> edge_curve;              ///< per curve edge: curve id
  std::vector<Side> surface_faces;          ///< ascending
  std::vector<int> face_surface;            ///< per surface face: surface id
  std::vector<int> hex_volume;              ///< per hex: volume id, 0 unknown

  /// Is nothing known of any node?
  bool empty() const { return node_owner.empty(); }
};

/// How associate() looks for owners.
struct AssociateOptions {
  /// A boundary node may lie this far from its entity, relative to the model size; farther where the CAD's own pieces
  /// do (Model::tolerance). Elements may be smaller than that.
  double relative_tolerance = 1e-5;
  /// Start from the tags in the file where it has them.
  bool use_tags = true;
  /// Of the mesh, where they are known already.
  const Faces* faces = nullptr;
};

/// The association and what was noticed while it was made, one line each: tags that name no entity, tags that the
/// geometry contradicts and that were replaced (count and first), entities that got no part of the mesh, volumes that
/// differ by more than a tenth from those of their hexes.
struct AssociateResult {
  Association association;           ///< complete
  std::vector<std::string> notices;  ///< empty: there was nothing to notice
  double max_distance = 0;           ///< largest distance of a boundary node from its owner, model units
  Index worst_node = -1;             ///< the node that far away; -1: there is no boundary node
};

/// Builds a complete association of a valid mesh with a model, from tags that are checked against the geometry, or
/// from geometry alone (docs/design.md). tags may be null or partial; they never decide against the geometry, so
/// that files whose tags follow another numbering give the same result. The rules:
///  - faces: on the surface that all four corners lie on; of several, the nearest to corners and centre with the
///    same normal;
///  - volumes: interior faces that lie on surfaces between volumes divide the mesh; the surfaces around a part tell
///    which volume it is;
///  - edges between different surfaces: on a curve that bounds them all, the nearest to ends and middle. Edges within
///    one surface: on its seam if both ends are and the seam stays with the edge in between; a mesh need not follow
///    seams;
///  - nodes: a vertex owns the nearest node within tolerance, if the vertex bounds all curves and surfaces there; other
///    nodes are owned by their curve edge, else their surface face, else their volume.
/// Throws Error when
///  - the mesh does not lie on the model: names the worst node, its distance, the nearest surface, and mixed-up units
///    or a displacement where the boxes say so;
///  - the mesh does not follow the surfaces between volumes, the curves, or the vertices between curves; for volumes
///    that share no surface (STEP) it asks for the CAD to be glued.
AssociateResult associate(const Mesh& mesh, const Model& model, const Association* tags,
                          const AssociateOptions& options = {});
/// From geometry alone.
inline AssociateResult associate(const Mesh& mesh, const Model& model, const AssociateOptions& options = {}) {
  return associate(mesh, model, nullptr, options);
}

/// A facet model of a mesh's own skin, and the association with it.
struct FacetResult {
  std::shared_ptr<const Model> model;  ///< never null; it keeps copies of what it needs of the mesh
  Association association;             ///< complete
};
/// How the skin is divided into surfaces, curves and vertices.
struct SkinOptions {
  double feature_angle = 35;          ///< degrees, 0..180: an edge at which faces turn by more is on a curve
  const Association* tags = nullptr;  ///< lists ascending, as in a complete association; null: by angle and blocks
  /// The skin is curved: through these. Null, or where all lie halfway: straight.
  const MiddleNodes* middles = nullptr;
  /// Of the mesh, where they are known already.
  const Faces* faces = nullptr;
};
/// The mesh's skin as its model. Volumes: the blocks where they partition the mesh, in the blocks' order, else one.
/// With tags the skin is divided as they say instead of by angle and blocks: by the tags of hexes, of faces (0 where
/// there is none), of edges and of nodes on vertices; ids are those of the facet model, volumes in ascending order of
/// their tags. Throws Error for a mesh without hexes and an angle out of range.
FacetResult associate_with_own_skin(const Mesh& mesh, const SkinOptions& options = {});

/// Owner of a node; no owner where the association has none.
Owner owner_of_node(const Association& association, Index node);
/// Curve if the edge lies on one, else the surface of its boundary faces, else the volume. Linear in the boundary.
Owner owner_of_edge(const Association& association, const Mesh& mesh, const Edges& edges, const Faces& faces,
                    Index edge);
/// Surface if the face lies on one, else the volume of its hexes. Logarithmic.
Owner owner_of_face(const Association& association, const Faces& faces, Index face);
/// Nodes whose owner is the entity. Ascending.
std::vector<Index> nodes_owned_by(const Association& association, Owner entity);
/// The same and those of the entities that bound it (a surface's curves and vertices). Ascending.
std::vector<Index> nodes_on(const Association& association, const Model& model, Owner entity);

/// Distance of boundary nodes (owners of dimension 0..2) from their owners.
struct OffModel {
  double max = 0;           ///< model units
  double max_relative = 0;  ///< divided by the model size
  Index node = -1;          ///< the worst, -1 when no node is on the boundary
  Owner owner;              ///< of the worst
};
/// Looks at all nodes that a vertex, curve or surface owns. Entities have to exist in the model.
OffModel off_model(const Mesh& mesh, const Association& association, const Model& model);

/// A node that is not where its owner is.
struct OffOwner {
  Index node = -1;      ///< 0-based
  Owner owner;          ///< where it should be
  double distance = 0;  ///< from the owner, model units
};

/// Every broken promise of a complete association (see above), one line each.
std::vector<std::string> check_association(const Mesh& mesh, const Association& association, const Model& model);

}  // namespace hextwist
