// HDF5 files that take data from other files: by links, by lists of external files, by virtual datasets.
#pragma once

#include <filesystem>

namespace hextwist::io {

/// Throws Error where a file in the form of HDF5 names data outside of itself while files may be read below `folder`
/// only (Fence::folder); empty: anywhere, and nothing is looked at. A file of another form is refused as well.
void refuse_links_outside(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace hextwist::io
