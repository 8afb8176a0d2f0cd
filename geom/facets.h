// The surfaces of the CAD as triangles, for pictures of it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hextwist/geom/model.h"

namespace hextwist {

/// Triangles of one surface, within its trimming curves: points by their parameters, three of these each. No order of
/// the corners is promised.
struct SurfaceFacets {
  std::vector<Parameters> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
};

/// A model that can say how its surfaces look without a mesh on them implements this too.
class KnowsFacets {
 public:
  virtual ~KnowsFacets() = default;
  /// As fine as a picture needs: a few thousandths of the size of the surface off it.
  virtual SurfaceFacets facets(int surface) const = 0;
};

/// Of a surface of such a model, under other ids or not; none of any other model.
SurfaceFacets facets_of(const Model& model, int surface);

}  // namespace hextwist
