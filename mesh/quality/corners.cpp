// Metrics from the 3x3 Jacobian matrices at the corners (and the centre).

#include <cmath>

#include "hextwist/mesh/quality/kernels_internal.h"

namespace hextwist {
namespace {

template <int N>
Lanes<N> shape(const LaneHex<N>& x, double) {
  return shape_of(HexCorners<N>(x));
}

template <int N>
Lanes<N> mean_ratio(const LaneHex<N>& x, double) {
  const LaneEdges<N> edges(x);
  const auto square = squares(edges);
  Lanes<N> sum = Lanes<N>::Zero();  // of the inverses, times 3
  Lanes<N> least = Lanes<N>::Ones();
  for (int c = 0; c < 8; ++c) {
    const Lanes<N> det = determinant_at(edges, c);
    const Lanes<N> frobenius =
        square[0][gather_bits(0, c)] + square[1][gather_bits(1, c)] + square[2][gather_bits(2, c)];
    const Lanes<N> power =
        (frobenius > 0).select(det * det.abs() / (frobenius * frobenius * frobenius), Lanes<N>::Zero());
    least = least.min(power);
    sum += Lanes<N>::each([&](int lane) { return power[lane] > 0 ? 1 / std::cbrt(power[lane]) : 0; });
  }
  return (least > 0).select(24 / (least > 0).select(sum, Lanes<N>::Ones()), Lanes<N>::Zero());
}

template <int N>
Lanes<N> condition_number(const LaneHex<N>& x, double) {
  const LaneEdges<N> edges(x);
  const auto square = squares(edges);
  Lanes<N> worst = Lanes<N>::Zero();  // square of three times the metric
  for (int c = 0; c < 8; ++c) {
    const LaneVec<N>&a = edges.at(0, c), &b = edges.at(1, c), &d = edges.at(2, c);
    const Lanes<N> det = determinant(a, b, d);
    const Lanes<N> frobenius =
        square[0][gather_bits(0, c)] + square[1][gather_bits(1, c)] + square[2][gather_bits(2, c)];
    // The cofactors are det times the inverse.
    const Lanes<N> cofactors = cross(a, b).squared() + cross(b, d).squared() + cross(d, a).squared();
    const Lanes<N> safe = (det > 0).select(det, Lanes<N>::Ones());
    const Lanes<N> power = frobenius * (cofactors / (safe * safe));
    worst = worst.max((det > 0).select(power, Lanes<N>::Constant(9 * unbounded * unbounded)));
  }
  return (worst.sqrt() / 3).min(unbounded);
}

template <int N>
Lanes<N> scaled_jacobian(const LaneHex<N>& x, double) {
  return scaled_jacobian_of(HexCorners<N>(x));
}

template <int N>
Lanes<N> shear(const LaneHex<N>& x, double) {
  return worst_scaled_corner<N>(HexCorners<N>(x), Lanes<N>::Ones()).max(0).sqrt();
}

template <int N>
Lanes<N> oddy(const LaneHex<N>& x, double) {
  const LaneEdges<N> edges(x);
  const auto centre = principal_axes(edges);
  Lanes<N> worst = Lanes<N>::Zero();  // the cube of the metric
  const Lanes<N> none = Lanes<N>::Constant(unbounded * unbounded * unbounded);
  for (int c = 0; c < 9; ++c) {
    const LaneVec<N>& a = c < 8 ? edges.at(0, c) : centre[0];
    const LaneVec<N>& b = c < 8 ? edges.at(1, c) : centre[1];
    const LaneVec<N>& d = c < 8 ? edges.at(2, c) : centre[2];
    const Lanes<N> det = determinant(a, b, d), aa = a.squared(), bb = b.squared(), dd = d.squared();
    const Lanes<N> ab = dot(a, b), ad = dot(a, d), bd = dot(b, d), trace = aa + bb + dd;
    const Lanes<N> safe = (det > 0).select(trace, Lanes<N>::Ones());
    // Without the trace: |G|^2 - tr(G)^2 / 3 for G / tr(G), in a form that can't be negative and cancels nothing.
    const Lanes<N> deviator =
        (((aa - bb) / safe).square() + ((bb - dd) / safe).square() + ((dd - aa) / safe).square()) / 3 +
        2 * ((ab / safe).square() + (ad / safe).square() + (bd / safe).square());
    const Lanes<N> flatness = (det > 0).select((det / safe).square() / safe, Lanes<N>::Ones());  // det^2 / trace^3
    const Lanes<N> power = deviator * (deviator / flatness) * (deviator / flatness);
    worst = worst.max((det > 0).select(power, none));
  }
  return Lanes<N>::each([&](int lane) { return std::min(std::cbrt(worst[lane]), unbounded); });
}

template <int N>
Lanes<N> corner_jacobian(const LaneHex<N>& x, double) {
  const LaneEdges<N> edges(x);
  Lanes<N> worst = determinant_at(edges, 0);
  for (int c = 1; c < 8; ++c) worst = worst.min(determinant_at(edges, c));
  return worst;
}

template <int N>
Lanes<N> jacobian(const LaneHex<N>& x, double average) {
  const auto centre = principal_axes(LaneEdges<N>(x));
  return corner_jacobian<N>(x, average).min(determinant(centre[0], centre[1], centre[2]) / 64);
}

}  // namespace

const Kernel shape_kernel = {shape<1>, shape<n_lanes>};
const Kernel scaled_jacobian_kernel = {scaled_jacobian<1>, scaled_jacobian<n_lanes>};
const Kernel mean_ratio_kernel = {mean_ratio<1>, mean_ratio<n_lanes>};
const Kernel condition_number_kernel = {condition_number<1>, condition_number<n_lanes>};
const Kernel shear_kernel = {shear<1>, shear<n_lanes>};
const Kernel oddy_kernel = {oddy<1>, oddy<n_lanes>};
const Kernel jacobian_kernel = {jacobian<1>, jacobian<n_lanes>};
const Kernel corner_jacobian_kernel = {corner_jacobian<1>, corner_jacobian<n_lanes>};

}  // namespace hextwist
