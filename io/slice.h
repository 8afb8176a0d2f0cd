// Mesh files that are too large for one reader: each of several reads a slice of the hexes, with all nodes of these.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "hextwist/base/fence.h"
#include "hextwist/io/io.h"

namespace hextwist {
namespace io {
struct GmshWhole;
}

/// A file that can be read in slices.
struct SlicedFile {
  std::filesystem::path file;
  std::int64_t n_nodes = 0, n_hexes = 0;
  std::int64_t highest_node = 0;                        ///< id; of nodes of no hex, too
  std::shared_ptr<const io::GmshWhole> gmsh = nullptr;  ///< what slices of a .msh file have to know of the others
};

/// What a file has that stands against slices.
struct Unsliced {
  std::string what;           ///< "arrays as text"; empty: nothing
  bool may_be_split = false;  ///< all the same, with the whole in memory
};

/// Looks through all ids, or cells, of a file once. Nothing where it is not read in slices: other formats than Exodus
/// and .vtu, other elements or hexes of second order. Of Exodus: ids that are out of order and far apart, element sets
/// that are element blocks with more hexes. Of .vtu: arrays as text, arrays that VTK calls global ids. Of .msh:
/// other versions than 4.1, partitions, values of elements that are no hexes, ids far apart. why: is told. Throws Error
/// as read_mesh() does.
std::optional<SlicedFile> in_slices(const std::filesystem::path& file, const Fence& fence = {},
                                    Unsliced* why = nullptr);

struct MeshSlice {
  MeshFile file;         ///< with the ids, groups and fields of the whole; of FileResults what has no places
  std::string left_out;  ///< the rest of FileResults, for a message; empty: nothing
};

/// Slice `number` (from 0) of n, equal counts in the order of the file; a file of fewer hexes has empty ones. What is
/// not of the hexes alone (whether nodes are of no hex, say) no slice can tell. Throws Error as read_mesh() does.
MeshSlice read_slice(const SlicedFile& file, int number, int n);

}  // namespace hextwist
