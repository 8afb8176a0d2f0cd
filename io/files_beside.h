// What else a mesh is made of besides the file that names it.
#pragma once

#include <filesystem>
#include <vector>

namespace hextwist {

/// Other files and folders that a mesh of this name is read from or written to, there or not: constant/polyMesh beside
/// case.foam and what lies in it, the files of SPECFEM3D. Files that the mesh itself names are not among them.
std::vector<std::filesystem::path> files_beside(const std::filesystem::path& file);

}  // namespace hextwist
