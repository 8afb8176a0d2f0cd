#include "corpus/inputs.h"

#include <algorithm>
#include <string>

namespace hextwist::corpus {
namespace {

namespace fs = std::filesystem;

std::string ending(const fs::path& file) {
  std::string result = file.extension().string();
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

bool has_ending(const fs::path& file, std::initializer_list<const char*> known) {
  return std::ranges::find(known, ending(file)) != known.end();
}

bool is_mesh(const fs::path& file) {
  return has_ending(file, {".msh", ".e", ".exo", ".ex2", ".exodus", ".g", ".vtk", ".vtu", ".inp", ".mesh"});
}
bool is_cad(const fs::path& file) {
  return has_ending(file, {".step", ".stp", ".brep", ".igs", ".iges"});
}

void add(const fs::path& mesh, std::vector<Input>& to) {
  std::vector<fs::path> beside, of_name;
  for (const auto& entry : fs::directory_iterator(fs::absolute(mesh).parent_path()))
    if (entry.is_regular_file() && is_cad(entry.path())) {
      beside.push_back(entry.path());
      if (mesh.stem().string().starts_with(entry.path().stem().string())) of_name.push_back(entry.path());
    }
  // plate_hole is of plate_hole_1k, plate is not where both are there.
  std::size_t longest = 0;
  for (const fs::path& cad : of_name) longest = std::max(longest, cad.stem().string().size());
  std::erase_if(of_name, [&](const fs::path& cad) { return cad.stem().string().size() < longest; });
  std::vector<fs::path> cads = of_name.empty() ? beside : of_name;
  if (cads.empty() || cads.size() > 4) cads = {{}};
  std::ranges::sort(cads);
  for (const fs::path& cad : cads) to.push_back({mesh, cad});
}

}  // namespace

std::vector<Input> find_inputs(std::span<const fs::path> places) {
  std::vector<fs::path> meshes;
  for (const fs::path& place : places) {
    if (!fs::is_directory(place)) {
      meshes.push_back(place);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(place))
      if (entry.is_regular_file() && is_mesh(entry.path())) meshes.push_back(entry.path());
  }
  std::ranges::sort(meshes);
  std::vector<Input> result;
  for (const fs::path& mesh : meshes) add(mesh, result);
  return result;
}

}  // namespace hextwist::corpus
