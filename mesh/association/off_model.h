// off_model() for part of a mesh.
#pragma once

#include <span>

#include "hextwist/mesh/association/association.h"

namespace hextwist::detail {

/// off_model() of association.h among these nodes only, in any order.
OffModel off_model(const Mesh& mesh, const Association& association, const Model& model, std::span<const Index> nodes);

}  // namespace hextwist::detail
