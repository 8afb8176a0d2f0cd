#include "hextwist/mesh/quality/measure.h"

#include <atomic>

#include "hextwist/base/parallel.h"
#include "hextwist/mesh/quality/kernels_internal.h"

namespace hextwist {
namespace {

/// N hexes from `hex` on. False where a hex may not be valid.
template <int N>
HEXTWIST_LANES bool measure_some(const Mesh& mesh, Index hex, Measures& all) {
  const LaneHex<N> x = load<N>(mesh, hex);
  const HexCorners<N> terms(x);
  const auto put = [&](std::vector<double>& values, const Lanes<N>& some) {
    Eigen::Map<Lanes<N>>(values.data() + hex) = some;
  };
  put(all.shape, shape_of(terms));
  put(all.scaled_jacobian, scaled_jacobian_of(terms));
  put(all.volume, volume_of<N>(x));
  return (affine_clearance(terms.edges) > 0).all();
}

}  // namespace

Measures measure(const Mesh& mesh) {
  Measures all;
  for (std::vector<double>* values : {&all.shape, &all.scaled_jacobian, &all.volume})
    resize_for_overwrite(*values, mesh.hexes.size());
  std::atomic<bool> valid = true;
  parallel_ranges(mesh.n_hexes(), [&](Index begin, Index end) {
    Index h = begin;
    for (; h + n_lanes <= end; h += n_lanes)
      if (!measure_some<n_lanes>(mesh, h, all) && !all_valid(mesh, h, h + n_lanes)) valid = false;
    for (; h < end; ++h)
      if (!measure_some<1>(mesh, h, all) && !all_valid(mesh, h, h + 1)) valid = false;
  });
  all.all_valid = valid;
  return all;
}

}  // namespace hextwist
