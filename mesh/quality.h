// Quality of hexes: shape and scaled Jacobian.
//
// At each corner c of a hex, A is the 3x3 matrix of its three edge vectors (right-handed order).
//   shape           3 det(A)^(2/3) / |A|^2 (Frobenius), smallest of the eight corners, 0 where det <= 0 (Knupp; the
//                   metric of Harris et al. tables 2 to 4)
//   scaled Jacobian det(A) / product of the edge lengths, smallest of the eight corners and the centre (as Verdict)
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace hextwist {

enum class Metric { shape, scaled_jacobian };

/// "shape", "scaled Jacobian".
const char* name(Metric metric);
/// Metric by name, case ignored, words cut or joined with '_' or ' '. Throws Error listing the known ones.
Metric metric(std::string_view name);

double quality(Metric metric, std::span<const Vec3, 8> corners);
double quality(Metric metric, const Mesh& mesh, Index hex);
/// One value per hex.
std::vector<double> quality(Metric metric, const Mesh& mesh);

struct Summary {
  Index count = 0;
  double average = 0;
  double std_dev = 0;  ///< of the population (divided by n)
  double min = 0;
  double max = 0;
  Index min_hex = -1;  ///< lowest index among equals
  Index max_hex = -1;
};
/// Summary over all values, or over a selection of hexes. The sum's order is fixed: same result for any threads.
Summary summarize(std::span<const double> values);
Summary summarize(std::span<const double> values, std::span<const Index> hexes);

/// Smallest corner Jacobian determinant of a hex (8 corners): positive means uninverted.
double min_corner_jacobian(std::span<const Vec3, 8> corners);
double min_corner_jacobian(const Mesh& mesh, Index hex);

}  // namespace hextwist
