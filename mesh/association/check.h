// check_association() for meshes that may lie farther off their model than those that are usual.
#pragma once

#include "hextwist/mesh/association/association.h"

namespace hextwist {

/// The same; nodes may be that far from where their parameters are, relative to the model size.
std::vector<std::string> check_association(const Mesh& mesh, const Association& association, const Model& model,
                                           double relative_tolerance);

}  // namespace hextwist
