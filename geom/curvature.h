// How strongly the CAD bends. The skin of a mesh estimates it from how its facets are turned against each other
// (facet/curvature_internal.h); where they turn by more than the feature angle is an edge, not curvature.
#pragma once

#include <vector>

#include "hextwist/geom/facet/bilinear.h"
#include "hextwist/geom/model.h"

namespace hextwist {

/// A piece of a curve or surface and its curvature, above 0.
struct Bend {
  BilinearPatch piece;
  double curvature = 0;
};

/// A model that knows the curvature of its curves and surfaces implements this too.
class KnowsCurvature {
 public:
  virtual ~KnowsCurvature() = default;
  /// One over the radius of the tightest circle at a place: of a curve; of a surface the larger principal curvature
  /// (without sign). 0 where straight or flat, at vertices and in volumes, and where there is none (tip of a cone).
  virtual double curvature(Owner entity, Parameters at) const = 0;
  /// Whether curves and surfaces come in pieces, each of one curvature. Then those that are bent are these; a piece of
  /// a curve has its ends twice.
  virtual bool in_pieces() const { return false; }
  virtual std::vector<Bend> bends(Owner) const { return {}; }
};

/// Null for a model that does not.
const KnowsCurvature* curvature_of(const Model& model);

}  // namespace hextwist
