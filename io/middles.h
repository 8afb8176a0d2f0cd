// Middle nodes of second-order hexes in files: in which order formats have them, and how readers and writers take them.
#pragma once

#include "hextwist/io/format.h"
#include "hextwist/mesh/second_order/second_order.h"

namespace hextwist::io {

/// Of the 12, or 12 + 6 + 1, middle nodes that follow the corners in a file: 0..11 the edge, 12..17 the face, 18 the
/// hex (corners.h).
using MiddleOrder = std::array<int, 19>;

/// By the corners (1..8 in the order of files) at the ends of edges and around faces; whether the centre comes before
/// the faces.
constexpr MiddleOrder middle_order(const std::array<std::array<int, 2>, 12>& edges,
                                   const std::array<std::array<int, 4>, 6>& faces, bool centre_first = false) {
  MiddleOrder order{};
  for (int i = 0; i < 12; ++i) order[i] = edge_between(file_corner[edges[i][0] - 1], file_corner[edges[i][1] - 1]);
  for (int i = 0; i < 6; ++i) order[12 + i + centre_first] = 12 + face_of_file_corners(faces[i]);
  order[centre_first ? 12 : 18] = 18;
  return order;
}

// Sources: VTK's and Gmsh's own element libraries (the tests ask them), Schoof and Yarberry, "EXODUS II", 1994, the
// Abaqus and CalculiX manuals.
inline constexpr std::array<std::array<int, 2>, 12> ring_ring_pillars = {
    {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {5, 6}, {6, 7}, {7, 8}, {8, 5}, {1, 5}, {2, 6}, {3, 7}, {4, 8}}};
inline constexpr std::array<std::array<int, 2>, 12> ring_pillars_ring = {
    {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {1, 5}, {2, 6}, {3, 7}, {4, 8}, {5, 6}, {6, 7}, {7, 8}, {8, 5}}};
inline constexpr MiddleOrder vtk_middles = middle_order(
    ring_ring_pillars, {{{1, 4, 8, 5}, {2, 3, 7, 6}, {1, 2, 6, 5}, {4, 3, 7, 8}, {1, 2, 3, 4}, {5, 6, 7, 8}}});
inline constexpr MiddleOrder gmsh_middles =
    middle_order({{{1, 2}, {1, 4}, {1, 5}, {2, 3}, {2, 6}, {3, 4}, {3, 7}, {4, 8}, {5, 6}, {5, 8}, {6, 7}, {7, 8}}},
                 {{{1, 2, 3, 4}, {1, 2, 6, 5}, {1, 4, 8, 5}, {2, 3, 7, 6}, {4, 3, 7, 8}, {5, 6, 7, 8}}});
inline constexpr MiddleOrder exodus_middles = middle_order(
    ring_pillars_ring, {{{1, 2, 3, 4}, {5, 6, 7, 8}, {1, 4, 8, 5}, {2, 3, 7, 6}, {1, 2, 6, 5}, {4, 3, 7, 8}}}, true);
inline constexpr MiddleOrder abaqus_middles = middle_order(
    ring_ring_pillars, {{{1, 2, 3, 4}, {5, 6, 7, 8}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}}}, true);

/// Middle nodes that a reader has found, 19 per hex by MiddleOrder's numbers; -1: none.
struct FoundMiddles {
  static constexpr std::size_t width = 19;
  std::vector<Index> nodes;
  int nodes_per_hex = 8;  ///< the most that a hex has

  /// Of a hex, by its place: what the file has behind its corners (12 or 19). Hexes that are left out are straight.
  void add(std::size_t hex, std::span<const Index> in_file, const MiddleOrder& order);
  /// So many hexes there are.
  void finish(std::size_t n_hexes) { nodes.resize(any() ? width * n_hexes : 0, -1); }
  bool any() const { return nodes_per_hex > 8; }
};

/// Takes the middle nodes out of the nodes of a mesh that was read with all of them as nodes: what is left is a mesh of
/// hexes with 8 nodes, and where the middles were (MeshFile::middles). Sets and fields lose them. Throws Error where
/// hexes of first and second order, or two of second order, do not fit together.
void take_middles(MeshFile& file, const FoundMiddles& found);

/// Nodes of a hex in the order of a file: 8, 20 or 27. second: null for 8.
struct FileHex {
  std::array<Index, 27> nodes{};
  int n = 8;
  std::span<const Index> all() const { return std::span(nodes).first(static_cast<std::size_t>(n)); }
};
FileHex file_hex(const Mesh& mesh, const SecondOrder* second, Index hex, const MiddleOrder& order);

}  // namespace hextwist::io
