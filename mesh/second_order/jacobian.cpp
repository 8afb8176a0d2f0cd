#include "hextwist/mesh/second_order/jacobian.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "hextwist/mesh/quality/bernstein_internal.h"

namespace hextwist {
namespace {

using Piece = BernsteinPiece<5>;
constexpr int n_rows = Piece::n_rows;
constexpr double coefficient_rounding = 1e-13;  // of the product of the longest derivatives

constexpr std::array<double, 6> choose_5 = {1, 5, 10, 10, 5, 1};
constexpr std::array<double, 3> choose_2 = {1, 2, 1};

/// A polynomial in Bernstein form, each coefficient times its binomials: products are plain convolutions then.
template <class T, int nx, int ny, int nz>
struct Scaled {
  static constexpr int size[3] = {nx, ny, nz};
  std::array<T, static_cast<std::size_t>(nx) * ny * nz> c;
  T& at(int i, int j, int k) { return c[i + nx * (j + ny * k)]; }
  const T& at(int i, int j, int k) const { return c[i + nx * (j + ny * k)]; }
};

/// Values at 0, 1/2, 1 of each axis to Bernstein coefficients.
QuadraticHex bernstein(const QuadraticHex& values) {
  QuadraticHex c = values;
  for (const int step : {1, 3, 9})
    for (int i = 0; i < 27; ++i)
      if (i / step % 3 == 1) c[i] = 2 * c[i] - 0.5 * (c[i - step] + c[i + step]);
  return c;
}

/// The derivative along an axis.
template <int axis>
auto derivative(const QuadraticHex& control) {
  constexpr int step = axis == 0 ? 1 : axis == 1 ? 3 : 9;
  Scaled<Vec3, axis == 0 ? 2 : 3, axis == 1 ? 2 : 3, axis == 2 ? 2 : 3> d;
  for (int k = 0; k < d.size[2]; ++k)
    for (int j = 0; j < d.size[1]; ++j)
      for (int i = 0; i < d.size[0]; ++i) {
        const int from = i + 3 * j + 9 * k;
        double binomials = 2;  // the degree
        if (axis != 0) binomials *= choose_2[i];
        if (axis != 1) binomials *= choose_2[j];
        if (axis != 2) binomials *= choose_2[k];
        d.at(i, j, k) = binomials * (control[from + step] - control[from]);
      }
  return d;
}

template <int nx, int ny, int nz>
double longest(const Scaled<Vec3, nx, ny, nz>& d) {
  double most = 0;
  for (const Vec3& v : d.c) most = std::max(most, v.squaredNorm());
  return std::sqrt(most);
}

struct Determinant {
  Piece whole;
  double scale;
};

Determinant determinant(const QuadraticHex& hex) {
  const QuadraticHex control = bernstein(hex);
  const auto dx = derivative<0>(control);
  const auto dy = derivative<1>(control);
  const auto dz = derivative<2>(control);
  Scaled<Vec3, 5, 4, 4> area;
  area.c.fill(Vec3::Zero());
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 3; ++i)
        for (int n = 0; n < 2; ++n)
          for (int m = 0; m < 3; ++m)
            for (int l = 0; l < 3; ++l) area.at(i + l, j + m, k + n) += dy.at(i, j, k).cross(dz.at(l, m, n));
  Determinant result{{}, longest(dx) * longest(dy) * longest(dz)};
  auto& c = result.whole.coefficient;
  c.fill(0);
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 5; ++i)
        for (int n = 0; n < 3; ++n)
          for (int m = 0; m < 3; ++m)
            for (int l = 0; l < 2; ++l)
              c[i + l + n_rows * (j + m + n_rows * (k + n))] += area.at(i, j, k).dot(dx.at(l, m, n));
  for (int k = 0; k < n_rows; ++k)
    for (int j = 0; j < n_rows; ++j)
      for (int i = 0; i < n_rows; ++i) c[i + n_rows * (j + n_rows * k)] /= choose_5[i] * choose_5[j] * choose_5[k];
  return result;
}

/// Lagrange's basis at 0, 1/2, 1, and its derivatives.
std::array<double, 3> basis(double x) {
  return {(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)};
}
std::array<double, 3> slopes(double x) {
  return {4 * x - 3, 4 - 8 * x, 4 * x - 1};
}

}  // namespace

Vec3 point(const QuadraticHex& hex, const Vec3& at) {
  const auto x = basis(at.x()), y = basis(at.y()), z = basis(at.z());
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 27; ++i) sum += x[i % 3] * y[i / 3 % 3] * z[i / 9] * hex[i];
  return sum;
}

std::array<Vec3, 3> jacobian(const QuadraticHex& hex, const Vec3& at) {
  std::array<Vec3, 3> columns;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<std::array<double, 3>, 3> f = {basis(at.x()), basis(at.y()), basis(at.z())};
    f[axis] = slopes(at[axis]);
    columns[axis] = Vec3::Zero();
    for (int i = 0; i < 27; ++i) columns[axis] += f[0][i % 3] * f[1][i / 3 % 3] * f[2][i / 9] * hex[i];
  }
  return columns;
}

bool is_positive_everywhere(const QuadraticHex& hex) {
  const Determinant det = determinant(hex);
  return !not_above(det.whole, coefficient_rounding * det.scale);
}

void blend_faces(QuadraticHex& hex) {
  for (const int at : {4, 10, 12, 14, 16, 22}) {
    // The two axes in the face.
    std::array<int, 2> steps{};
    int n = 0;
    for (const int step : {1, 3, 9})
      if (at / step % 3 == 1) steps[n++] = step;
    const auto [s, t] = steps;
    hex[at] = 0.5 * (hex[at - s] + hex[at + s] + hex[at - t] + hex[at + t]) -
              0.25 * (hex[at - s - t] + hex[at + s - t] + hex[at - s + t] + hex[at + s + t]);
  }
  blend_centre(hex);
}

void blend_centre(QuadraticHex& hex) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 27; ++i) {
    const int n_middles = (i % 3 == 1) + (i / 3 % 3 == 1) + (i / 9 == 1);
    if (n_middles == 2) sum += 0.5 * hex[i];
    if (n_middles == 1) sum -= 0.25 * hex[i];
    if (n_middles == 0) sum += 0.125 * hex[i];
  }
  hex[13] = sum;
}

}  // namespace hextwist
