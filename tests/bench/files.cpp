// Goal 9: a million hexes to files and back.
#include <cstdio>
#include <filesystem>

#include "groups.h"
#include "hextwist/mesh/io.h"
#include "measure.h"
#include "meshes.h"

namespace hextwist::bench {
namespace {

const Mesh& million() {
  static const Mesh made = cube(100);
  return made;
}

std::filesystem::path file_of(const std::string& extension) {
  return output_file("million").replace_extension(extension);
}
std::size_t written(const std::string& extension, bool quality) {
  WriteOptions options;
  options.write_quality = quality;
  write_mesh(file_of(extension), million(), nullptr, options);
  return std::filesystem::file_size(file_of(extension));
}

/// The bytes of the arrays, as fast as stdio writes them.
std::size_t written_raw() {
  std::FILE* file = std::fopen(file_of("raw").c_str(), "wb");
  std::size_t n = 0;
  n += 24 * std::fwrite(million().points.data(), 24, million().points.size(), file);
  n += 32 * std::fwrite(million().hexes.data(), 32, million().hexes.size(), file);
  std::fclose(file);
  return n;
}

}  // namespace

void add_files() {
  const auto size = [](std::size_t n) { return n; };
  add_rate("floor/raw", written_raw, size);
  for (const std::string extension : {"vtu", "msh", "e", "inp"}) {
    add_rate(
        "write/" + extension, [=] { return written(extension, false); }, size);
    add_rate(
        "read/" + extension,
        [=] {
          if (!std::filesystem::exists(file_of(extension))) written(extension, false);
          return read_mesh(file_of(extension));
        },
        [=](const MeshFile&) { return std::filesystem::file_size(file_of(extension)); });
  }
}

}  // namespace hextwist::bench
