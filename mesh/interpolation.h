// Values of fields at any points, and on another mesh of the same part, as weights of the values at nodes.
//
//   const Interpolation there = interpolation_at(mesh, points);
//   const std::vector<double> values = values_at(mesh, field, there);
//   const SparseRows p = sparse_rows(before, prolongation(before, after, origin));   // new values = p * old values
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace HEXTWIST_API hextwist {

/// For each of some points a hex, and what its nodes count there.
struct Interpolation {
  std::vector<Index> hexes;       ///< per point the hex that holds it, of several the lowest; outside the nearest
  std::vector<double> weights;    ///< 8 per point, in the order of the hex's nodes; their sum is 1
  std::vector<double> distances;  ///< per point how far it is from that hex; 0 inside
};

/// A sparse matrix by rows: row i has values[k] in column columns[k], for k from first[i] to first[i + 1] - 1.
struct SparseRows {
  std::vector<std::int64_t> first = {0};  ///< one more than rows
  std::vector<Index> columns;             ///< ascending in each row, each once
  std::vector<double> values;             ///< none is 0
};

/// Where points are in a mesh; outside of it the nearest place of the mesh counts. Inside a hex: trilinear. Throws
/// Error for a mesh without hexes and for a coordinate that is not finite, naming the point.
Interpolation interpolation_at(const Mesh& mesh, std::span<const Vec3> points);

/// The nodes of `after` in `before`, from which it was refined or coarsened. origin: per hex of `after` a hex of
/// `before` that it lies in or was made of (AdaptResult::origin): each node is looked for from there on, so that what
/// is apart in `before` stays so; empty: by place alone. A node at the place of an old one counts that one alone. What
/// is linear stays so also outside of `before`, where nodes lie on a curved CAD. Throws Error for hexes in origin that
/// do not exist, for another number of them, for a mesh without hexes.
Interpolation prolongation(const Mesh& before, const Mesh& after, std::span<const Index> origin = {});

/// The same as a matrix: values at the points = matrix * values at the nodes of `mesh`.
SparseRows sparse_rows(const Mesh& mesh, const Interpolation& at);

/// Values of a field of the mesh at the points, `components` each. Of whole numbers that of the node that counts most;
/// of hexes that of the hex.
std::vector<double> values_at(const Mesh& mesh, const Field& field, const Interpolation& at);

}  // namespace hextwist
