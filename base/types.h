// Small value types shared by every room: points, indices, boxes, errors.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "hextwist/base/export.h"

namespace HEXTWIST_API hextwist {

/// A point or vector in model units.
using Vec3 = Eigen::Vector3d;

/// Position in an array, 0-based. Ids shown to users are 1-based or come from the file (node_id(), hex_id()).
using Index = std::int32_t;

/// Bad input: names the file, line, entity or id that is wrong. what() is one line, ready to be shown to a user.
/// Programmer errors are asserts; a node that cannot reach the CAD is a row of the report. Neither is an Error.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Axis-aligned box; empty until a point is added.
struct Box {
  /// Lowest corner, model units; infinity while the box is empty.
  Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
  /// Highest corner, model units; -infinity while the box is empty.
  Vec3 max = Vec3::Constant(-std::numeric_limits<double>::infinity());

  /// Is there no point in it? A box of one point is not empty.
  bool empty() const { return !(min.x() <= max.x()); }
  /// Grows by as little as it takes to hold the point.
  void add(const Vec3& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  /// Grows to hold another box; an empty one changes nothing.
  void add(const Box& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
  /// Length of the diagonal, 0 when empty: what "model size" means everywhere.
  double diagonal() const { return empty() ? 0 : (max - min).norm(); }
};

/// Squared distance of a point from a box; 0 inside.
inline double distance2(const Box& box, const Vec3& p) {
  return (p - p.cwiseMax(box.min).cwiseMin(box.max)).squaredNorm();
}

}  // namespace hextwist
