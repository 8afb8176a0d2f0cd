// Is a polynomial of three variables above a bound everywhere in the unit cube? Its coefficients in the Bernstein basis
// bound it from below and are its values at the corners; where one is not above, the cube is halved until all are
// (proved) or a value that is not above is found (validity.h has the source).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "hextwist/base/types.h"

namespace hextwist {

/// Of a degree in each variable: number i + n j + n n k belongs to degree i, j, k of x, y, z, n = degree + 1.
template <int degree>
struct BernsteinPiece {
  static constexpr int n_rows = degree + 1, n_coefficients = n_rows * n_rows * n_rows;
  std::array<double, n_coefficients> coefficient;
  Vec3 low = Vec3::Zero(), size = Vec3::Ones();  ///< where it is in the cube that it is a piece of

  /// The coefficient of corner c (corners.h).
  static constexpr int at_corner(int c) { return degree * ((c & 1) + n_rows * ((c >> 1 & 1) + n_rows * (c >> 2 & 1))); }
  /// Calls f(first, step) for the rows of coefficients along an axis.
  template <class F>
  static void for_rows(int axis, F f) {
    const int step = axis == 0 ? 1 : axis == 1 ? n_rows : n_rows * n_rows;
    for (int i = 0; i < n_coefficients; ++i)
      if (i / step % n_rows == 0) f(i, step);
  }

  /// The axis along which the coefficients bend most: halving it brings them nearest to the values.
  int most_bent() const {
    std::array<double, 3> bend{};
    for (int axis = 0; axis < 3; ++axis)
      for_rows(axis, [&](int i, int step) {
        for (int r = 1; r < degree; ++r) {
          const double* c = &coefficient[i + r * step];
          bend[axis] = std::max(bend[axis], std::abs(c[-step] - 2 * c[0] + c[step]));
        }
      });
    return static_cast<int>(std::ranges::max_element(bend) - bend.begin());
  }

  /// Halves along an axis (de Casteljau).
  std::array<BernsteinPiece, 2> halves(int axis) const {
    std::array<BernsteinPiece, 2> half = {*this, *this};
    for_rows(axis, [&](int i, int step) {
      std::array<double, n_rows> row;
      for (int r = 0; r < n_rows; ++r) row[r] = coefficient[i + r * step];
      for (int level = 0; level < n_rows; ++level) {
        half[0].coefficient[i + level * step] = row[0];
        half[1].coefficient[i + (degree - level) * step] = row[degree - level];
        for (int r = 0; r < degree - level; ++r) row[r] = (row[r] + row[r + 1]) / 2;
      }
    });
    for (BernsteinPiece& piece : half) piece.size[axis] /= 2;
    half[1].low[axis] += half[1].size[axis];
    return half;
  }
};

struct BernsteinPlace {
  double value;  ///< 0 where too many pieces were looked at
  Vec3 at;
};
/// A place where it is not above `least`, or where that can't be decided within 4096 pieces. Nothing: it is above
/// everywhere.
template <int degree>
std::optional<BernsteinPlace> not_above(const BernsteinPiece<degree>& whole, double least) {
  constexpr int max_pieces = 4096;
  std::vector<BernsteinPiece<degree>> open = {whole};
  for (std::size_t next = 0; next < open.size(); ++next) {
    const BernsteinPiece<degree> piece = open[next];
    for (int c = 0; c < 8; ++c)
      if (const double value = piece.coefficient[piece.at_corner(c)]; !(value > least))
        return BernsteinPlace{value, piece.low + piece.size.cwiseProduct(Vec3(c & 1, c >> 1 & 1, c >> 2 & 1))};
    if (std::ranges::all_of(piece.coefficient, [&](double value) { return value > least; })) continue;
    if (open.size() >= max_pieces) return BernsteinPlace{0, piece.low + piece.size / 2};
    const auto both = piece.halves(piece.most_bent());
    open.insert(open.end(), both.begin(), both.end());
  }
  return std::nullopt;
}

}  // namespace hextwist
