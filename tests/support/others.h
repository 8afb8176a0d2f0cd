// Elements beside hexes: random ones for tests, and checkers that share no code with the library beyond the arrays.
#pragma once

#include <gtest/gtest.h>

#include <random>

#include "hextwist/mesh/others.h"

namespace hextwist::test {

/// How many of each are glued on, of all faces and edges that there are.
struct Glue {
  int rigid_one_in = 12;    ///< pyramids, wedges, tetrahedra, triangles and quads that stand off the hexes
  int skin_one_in = 3;      ///< quads on faces, lines on edges
  bool only_below = false;  ///< those that are not cut at nodes with z = 0 alone
};
/// The mesh with other elements at random faces, edges and nodes, some of them in its blocks; named as Abaqus does. Ids
/// below or above those of the hexes.
Mesh with_others(Mesh mesh, std::mt19937& random, const Glue& glue = {});

/// Every element of the first mesh is in the second, at the same places and under the same id; or cut into quads that
/// cover the same area and turn the same way, or lines that lead from its first node to its last. (Quads are planar.)
testing::AssertionResult others_kept(const Mesh& before, const Mesh& after);

/// Quads that were faces of hexes are, lines that were edges are. No node of a hex or of another element with edges
/// lies inside an edge or face of another element, and none of another element inside an edge or face of a hex.
testing::AssertionResult others_conformal(const Mesh& before, const Mesh& after);

/// Is a node of the mesh inside an edge of an element of `with` that is not cut along?
bool has_node_in_rigid_edge(const Mesh& with, const Mesh& mesh);

}  // namespace hextwist::test
