// Verifying a change where it is: what verify.h promises, for a part of a mesh that is known to hold the change.
#pragma once

#include <span>
#include <vector>

#include "hextwist/patch/verify.h"

namespace hextwist {

/// A changed mesh, and the part of it that holds the change with all hexes that share a node with it: a mesh of its
/// own, or the whole. All lists ascend.
struct ChangedPart {
  const MeshedModel& input;   ///< all of it, before
  const MeshedModel& before;  ///< the part
  const MeshedModel& after;
  std::span<const Index> nodes = {}, hexes = {};  ///< of `before` in `input`; empty: the part is the whole
  Index n_kept = 0;                               ///< hexes of `after` 0 .. n_kept - 1 are hexes of `before`
  std::vector<Index> gone = {};                   ///< hexes of `before` that were cut
  std::vector<Index> moved = {};                  ///< nodes of `before` that lie elsewhere now
  std::vector<Index> touched = {};                ///< kept hexes of `after` with such a node

  /// Numbers of the whole: of nodes and hexes of `before`; of nodes of `after`.
  Index whole_node(Index node) const;
  Index whole_hex(Index hex) const { return hexes.empty() ? hex : hexes[hex]; }
};

/// The kept hexes of `after` with a node that moved.
std::vector<Index> touched_hexes(const Mesh& after, Index n_kept, std::span<const Index> moved);

/// verify() by the change alone. False when only doing everything from scratch will do; the report is then as it was.
bool verify_change(const ChangedPart& change, const Measured& known, Report& report);

/// verify() where that was so.
void verify_all(const MeshedModel& refined, const Measured& known, Report& report);

}  // namespace hextwist
