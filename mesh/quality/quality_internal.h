// The kernels behind the metrics, and what they share.
//
// Roots are monotone, so where it can be done a metric compares powers at the corners and takes one root at the end.
#pragma once

#include <array>

#include "hextwist/mesh/hex_lanes.h"

namespace hextwist {

/// One metric for one hex, and for several at once. The second argument is the volume that relative size compares with.
struct Kernel {
  Lanes<1> (*one)(const LaneHex<1>&, double average);
  Lanes<n_lanes> (*some)(const LaneHex<n_lanes>&, double average);
};

extern const Kernel shape_kernel, scaled_jacobian_kernel, mean_ratio_kernel, condition_number_kernel, shear_kernel,
    oddy_kernel, jacobian_kernel, corner_jacobian_kernel;                                      // corners
extern const Kernel skew_kernel, taper_kernel, aspect_ratio_kernel;                            // axes
extern const Kernel edge_ratio_kernel, stretch_kernel, diagonal_kernel;                        // lengths
extern const Kernel volume_kernel, relative_size_kernel, dimension_kernel, distortion_kernel;  // sizes

/// The worst value of a metric that has no largest one, as in Verdict: finite, so that sums stay finite.
inline constexpr double unbounded = 1e30;

template <int N>
HEXTWIST_LANES LaneVec<N> scaled(double factor, const LaneVec<N>& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}

template <int N>
HEXTWIST_LANES Lanes<N> determinant_at(const LaneEdges<N>& edges, int c) {
  return determinant(edges.at(0, c), edges.at(1, c), edges.at(2, c));
}
/// Principal axes: the sum of the four edges of each direction, four times the Jacobian matrix at the centre.
template <int N>
HEXTWIST_LANES std::array<LaneVec<N>, 3> principal_axes(const LaneEdges<N>& edges) {
  std::array<LaneVec<N>, 3> axes;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& e = edges.along[axis];
    axes[axis] = e[0] + e[1] + (e[2] + e[3]);
  }
  return axes;
}

/// a / b where b is positive and the quotient less than `unbounded`, else `unbounded`.
template <int N>
HEXTWIST_LANES Lanes<N> bounded_ratio(const Lanes<N>& a, const Lanes<N>& b) {
  const Lanes<N> safe = (b > 0).select(b, Lanes<N>::Ones());
  return (b > 0).select((a / safe).min(unbounded), Lanes<N>::Constant(unbounded));
}

}  // namespace hextwist
