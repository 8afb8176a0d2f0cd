// Levels: how often each hex was cut in all its directions, and marks that keep neighbours within one level.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hextwist/sizing/request.h"

namespace hextwist {

/// Field of hexes that says how often each was cut, 0 where the mesh has none. Children of a hex that was cut in all
/// its directions in one pass are one level above it; those of the transition around keep its level.
inline constexpr const char* level_field = "level";

/// Level of every hex: the field, or zeros.
std::vector<int> levels(const Mesh& mesh);

/// Flags of hexes that are cut in all directions and of those that have to go with them so that levels stay graded: a
/// neighbour of a flagged hex that is of a lower level is flagged too, and so on. Returns how many were added.
Index close_flags(const Mesh& mesh, std::span<const int> level, std::span<std::uint8_t> flags);

/// The field, made of zeros where the mesh has none.
Field& level_field_of(Mesh& mesh);

/// Marks more nodes (all of some hexes), so that trisecting keeps levels graded (Levels::graded) where they are; with
/// Concave::fill what that fills as well. Returns how many hexes more are marked as a whole.
Index grade_marks(const Mesh& mesh, Concave concave, std::span<std::uint8_t> marked);
/// Tells of them.
void say_graded(Index n_hexes, std::vector<std::string>& notices);

}  // namespace hextwist
