#include "hextwist/io/io.h"

#include <fstream>

#include "hextwist/base/text.h"
#include "hextwist/io/format.h"
#include "hextwist/io/results.h"

namespace hextwist {
namespace {

template <MeshFile (*read)(const io::Bytes&)>
MeshFile read_whole(const std::filesystem::path& file, const Fence&) {
  const io::Bytes bytes = io::read_bytes(file);
  return io::unchanged_by(bytes, [&] { return read(bytes); });
}

using Notices = std::vector<std::string>;

template <void (*write)(io::Output&, const Mesh&, const Association&, const WriteOptions&, Notices&)>
void write_whole(const std::filesystem::path& file, const Mesh& mesh, const Association& association,
                 const WriteOptions& options, Notices& notices) {
  io::Output out(file, options.overwrite);
  write(out, mesh, association, options, notices);
  out.commit();
}

void write_exodus(const std::filesystem::path& file, const Mesh& mesh, const Association&, const WriteOptions& options,
                  Notices& notices) {
  io::write_exodus(file, mesh, options, notices);
}

struct Format {
  std::string_view extension, name;
  MeshFile (*read)(const std::filesystem::path&, const Fence&);
  void (*write)(const std::filesystem::path&, const Mesh&, const Association&, const WriteOptions&, Notices&);
};

constexpr Format formats[] = {
    {".msh", "gmsh", read_whole<io::read_gmsh>, write_whole<io::write_gmsh>},
    {".e", "exodus", io::read_exodus, write_exodus},
    {".exo", "exodus", io::read_exodus, write_exodus},
    {".g", "genesis", io::read_exodus, write_exodus},
    {".gen", "genesis", io::read_exodus, write_exodus},
    {".inp", "abaqus", io::read_abaqus, write_whole<io::write_abaqus>},
    {".mesh", "medit", read_whole<io::read_medit>, write_whole<io::write_medit>},
    {".vtk", "vtk", read_whole<io::read_vtk>, nullptr},
    {".vtu", "vtk", read_whole<io::read_vtu>, write_whole<io::write_vtu>},
};

/// What only another format has.
void say_left_out(const FileExtras& extras, std::string_view extension, Notices& notices) {
  if (extension != ".inp") {
    std::vector<std::string> what;
    for (const auto& [block, type] : extras.element_types)
      if (type != "C3D8" && std::ranges::find(what, type) == what.end()) what.push_back(type);
    if (!what.empty()) notices.push_back("element types are left out, which only .inp has: " + joined(what, ", "));
    what.clear();
    for (const AbaqusCard& card : extras.cards)
      if (const std::string name = card.text.substr(0, card.text.find_first_of(",\r\n"));
          std::ranges::find(what, name) == what.end())
        what.push_back(name);
    if (what.size() > 5) what.resize(5), what.emplace_back("...");
    if (!what.empty())
      notices.push_back(counted(std::ssize(extras.cards), "card") +
                        " left out, which only .inp has: " + joined(what, ", "));
  }
  if (extension != ".msh" && !extras.periodic.empty())
    notices.push_back("pairs of nodes of " +
                      counted(std::ssize(extras.periodic), "periodic entity", "periodic entities") +
                      " left out, which only .msh has");
}

/// The first bytes of a file; empty where it can't be read.
std::string beginning(const std::filesystem::path& file) {
  std::string bytes(4, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

/// By name (of several formats of one name the one with this extension) or by extension.
const Format* format_of(const std::filesystem::path& file, std::string_view name) {
  const std::string extension = lower_extension(file);
  const Format* of_name = nullptr;
  for (const Format& format : formats) {
    if (format.extension == extension && (name.empty() || format.name == name)) return &format;
    if (!of_name && !name.empty() && format.name == name) of_name = &format;
  }
  return of_name;
}
const Format* format_to_read(const std::filesystem::path& file, std::string_view name) {
  const Format* format = format_of(file, name);
  if (format && format->extension == lower_extension(file)) return format;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return format;
  const std::string bytes = beginning(file);
  if (!format && (bytes.starts_with("CDF") || bytes == "\x89HDF")) return format_of(file, "exodus");
  return format && format->name == "vtk" && bytes.starts_with("<") ? format_of("a.vtu", name) : format;
}
const Format* format_to_write(const std::filesystem::path& file, std::string_view name) {
  const Format* format = format_of(file, name);
  return format && !format->write && !name.empty() ? format_of("a.vtu", name) : format;
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

MeshFile read_mesh(const std::filesystem::path& file, std::string_view name, const Fence& fence) {
  const Format* format = format_to_read(file, name);
  if (!format || !format->read)
    throw Error(file.string() + ": meshes of this kind cannot be read; known are " + readable_extensions());
  return format->read(file, fence);
}

std::vector<std::string> write_mesh(const std::filesystem::path& file, const Mesh& mesh, const Association* association,
                                    const WriteOptions& options) {
  const Format* format = format_to_write(file, options.format);
  if (!format || !format->write)
    throw Error(file.string() + ": meshes of this kind cannot be written; known are " + writable_extensions());
  static const Association nothing;
  Notices notices;
  if (options.extras) say_left_out(*options.extras, format->extension, notices);
  try {
    format->write(file, mesh, association ? *association : nothing, options, notices);
    if (mesh.results && format->write != write_exodus)
      if (const std::string more = extras_text(*mesh.results); !more.empty())
        notices.push_back(std::string(format->extension) + " has no place for what came with " + more + ": left out");
    return notices;
  } catch (const Error& error) {
    // Errors about the mesh lack the file's name.
    const std::string what = error.what();
    if (what.starts_with(file.string() + ":")) throw;
    throw Error(file.string() + ": " + what);
  }
}

}  // namespace hextwist
