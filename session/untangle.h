// A mesh that comes in with inverted hexes.
#pragma once

#include <string>
#include <vector>

#include "hextwist/session/transaction.h"

namespace hextwist {

/// The inverted hexes of these violations if untangling them could make the mesh right; else nothing.
std::vector<Index> inverted_among(const std::vector<Violation>& violations);
/// Each of these untangles around these hexes (ascending) and returns those that are inverted still. Near: one to four
/// layers of hexes; slide: nodes on curves and surfaces too, along these.
std::vector<Index> untangle_near(const Transaction& run, Mesh& mesh, Association& association, const Model* model,
                                 std::vector<Index> inverted, bool slide);
/// Where the skin itself is folded and there is no CAD: its nodes within two layers move as they like, by less than the
/// size of a hex.
std::vector<Index> untangle_freely(const Transaction& run, Mesh& mesh, std::vector<Index> inverted);
/// More and more layers, in the end everywhere; nodes on curves and surfaces stay, then slide.
std::vector<Index> untangle_far(const Transaction& run, Mesh& mesh, Association& association, const Model* model,
                                std::vector<Index> inverted);
/// The notice of a mesh that was untangled.
std::string untangled_text(const Mesh& mesh, const std::vector<Vec3>& before, const std::vector<Index>& inverted);

}  // namespace hextwist
