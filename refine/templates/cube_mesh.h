// A small mesh inside the unit cube, for making templates.
#pragma once

#include <vector>

#include "hextwist/mesh/corners.h"

namespace hextwist {

struct CubeMesh {
  std::vector<Vec3> points;
  std::vector<Hex> hexes;

  /// Index of the point, new unless there is one at the same place.
  Index add(const Vec3& p);
  void add_hex(const std::array<Vec3, 8>& corners);
};

/// The unit cube's corners.
std::array<Vec3, 8> unit_corners();
/// Strictly inside, not on the skin.
bool is_inside_cube(const Vec3& p);
/// Image of a point of the unit cube under the trilinear map to eight corners.
Vec3 trilinear(const std::array<Vec3, 8>& corners, const Vec3& at);
/// Adds `piece`, a mesh of the unit cube, mapped to the hex with the given corners.
void add_mapped(CubeMesh& mesh, const CubeMesh& piece, const std::array<Vec3, 8>& corners);

}  // namespace hextwist
