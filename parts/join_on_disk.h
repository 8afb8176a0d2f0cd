// Parts made one file with one part in memory at a time.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hextwist/base/fence.h"
#include "hextwist/parts/files.h"

namespace hextwist {

/// Reads the parts twice: for the ids and groups of the whole, and for all else, which goes to its place in the file.
/// Besides a part there are a few bits for each node and hex in memory, and the sets. Returns what is to be said;
/// nothing, and wrote nothing, where the file can't be written so: other formats than Exodus, blocks that overlap, ids
/// far apart, fields that have other components in other parts. Throws Error as read_parts() does.
std::optional<std::vector<std::string>> join_on_disk(const SplitName& parts, const std::filesystem::path& to,
                                                     const Fence& fence);

}  // namespace hextwist
