// Is the Jacobian of a hex of second order positive everywhere? Proved, not sampled.
//
// The determinant of the triquadratic map is of degree 5 in each coordinate. Its 216 coefficients in the Bernstein
// basis bound it from below and are its values at the corners; where one is not positive, the hex is halved until all
// are (proved) or a value that is not positive is found. A hex of 20 nodes is the hex of 27 whose faces and centre are
// blended from its edges, so one proof serves both. Source: Johnen, Remacle, Geuzaine, Geometrical validity of
// curvilinear finite elements (J. Comput. Phys. 233, 2013).
#pragma once

#include <array>
#include <span>

#include "hextwist/base/types.h"

namespace HEXTWIST_API hextwist {

/// The 27 nodes of a hex: number i + 3 j + 9 k lies at (i, j, k) / 2 of the unit cube.
using QuadraticHex = std::array<Vec3, 27>;

/// The point at a place of the unit cube.
Vec3 point(const QuadraticHex& hex, const Vec3& at);
/// The columns of the Jacobian at a place of the unit cube: derivatives along its x, y and z, model units.
std::array<Vec3, 3> jacobian(const QuadraticHex& hex, const Vec3& at);

/// What can't be decided within rounding (1e-13 of the product of the longest derivatives) or within 4096 pieces counts
/// as not positive. Precondition: finite coordinates.
bool is_positive_everywhere(const QuadraticHex& hex);

/// Puts face nodes and the centre where the edges alone say (a hex of 20 nodes).
void blend_faces(QuadraticHex& hex);
/// The centre where edges, faces and corners say.
void blend_centre(QuadraticHex& hex);

}  // namespace hextwist
