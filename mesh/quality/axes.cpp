// Metrics from the principal axes X1, X2, X3, and their cross derivatives: Robinson's shape parameters.

#include "hextwist/mesh/quality/quality_internal.h"

namespace hextwist {
namespace {

template <int N>
Lanes<N> skew(const LaneHex<N>& x, double) {
  const auto axes = principal_axes(LaneEdges<N>(x));
  Lanes<N> worst = Lanes<N>::Zero();  // square of the cosine
  for (int a = 0; a < 3; ++a) {
    const LaneVec<N>&u = axes[a], &v = axes[(a + 1) % 3];
    const Lanes<N> uu = u.squared(), vv = v.squared(), uv = dot(u, v);
    const Lanes<N> safe = (uu > 0 && vv > 0).select(uu * vv, Lanes<N>::Ones());
    worst = worst.max((uu > 0 && vv > 0).select(uv * uv / safe, Lanes<N>::Constant(unbounded * unbounded)));
  }
  return worst.sqrt();
}

template <int N>
Lanes<N> taper(const LaneHex<N>& x, double) {
  const LaneEdges<N> edges(x);
  const auto axes = principal_axes(edges);
  Lanes<N> worst = Lanes<N>::Zero();
  for (int first = 0; first < 2; ++first)
    for (int second = first + 1; second < 3; ++second) {
      // How the edges along the first axis change along the second; bit of the second axis in k, see corners.h.
      const auto& e = edges.along[first];
      const bool low_bit = second == (first == 0 ? 1 : 0);
      const LaneVec<N> change = low_bit ? (e[1] - e[0]) + (e[3] - e[2]) : (e[2] - e[0]) + (e[3] - e[1]);
      worst = worst.max(
          bounded_ratio<N>(change.squared().sqrt(), axes[first].squared().min(axes[second].squared()).sqrt()));
    }
  return worst;
}

template <int N>
Lanes<N> aspect_ratio(const LaneHex<N>& x, double) {
  const auto axes = principal_axes(LaneEdges<N>(x));
  const Lanes<N> a = axes[0].squared(), b = axes[1].squared(), c = axes[2].squared();
  return bounded_ratio<N>(a.max(b).max(c).sqrt(), a.min(b).min(c).sqrt());
}

}  // namespace

const Kernel skew_kernel = {skew<1>, skew<n_lanes>};
const Kernel taper_kernel = {taper<1>, taper<n_lanes>};
const Kernel aspect_ratio_kernel = {aspect_ratio<1>, aspect_ratio<n_lanes>};

}  // namespace hextwist
