// Is this a mesh at all? Finds every violation, names them by id.
#pragma once

#include <string>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace hextwist {

enum class ViolationKind {
  bad_index,         ///< a hex names a node that does not exist
  not_finite,        ///< a coordinate is NaN or infinite
  repeated_node,     ///< a hex names a node twice
  duplicate_hex,     ///< two hexes on the same eight nodes
  duplicate_node,    ///< two nodes at the same place (within tolerance)
  unused_node,       ///< a node of no hex
  hanging_node,      ///< a node inside an edge or face of a hex that does not have it
  crowded_face,      ///< a face with more than two hexes
  torn_edge,         ///< hexes around an edge or node that are joined through it alone (non-manifold); a warning
  inverted,          ///< smallest corner Jacobian not positive
};

const char* name(ViolationKind kind);

struct Violation {
  ViolationKind kind;
  std::vector<Index> hexes;  ///< involved, ascending
  std::vector<Index> nodes;
  std::string text;  ///< one line with ids as the user knows them
};

struct ValidateOptions {
  /// Nodes nearer than this times the size of the box count as one place. 0 switches the search off.
  double relative_tolerance = 1e-10;
};

/// Every violation, by kind, then by first hex or node. Empty: the mesh is conformal, uninverted and clean.
std::vector<Violation> validate(const Mesh& mesh, const ValidateOptions& options = {});

/// A violation that only warns (unused_node, torn_edge, duplicate_node): the mesh can still be refined.
bool is_warning(ViolationKind kind);

/// What repair_orientation() turned around.
struct OrientationRepair {
  std::vector<Index> flipped;  ///< hexes, ascending
  std::string notice;          ///< one line, "" when nothing was done
};

/// Turns hexes that are inside out (negative volume, and consistently so at all corners) the right way by exchanging
/// their z = 0 and z = 1 corners; sides in side sets follow. Hexes with mixed corner signs stay as they are: those are
/// inverted, not mirrored.
OrientationRepair repair_orientation(Mesh& mesh);

}  // namespace hextwist
