// Closest triangles of a soup, by CGAL's AABB tree. Internal to geom.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "hextwist/base/types.h"

namespace hextwist {

/// A triangle near a point: the point's closest point on it has these barycentric weights.
struct NearTriangle {
  int triangle = 0;
  double distance = 0;
  Vec3 weights = Vec3::Zero();
};

/// Immutable after construction; queries may run in several threads at once.
class TriangleTree {
 public:
  /// Triangles are triples of indices into points; there must be at least one.
  TriangleTree(const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles);
  ~TriangleTree();
  TriangleTree(TriangleTree&&) noexcept;
  TriangleTree& operator=(TriangleTree&&) noexcept;

  /// All triangles whose distance from p is at most that of the closest one plus `slack`; nearest first, equal
  /// distances by index.
  void closest(const Vec3& p, double slack, std::vector<NearTriangle>& out) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Closest point of triangle abc to p as barycentric weights.
Vec3 closest_weights(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace hextwist
