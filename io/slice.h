// Mesh files that are too large for one reader: each of several reads a slice of the hexes, with all nodes of these.
#pragma once

#include <filesystem>
#include <optional>

#include "hextwist/base/fence.h"
#include "hextwist/io/io.h"

namespace hextwist {

struct MeshSlice {
  MeshFile file;  ///< with the ids, groups and fields of the whole; of FileResults what has no places
  std::int64_t n_nodes = 0, n_hexes = 0;  ///< of the whole file
  std::string left_out;                   ///< the rest of FileResults, for a message; empty: nothing
};

/// Slice `number` (from 0) of n, equal counts in the order of the file; a file of fewer hexes has empty ones. Nothing
/// where such files are not read so: other formats than Exodus, other elements or hexes of second order, ids that are
/// out of order and far apart, element sets that are element blocks with more hexes. All slices of a file have the same
/// answer. What is not of the hexes alone (whether nodes are of no hex, say) no slice can tell. Throws Error as
/// read_mesh() does.
std::optional<MeshSlice> read_slice(const std::filesystem::path& file, int number, int n, const Fence& fence = {});

}  // namespace hextwist
