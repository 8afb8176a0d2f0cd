// Any bytes as a file of one format: it is read, or refused by an Error of one line. What is read is a mesh all of
// whose numbers are in range, and can be written.
#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>

#include "hextwist/base/fenced.h"
#include "hextwist/io/format.h"
#include "hextwist/mesh/validate/validate.h"

namespace hextwist {
namespace {

using io::Bytes;

// Those that want a file get one without a name.
[[maybe_unused]] MeshFile called(MeshFile (*read)(const std::filesystem::path&, const Fence&), const std::uint8_t* data,
                                 std::size_t n) {
  static const Handover file;
  if (::ftruncate(file.descriptor(), 0) != 0 || ::pwrite(file.descriptor(), data, n, 0) != static_cast<ssize_t>(n))
    std::abort();
  // No other files: *INCLUDE.
  return read(file.path(), {.folder = "/nonexistent"});
}
[[maybe_unused]] MeshFile called(MeshFile (*read)(const Bytes&), const std::uint8_t* data, std::size_t n) {
  // As large as the input, so that a byte behind it is seen.
  auto copy = std::make_unique_for_overwrite<char[]>(n);
  std::memcpy(copy.get(), data, n);
  return read({"input", {copy.release(), io::ReleaseBytes{}}, n});
}

void require(bool holds) {
  if (!holds) std::abort();
}

void check(const Mesh& mesh) {
  const auto node = [&](Index n) { return n >= 0 && n < mesh.n_nodes(); };
  const auto hex = [&](Index h) { return h >= 0 && h < mesh.n_hexes(); };
  for (const Hex& one : mesh.hexes) require(std::ranges::all_of(one, node));
  for (const Block& block : mesh.blocks) require(std::ranges::all_of(block.hexes, hex));
  for (const NodeSet& set : mesh.node_sets) require(std::ranges::all_of(set.nodes, node));
  for (const SideSet& set : mesh.side_sets)
    require(std::ranges::all_of(set.sides, [&](const Side& s) { return hex(s.hex) && s.face >= 0 && s.face < 6; }));
  for (const Field& field : mesh.fields)
    require(field.values.size() == static_cast<std::size_t>(field.components) *
                                       (field.on == Field::On::node ? mesh.points.size() : mesh.hexes.size()));
  for (const Vec3& point : mesh.points) require(point.allFinite());
  require(mesh.node_ids.empty() || mesh.node_ids.size() == mesh.points.size());
  require(mesh.hex_ids.empty() || mesh.hex_ids.size() == mesh.hexes.size());
  validate(mesh);
}

}  // namespace
}  // namespace hextwist

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    const hextwist::MeshFile file = hextwist::called(hextwist::io::HEXTWIST_FUZZ_READER, data, size);
    hextwist::check(file.mesh);
  } catch (const hextwist::Error& error) {
    hextwist::require(std::strchr(error.what(), '\n') == nullptr);
  }
  return 0;
}
