#include "hextwist/geom/model.h"

#include "hextwist/geom/curvature.h"

namespace hextwist {

Projection Model::project(Owner entity, const Vec3& p) const {
  Projection result;
  project(entity, {&p, 1}, {}, {&result, 1});
  return result;
}

const KnowsCurvature* curvature_of(const Model& model) {
  return dynamic_cast<const KnowsCurvature*>(&model);
}

}  // namespace hextwist
