// Whether parts have made of hexes between them what their owners made.
#pragma once

#include "hextwist/parts/local_mesh.h"

namespace hextwist {

/// Rings that are compared with their owners and must be the same.
inline constexpr int least_rings = 2;
/// More rings than this make no sense.
inline constexpr int most_rings = 250;

/// What a part has made of a hex in its halo.
struct Made {
  std::int64_t hex = 0;  ///< id in the input mesh
  std::uint64_t digest = 0;
};

/// What must be known of the hexes of a halo to compare them: per other part, and the ring of each.
struct HaloMade {
  std::vector<std::vector<Made>> of;
  std::vector<std::vector<std::uint8_t>> ring;
};
HaloMade made_of_halo(const LocalMesh& local, std::span<const std::uint64_t> digest, int n_parts);

/// Of a part's own hexes: does another have the same? base: of the part.
std::vector<std::uint8_t> is_same(std::span<const Made> theirs, const BaseHexes& base,
                                  std::span<const std::uint64_t> digest);

}  // namespace hextwist
