// The reference hex as bit arithmetic.
//
// Corner c of a hex lies at (c & 1, c >> 1 & 1, c >> 2 & 1).
// Edge e = 4 * axis + k runs along `axis`; k holds the bits of the other two axes, the lower axis in bit 0.
// Face f = 2 * axis + side lies at coordinate `side` of `axis`; its corner k (0..3) holds the bits of the other two
// axes, the lower axis in bit 0. That bit frame is used inside; files want a cycle: `face_cycle`.
#pragma once

#include <array>

#include "hextwist/mesh/mesh.h"

namespace HEXTWIST_API hextwist {

inline constexpr int n_hex_corners = 8;  ///< numbered 0 .. 7 by their bits
inline constexpr int n_hex_edges = 12;   ///< numbered 0 .. 11, four along x, four along y, four along z
inline constexpr int n_hex_faces = 6;    ///< numbered 0 .. 5: x = 0, x = 1, y = 0, y = 1, z = 0, z = 1

/// Spreads the two bits of k over the axes other than `axis`.
constexpr int spread_bits(int axis, int k) {
  return axis == 0 ? k << 1 : axis == 1 ? (k & 1) | (k & 2) << 1 : k;
}
/// Gathers the two bits of corner c other than that of `axis`.
constexpr int gather_bits(int axis, int c) {
  return axis == 0 ? c >> 1 : axis == 1 ? (c & 1) | (c >> 1 & 2) : c & 3;
}

/// Corner at end 0 or 1 of an edge.
constexpr int edge_corner(int edge, int end) {
  return spread_bits(edge >> 2, edge & 3) | end << (edge >> 2);
}
/// The edge between two corners that differ in exactly one bit.
constexpr int edge_between(int c, int d) {
  const int axis = (c ^ d) == 1 ? 0 : (c ^ d) == 2 ? 1 : 2;
  return 4 * axis + gather_bits(axis, c);
}
/// Corner k (0..3, bit frame) of a face.
constexpr int face_corner(int face, int k) {
  return spread_bits(face >> 1, k) | (face & 1) << (face >> 1);
}

/// Edge j of a face in its bit frame: j = 0, 1 run along the face's first axis at second coordinate 0, 1;
/// j = 2, 3 run along its second axis at first coordinate 0, 1. Returns the edge of the hex.
constexpr int face_edge(int face, int j) {
  const int c = j < 2 ? face_corner(face, j << 1) : face_corner(face, j & 1);
  const int d = j < 2 ? face_corner(face, j << 1 | 1) : face_corner(face, (j & 1) | 2);
  return edge_between(c, d);
}

/// Corners of a face as a cycle that is counter-clockwise seen from outside of a positively oriented hex.
constexpr std::array<int, 4> face_cycle(int face) {
  // In the bit frame the cycle 0 1 3 2 turns from the first to the second remaining axis; that is the outward
  // direction for axis 0 and 2 at side 1 and for axis 1 at side 0.
  const bool outward = ((face & 1) == 1) == (face >> 1 != 1);
  if (outward) return {face_corner(face, 0), face_corner(face, 1), face_corner(face, 3), face_corner(face, 2)};
  return {face_corner(face, 0), face_corner(face, 2), face_corner(face, 3), face_corner(face, 1)};
}

/// Corner order of VTK, Exodus, Abaqus, Gmsh and MEDIT: their corner i is our corner file_corner[i]; the table is
/// its own inverse.
inline constexpr std::array<int, 8> file_corner = {0, 1, 3, 2, 4, 5, 7, 6};

/// Nodes of one side, in the bit frame.
constexpr std::array<Index, 4> face_nodes(const Hex& hex, int face) {
  return {hex[face_corner(face, 0)], hex[face_corner(face, 1)], hex[face_corner(face, 2)], hex[face_corner(face, 3)]};
}
/// Nodes of one side as a cycle, counter-clockwise seen from outside of a positively oriented hex.
constexpr std::array<Index, 4> face_node_cycle(const Hex& hex, int face) {
  const auto cycle = face_cycle(face);
  return {hex[cycle[0]], hex[cycle[1]], hex[cycle[2]], hex[cycle[3]]};
}
/// Whether two cycles of the same four nodes turn the same way.
constexpr bool turn_the_same_way(const std::array<Index, 4>& a, const std::array<Index, 4>& b) {
  for (std::size_t i = 0; i < 4; ++i)
    if (b[i] == a[0]) return b[(i + 1) % 4] == a[1];
  return false;
}

}  // namespace hextwist
