// Arithmetic on several hexes at once, one per lane, written once for any number of lanes so that one hex alone gets
// the same bits as a million.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "hextwist/mesh/corners.h"

namespace hextwist {

/// What works on lanes is a few instructions where it is inlined, and many where it is called.
#if defined(__GNUC__)
#define HEXTWIST_LANES [[gnu::always_inline]] inline
#else
#define HEXTWIST_LANES inline
#endif

template <int N>
using Lanes = Eigen::Array<double, N, 1>;

template <int N>
struct LaneVec {
  Lanes<N> x, y, z;

  HEXTWIST_LANES LaneVec operator-(const LaneVec& b) const { return {x - b.x, y - b.y, z - b.z}; }
  HEXTWIST_LANES LaneVec operator+(const LaneVec& b) const { return {x + b.x, y + b.y, z + b.z}; }
  HEXTWIST_LANES Lanes<N> squared() const {
    // In steps, here and below: longer expressions are calls of Eigen.
    Lanes<N> sum = x * x;
    sum += y * y;
    sum += z * z;
    return sum;
  }
};

template <int N>
HEXTWIST_LANES Lanes<N> determinant(const LaneVec<N>& a, const LaneVec<N>& b, const LaneVec<N>& c) {
  const auto cofactor = [](const Lanes<N>& p, const Lanes<N>& q, const Lanes<N>& r, const Lanes<N>& s) {
    Lanes<N> result = p * q;
    result -= r * s;
    return result;
  };
  Lanes<N> sum = a.x * cofactor(b.y, c.z, b.z, c.y);
  sum += a.y * cofactor(b.z, c.x, b.x, c.z);
  sum += a.z * cofactor(b.x, c.y, b.y, c.x);
  return sum;
}

template <int N>
using LaneHex = std::array<LaneVec<N>, 8>;

inline LaneHex<1> load(std::span<const Vec3, 8> corners) {
  LaneHex<1> lanes;
  for (int c = 0; c < 8; ++c) {
    lanes[c].x[0] = corners[c].x();
    lanes[c].y[0] = corners[c].y();
    lanes[c].z[0] = corners[c].z();
  }
  return lanes;
}
/// Hexes hex_of(0) to hex_of(N - 1).
template <int N, class HexOf>
HEXTWIST_LANES LaneHex<N> load(const Mesh& mesh, const HexOf& hex_of) {
  LaneHex<N> lanes;
  for (int lane = 0; lane < N; ++lane) {
    const Hex& hex = mesh.hexes[hex_of(lane)];
    for (int c = 0; c < 8; ++c) {
      const Vec3& p = mesh.points[hex[c]];
      lanes[c].x[lane] = p.x();
      lanes[c].y[lane] = p.y();
      lanes[c].z[lane] = p.z();
    }
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

}  // namespace hextwist
