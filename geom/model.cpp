#include "hextwist/geom/model.h"

namespace hextwist {

Projection Model::project(Owner entity, const Vec3& p) const {
  Projection result;
  project(entity, {&p, 1}, {}, {&result, 1});
  return result;
}

}  // namespace hextwist
