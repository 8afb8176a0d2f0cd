// Is a hex valid? The one judge of reading, checking, smoothing, untangling, repairing and verifying.
//
// Valid: the Jacobian determinant of the trilinear map is positive everywhere in the hex, not only at its corners, and
// the hex is not flat but for rounding. So centre, edges and volume are positive too.
//
// The determinant is quadratic in each coordinate. Its 27 coefficients in the Bernstein basis bound it from below and
// are its values at the corners; where one is not positive, the hex is halved until all are (proved) or a value that is
// not positive is found. Source: Johnen, Remacle, Geuzaine, Geometrical validity of curvilinear finite elements (J.
// Comput. Phys. 233, 2013), there for curved elements.
#pragma once

#include <span>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace HEXTWIST_API hextwist {

/// A hex with a smaller scaled Jacobian (quality.h: corners and centre) is flat but for rounding.
inline constexpr double least_scaled_jacobian = 1e-6;

/// Why a hex is not valid.
enum class HexFault {
  none,    ///< it is valid
  corner,  ///< the Jacobian at a corner is not positive
  inside,  ///< it is at all corners, but not everywhere in between
  flat,    ///< positive everywhere, scaled Jacobian below least_scaled_jacobian
};

/// What was found in a hex.
struct HexVerdict {
  HexFault fault = HexFault::none;  ///< none: the rest means nothing
  double value = 0;                 ///< the offending Jacobian; of flat hexes the scaled one
  Vec3 at = Vec3::Zero();           ///< where, in the unit cube
};

/// What is wrong with a hex. What can't be decided within rounding (about 1e-14 of the longest edges' product) or
/// within 4096 pieces counts as wrong. Precondition here and below: finite coordinates, nodes that exist.
HexVerdict judge(std::span<const Vec3, 8> corners);
/// The same of a hex of a mesh.
HexVerdict judge(const Mesh& mesh, Index hex);

/// Hexes that are not valid ("inverted" in all that is said), ascending: those with index >= first. The same for any
/// number of threads.
std::vector<Index> inverted_hexes(const Mesh& mesh, Index first = 0);
/// Those of a list (ascending) that are not valid.
std::vector<Index> inverted_hexes(const Mesh& mesh, std::span<const Index> hexes);
/// Whether there is none among all hexes; quicker.
bool all_valid(const Mesh& mesh);

/// Hexes with index >= first whose scaled Jacobian (quality.h) is below a limit, ascending.
std::vector<Index> hexes_below(const Mesh& mesh, double limit, Index first = 0);
/// The same among some hexes, ascending.
std::vector<Index> hexes_below(const Mesh& mesh, double limit, std::span<const Index> hexes);

}  // namespace hextwist
