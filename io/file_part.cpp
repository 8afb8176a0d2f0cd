#include "hextwist/io/file_part.h"

#include "hextwist/io/exodus/exodus_internal.h"
#include "hextwist/io/gmsh/gmsh.h"

namespace hextwist {
namespace {

bool is_msh(const std::filesystem::path& file) {
  return lower_case(file.extension().string()) == ".msh";
}

}  // namespace

std::filesystem::path part_name(const std::filesystem::path& name, int n_parts, int number) {
  if (is_msh(name)) {
    std::filesystem::path part = name;
    part.replace_filename(name.stem().string() + "_" + std::to_string(number + 1) + name.extension().string());
    return part;
  }
  const std::string of = std::to_string(n_parts), i = std::to_string(number);
  return name.string() + "." + of + "." + std::string(of.size() - std::min(of.size(), i.size()), '0') + i;
}

PartHead read_part_head(const std::filesystem::path& file) {
  if (!is_msh(file)) return io::read_exodus_head(file);
  return {io::gmsh_partition(io::read_bytes(file)).n, 0, 0};
}

int gmsh_part_number(const std::filesystem::path& file) {
  try {
    const io::GmshPartition of = io::gmsh_partition(io::read_bytes(file));
    return of.n > 1 && of.partitions.size() == 1 ? of.partitions[0] - 1 : -1;
  } catch (const Error&) {
    return -1;  // whoever reads all of it says what is wrong
  }
}

}  // namespace hextwist
