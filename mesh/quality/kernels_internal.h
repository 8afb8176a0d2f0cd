// Kernels that are evaluated together where all of a mesh is measured (measure.h), and alone as metrics.
#pragma once

#include <cmath>

#include "hextwist/mesh/quality/quality_internal.h"
#include "hextwist/mesh/quality/validity.h"

namespace hextwist {

/// What shape and scaled Jacobian are made of.
template <int N>
struct HexCorners {
  LaneEdges<N> edges;
  std::array<std::array<Lanes<N>, 4>, 3> square;  ///< of the edges' lengths
  std::array<Lanes<N>, 8> det;                    ///< at the corners

  HEXTWIST_LANES explicit HexCorners(const LaneHex<N>& x) : edges(x), square(squares(edges)) {
    for (int c = 0; c < 8; ++c) det[c] = determinant_at(edges, c);
  }
  HEXTWIST_LANES const Lanes<N>& square_at(int axis, int c) const { return square[axis][gather_bits(axis, c)]; }
};

template <int N>
HEXTWIST_LANES Lanes<N> shape_of(const HexCorners<N>& terms) {
  Lanes<N> worst = Lanes<N>::Ones();  // (shape / 3)^3, with the sign of the determinant; nothing is better than 1/27
  for (int c = 0; c < 8; ++c) {
    const Lanes<N>& det = terms.det[c];
    const Lanes<N> frobenius = terms.square_at(0, c) + terms.square_at(1, c) + terms.square_at(2, c);
    const Lanes<N> power = det * det.abs() / (frobenius * frobenius * frobenius);
    worst = worst.min((frobenius > 0).select(power, Lanes<N>::Zero()));
  }
  return Lanes<N>::each([&](int lane)
                            HEXTWIST_LANE_LAMBDA { return worst[lane] > 0 ? 3 * std::cbrt(worst[lane]) : 0; });
}

/// Square of det(A) / product of the lengths, with its sign; 0 where a length is 0.
template <int N>
HEXTWIST_LANES Lanes<N> signed_square(const Lanes<N>& det, const Lanes<N>& product) {
  return (product > 0).select(det * det.abs() / product, Lanes<N>::Zero());
}
/// The least of that over the corners and `worst`.
template <int N>
HEXTWIST_LANES Lanes<N> worst_scaled_corner(const HexCorners<N>& terms, Lanes<N> worst) {
  for (int c = 0; c < 8; ++c)
    worst = worst.min(
        signed_square<N>(terms.det[c], terms.square_at(0, c) * terms.square_at(1, c) * terms.square_at(2, c)));
  return worst;
}
template <int N>
HEXTWIST_LANES Lanes<N> scaled_jacobian_of(const HexCorners<N>& terms) {
  const auto centre = principal_axes(terms.edges);
  Lanes<N> worst =
      worst_scaled_corner<N>(terms, signed_square<N>(determinant(centre[0], centre[1], centre[2]),
                                                     centre[0].squared() * centre[1].squared() * centre[2].squared()));
  const Lanes<N> root = worst.abs().sqrt();  // 0 of both signs is 0
  return (worst < 0).select(-root, root);
}

/// The corners seen from corner 0, so that hexes far from the origin lose no digits.
template <int N>
HEXTWIST_LANES LaneHex<N> from_corner(const LaneHex<N>& x) {
  LaneHex<N> local;
  for (int c = 0; c < 8; ++c) local[c] = x[c] - x[0];
  return local;
}

/// A face that is a bilinear patch with corners p0 p1 p2 p3 (in a cycle seen from outside) adds s . (d x e) / 24 to the
/// volume, where s is the sum of the corners, d = p2 - p0 and e = p3 - p1 the diagonals: exact for the trilinear map.
template <int N>
HEXTWIST_LANES Lanes<N> volume_of(const LaneHex<N>& x) {
  const LaneHex<N> local = from_corner<N>(x);
  Lanes<N> sum = Lanes<N>::Zero();
  for (int face = 0; face < 6; ++face) {
    const auto cycle = face_cycle(face);
    const LaneVec<N>&p = local[cycle[0]], &q = local[cycle[1]], &r = local[cycle[2]], &s = local[cycle[3]];
    sum += determinant((p + q) + (r + s), r - p, s - q);
  }
  return sum / 24;
}

/// Positive: the determinant is more than least_scaled_jacobian of the longest edges' product everywhere, because the
/// edges of each direction differ little from their mean X. At every place the derivatives are means of edges, none
/// farther than r from X, and det(X + d) differs from det(X) by less than the product of the |X| + r less that of the
/// |X|. Most hexes of most meshes are told valid by this.
template <int N>
HEXTWIST_LANES Lanes<N> affine_clearance(const LaneEdges<N>& edges) {
  constexpr double above = 1 + 1e-5;  // more than least_scaled_jacobian, and than rounding adds
  std::array<LaneVec<N>, 3> mean = principal_axes(edges);
  Lanes<N> with_radius = Lanes<N>::Ones(), without = Lanes<N>::Ones();
  for (int axis = 0; axis < 3; ++axis) {
    mean[axis] = scaled(0.25, mean[axis]);
    const auto& e = edges.along[axis];
    const Lanes<N> radius = (e[0] - mean[axis])
                                .squared()
                                .max((e[1] - mean[axis]).squared())
                                .max((e[2] - mean[axis]).squared())
                                .max((e[3] - mean[axis]).squared())
                                .sqrt();
    const Lanes<N> length = mean[axis].squared().sqrt();
    with_radius *= length + radius;
    without *= length;
  }
  return determinant(mean[0], mean[1], mean[2]) + without - above * with_radius;
}

/// Coefficients of the determinant: number i + 3 j + 9 k belongs to degree i, j, k of x, y, z.
template <int N>
using Coefficients = std::array<Lanes<N>, 27>;

/// dx is bilinear in y and z, dy in x and z, dz in x and y; the product of three linear basis functions of one
/// coordinate at most squared is 1 or 1/2 of a quadratic one. First dx x dy, which is quadratic in z alone.
template <int N>
HEXTWIST_LANES Coefficients<N> coefficients(const LaneEdges<N>& edges) {
  const auto &dx = edges.along[0], &dy = edges.along[1], &dz = edges.along[2];
  Coefficients<N> result;
  result.fill(Lanes<N>::Zero());
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const std::array<LaneVec<N>, 3> area = {cross(dx[j], dy[i]),
                                              scaled(0.5, cross(dx[j], dy[i + 2]) + cross(dx[j + 2], dy[i])),
                                              cross(dx[j + 2], dy[i + 2])};
      for (int k = 0; k < 3; ++k)
        for (int other_i = 0; other_i < 2; ++other_i)
          for (int other_j = 0; other_j < 2; ++other_j) {
            const double weight = (i == other_i ? 1 : 0.5) * (j == other_j ? 1 : 0.5);
            result[(i + other_i) + 3 * (j + other_j) + 9 * k] += weight * dot(area[k], dz[other_i + 2 * other_j]);
          }
    }
  return result;
}

/// Product of the longest edges of the three directions: no determinant is larger.
template <int N>
HEXTWIST_LANES Lanes<N> longest_product(const LaneEdges<N>& edges) {
  Lanes<N> product = Lanes<N>::Ones();
  for (const auto& along : edges.along)
    product *= along[0].squared().max(along[1].squared()).max(along[2].squared()).max(along[3].squared());
  return product.sqrt();
}

/// Positive: surely valid, as no scaled Jacobian is below this times least_scaled_jacobian either. Nearly all hexes
/// are.
template <int N>
HEXTWIST_LANES Lanes<N> clearance(const LaneEdges<N>& edges) {
  const Coefficients<N> all = coefficients(edges);
  Lanes<N> least = all[0];
  for (int i = 1; i < 27; ++i) least = least.min(all[i]);
  return least - least_scaled_jacobian * longest_product(edges);
}

}  // namespace hextwist
