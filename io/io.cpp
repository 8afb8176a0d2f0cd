#include "hextwist/io/io.h"

#include <fstream>

#include "hextwist/base/text.h"
#include "hextwist/io/exodus/exodus_internal.h"
#include "hextwist/io/file_part.h"
#include "hextwist/io/format.h"
#include "hextwist/io/gmsh/slice_internal.h"
#include "hextwist/io/results.h"
#include "hextwist/io/vtk/vtu_internal.h"
#include "hextwist/mesh/others.h"

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

template <void (*write)(const std::filesystem::path&, const Mesh&, const WriteOptions&, Notices&)>
void write_file(const std::filesystem::path& file, const Mesh& mesh, const Association&, const WriteOptions& options,
                Notices& notices) {
  write(file, mesh, options, notices);
}
constexpr auto write_exodus = write_file<io::write_exodus>;

/// In place of a format whose library was not there.
constexpr char cgns_without[] = "CGNS (libcgns-dev)", hdf5_without[] = "HDF5 (libhdf5-dev)",
               med_without[] = "MED (libmedc-dev)";
template <const char* what>
MeshFile cannot_read(const std::filesystem::path& file, const Fence&) {
  throw Error(file.string() + ": this hextwist was built without " + what);
}
template <const char* what>
void cannot_write(const std::filesystem::path&, const Mesh&, const Association&, const WriteOptions&, Notices&) {
  throw Error(std::string("this hextwist was built without ") + what);
}
#ifdef HEXTWIST_HAS_MED
constexpr auto read_med = io::read_med;
constexpr auto write_med = write_file<io::write_med>;
#else
constexpr auto read_med = cannot_read<med_without>;
constexpr auto write_med = cannot_write<med_without>;
#endif
#ifdef HEXTWIST_HAS_CGNS
constexpr auto read_cgns = io::read_cgns;
constexpr auto write_cgns = write_file<io::write_cgns>;
#else
constexpr auto read_cgns = cannot_read<cgns_without>;
constexpr auto write_cgns = cannot_write<cgns_without>;
#endif
#ifdef HEXTWIST_HAS_HDF5
constexpr auto read_vtkhdf = io::read_vtkhdf, read_xdmf = io::read_xdmf;
constexpr auto write_vtkhdf = io::write_vtkhdf, write_xdmf = io::write_xdmf;
#else
constexpr auto read_vtkhdf = cannot_read<hdf5_without>, read_xdmf = read_vtkhdf;
constexpr auto write_vtkhdf = cannot_write<hdf5_without>, write_xdmf = write_vtkhdf;
#endif

struct Format {
  std::string_view extension, name;
  std::array<int, 2> second_order;  ///< nodes per hex that it can have, the usual first; 0: none
  MeshFile (*read)(const std::filesystem::path&, const Fence&);
  void (*write)(const std::filesystem::path&, const Mesh&, const Association&, const WriteOptions&, Notices&);
};

constexpr Format formats[] = {
    {".msh", "gmsh", {20, 27}, read_whole<io::read_gmsh>, write_whole<io::write_gmsh>},
    {".e", "exodus", {20, 27}, io::read_exodus, write_exodus},
    {".exo", "exodus", {20, 27}, io::read_exodus, write_exodus},
    {".g", "genesis", {20, 27}, io::read_exodus, write_exodus},
    {".gen", "genesis", {20, 27}, io::read_exodus, write_exodus},
    {".inp", "abaqus", {20, 27}, io::read_abaqus, write_whole<io::write_abaqus>},
    {".mesh", "medit", {27, 27}, read_whole<io::read_medit>, write_whole<io::write_medit>},
    {".mfem", "mfem", {27, 27}, read_whole<io::read_mfem>, write_whole<io::write_mfem>},
    {".med", "med", {20, 27}, read_med, write_med},
    {".cgns", "cgns", {20, 27}, read_cgns, write_cgns},
    {".bdf", "nastran", {20, 20}, read_whole<io::read_nastran>, write_whole<io::write_nastran>},
    {".nas", "nastran", {20, 20}, read_whole<io::read_nastran>, write_whole<io::write_nastran>},
    {".unv", "unv", {20, 20}, read_whole<io::read_unv>, write_whole<io::write_unv>},
    {".foam", "openfoam", {0, 0}, io::read_openfoam, write_file<io::write_openfoam>},
    {".k", "lsdyna", {20, 20}, read_whole<io::read_lsdyna>, write_whole<io::write_lsdyna>},
    {".key", "lsdyna", {20, 20}, read_whole<io::read_lsdyna>, write_whole<io::write_lsdyna>},
    {".cdb", "ansys", {20, 20}, read_whole<io::read_ansys>, write_whole<io::write_ansys>},
    {".re2", "nek", {20, 20}, read_whole<io::read_nek>, write_whole<io::write_nek>},
    {".specfem", "specfem", {27, 27}, io::read_specfem, write_file<io::write_specfem>},
    {".vtk", "vtk", {0, 0}, read_whole<io::read_vtk>, nullptr},
    {".vtu", "vtk", {20, 27}, read_whole<io::read_vtu>, write_whole<io::write_vtu>},
    {".vtkhdf", "vtkhdf", {20, 27}, read_vtkhdf, write_vtkhdf},
    {".xdmf", "xdmf", {20, 27}, read_xdmf, write_xdmf},
    {".xmf", "xdmf", {20, 27}, read_xdmf, write_xdmf},
};

/// What becomes of elements beside the hexes. name: of the format.
void say_of_others(const Mesh& mesh, std::string_view extension, std::string_view name, Notices& notices) {
  if (!mesh.others) return;
  constexpr std::string_view known[] = {".inp", ".e",   ".exo", ".g",   ".gen", ".vtu",
                                        ".msh", ".bdf", ".nas", ".unv", ".med"};
  if (std::ranges::find(known, extension) == std::end(known)) {
    notices.push_back("other elements are left out, which " + std::string(extension) +
                      " files have no place for here: " + others_text(mesh));
    return;
  }
  const OtherHeads& heads = *mesh.others->heads;
  if (!heads.rest.empty() && heads.format != name)
    notices.push_back("what only " + heads.format + " files say of other elements is left out");
  const bool any_attribute = std::ranges::any_of(
      heads.fields, [](const OtherField& field) { return field.is_attribute && field.name != "gmsh:entity"; });
  if (any_attribute && extension != ".vtu" && name != "exodus" && name != "genesis")
    notices.push_back("attributes of other elements are left out, which " + std::string(extension) +
                      " files have no place for");
  if (!heads.sides.empty() && (name == "nastran" || name == "unv" || name == "med"))
    notices.push_back("sides of other elements are left out, which " + std::string(extension) +
                      " files have no place for here");
}

/// What only another format has. extension: empty for the parts of a mesh, which have none of it.
void say_left_out(const FileExtras& extras, std::string_view extension, Notices& notices) {
  const auto why = [&](const char* owner) {
    return extension.empty() ? "which parts have no place for" : std::string("which only ") + owner + " has";
  };
  if (extension != ".inp") {
    std::vector<std::string> what;
    for (const auto& [block, type] : extras.element_types)
      if (type != "C3D8" && std::ranges::find(what, type) == what.end()) what.push_back(type);
    if (!what.empty()) notices.push_back("element types are left out, " + why(".inp") + ": " + joined(what, ", "));
    what.clear();
    for (const AbaqusCard& card : extras.cards)
      if (const std::string name = card.text.substr(0, card.text.find_first_of(",\r\n"));
          std::ranges::find(what, name) == what.end())
        what.push_back(name);
    if (what.size() > 5) what.resize(5), what.emplace_back("...");
    if (!what.empty())
      notices.push_back(counted(std::ssize(extras.cards), "card") + " left out, " + why(".inp") + ": " +
                        joined(what, ", "));
  }
  if (extension != ".specfem" && !extras.materials.empty())
    notices.push_back("properties of " + counted(std::ssize(extras.materials), "material") + " left out, " +
                      why(".specfem"));
  if (extension != ".cgns" && !extras.boundary_types.empty())
    notices.push_back("kinds of " +
                      counted(std::ssize(extras.boundary_types), "boundary condition", "boundary conditions") +
                      " left out, " + why(".cgns"));
  if (extension != ".msh" && !extras.periodic.empty())
    notices.push_back("pairs of nodes of " +
                      counted(std::ssize(extras.periodic), "periodic entity", "periodic entities") + " left out, " +
                      why(".msh"));
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
  const bool shared = format && format->extension == ".mesh" && name.empty();  // MEDIT's and MFEM's
  if (format && format->extension == lower_extension(file) && !shared) return format;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return format;
  const std::string bytes = beginning(file);
  if (!format && (bytes.starts_with("CDF") || bytes == "\x89HDF")) return format_of(file, "exodus");
  if (format && format->name == "medit" && bytes == "MFEM") return format_of("a.mfem", "mfem");
  return format && format->name == "vtk" && bytes.starts_with("<") ? format_of("a.vtu", name) : format;
}
const Format* format_to_write(const std::filesystem::path& file, std::string_view name) {
  const Format* format = format_of(file, name);
  return format && !format->write && !name.empty() ? format_of("a.vtu", name) : format;
}

/// Nodes per hex that what is known of the blocks asks for. Throws Error where they don't fit together.
int nodes_per_hex_of(const Mesh& mesh, const FileExtras* extras) {
  if (!extras || extras->nodes_per_hex.empty()) return 8;
  const auto of = [&](int block) {
    const auto found = extras->nodes_per_hex.find(block);
    return found == extras->nodes_per_hex.end() ? 0 : found->second;
  };
  const int others = std::max(of(0), 8);
  std::vector<int> nodes(mesh.hexes.size(), 0);
  for (const Block& block : mesh.blocks)
    if (const int n = of(block.id); n > 0)
      for (const Index h : block.hexes)
        if (nodes[h] == 0) nodes[h] = n;
  for (int& n : nodes)
    if (n == 0) n = others;
  const auto other = std::ranges::adjacent_find(nodes, std::ranges::not_equal_to{});
  if (other != nodes.end()) {
    const auto h = static_cast<Index>(other - nodes.begin());
    throw Error("hex " + std::to_string(hex_id(mesh, h)) + " has " + std::to_string(nodes[h]) + " nodes and hex " +
                std::to_string(hex_id(mesh, h + 1)) + " " + std::to_string(nodes[h + 1]) +
                ": all hexes of a file have as many here ('block all element type ...', or an order for the file)");
  }
  return nodes.empty() ? 8 : nodes.front();
}

/// The most that any block has.
int most_nodes_per_hex(const FileExtras* extras) {
  int most = 8;
  if (extras)
    for (const auto& [block, n] : extras->nodes_per_hex) most = std::max(most, n);
  return most;
}

/// Nodes per hex of the file: what is asked for, as far as the format has it.
int nodes_per_hex_in(const Format& format, const Mesh& mesh, const WriteOptions& options, Notices& notices) {
  const auto& known = format.second_order;
  const std::string files = std::string(format.extension) + " files ";
  const bool asked = options.order == 2;
  int n = 8;
  if (asked && options.nodes_per_hex > 0)
    n = options.nodes_per_hex;
  else if (options.order != 1)
    n = asked ? most_nodes_per_hex(options.extras) : nodes_per_hex_of(mesh, options.extras);
  if (asked && n <= 8) n = known[0];
  if (known[0] == 0) {
    if (asked) throw Error(files + "have no middle nodes here: export with order 1");
    if (n > 8) notices.push_back(files + "have no middle nodes here: they are left out");
    return 8;
  }
  if (n > 8 && std::ranges::find(known, n) == known.end()) {
    if (asked && options.nodes_per_hex > 0)
      throw Error(files + "have no hexes with " + std::to_string(n) + " nodes here, but with " +
                  std::to_string(known[0]));
    notices.push_back(files + "have hexes with " + std::to_string(known[0]) + " nodes here, not " + std::to_string(n));
    n = known[0];
  }
  return n;
}

void write_in(const Format& format, const std::filesystem::path& file, const Mesh& mesh, const Association& association,
              const WriteOptions& options, Notices& notices) {
  const int n = nodes_per_hex_in(format, mesh, options, notices);
  if (n == 8) return format.write(file, mesh, association, options, notices);
  if (mesh.others)
    notices.emplace_back(
        "other elements have the nodes that they had: those that hexes share with them have no middle "
        "nodes there");
  const SecondOrder second = second_order(mesh, association, options.model ? options.model : options.skin, n);
  if (const std::string text = straightened_text(second); !text.empty()) notices.push_back(text);
  WriteOptions with_middles = options;
  with_middles.second = &second;
  format.write(file, second.mesh, second.association, with_middles, notices);
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

std::optional<SlicedFile> in_slices(const std::filesystem::path& file, const Fence& fence, Unsliced* why) {
  const Format* format = format_to_read(file, {});
  Unsliced reason{"another format than Exodus, .vtu and .msh", true};
  std::optional<SlicedFile> sliced;
  if (format && format->read == io::read_exodus) sliced = io::exodus_in_slices(file, fence, reason);
  if (format && format->read == read_whole<io::read_vtu>) sliced = io::vtu_in_slices(file, reason);
  if (format && format->read == read_whole<io::read_gmsh>) sliced = io::gmsh_in_slices(file, reason);
  if (why) *why = sliced ? Unsliced() : reason;
  return sliced;
}

MeshSlice read_slice(const SlicedFile& file, int number, int n) {
  if (file.gmsh) return io::read_gmsh_slice(file, number, n);
  const Format* format = format_to_read(file.file, {});
  return format && format->read == read_whole<io::read_vtu> ? io::read_vtu_slice(file, number, n)
                                                            : io::read_exodus_slice(file, number, n);
}

std::vector<std::string> left_out_of_parts(const FileExtras& extras) {
  Notices notices;
  say_left_out(extras, "", notices);
  if (!extras.patches.empty())
    notices.push_back("types of " + counted(std::ssize(extras.patches), "patch", "patches") +
                      " left out, which parts have no place for");
  if (!extras.heading.empty()) notices.emplace_back("the heading is left out, which parts have no place for");
  return notices;
}

bool is_written_in_pieces(const std::filesystem::path& file) {
  const Format* format = format_to_write(file, {});
  return format && format->write == write_exodus;
}

std::vector<std::string> write_mesh(const std::filesystem::path& file, const Mesh& mesh, const Association* association,
                                    const WriteOptions& options) {
  const Format* format = format_to_write(file, options.format);
  if (!format || !format->write)
    throw Error(file.string() + ": meshes of this kind cannot be written; known are " + writable_extensions());
  static const Association nothing;
  const Association& own = association ? *association : nothing;
  Notices notices;
  if (options.order < 0 || options.order > 2)
    throw Error(file.string() + ": order " + std::to_string(options.order) + " is neither 1 nor 2");
  if (options.extras) say_left_out(*options.extras, format->extension, notices);
  say_of_others(mesh, format->extension, format->name, notices);
  try {
    write_in(*format, file, mesh, own, options, notices);
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
