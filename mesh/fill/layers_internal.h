// What layers of a sweep share. Included by mesh/fill/*.cpp only.
#pragma once

#include <Eigen/SparseCholesky>
#include <map>

#include "hextwist/mesh/fill/builder_internal.h"

namespace hextwist::fill {

inline Edge edge_of(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}
using QuadsAtEdge = std::map<Edge, std::vector<Index>>;
QuadsAtEdge quads_at_edges(const std::vector<Quad>& quads);
/// The node of the quad that an edge leads to from `node`, other than `but`.
Index other_neighbour(const Quad& quad, Index node, Index but);
/// Makes quads that hang together turn all the same way.
void orient_alike(std::vector<Quad>& quads);
/// Edges of one quad alone, as the quads turn.
std::vector<Edge> rim_edges(const std::vector<Quad>& quads, const QuadsAtEdge& at_edge);

/// Per node of a rim the nodes above it, from itself on.
using Columns = std::map<Index, std::vector<Index>>;
/// Throws Error where its first node has another one. volume: how messages begin.
void add_column(Columns& columns, const std::vector<Index>& column, const std::string& volume);
/// How many nodes each of them has; 0: they differ, or there are none.
std::size_t height_of(const Columns& columns);

/// Positions of the inner nodes of a quad mesh for any places of its rim.
class Inside {
 public:
  Inside(const std::vector<Quad>& quads, const std::vector<Edge>& rim);

  const std::vector<Index>& inner() const { return inner_; }
  const std::vector<Index>& rim_nodes() const { return rim_nodes_; }

  /// from, from_inner: the places in one layer; to: those of the rim in the other. Both of the rim as rim_nodes().
  std::vector<Vec3> moved(const std::vector<Vec3>& from, const std::vector<Vec3>& from_inner,
                          const std::vector<Vec3>& to) const;
  /// Of the rim at these places, as the quads turn.
  Vec3 vector_area(const std::vector<Vec3>& rim) const;

 private:
  std::vector<Edge> rim_;  // as the quads turn
  std::map<Index, std::ptrdiff_t> slot_;
  std::vector<Index> rim_nodes_, inner_;
  Eigen::SparseMatrix<double> of_rim_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

}  // namespace hextwist::fill
