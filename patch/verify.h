// The last stage of a refinement: measures the result and finds out whether it is what was promised.
#pragma once

#include <memory>
#include <span>

#include "hextwist/patch/extremes.h"
#include "hextwist/sizing/report.h"

namespace hextwist {

/// What is known of a mesh that validate() has found to be without violations (warnings apart).
struct Measured {
  Summary shape, scaled_jacobian;
  double volume = 0;
  OffModel off_cad;
  std::shared_ptr<const Extremes> extremes = nullptr;  ///< may be left out
};
Measured measured(const MeshedModel& meshed);
/// Of the result of a refinement without violations.
Measured measured_after(const Report& report);

/// Fills in what the report says of quality, volume, distance from the CAD and violations. known: of the input; null:
/// everything is measured and validated from scratch.
///
/// Why it is enough to look at the change: hexes that were kept and whose nodes did not move are conformal, uninverted
/// and as good as before among themselves. What is validated from scratch is the part of the mesh made of all new
/// hexes, all around moved nodes and all that share a node with them; and of hexes at the boundary near new boundary
/// nodes, for these might lie in a face across a crack. Sides of new hexes with nothing behind must be on the CAD. If
/// anything at all is found there, or the change is a large part of the mesh, everything is done from scratch.
///
/// old: null where nodes of the input are the first and hexes have its ids; empty where the change is not known.
struct OldPlaces {
  std::span<const Index> node, hex;  ///< per node and hex of the refined mesh: the same one of the input, -1
};
void verify(const MeshedModel& input, const Measured* known, const MeshedModel& refined, const OldPlaces* old,
            Report& report);

}  // namespace hextwist
