#include "hextwist/mesh/io.h"

#include "hextwist/mesh/io_internal.h"

namespace hextwist {
namespace {

struct Format {
  std::string_view extension;
  MeshFile (*read)(const io::Bytes&);
  void (*write)(io::Output&, const Mesh&, const Association&, const WriteOptions&);
};

constexpr Format formats[] = {
    {".msh", io::read_gmsh, io::write_gmsh},
    {".vtu", nullptr, io::write_vtu},
};

const Format* format_of(const std::filesystem::path& file) {
  const std::string extension = io::lower_case(file.extension().string());
  for (const Format& format : formats)
    if (format.extension == extension) return &format;
  return nullptr;
}

template <class Does>
std::string extensions(Does&& does) {
  std::string result;
  for (const Format& format : formats)
    if (does(format)) result += (result.empty() ? "" : " ") + std::string(format.extension);
  return result;
}

}  // namespace

std::string readable_extensions() {
  return extensions([](const Format& format) { return format.read != nullptr; });
}

std::string writable_extensions() {
  return extensions([](const Format& format) { return format.write != nullptr; });
}

MeshFile read_mesh(const std::filesystem::path& file) {
  const Format* format = format_of(file);
  if (!format || !format->read)
    throw Error(file.string() + ": meshes of this kind cannot be read; known are " + readable_extensions());
  return format->read(io::read_bytes(file));
}

void write_mesh(const std::filesystem::path& file, const Mesh& mesh, const Association* association,
                const WriteOptions& options) {
  const Format* format = format_of(file);
  if (!format || !format->write)
    throw Error(file.string() + ": meshes of this kind cannot be written; known are " + writable_extensions());
  static const Association nothing;
  io::Output out(file, options.overwrite);
  try {
    format->write(out, mesh, association ? *association : nothing, options);
    out.commit();
  } catch (const Error& error) {
    // Reasons that lie in the mesh do not know the file's name.
    const std::string what = error.what();
    if (what.starts_with(file.string() + ":")) throw;
    throw Error(file.string() + ": " + what);
  }
}

}  // namespace hextwist
