// Quality of hexes: shape and scaled Jacobian.
//
// At each corner c of a hex, A is the 3x3 matrix of its three edge vectors (right-handed order).
//   shape           3 det(A)^(2/3) / |A|^2 (Frobenius), smallest of the eight corners, 0 where det <= 0 (Knupp; the
//                   metric of Harris et al. tables 2 to 4)
//   scaled Jacobian det(A) / product of the edge lengths, smallest of the eight corners and the centre, where the
//                   edge vectors are the sums of the four edges of each direction
//
// Guarantees:
//  1. 1 for a cube, 0 for a hex that is flat somewhere; shape in 0..1, scaled Jacobian in -1..1 (up to rounding);
//  2. the values of Verdict (and so of VTK, ParaView, CUBIT) to rounding, except where an edge or centre vector has no
//     length: such a corner has scaled Jacobian 0 here; Verdict calls the whole hex 1e30, the best there is;
//  3. independent of scale while edge lengths lie in 1e-50..1e50 (Verdict's shape is 0 below 1e-10);
//  4. the same bits from every function here, for any number of threads.
// Precondition everywhere: finite coordinates, nodes that exist (validate() finds the others).
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
/// Every metric, in the order of the enum.
std::span<const Metric> metrics();
/// Metric by name. Case does not matter, words may be cut short while that is unambiguous, and joined by ' ', '_', '-'
/// or nothing: "Scaled Jac", "scaled_jacobian", "sha". Throws Error listing the known ones.
Metric metric(std::string_view name);

double quality(Metric metric, std::span<const Vec3, 8> corners);
double quality(Metric metric, const Mesh& mesh, Index hex);
/// One value per hex.
std::vector<double> quality(Metric metric, const Mesh& mesh);

/// Count 0: everything else 0 or -1.
struct Summary {
  Index count = 0;
  double average = 0;
  double std_dev = 0;  ///< of the population (divided by n)
  double min = 0;
  double max = 0;
  Index min_hex = -1;  ///< index of the hex; the lowest among equals
  Index max_hex = -1;
};
/// Summary over all values (one per hex), or over a selection of hexes (in any order). The sum's order is fixed: same
/// result for any threads.
Summary summarize(std::span<const double> values);
Summary summarize(std::span<const double> values, std::span<const Index> hexes);

/// Smallest corner Jacobian determinant of a hex (8 corners): positive means uninverted.
double min_corner_jacobian(std::span<const Vec3, 8> corners);
double min_corner_jacobian(const Mesh& mesh, Index hex);
/// One value per hex.
std::vector<double> min_corner_jacobian(const Mesh& mesh);

}  // namespace hextwist
