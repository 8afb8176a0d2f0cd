// Where in a mesh is a point? The hex that holds it and its place in the hex's unit cube.
#pragma once

#include <span>

#include "hextwist/base/box_tree.h"
#include "hextwist/mesh/mesh.h"

namespace hextwist {

struct HexPlace {
  Index hex = -1;
  Vec3 at = Vec3::Zero();  ///< coordinates in the unit cube (corners.h), 0 to 1
  double distance = 0;     ///< 0 inside; else how far the point is from that place
};

/// Point of a hex at a place in its unit cube.
Vec3 trilinear_point(std::span<const Vec3, 8> corners, const Vec3& at);
/// The place in its unit cube where p lies, found by Newton's method: outside of 0 .. 1 for a point that is outside of
/// the hex. False where the method does not get there, or leaves -2 .. 3, where the map need not be one to one.
bool find_natural_coordinates(std::span<const Vec3, 8> corners, const Vec3& p, Vec3& at);
/// Columns: how the point changes with each coordinate.
std::array<Vec3, 3> trilinear_derivatives(std::span<const Vec3, 8> corners, const Vec3& at);
/// Closest place in one hex: the inverse of the trilinear map by Newton's method for points inside, the closest of the
/// six bilinear faces for those outside.
HexPlace closest_place(std::span<const Vec3, 8> corners, const Vec3& p);

/// Finds the hexes of a mesh; keeps a copy of their corners and a tree of their boxes. May be asked from any number of
/// threads.
class HexLocator {
 public:
  explicit HexLocator(const Mesh& mesh);
  /// The hexes of a selection only; HexPlace::hex is an index of the mesh.
  HexLocator(const Mesh& mesh, std::span<const Index> hexes);

  /// The hex that holds p, the lowest index where several do; outside of the mesh the nearest place of the nearest hex.
  /// hex is -1 for a locator without hexes.
  HexPlace locate(const Vec3& p) const;

 private:
  std::vector<Index> hexes_;
  std::vector<std::array<Vec3, 8>> corners_;
  BoxTree tree_;
};

}  // namespace hextwist
