// What reading and writing of Exodus II share.
#pragma once

#include "hextwist/io/format.h"

namespace hextwist::io {

/// Sides 1..6 of a hex, by their corners (Schoof and Yarberry, "EXODUS II: a finite element data model", 1994).
inline constexpr std::array<int, 6> exodus_face = {
    face_of_file_corners({1, 2, 6, 5}), face_of_file_corners({2, 3, 7, 6}), face_of_file_corners({3, 4, 8, 7}),
    face_of_file_corners({1, 5, 8, 4}), face_of_file_corners({1, 4, 3, 2}), face_of_file_corners({5, 6, 7, 8})};

/// The library's calls for many numbers are made in pieces of so many nodes or hexes: what they need stays in the
/// cache, and no array is there twice.
inline constexpr std::size_t exodus_piece = std::size_t{1} << 13;
template <class F>
void in_pieces(std::size_t n, F&& f) {
  for (std::size_t first = 0; first < n; first += exodus_piece) f(first, std::min(exodus_piece, n - first));
}

/// The library counts from 1.
inline std::int64_t exodus_position(std::size_t i) {
  return static_cast<std::int64_t>(i) + 1;
}

/// Name of the element block for hexes that are in no block.
inline constexpr const char* exodus_rest_block = "hextwist_no_block";

}  // namespace hextwist::io
