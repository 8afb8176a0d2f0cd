// How strongly the CAD bends. Not every model knows: the facets of a mesh's skin do not bend, they have corners.
#pragma once

#include "hextwist/geom/model.h"

namespace hextwist {

/// A model that knows the curvature of its curves and surfaces implements this too.
class KnowsCurvature {
 public:
  virtual ~KnowsCurvature() = default;
  /// One over the radius of the tightest circle at a place: of a curve; of a surface the larger principal curvature
  /// (without sign). 0 where straight or flat, at vertices and in volumes, and where there is none (tip of a cone).
  virtual double curvature(Owner entity, Parameters at) const = 0;
};

/// Null for a model that does not.
const KnowsCurvature* curvature_of(const Model& model);

}  // namespace hextwist
