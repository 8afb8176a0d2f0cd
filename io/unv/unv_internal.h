// Elements of I-deas universal files (dataset 2412).
#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "hextwist/mesh/others.h"

namespace hextwist::io {

inline constexpr int unv_hex = 115, unv_hex_20 = 116, unv_quad = 94, unv_quad_8 = 95;
inline constexpr int unv_quads[] = {44, 54, 64, 84, 94, 122};
inline constexpr int unv_quads_8[] = {45, 55, 65, 85, 95};
inline constexpr std::pair<int, const char*> unv_refused[] = {{114, "wedge"},
                                                              {117, "tetrahedron"},
                                                              {119, "brick of rigid sides"},
                                                              {101, "wedge"},
                                                              {102, "wedge"},
                                                              {103, "wedge"},
                                                              {104, "thick shell brick"},
                                                              {105, "thick shell brick"},
                                                              {106, "thick shell brick"}};

/// Fields of hexes that have the numbers of their physical property and material (io/hex_numbers.h).
inline constexpr const char *unv_property = "property", *unv_material = "material";

/// Elements beside the hexes: descriptor, shape, nodes; place: of node i of the file among those here (go round:
/// corner, middle, corner, ...).
struct UnvOther {
  int kind;
  OtherShape shape;
  std::size_t n_nodes;
  std::array<std::size_t, 15> place;
};
inline constexpr std::array<std::size_t, 15> unv_as_it_is = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14};
inline constexpr std::array<std::size_t, 15> unv_triangle_6 = {0, 3, 1, 4, 2, 5};
inline constexpr UnvOther unv_others[] = {
    {11, OtherShape::line, 2, unv_as_it_is},
    {21, OtherShape::line, 2, unv_as_it_is},
    {22, OtherShape::line, 2, unv_as_it_is},
    {24, OtherShape::line, 3, {0, 2, 1}},
    {31, OtherShape::line, 2, unv_as_it_is},
    {41, OtherShape::triangle, 3, unv_as_it_is},
    {51, OtherShape::triangle, 3, unv_as_it_is},
    {61, OtherShape::triangle, 3, unv_as_it_is},
    {74, OtherShape::triangle, 3, unv_as_it_is},
    {81, OtherShape::triangle, 3, unv_as_it_is},
    {91, OtherShape::triangle, 3, unv_as_it_is},
    {42, OtherShape::triangle, 6, unv_triangle_6},
    {52, OtherShape::triangle, 6, unv_triangle_6},
    {62, OtherShape::triangle, 6, unv_triangle_6},
    {82, OtherShape::triangle, 6, unv_triangle_6},
    {92, OtherShape::triangle, 6, unv_triangle_6},
    {111, OtherShape::tetrahedron, 4, unv_as_it_is},
    {118, OtherShape::tetrahedron, 10, {0, 4, 1, 5, 2, 6, 7, 8, 9, 3}},
    {112, OtherShape::wedge, 6, unv_as_it_is},
    {113, OtherShape::wedge, 15, {0, 6, 1, 7, 2, 8, 12, 13, 14, 3, 9, 4, 10, 5, 11}},
    {121, OtherShape::connector, 0, unv_as_it_is},
    {136, OtherShape::connector, 0, unv_as_it_is},
    {137, OtherShape::connector, 0, unv_as_it_is},
    {138, OtherShape::connector, 0, unv_as_it_is},
    {139, OtherShape::connector, 0, unv_as_it_is},
    {141, OtherShape::connector, 0, unv_as_it_is},
    {142, OtherShape::connector, 0, unv_as_it_is},
    {151, OtherShape::connector, 0, unv_as_it_is},
    {152, OtherShape::connector, 0, unv_as_it_is},
    {161, OtherShape::point, 1, unv_as_it_is},
};

/// Place of node i of a hex of 20 nodes (which go round: corner, middle, corner, ...) among corners and middle nodes in
/// VTK's order.
inline constexpr std::array<std::size_t, 20> unv_place = {0,  8,  1, 9,  2, 10, 3, 11, 16, 17,
                                                          18, 19, 4, 12, 5, 13, 6, 14, 7,  15};

}  // namespace hextwist::io
