#include "hextwist/io/file_part.h"

#include "hextwist/io/exodus/exodus_internal.h"
#include "hextwist/io/gmsh/gmsh.h"

namespace hextwist {

bool is_gmsh_part(const std::filesystem::path& file) {
  return lower_case(file.extension().string()) == ".msh";
}

std::filesystem::path part_name(const std::filesystem::path& name, int n_parts, int number) {
  if (is_gmsh_part(name)) {
    std::filesystem::path part = name;
    part.replace_filename(name.stem().string() + "_" + std::to_string(number + 1) + name.extension().string());
    return part;
  }
  const std::string of = std::to_string(n_parts), i = std::to_string(number);
  return name.string() + "." + of + "." + std::string(of.size() - std::min(of.size(), i.size()), '0') + i;
}

PartHead read_part_head(const std::filesystem::path& file) {
  if (!is_gmsh_part(file)) return io::read_exodus_head(file);
  return {read_gmsh_part_head(file).n_parts, 0, 0};
}

GmshPartHead read_gmsh_part_head(const std::filesystem::path& file) {
  const io::GmshPartition of = io::gmsh_partition(io::read_bytes(file));
  return {of.n, of.partitions.size() == 1 ? of.partitions[0] - 1 : -1};
}

}  // namespace hextwist
