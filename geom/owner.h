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
  std::int32_t dim = -1;  ///< 0 .. 3; -1 where there is no owner
  std::int32_t id = 0;    ///< from 1, per dimension; 0 where there is no owner

  /// Is there an owner? Whether a model has such an entity is not asked.
  explicit operator bool() const { return dim >= 0; }
  /// By dimension, then by id; no owner comes first.
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
  double u = std::numeric_limits<double>::quiet_NaN();  ///< first parameter of a surface, t of a curve
  double v = std::numeric_limits<double>::quiet_NaN();  ///< second parameter of a surface
};

/// Result of projecting a point: the closest point of the entity, its parameters, the distance moved.
struct Projection {
  Vec3 point = Vec3::Zero();  ///< on the entity, model units
  Parameters parameters;      ///< of that point; NaN on a vertex
  double distance = 0;        ///< from the point that was asked about, model units
};

}  // namespace hextwist
