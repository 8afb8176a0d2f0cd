// What writers need of elements beside the hexes (mesh/others.h).
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hextwist/mesh/others.h"

namespace hextwist::io {

/// Ids of the other elements in a file where they share numbers with the hexes: their own, pieces behind the highest.
/// All behind the hexes, and a notice, where these are counted from 1 (hex_ids, as ids_in_file() has them, empty though
/// the mesh has some) or an id would be above `highest` (limit: that in words).
std::vector<std::int64_t> other_ids_in_file(const Mesh& mesh, std::span<const std::int64_t> hex_ids,
                                            std::int64_t highest, const char* limit, std::vector<std::string>& notices);

/// The other elements of a block, ascending.
std::vector<Index> others_of_block(const Mesh& mesh, int block);
/// Sides of other elements in a side set: element and side, in the order of the file.
std::vector<std::pair<Index, std::string>> other_sides_of(const Mesh& mesh, int side_set);

}  // namespace hextwist::io
