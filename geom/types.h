// Small value types shared by every layer: points, owners, boxes, parameters, errors.
#pragma once

#include <Eigen/Core>
#include <compare>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

namespace hextwist {

/// A point or vector in model units.
using Vec3 = Eigen::Vector3d;

/// Bad input: names the file, line, entity or id that is wrong. what() is one line, ready to be shown to a user.
/// Programmer errors are asserts, geometric disappointments are rows of a report; neither is an Error.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One entity of the CAD: dim 0 vertex, 1 curve, 2 surface, 3 volume; id 1-based per dim.
/// The default value means "nobody".
struct Owner {
  std::int32_t dim = -1;
  std::int32_t id = 0;

  explicit operator bool() const { return dim >= 0; }
  auto operator<=>(const Owner&) const = default;
};

/// "vertex", "curve", "surface", "volume".
inline const char* dimension_name(int dim) {
  constexpr const char* names[] = {"vertex", "curve", "surface", "volume"};
  return dim >= 0 && dim <= 3 ? names[dim] : "nothing";
}

/// "curve 3", or "nothing".
inline std::string to_string(Owner owner) {
  return owner ? std::string(dimension_name(owner.dim)) + " " + std::to_string(owner.id) : "nothing";
}

/// Parameters of a point on its owner: (u, v) on a surface, t = u on a curve. NaN where unknown or meaningless.
struct Parameters {
  double u = std::numeric_limits<double>::quiet_NaN();
  double v = std::numeric_limits<double>::quiet_NaN();
};

/// Result of projecting a point: the closest point of the entity, its parameters, the distance moved.
struct Projection {
  Vec3 point = Vec3::Zero();
  Parameters parameters;
  double distance = 0;
};

/// Axis-aligned box; empty until a point is added.
struct Box {
  Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 max = Vec3::Constant(-std::numeric_limits<double>::infinity());

  bool empty() const { return !(min.x() <= max.x()); }
  void add(const Vec3& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  void add(const Box& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
  /// Length of the diagonal, 0 when empty: what "model size" means everywhere.
  double diagonal() const { return empty() ? 0 : (max - min).norm(); }
};

}  // namespace hextwist
