// Who owns a point of a mesh: an entity of the CAD, where on it, and what projecting onto it gives.
#pragma once

#include <compare>
#include <cstdint>
#include <limits>
#include <string>

#include "hextwist/base/types.h"

namespace HEXTWIST_API hextwist {

/// One entity of the CAD: dim 0 vertex, 1 curve, 2 surface, 3 volume; id 1-based per dim.
/// The default value means "no owner".
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

}  // namespace hextwist
