// Smoothing of levelled meshes: it moves the mesh that is handed out, never the cells from which it is made, since
// cells that come of smoothed ones are worse. So what was moved is kept beside the forest.
#pragma once

#include <memory>

#include "hextwist/refine/levels/forest.h"

namespace hextwist {

/// Nodes that are not where the forest puts them, and where they are.
struct Overlay {
  std::vector<Index> nodes;  ///< of the mesh handed out, ascending
  std::vector<Vec3> points;
  std::vector<Parameters> parameters;  ///< empty without an association

  bool empty() const { return nodes.empty(); }
};

/// After these nodes (ascending) of the mesh handed out have moved too.
Overlay overlay_after(const Overlay& before, std::span<const Index> moved, const MeshedModel& meshed);

/// Puts the nodes of the step's mesh where they were in the mesh before. A hex that is new, or keeps some of its moved
/// nodes and not all, must not be much worse than what the forest makes of it: else they go back, bit by bit. pinned:
/// nodes of before (ascending) that are put there in any case. Returns what is left of the overlay; n_dropped: how many
/// nodes went back, if only in part, or are gone.
Overlay put_on(const Overlay& before, const Mesh& mesh_before, const Association& association_before,
               std::span<const Index> pinned, LevelStep& step, Index& n_dropped);

}  // namespace hextwist
