// Goal 8: quality of a million hexes.
#include "hextwist/mesh/quality/quality.h"

#include "groups.h"
#include "hextwist/mesh/validate/validate.h"
#include "measure.h"
#include "meshes.h"

namespace hextwist::bench {
namespace {

const Mesh& million() {
  static const Mesh made = cube(100);
  return made;
}

}  // namespace

void add_quality() {
  add_time("quality/shape", [] { return quality(Metric::shape, million()); });
  add_time("quality/scaled_jacobian", [] { return quality(Metric::scaled_jacobian, million()); });
  add_time("quality/validate", [] { return validate(million()); });
}

}  // namespace hextwist::bench
