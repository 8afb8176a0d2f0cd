// The trisecting pass: single hex sheet operations of Harris, Benzley and Owen, sections 4.1 to 4.4, all at once.
//
// A code of this pass is a mask of 12 bits, one for each edge of a hex (corners.h): bit set, edge cut in three.
// What a quad face looks like depends on its own four edges alone:
//
//   none   1 quad                        two opposite    3 quads
//   one    4 quads, 2 nodes inside       all four        9 quads, 4 nodes inside
//   two adjacent (L)  11 quads, 8 inside three (U)      14 quads, 10 inside
//
// so a hex is cut independently of all others. Hexes without an L or U that are convex in each direction get the
// paper's templates (a), (b), (c), direction after direction: 27, 13, 9, 5, 4, 3 hexes. All other masks get a smaller
// hex inside and a frustum under each face; a frustum has cuts on its outer face only (1, 5, 4, 13, L 14, U 18 hexes).
// A hex that itself has its cuts on one face only needs just that frustum.
#pragma once

#include <memory>
#include <span>

#include "hextwist/refine/templates/split_table.h"

namespace hextwist {

inline constexpr int n_trisect_codes = 1 << n_hex_edges;
inline constexpr int trisect_all = n_trisect_codes - 1;

std::shared_ptr<const SplitTable> trisect_table();

/// Some direction has three or two diagonal cut edges: the twist plane would have to cross itself (figure 6).
bool is_concave_in_a_direction(int edge_mask);

/// No face is an L or U and no direction has three or two diagonal cut edges: the paper's templates suffice.
bool is_convex(int edge_mask);

/// Edge mask of a hex from the marks of its corners: an edge is cut when both its ends are marked.
int edge_mask_of_corners(int corner_mask);

/// Face code of the trisecting pass: bit j is set when edge j of the face (face_edge() in corners.h) is cut.
int trisect_face_code(int edge_mask, int face);

}  // namespace hextwist
