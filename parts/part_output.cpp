#include <algorithm>
#include <fstream>
#include <sstream>

#include "hextwist/base/text.h"
#include "hextwist/io/io.h"
#include "hextwist/io/pieces.h"
#include "hextwist/io/vtk/escaped.h"
#include "hextwist/parts/own_part.h"

namespace hextwist {
namespace {

/// What VTK's list of pieces says of the arrays of all: the declarations of one piece, as the writer of .vtu puts them.
std::string list_of_pieces(const std::filesystem::path& piece, const std::vector<std::string>& names) {
  std::ifstream from(piece, std::ios::binary);
  std::ostringstream to;
  to << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n<PUnstructuredGrid GhostLevel=\"0\">\n";
  std::string line;
  bool is_inside = false;
  while (std::getline(from, line) && !line.starts_with("<AppendedData")) {
    for (const char* section : {"PointData", "CellData", "Points"}) {
      if (line.starts_with("<" + std::string(section) + ">") || line.starts_with("<" + std::string(section) + " ")) {
        to << "<P" << section << ">\n";
        is_inside = true;
      }
      if (line.starts_with("</" + std::string(section) + ">")) {
        to << "</P" << section << ">\n";
        is_inside = false;
      }
    }
    constexpr std::string_view array = "<DataArray ";
    if (!is_inside || !line.starts_with(array)) continue;
    const std::size_t end = line.find(" format=");
    to << "<PDataArray " << line.substr(array.size(), end - array.size()) << "/>\n";
  }
  for (const std::string& name : names) to << "<Piece Source=\"" << io::escaped(name) << "\"/>\n";
  to << "</PUnstructuredGrid>\n</VTKFile>\n";
  return to.str();
}

}  // namespace

void check_output_name(const std::filesystem::path& name) {
  const std::string ending = lower_extension(name);
  if (ending.empty() || is_gmsh_part(name) || is_written_in_pieces(name)) return;
  if ((" " + readable_extensions() + " ").find(" " + ending + " ") == std::string::npos) return;
  std::istringstream writable(writable_extensions());
  std::string known;
  for (std::string each; writable >> each;)
    if (is_written_in_pieces("a" + each)) known += each + " ";
  throw Error(name.string() + ": parts are not written as " + ending + " files; their names end in " + known +
              "(Exodus), .msh or .pvtu");
}

PartOutput::PartOutput(std::filesystem::path name, int n_parts)
    : name_(std::move(name)), n_parts_(n_parts), is_vtk_(lower_case(name_.extension().string()) == ".pvtu") {}

PartOutput::~PartOutput() {
  std::error_code ignored;
  for (const auto& [from, to] : renamed_) std::filesystem::remove(from, ignored);
}

std::filesystem::path PartOutput::piece(int part) const {
  if (!is_vtk_) return part_name(name_, n_parts_, part);
  const std::string of = std::to_string(n_parts_), i = std::to_string(part);
  std::filesystem::path file = name_;
  file.replace_filename(name_.stem().string() + "_" + std::string(of.size() - std::min(of.size(), i.size()), '0') + i +
                        ".vtu");
  return file;
}

void PartOutput::write(const OwnPart& part, std::vector<std::string>& notices) {
  std::vector<std::string> told;
  const std::filesystem::path to = piece(part.file.number), extension = to.extension();
  if (is_vtk_ || is_gmsh_part(to)) {
    std::filesystem::path from = to;
    from.replace_filename("." + to.stem().string() + ".part" + extension.string());
    renamed_.push_back({from, to});
    WriteOptions options;
    options.part = &part.file;
    told = write_mesh(from, part.mesh, &part.association, options);
    if (is_vtk_ && part.file.number == 0) write_list(from);
  } else {
    files_.push_back(std::make_unique<Replacement>(to, true));
    write_part(*files_.back(), part.mesh, part.file, told);
  }
  for (std::string& line : told)
    if (std::ranges::find(notices, line) == notices.end()) notices.push_back(std::move(line));
}

void PartOutput::write_list(const std::filesystem::path& first_piece) {
  std::vector<std::string> names;
  for (int p = 0; p < n_parts_; ++p) names.push_back(piece(p).filename().string());
  files_.push_back(std::make_unique<Replacement>(name_, true));
  std::ofstream list(files_.back()->temporary(), std::ios::binary);
  list << list_of_pieces(first_piece, names);
  list.close();
  if (!list) files_.back()->fail("cannot be written (disk full?)");
}

void PartOutput::commit() {
  for (const auto& [from, to] : renamed_) {
    std::error_code error;
    std::filesystem::rename(from, to, error);
    if (error) throw Error(to.string() + ": cannot be written (" + error.message() + ")");
  }
  renamed_.clear();
  for (const auto& file : files_) file->commit();
}

}  // namespace hextwist
