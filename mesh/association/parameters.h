// Where nodes lie on the curves and surfaces that own them.
#pragma once

#include <span>
#include <vector>

#include "hextwist/mesh/association/association.h"

namespace hextwist {

/// By projection, per node; NaN for nodes that no curve or surface owns. What a node gets depends on it alone.
std::vector<Parameters> projected_parameters(const Model& model, const Mesh& mesh, std::span<const Owner> owners);

}  // namespace hextwist
