// What became of the hexes of a request: flat ones, which are not accepted, and poor ones, which are told.
#pragma once

#include <span>
#include <vector>

#include "hextwist/sizing/report.h"

namespace hextwist {

/// Scaled Jacobian below which a new hex is looked at (hexes_below() of validity.h): `low` of the functions here.
inline constexpr double poor_quality = 0.1;

/// Those of the low hexes whose scaled Jacobian is below a thousandth of the smallest among the hexes of the input
/// around the one they lie in. origin: per refined hex, as in RefineResult.
std::vector<Index> flattened_hexes(const Mesh& input, const Mesh& refined, std::span<const Index> origin,
                                   std::span<const Index> low);

/// The low hexes; where the input has such hexes itself, those below a fifth of its smallest. before: of the input (the
/// whole, where `input` is a part), if that is known; else it is measured.
PoorHexes poor_hexes(const Mesh& input, const Summary& before, const Mesh& refined, std::span<const Index> low);

/// Those of the nodes that are off their owners still: by more than 1e-7 of the model size and its own tolerance there.
std::vector<OffOwner> still_off(const MeshedModel& refined, std::span<const OffOwner> nodes);

}  // namespace hextwist
