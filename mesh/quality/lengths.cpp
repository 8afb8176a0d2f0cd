// Metrics from the lengths of the twelve edges and four diagonals.

#include <cmath>

#include "hextwist/mesh/quality/quality_internal.h"

namespace hextwist {
namespace {

template <int N>
struct Extremes {
  Lanes<N> least, most;  ///< squared lengths
};

template <int N>
Extremes<N> edges_of(const LaneHex<N>& x) {
  const auto square = squares(LaneEdges<N>(x));
  Extremes<N> result{square[0][0], square[0][0]};
  for (const auto& axis : square)
    for (const auto& length : axis) {
      result.least = result.least.min(length);
      result.most = result.most.max(length);
    }
  return result;
}

template <int N>
Extremes<N> diagonals_of(const LaneHex<N>& x) {
  Extremes<N> result;
  for (int c = 0; c < 4; ++c) {
    const Lanes<N> length = (x[7 - c] - x[c]).squared();
    result.least = c == 0 ? length : Lanes<N>(result.least.min(length));
    result.most = c == 0 ? length : Lanes<N>(result.most.max(length));
  }
  return result;
}

/// Square root of a quotient of which more is better: 0 where nothing has a length.
template <int N>
Lanes<N> root_ratio(const Lanes<N>& a, const Lanes<N>& b) {
  const Lanes<N> safe = (b > 0).select(b, Lanes<N>::Ones());
  return (b > 0).select((a / safe).sqrt(), Lanes<N>::Zero());
}

template <int N>
Lanes<N> edge_ratio(const LaneHex<N>& x, double) {
  const auto edges = edges_of<N>(x);
  return bounded_ratio<N>(edges.most.sqrt(), edges.least.sqrt());
}

template <int N>
Lanes<N> stretch(const LaneHex<N>& x, double) {
  return std::sqrt(3.0) * root_ratio<N>(edges_of<N>(x).least, diagonals_of<N>(x).most);
}

template <int N>
Lanes<N> diagonal(const LaneHex<N>& x, double) {
  const auto diagonals = diagonals_of<N>(x);
  return root_ratio<N>(diagonals.least, diagonals.most);
}

}  // namespace

const Kernel edge_ratio_kernel = {edge_ratio<1>, edge_ratio<n_lanes>};
const Kernel stretch_kernel = {stretch<1>, stretch<n_lanes>};
const Kernel diagonal_kernel = {diagonal<1>, diagonal<n_lanes>};

}  // namespace hextwist
