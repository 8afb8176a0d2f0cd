// Arithmetic on several hexes at once, one per lane, written once for any number of lanes so that one hex alone gets
// the same bits as a million.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>

#include "hextwist/mesh/corners.h"

namespace hextwist {

/// What works on lanes is a few instructions where it is inlined, and many where it is called.
#if defined(__GNUC__)
#define HEXTWIST_LANES [[gnu::always_inline]] inline
#define HEXTWIST_LANE_LAMBDA __attribute__((always_inline))
#else
#define HEXTWIST_LANES inline
#define HEXTWIST_LANE_LAMBDA
#endif

namespace detail {
/// Vectors of the compiler; of one number that number, which has all operators alike.
template <int N>
struct LaneTypes {
  typedef double Values __attribute__((vector_size(N * sizeof(double))));
  typedef std::int64_t Mask __attribute__((vector_size(N * sizeof(double))));
};
template <>
struct LaneTypes<1> {
  using Values = double;
  using Mask = bool;
};
}  // namespace detail

template <int N>
struct Lanes;

template <int N>
struct LaneMask {
  typename detail::LaneTypes<N>::Mask is;

  HEXTWIST_LANES Lanes<N> select(const Lanes<N>& where_true, const Lanes<N>& elsewhere) const;
  HEXTWIST_LANES bool all() const {
    if constexpr (N == 1) return is;
    if constexpr (N == 2) return (is[0] & is[1]) != 0;
    if constexpr (N == 4) return (is[0] & is[1] & is[2] & is[3]) != 0;
  }
  HEXTWIST_LANES LaneMask operator&&(const LaneMask& b) const {
    return {static_cast<typename detail::LaneTypes<N>::Mask>(is & b.is)};
  }
};

/// N numbers, one per hex. Functions that take or return several by value are inlined always, since how they are passed
/// depends on the instructions that a function may use.
template <int N>
struct Lanes {
  using Values = typename detail::LaneTypes<N>::Values;
  Values values;

  HEXTWIST_LANES static Lanes Constant(double c) { return {Values{} + c}; }
  HEXTWIST_LANES static Lanes Zero() { return {Values{}}; }
  HEXTWIST_LANES static Lanes Ones() { return Constant(1); }
  /// f(0) to f(N - 1).
  template <class F>
  HEXTWIST_LANES static Lanes each(const F& f) {
    if constexpr (N == 1) return {f(0)};
    if constexpr (N == 2) return {Values{f(0), f(1)}};
    if constexpr (N == 4) return {Values{f(0), f(1), f(2), f(3)}};
  }
  HEXTWIST_LANES double operator[](int lane) const {
    if constexpr (N == 1)
      return values;
    else
      return values[lane];
  }
  HEXTWIST_LANES void store(double* to) const { std::memcpy(to, &values, sizeof values); }

  // As std::min and std::max have it: what comes first stays where the two can't be compared.
  HEXTWIST_LANES Lanes min(const Lanes& b) const { return {b.values < values ? b.values : values}; }
  HEXTWIST_LANES Lanes max(const Lanes& b) const { return {values < b.values ? b.values : values}; }
  HEXTWIST_LANES Lanes min(double b) const { return min(Constant(b)); }
  HEXTWIST_LANES Lanes max(double b) const { return max(Constant(b)); }
  HEXTWIST_LANES Lanes abs() const {
    if constexpr (N == 1) {
      return {std::abs(values)};
    } else {
      using Bits = typename detail::LaneTypes<N>::Mask;
      constexpr std::int64_t all_but_sign = std::numeric_limits<std::int64_t>::max();
      return {reinterpret_cast<Values>(reinterpret_cast<Bits>(values) & all_but_sign)};
    }
  }
  HEXTWIST_LANES Lanes sqrt() const {
    return each([&](int lane) HEXTWIST_LANE_LAMBDA { return std::sqrt((*this)[lane]); });
  }
  HEXTWIST_LANES Lanes square() const { return {values * values}; }

  HEXTWIST_LANES Lanes operator-() const { return {-values}; }
  HEXTWIST_LANES Lanes& operator+=(const Lanes& b) { return *this = {values + b.values}; }
  HEXTWIST_LANES Lanes& operator-=(const Lanes& b) { return *this = {values - b.values}; }
  HEXTWIST_LANES Lanes& operator*=(const Lanes& b) { return *this = {values * b.values}; }
  HEXTWIST_LANES Lanes& operator/=(double b) { return *this = {values / b}; }
  HEXTWIST_LANES friend Lanes operator+(const Lanes& a, const Lanes& b) { return {a.values + b.values}; }
  HEXTWIST_LANES friend Lanes operator-(const Lanes& a, const Lanes& b) { return {a.values - b.values}; }
  HEXTWIST_LANES friend Lanes operator*(const Lanes& a, const Lanes& b) { return {a.values * b.values}; }
  HEXTWIST_LANES friend Lanes operator/(const Lanes& a, const Lanes& b) { return {a.values / b.values}; }
  HEXTWIST_LANES friend Lanes operator*(double a, const Lanes& b) { return {a * b.values}; }
  HEXTWIST_LANES friend Lanes operator/(double a, const Lanes& b) { return {a / b.values}; }
  HEXTWIST_LANES friend Lanes operator/(const Lanes& a, double b) { return {a.values / b}; }
  HEXTWIST_LANES friend LaneMask<N> operator>(const Lanes& a, double b) { return {a.values > b}; }
  HEXTWIST_LANES friend LaneMask<N> operator<(const Lanes& a, double b) { return {a.values < b}; }
  HEXTWIST_LANES friend LaneMask<N> operator>=(const Lanes& a, double b) { return {a.values >= b}; }
  HEXTWIST_LANES friend LaneMask<N> operator!=(const Lanes& a, double b) { return {a.values != b}; }
};

template <int N>
HEXTWIST_LANES Lanes<N> LaneMask<N>::select(const Lanes<N>& where_true, const Lanes<N>& elsewhere) const {
  return {is ? where_true.values : elsewhere.values};
}

template <int N>
struct LaneVec {
  Lanes<N> x, y, z;

  HEXTWIST_LANES LaneVec operator-(const LaneVec& b) const { return {x - b.x, y - b.y, z - b.z}; }
  HEXTWIST_LANES LaneVec operator+(const LaneVec& b) const { return {x + b.x, y + b.y, z + b.z}; }
  HEXTWIST_LANES Lanes<N> squared() const {
    Lanes<N> sum = x * x;
    sum += y * y;
    sum += z * z;
    return sum;
  }
};

template <int N>
HEXTWIST_LANES Lanes<N> dot(const LaneVec<N>& a, const LaneVec<N>& b) {
  Lanes<N> sum = a.x * b.x;
  sum += a.y * b.y;
  sum += a.z * b.z;
  return sum;
}
template <int N>
HEXTWIST_LANES LaneVec<N> cross(const LaneVec<N>& a, const LaneVec<N>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <int N>
HEXTWIST_LANES Lanes<N> determinant(const LaneVec<N>& a, const LaneVec<N>& b, const LaneVec<N>& c) {
  return dot(a, cross(b, c));
}

template <int N>
using LaneHex = std::array<LaneVec<N>, 8>;

inline LaneHex<1> load(std::span<const Vec3, 8> corners) {
  LaneHex<1> lanes;
  for (int c = 0; c < 8; ++c) {
    lanes[c] = {{corners[c].x()}, {corners[c].y()}, {corners[c].z()}};
  }
  return lanes;
}
/// Hexes hex_of(0) to hex_of(N - 1).
template <int N, class HexOf>
HEXTWIST_LANES LaneHex<N> load(const Mesh& mesh, const HexOf& hex_of) {
  std::array<const Hex*, N> hexes;
  for (int lane = 0; lane < N; ++lane) hexes[lane] = &mesh.hexes[hex_of(lane)];
  LaneHex<N> lanes;
  for (int c = 0; c < 8; ++c) {
    std::array<const Vec3*, N> p;
    for (int lane = 0; lane < N; ++lane) p[lane] = &mesh.points[(*hexes[lane])[c]];
    const auto along = [&](int axis) HEXTWIST_LANE_LAMBDA {
      return Lanes<N>::each([&](int lane) HEXTWIST_LANE_LAMBDA { return (*p[lane])[axis]; });
    };
    lanes[c] = {along(0), along(1), along(2)};
  }
  return lanes;
}
/// Hexes `first` to first + N - 1.
template <int N>
HEXTWIST_LANES LaneHex<N> load(const Mesh& mesh, Index first) {
  return load<N>(mesh, [&](int lane) { return first + lane; });
}

/// The edges of a hex by direction, all pointing up; edge k of an axis as in corners.h.
template <int N>
struct LaneEdges {
  std::array<std::array<LaneVec<N>, 4>, 3> along;

  HEXTWIST_LANES explicit LaneEdges(const LaneHex<N>& x) {
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 0; k < 4; ++k) along[axis][k] = x[edge_corner(4 * axis + k, 1)] - x[edge_corner(4 * axis + k, 0)];
  }
  /// The edge of an axis at a corner.
  const LaneVec<N>& at(int axis, int c) const { return along[axis][gather_bits(axis, c)]; }
};

/// Squared lengths of the edges.
template <int N>
HEXTWIST_LANES std::array<std::array<Lanes<N>, 4>, 3> squares(const LaneEdges<N>& edges) {
  std::array<std::array<Lanes<N>, 4>, 3> result;
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 4; ++k) result[axis][k] = edges.along[axis][k].squared();
  return result;
}

/// How many lanes every machine has.
inline constexpr int n_lanes = 2;

namespace detail {
/// f(N, i) for steps of N from begin on, then f(1, i).
template <int N, class F>
HEXTWIST_LANES void for_steps(Index begin, Index end, const F& f) {
  for (; begin + N <= end; begin += N) f(std::integral_constant<int, N>(), begin);
  for (; begin < end; ++begin) f(std::integral_constant<int, 1>(), begin);
}
template <class F>
void for_narrow_lanes(Index begin, Index end, const F& f) {
  for_steps<n_lanes>(begin, end, f);
}
#if defined(__GNUC__) && defined(__x86_64__)
/// Without fused multiplication and addition, which would give other bits.
template <class F>
[[gnu::target("avx2")]] void for_wide_lanes(Index begin, Index end, const F& f) {
  for_steps<4>(begin, end, f);
}
inline bool has_wide_lanes() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}
#endif
}  // namespace detail

/// f(N, i) for begin .. end - 1 in steps: what it does for N hexes from i on, as many together as the machine can. N is
/// an integral_constant; f must be marked HEXTWIST_LANE_LAMBDA.
template <class F>
void for_lanes(Index begin, Index end, const F& f) {
#if defined(__GNUC__) && defined(__x86_64__)
  if (detail::has_wide_lanes()) return detail::for_wide_lanes(begin, end, f);
#endif
  detail::for_narrow_lanes(begin, end, f);
}

}  // namespace hextwist
