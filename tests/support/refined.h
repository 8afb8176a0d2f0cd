// A refined mesh straight from a split: nodes at their template places in straight-sided parents.
#pragma once

#include <vector>

#include "hextwist/mesh/mesh.h"
#include "hextwist/refine/split.h"

namespace hextwist::test {

Mesh refined(const Mesh& mesh, const Split& split);

/// Trisecting codes from node marks.
std::vector<std::uint16_t> codes_of_nodes(const Mesh& mesh, const std::vector<char>& marked);

}  // namespace hextwist::test
