// What reading and writing of MFEM's meshes share: how MFEM numbers edges and faces, where its middle nodes are.
#pragma once

#include "hextwist/io/medit/references_internal.h"
#include "hextwist/io/middles.h"
#include "hextwist/mesh/topology.h"

namespace hextwist::io {

inline constexpr int mfem_square = 3, mfem_cube = 5;

/// Edges and faces of a hex in MFEM's order, as ours (corners.h); corners are those of other files.
inline constexpr MiddleOrder mfem_middles =
    middle_order({{{1, 2}, {2, 3}, {4, 3}, {1, 4}, {5, 6}, {6, 7}, {8, 7}, {5, 8}, {1, 5}, {2, 6}, {3, 7}, {4, 8}}},
                 {{{4, 3, 2, 1}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}, {5, 6, 7, 8}}});

/// Comments of ours: groups and their attributes, and the attributes of what is in no group.
inline constexpr ReferenceKinds mfem_blocks = {"block", "no_block"}, mfem_side_sets = {"sideset", "no_sideset"};

/// MFEM numbers edges and faces as its elements name them for the first time: per edge or face of ours its number.
template <std::size_t n>
std::vector<Index> mfem_numbers(const std::vector<std::array<Index, n>>& of_hex, std::size_t n_items,
                                std::size_t first_middle) {
  std::vector<Index> number(n_items, -1);
  Index next = 0;
  for (const std::array<Index, n>& items : of_hex)
    for (std::size_t i = 0; i < n; ++i) {
      const int local = mfem_middles[first_middle + i] - static_cast<int>(first_middle);
      if (Index& of_item = number[items[local]]; of_item < 0) of_item = next++;
    }
  return number;
}
inline std::vector<Index> mfem_edges(const Edges& edges) {
  return mfem_numbers(edges.of_hex, edges.nodes.size(), 0);
}
inline std::vector<Index> mfem_faces(const Faces& faces) {
  return mfem_numbers(faces.of_hex, faces.nodes.size(), n_hex_edges);
}

}  // namespace hextwist::io
