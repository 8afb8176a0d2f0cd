// The best and the worst hexes of a mesh, so that the next in line is known when one of them is cut.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace hextwist {

/// Hexes with the least (or largest) values of a metric: (value, or -value among the largest; id), ascending. Every hex
/// that is not on the list would come after its last. Empty: nothing is known.
using ExtremeList = std::vector<std::pair<double, std::int64_t>>;

struct Extremes {
  std::array<ExtremeList, 2> shape, scaled_jacobian;  ///< least, largest
};

/// Of all hexes but those `without` (ascending); values: one per hex of the mesh.
ExtremeList extremes(const Mesh& mesh, std::span<const double> values, bool largest,
                     std::span<const Index> without = {});

/// The list after hexes with these ids (ascending) are gone and others have come; may become empty.
ExtremeList changed(const ExtremeList& list, std::span<const std::int64_t> gone, const ExtremeList& come);

}  // namespace hextwist
