// Everything that is asked of every hex of a mesh at the end of a refinement, in one walk.
#pragma once

#include <span>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace hextwist {

struct Measures {
  std::vector<double> shape, scaled_jacobian, volume;  ///< per hex: the bits of quality()
  bool all_valid = true;                               ///< as all_valid() of validity.h
};
/// Precondition: finite coordinates, nodes that exist.
Measures measure(const Mesh& mesh);
/// Of these hexes alone, in their order.
Measures measure(const Mesh& mesh, std::span<const Index> hexes);

}  // namespace hextwist
