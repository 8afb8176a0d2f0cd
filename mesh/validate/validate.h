// Is this a mesh at all? Finds every violation, names them by id.
#pragma once

#include <string>
#include <vector>

#include "hextwist/mesh/topology.h"

namespace HEXTWIST_API hextwist {

/// The later kinds are looked for among sound hexes only, those on eight different nodes that exist, each once; so one
/// defect is not told several times over. Geometric kinds leave out nodes that are not finite.
enum class ViolationKind {
  bad_index,       ///< a hex names a node that does not exist
  not_finite,      ///< a coordinate is NaN or infinite
  repeated_node,   ///< a hex names a node twice
  duplicate_hex,   ///< hexes on the same eight nodes
  duplicate_node,  ///< nodes at the same place (within tolerance); a warning, since cracks and contact have them
  unused_node,     ///< a node of no hex; a warning
  hanging_node,    ///< a node inside an edge or face of a hex that does not have it (see below)
  touching_part,   ///< the same, but across a crack or in contact; a warning
  crowded_face,    ///< a face with more than two hexes
  folded_face,     ///< two hexes on the same side of their face, or joined to its four nodes in different order
  torn_edge,       ///< hexes around an edge or node that are joined through it alone (non-manifold); a warning
  inverted,        ///< not valid (quality/validity.h): the Jacobian is not positive everywhere, or flat by rounding
  flattened,       ///< a refinement made it flat compared with the hexes that were there (not found by validate())
  off_model,       ///< a refinement left a node off its curve or surface (not found by validate())
};

/// "hanging node" and so on.
const char* name(ViolationKind kind);

/// One thing that is wrong with a mesh.
struct Violation {
  ViolationKind kind;        ///< is_warning() says whether it matters
  std::vector<Index> hexes;  ///< involved, ascending
  std::vector<Index> nodes;  ///< involved, ascending
  std::string text;          ///< one line with ids as the user knows them, long lists cut short
};

/// What counts as the same place.
struct ValidateOptions {
  /// Nodes nearer than this times the size of the box count as one place (0 .. 1e-4). 0 switches the search off.
  double relative_tolerance = 1e-10;
  /// Gets the faces of a mesh of which only warnings are told, for who goes on with them; those of others stay as is.
  Faces* faces = nullptr;
};

/// Every violation, by kind, then by first hex or node. Empty: the mesh is conformal, uninverted and clean.
/// A node counts as inside an edge or face when it is nearer to it than 1e-3 of the shortest edge of that face and than
/// about 1e-6 of the mesh (files keep that many digits), but not that near to one of its corners. It hangs if edges of
/// the skin join it to both ends of that edge, or to all corners of that face. Seams of double nodes (cracks) and
/// bodies in contact may have other nodes on their two sides.
std::vector<Violation> validate(const Mesh& mesh, const ValidateOptions& options = {});

/// Quicker, and in less memory: false when validate() may find something worse than a warning. True is certain.
/// known_valid: that all hexes are valid (quality/validity.h) has been found out already.
bool has_only_warnings(const Mesh& mesh, bool known_valid = false);

/// A violation that only warns: the mesh can still be refined.
bool is_warning(ViolationKind kind);

/// What repair_orientation() turned around.
struct OrientationRepair {
  std::vector<Index> flipped;  ///< hexes, ascending
  std::string notice;          ///< one line, "" when nothing was done
};

/// Turns hexes that are mirrored the right way by exchanging their z = 0 and z = 1 corners; sides in side sets follow.
/// Neighbours must see their common face from different sides. So each part of the mesh that is joined by faces has one
/// consistent orientation, up to turning it as a whole, and its total volume says which way is right. The hexes that
/// differ from it are turned, all or some in any pattern, by patches: those joined to each other, if their volume
/// together is negative. A single hex of negative volume that agrees with its neighbours is inverted, not mirrored, and
/// stays as it is: turning it would lay it over them.
/// Throws Error naming the first hex that names a node that does not exist.
OrientationRepair repair_orientation(Mesh& mesh);

/// A side of the mesh before the repair, after it: for lists of sides outside of the mesh.
Side side_after(const OrientationRepair& repair, Side side);

}  // namespace hextwist
