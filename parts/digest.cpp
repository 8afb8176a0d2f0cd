#include "hextwist/parts/digest.h"

#include <cstring>

#include "hextwist/refine/split.h"

namespace hextwist {
namespace {

void mix_bytes(std::uint64_t& digest, const void* bytes, std::size_t n) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i + 8 <= n; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, at + i, 8);
    mix(digest, word);
  }
}

}  // namespace

std::vector<std::uint64_t> digests(const MeshedModel& made, std::span<const Index> base_of,
                                   std::span<const std::uint64_t> history, std::size_t n_base) {
  std::vector<std::uint64_t> digest(n_base, 0);
  const Mesh& mesh = made.mesh;
  const Association& association = made.association;
  const auto mix_values = [&](std::uint64_t& of, const Field& field, Index i) {
    const auto n = static_cast<std::size_t>(field.components);
    if (field.values.size() >= (static_cast<std::size_t>(i) + 1) * n)
      mix_bytes(of, &field.values[static_cast<std::size_t>(i) * n], n * sizeof(double));
  };
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    std::uint64_t& of = digest[base_of[h]];
    mix(of, history[h]);
    for (const Index n : mesh.hexes[h]) {
      mix_bytes(of, mesh.points[n].data(), sizeof(Vec3));
      if (!association.node_owner.empty()) {
        const Owner owner = association.node_owner[n];
        mix(of, static_cast<std::uint64_t>(owner.dim) << 32 | static_cast<std::uint32_t>(owner.id));
      }
      if (!association.node_parameters.empty()) mix_bytes(of, &association.node_parameters[n], sizeof(Parameters));
    }
    for (const Field& field : mesh.fields) {
      if (field.on == Field::On::hex)
        mix_values(of, field, h);
      else
        for (const Index n : mesh.hexes[h]) mix_values(of, field, n);
    }
  }
  return digest;
}

void record_levels(const Levelling& levelling, const Mesh& input, PassRecorder& recorder) {
  std::vector<Hex> hexes = input.hexes;
  Index n_nodes = input.n_nodes();
  int level = 0;
  for (const auto& pass : levelling.forest.grown->stack) {
    std::vector<std::uint16_t> codes(hexes.size(), 0);
    for (const CutHex& cut : pass->lineage.hexes) codes[cut.hex] = cut.code;
    Split again = split(hexes, n_nodes, pass->lineage.table, codes);
    recorder.record({level++, 0, 0}, again.lineage, hexes, {});
    hexes = std::move(again.hexes);
    n_nodes = again.n_nodes;
  }
}

}  // namespace hextwist
