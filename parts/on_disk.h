// Refinements of a mesh that is larger than the memory: part after part, from disk to disk.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "hextwist/base/fence.h"
#include "hextwist/parts/asked.h"
#include "hextwist/parts/partition.h"

namespace hextwist {

struct OnDiskOptions {
  int n_rings = 6;               ///< of others' hexes around a part, to begin with, and as many as the depth more
  std::filesystem::path folder;  ///< for what is put aside; empty: that of the output. Nothing stays there
  Fence fence = {};              ///< where the parts are read
  int n_parts = 0;               ///< 0: those of a split mesh; else a file of the whole is divided into so many
  PartitionBy by = PartitionBy::boxes;
};

/// Reads the parts of a mesh, refines them, each with its halo, and writes as many: joined they are what hextwist
/// makes of the joined mesh. There is one part with its halo in memory, and what goes with the surfaces of all parts.
/// The model is the skin of the mesh. A file of the whole is read in slices and divided first (source.h); throws Error
/// where that can't be done. say: lines about what was done. Asks check_interrupt() between parts. Throws
/// Error; then no part was written.
void refine_on_disk(const std::filesystem::path& input, const PartCommands& commands,
                    const std::filesystem::path& output, const OnDiskOptions& options,
                    const std::function<void(const std::string&)>& say);

/// Divides a file of the whole into n_parts, slice by slice. Returns false where it can't be read so or has
/// values that slices do not keep (MeshSlice::left_out), and wrote nothing.
bool split_on_disk(const std::filesystem::path& file, const std::filesystem::path& output, const OnDiskOptions& options,
                   const std::function<void(const std::string&)>& say);

}  // namespace hextwist
