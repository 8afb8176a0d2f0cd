// Puts the new nodes of a refinement where they belong: on their curves and surfaces, and between them.
#pragma once

#include <span>
#include <vector>

#include "hextwist/geom/model.h"
#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/smooth/smooth.h"
#include "hextwist/refine/split.h"

namespace hextwist {

/// Moves the new nodes of `mesh` (as carry() left them: in straight-sided parents) to their places:
///  1. on a curve: by curve parameter, in the same proportion between the ends of the cut edge;
///  2. on a surface: the straight (then, for nodes inside faces, blended) place projected, starting from the
///     parameters of the nearest old node;
///  3. elsewhere: the straight place plus the displacements of the edges and faces around, blended (transfinite
///     interpolation of Gordon and Hall, 1973), so that fine cells follow a curved coarse boundary.
/// Parameters of nodes on curves and surfaces are set. Old nodes do not move. The result does not depend on the
/// number of threads. split.hexes is not used (it has moved into the mesh).
void place(const Mesh& old_mesh, const Association& old_association, const Split& split, const Model& model, Mesh& mesh,
           Association& association);

/// What repairing is told.
struct RepairOptions {
  std::span<const Index> fixed = {};             ///< nodes that do not move
  std::span<const std::string> keep_jumps = {};  ///< as in SmoothOptions
  /// Surfaces that repeat each other: their nodes stay as long as something else helps, as what moves on one of them
  /// alone has no image on the other any more.
  std::span<const int> repeated_surfaces = {};
  /// Called after each sweep; once it returns false, repair stops soon, and the caller should drop the mesh.
  SmoothProgress progress = {};
};

/// Turns inverted children right again: by untangling around them (smooth.h; new nodes slide along their curves and
/// surfaces; where need be, old nodes inside volumes that are not `fixed` give way), and where that does not help by
/// moving new nodes back towards their place in the straight-sided parent, off their curve or surface. Nodes that end
/// up off their owner come back as rows; hexes that are still inverted are left for the caller to find
/// (inverted_hexes() of validity.h). had_to: whether there were any.
std::vector<OffOwner> repair_children(const Mesh& old_mesh, const Split& split, const Model* model, Mesh& mesh,
                                      Association& association, const RepairOptions& options = {},
                                      bool* had_to = nullptr);

}  // namespace hextwist
