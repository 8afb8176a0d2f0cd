// Metrics from the volume and its derivatives.

#include <array>

#include "hextwist/mesh/quality/kernels_internal.h"

namespace hextwist {
namespace {

template <int N>
Lanes<N> volume(const LaneHex<N>& x, double) {
  return volume_of<N>(x);
}

template <int N>
Lanes<N> dimension(const LaneHex<N>& x, double average) {
  const LaneHex<N> local = from_corner<N>(x);
  LaneHex<N> gradient;  // of 24 times the volume
  for (auto& g : gradient) g = {Lanes<N>::Zero(), Lanes<N>::Zero(), Lanes<N>::Zero()};
  for (int face = 0; face < 6; ++face) {
    const auto cycle = face_cycle(face);
    const LaneVec<N>&p = local[cycle[0]], &q = local[cycle[1]], &r = local[cycle[2]], &s = local[cycle[3]];
    const LaneVec<N> sum = (p + q) + (r + s), d = r - p, e = s - q;
    const LaneVec<N> area = cross(d, e), by_d = cross(e, sum), by_e = cross(sum, d);
    gradient[cycle[0]] = gradient[cycle[0]] + (area - by_d);
    gradient[cycle[1]] = gradient[cycle[1]] + (area - by_e);
    gradient[cycle[2]] = gradient[cycle[2]] + (area + by_d);
    gradient[cycle[3]] = gradient[cycle[3]] + (area + by_e);
  }
  Lanes<N> squared = Lanes<N>::Zero();
  for (const auto& g : gradient) squared += scaled(1.0 / 24, g).squared();
  const Lanes<N> safe = (squared > 0).select(squared, Lanes<N>::Ones());
  return (squared > 0).select(volume<N>(x, average).abs() / (2 * safe).sqrt(), Lanes<N>::Zero());
}

template <int N>
Lanes<N> relative_size(const LaneHex<N>& x, double average) {
  if (!(average > 0)) return Lanes<N>::Zero();
  const LaneEdges<N> edges(x);
  Lanes<N> size = Lanes<N>::Zero();
  for (int c = 0; c < 8; ++c) size += determinant_at(edges, c);
  size /= 8 * average;
  const Lanes<N> safe = (size > 0).select(size, Lanes<N>::Ones());
  return (size > 0).select(safe.min(1 / safe).square(), Lanes<N>::Zero());
}

template <int N>
Lanes<N> distortion(const LaneHex<N>& x, double) {
  const LaneEdges<N> edges(x);
  Lanes<N> least = determinant_at(edges, 0);
  for (int c = 1; c < 8; ++c) least = least.min(determinant_at(edges, c));
  constexpr double low = 0.21132486540518711775;  // (1 - 1/sqrt(3)) / 2
  Lanes<N> sum = Lanes<N>::Zero();
  for (int gauss = 0; gauss < 8; ++gauss) {
    std::array<LaneVec<N>, 3> derivative;
    for (int axis = 0; axis < 3; ++axis) {
      const auto& e = edges.along[axis];
      const int near = gather_bits(axis, gauss);
      const LaneVec<N> close = scaled(1 - low, e[near]) + scaled(low, e[near ^ 1]);
      const LaneVec<N> far = scaled(1 - low, e[near ^ 2]) + scaled(low, e[near ^ 3]);
      derivative[axis] = scaled(1 - low, close) + scaled(low, far);
    }
    const Lanes<N> det = determinant(derivative[0], derivative[1], derivative[2]);
    least = least.min(det);
    sum += det;
  }
  const Lanes<N> volume = sum / 8, safe = (volume != 0).select(volume, Lanes<N>::Ones());
  return (volume != 0).select((least / safe).min(unbounded).max(-unbounded), Lanes<N>::Zero());
}

}  // namespace

const Kernel volume_kernel = {volume<1>, volume<n_lanes>};
const Kernel relative_size_kernel = {relative_size<1>, relative_size<n_lanes>};
const Kernel dimension_kernel = {dimension<1>, dimension<n_lanes>};
const Kernel distortion_kernel = {distortion<1>, distortion<n_lanes>};

}  // namespace hextwist
