#include "hextwist/mesh/quality/measure.h"

#include <atomic>

#include "hextwist/base/parallel.h"
#include "hextwist/mesh/quality/kernels_internal.h"

namespace hextwist {
namespace {

/// N hexes, whose values come `at` there. False where a hex may not be valid.
template <int N, class HexOf>
HEXTWIST_LANES bool measure_some(const Mesh& mesh, const HexOf& hex_of, Index at, Measures& all) {
  const LaneHex<N> x = load<N>(mesh, [&](int lane) { return hex_of(at + lane); });
  const HexCorners<N> terms(x);
  shape_of(terms).store(all.shape.data() + at);
  scaled_jacobian_of(terms).store(all.scaled_jacobian.data() + at);
  volume_of<N>(x).store(all.volume.data() + at);
  return (affine_clearance(terms.edges) > 0).all() || (clearance(terms.edges) > 0).all();
}

/// The hexes hex_of(0) to hex_of(n - 1).
template <class HexOf>
Measures measure(const Mesh& mesh, std::size_t n, const HexOf& hex_of) {
  Measures all;
  for (std::vector<double>* values : {&all.shape, &all.scaled_jacobian, &all.volume}) resize_for_overwrite(*values, n);
  std::atomic<bool> valid = true;
  const auto are_valid = [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
      if (judge(mesh, hex_of(i)).fault != HexFault::none) return false;
    return true;
  };
  parallel_ranges(static_cast<Index>(n), [&](Index begin, Index end) {
    for_lanes(begin, end, [&](auto lanes, Index i) HEXTWIST_LANE_LAMBDA {
      if (!measure_some<lanes>(mesh, hex_of, i, all) && !are_valid(i, i + lanes)) valid = false;
    });
  });
  all.all_valid = valid;
  return all;
}

}  // namespace

Measures measure(const Mesh& mesh) {
  return measure(mesh, mesh.hexes.size(), [](Index i) { return i; });
}
Measures measure(const Mesh& mesh, std::span<const Index> hexes) {
  return measure(mesh, hexes.size(), [&](Index i) { return hexes[i]; });
}

}  // namespace hextwist
