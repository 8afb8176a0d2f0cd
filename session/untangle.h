// A mesh that comes in with inverted hexes.
#pragma once

#include <string>
#include <vector>

#include "hextwist/session/transaction.h"

namespace hextwist {

/// The inverted hexes of these violations if untangling them could make the mesh right; else nothing.
std::vector<Index> inverted_among(const std::vector<Violation>& violations);
/// Untangles around these hexes, then everywhere; boundary: nodes on curves and surfaces slide. False: some are
/// inverted still.
bool untangle_mesh(const Transaction& run, Mesh& mesh, Association& association, const Model* model,
                   const std::vector<Index>& inverted, bool boundary);
/// The notice of a mesh that was untangled.
std::string untangled_text(const Mesh& mesh, const std::vector<Vec3>& before, const std::vector<Index>& inverted);

}  // namespace hextwist
