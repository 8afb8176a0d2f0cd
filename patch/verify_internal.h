// Verifying a change where it is: what verify.h promises, for a part of a mesh that is known to hold the change.
#pragma once

#include <span>
#include <vector>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/quality/measure.h"
#include "hextwist/patch/verify.h"

namespace hextwist {

/// A changed mesh, and the part of it that holds the change with all hexes that share a node with it: a mesh of its
/// own, or the whole. All lists ascend.
struct ChangedPart {
  const MeshedModel& input;   ///< all of it, before
  const MeshedModel& before;  ///< the part
  const MeshedModel& after;   ///< nodes of `before` are the first; those that are gone are nodes of no hex
  std::span<const Index> nodes = {}, hexes = {};  ///< of `before` in `input`; empty: the part is the whole
  Index n_kept = 0;                               ///< hexes of `after` 0 .. n_kept - 1 are hexes of `before`
  std::vector<Index> gone = {};                   ///< hexes of `before` that were cut
  std::vector<Index> moved = {};                  ///< nodes of `before` that lie elsewhere now
  std::vector<Index> touched = {};                ///< kept hexes of `after` with such a node
  /// How nodes and hexes of the whole are called afterwards, and which ids the hexes that come (in the order of
  /// `after`) have there. Null: all that is new comes last, in that order, and so do the ids.
  const Reindexing *renamed_nodes = nullptr, *renamed_hexes = nullptr;
  std::span<const std::int64_t> come_ids = {};

  /// Numbers in the whole: before, of nodes and hexes of `before`; after, of nodes of `after`.
  Index whole_hex(Index hex) const { return hexes.empty() ? hex : hexes[hex]; }
  Index whole_node(Index node) const { return nodes.empty() ? node : nodes[node]; }
  std::vector<Index> whole_gone() const;  ///< `gone` in the whole
  Index whole_node_after(Index node) const;
};

/// Fills in what moved and what that touches. Precondition: the rest is known.
void find_moved(ChangedPart& change);

/// A mesh with nodes and hexes in the order of the mesh before: those that stay first, then the new ones. Nodes that
/// are gone stay too, without hexes. No more than verifying looks at. old_node, old_hex: per node and hex the same
/// before, -1.
MeshedModel in_former_order(const MeshedModel& before, const MeshedModel& after, std::span<const Index> old_node,
                            std::span<const Index> old_hex);

/// What these values of all hexes add up to; nothing is said of the CAD.
Measured measured_without_cad(const Mesh& mesh, const Measures& of_hexes);
/// Tells the report what the input had, and what the result has, as measured_after() reads it.
void set_before(const Measured& of, Report& report);
void set_after(const Measured& of, Report& report);

/// Whether the part is sound after the change if it was before, and no hex that came or has a node that moved is
/// inverted. False where that can't be told from the change.
bool is_sound(const ChangedPart& change);

/// verify() by the change alone. False when only doing everything from scratch will do; the report is then as it was.
bool verify_change(const ChangedPart& change, const Measured& known, Report& report);

/// What verify() says of a mesh that is the input.
void verify_unchanged(const Measured& known, Report& report);

/// verify() where that was so.
void verify_all(const MeshedModel& refined, const Measured& known, Report& report);

}  // namespace hextwist
