// Nek5000's and NekRS' .re2: elements with their own eight corners, middles of curved edges, conditions on sides.
//
// 80 characters "#v002<elements,9><dimension,3><fluid elements,9>", the float 6.54321 (which tells the byte order), per
// element its group and x, y, z of its corners, then lists of (element, edge or side, five numbers, a code): one of
// curves and one of conditions for each field. Version 1 has words of 4 bytes, 2 and 3 have 8 (integers as doubles); 3
// says that there is one list of conditions. Source: Nek5000's documentation, "Mesh file", and what its tool gmsh2nek
// writes: sides have the code MSH and the number of their set as the fifth number.
#pragma once

#include <functional>

#include "hextwist/io/middles.h"

namespace hextwist::io {

inline constexpr float nek_mark = 6.54321F;
inline constexpr std::size_t nek_header = 80;

/// Edges 1 .. 12: the lower ring, the upper ring, the pillars.
inline constexpr const MiddleOrder& nek_edges = vtk_middles;
/// Sides 1 .. 6, as faces of corners.h.
inline constexpr std::array<int, 6> nek_sides = {
    face_of_file_corners({1, 2, 6, 5}), face_of_file_corners({2, 3, 7, 6}), face_of_file_corners({3, 4, 8, 7}),
    face_of_file_corners({4, 1, 5, 8}), face_of_file_corners({1, 2, 3, 4}), face_of_file_corners({5, 6, 7, 8})};

/// Of corners, eight of each element in the order of the files: per corner the first that it is one node with, by their
/// places. crowded: called with a corner where too many are near to tell.
std::vector<Index> one_by_place(std::span<const Vec3> corners, const std::function<void(Index)>& crowded);

/// Solvers know groups up to this.
inline constexpr int nek_highest_group = 10;
/// Names of blocks that say which elements are solid: they come last.
inline constexpr const char *nek_fluid = "fluid", *nek_solid = "solid";
/// Conditions that need nothing but their code; a side set of such a name has it.
inline constexpr std::string_view nek_codes[] = {"W", "v", "V",  "vl", "VL",  "O",   "o",   "ON",  "on", "SYM",
                                                 "A", "T", "t",  "F",  "f",   "I",   "C",   "c",   "SH", "sh",
                                                 "S", "s", "mv", "MV", "MSH", "EXO", "CGN", "INT", "int"};

}  // namespace hextwist::io
