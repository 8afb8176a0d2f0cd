#include "hextwist/io/files_beside.h"

#include "hextwist/base/text.h"
#include "hextwist/io/openfoam/openfoam_internal.h"
#include "hextwist/io/specfem/specfem_internal.h"

namespace hextwist {

std::vector<std::filesystem::path> files_beside(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> result;
  const std::string extension = lower_extension(file);
  if (extension == ".foam") {
    result.push_back(io::poly_mesh_of(file));
    std::error_code ignored;  // not there yet
    for (const auto& entry : std::filesystem::directory_iterator(result.front(), ignored))
      result.push_back(entry.path());
  }
  if (extension == ".specfem") {
    for (const char* name : io::specfem_files) result.push_back(file.parent_path() / name);
    for (const char* name : io::specfem_surfaces) result.push_back(file.parent_path() / name);
  }
  return result;
}

}  // namespace hextwist
