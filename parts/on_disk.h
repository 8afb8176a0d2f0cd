// Refinements of a mesh that is larger than the memory: part after part, from disk to disk.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "hextwist/base/fence.h"
#include "hextwist/parts/asked.h"

namespace hextwist {

struct OnDiskOptions {
  int n_rings = 6;               ///< of others' hexes around a part, to begin with, and as many as the depth more
  std::filesystem::path folder;  ///< for what is put aside; empty: that of the output. Nothing stays there
  Fence fence = {};              ///< where the parts are read
};

/// Reads the parts of a split mesh, refines them, each with its halo, and writes as many: joined they are what hextwist
/// makes of the joined mesh. There is one part with its halo in memory, and what goes with the surfaces of all parts.
/// The model is the skin of the mesh. say: lines about what was done. Asks check_interrupt() between parts. Throws
/// Error; then no part was written.
void refine_on_disk(const std::filesystem::path& any_part, const PartCommands& commands,
                    const std::filesystem::path& output, const OnDiskOptions& options,
                    const std::function<void(const std::string&)>& say);

}  // namespace hextwist
