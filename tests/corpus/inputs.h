// Which meshes are tried, and on which CAD.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

namespace hextwist::corpus {

struct Input {
  std::filesystem::path mesh, cad;  ///< cad empty: on its own skin
};

/// Every mesh in the folders and below, and those named. The CAD of a mesh: all files beside it whose name is its name
/// or the beginning of it; where there is none, every CAD file beside it; else none.
std::vector<Input> find_inputs(std::span<const std::filesystem::path> places);

}  // namespace hextwist::corpus
