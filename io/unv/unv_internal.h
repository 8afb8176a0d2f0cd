// Elements of I-deas universal files (dataset 2412).
#pragma once

#include <array>
#include <cstddef>
#include <utility>

namespace hextwist::io {

inline constexpr int unv_hex = 115, unv_hex_20 = 116, unv_quad = 94, unv_quad_8 = 95;
inline constexpr int unv_quads[] = {44, 54, 64, 84, 94, 122};
inline constexpr int unv_quads_8[] = {45, 55, 65, 85, 95};
inline constexpr std::pair<int, const char*> unv_refused[] = {{111, "tetrahedron"},
                                                              {118, "tetrahedron of 10 nodes"},
                                                              {117, "tetrahedron"},
                                                              {112, "wedge"},
                                                              {113, "wedge of 15 nodes"},
                                                              {114, "wedge"},
                                                              {119, "brick of rigid sides"},
                                                              {101, "wedge"},
                                                              {102, "wedge"},
                                                              {103, "wedge"},
                                                              {104, "thick shell brick"},
                                                              {105, "thick shell brick"},
                                                              {106, "thick shell brick"}};

/// Place of node i of a hex of 20 nodes (which go round: corner, middle, corner, ...) among corners and middle nodes in
/// VTK's order.
inline constexpr std::array<std::size_t, 20> unv_place = {0,  8,  1, 9,  2, 10, 3, 11, 16, 17,
                                                          18, 19, 4, 12, 5, 13, 6, 14, 7,  15};

}  // namespace hextwist::io
