// Goal 9: a million hexes to files and back.
//
// All of reading and writing is measured, checks and groups included. Gmsh's files name the CAD entity of every node
// and have the quads and lines on surfaces and curves, so ours are written with an association; the others have
// nothing but the mesh and its one block (.vtu: and the ids of nodes and hexes).
#include <cstdio>
#include <filesystem>

#include "exodus_floor.h"
#include "groups.h"
#include "hextwist/io/io.h"
#include "measure.h"
#include "meshes.h"

namespace hextwist::bench {
namespace {

const MeshedModel& million() {
  static const MeshedModel made = cube_on_brick(100);
  return made;
}

std::filesystem::path file_of(const std::string& extension) {
  return output_file("million").replace_extension(extension);
}
std::size_t written(const std::string& extension, bool quality) {
  WriteOptions options;
  options.write_quality = quality;
  write_mesh(file_of(extension), million().mesh, extension == "msh" ? &million().association : nullptr, options);
  return std::filesystem::file_size(file_of(extension));
}

/// The bytes of the arrays, as fast as stdio writes them.
std::size_t written_raw() {
  std::FILE* file = std::fopen(file_of("raw").c_str(), "wb");
  std::size_t n = 0;
  const Mesh& mesh = million().mesh;
  n += 24 * std::fwrite(mesh.points.data(), 24, mesh.points.size(), file);
  n += 32 * std::fwrite(mesh.hexes.data(), 32, mesh.hexes.size(), file);
  std::fclose(file);
  return n;
}

std::size_t written_plainly() {
  static const ExodusArrays arrays = exodus_arrays(million().mesh);
  write_exodus_plainly(file_of("exodus_floor"), arrays);
  return std::filesystem::file_size(file_of("exodus_floor"));
}

}  // namespace

void add_files() {
  const auto size = [](std::size_t n) { return n; };
  add_rate("floor/raw", written_raw, size);
  add_rate("floor/exodus_write", written_plainly, size);
  add_rate(
      "floor/exodus_read",
      [] {
        if (!std::filesystem::exists(file_of("exodus_floor"))) written_plainly();
        return read_exodus_plainly(file_of("exodus_floor"));
      },
      [](const ExodusArrays&) { return std::filesystem::file_size(file_of("exodus_floor")); });
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
