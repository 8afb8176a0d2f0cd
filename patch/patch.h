// A small refinement does not need the mesh, only the part around its target. That part, the patch, is cut out as a
// mesh of its own, refined by the same passes as any mesh, verified, and spliced into the whole (splice.h).
//
// Nodes and hexes of a patch are in the order of the whole, and all rules of refining (which node comes first, which
// hex names a face, how children follow each other) compare numbers only. So the result is the one that the passes over
// the whole mesh give, to the bit, provided that nothing they look at lies beyond the patch. That is made sure of by
// rings of hexes around the target: whatever a pass does to a hex depends on a few rings around it (enough_rings), and
// afterwards no hex of the outer rings may have been cut. Where one was, the patch is made wider.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "hextwist/mesh/meshed_model.h"

namespace hextwist {

/// When patches are used. For tests to change.
struct PatchRule {
  Index least_mesh = 20000;  ///< hexes of a mesh for which it is worth the trouble
  Index part = 8;            ///< a patch is at most one part in so many of the mesh
};
inline PatchRule patch_rule;

/// Hexes around some nodes: in ring 1 those at the nodes, in ring 2 those that share a node with ring 1, ...
struct Rings {
  std::vector<Index> hexes;        ///< ascending
  std::vector<std::uint8_t> ring;  ///< per hex
  int n_rings = 0;
  bool is_all = false;  ///< nothing of the mesh touches the last ring from outside
};

/// Appends the hexes at these nodes, each at least once; false: does not know them all. The nodes of one call are those
/// that the call before has led to.
using HexesAt = std::function<bool(std::span<const Index> nodes, std::vector<Index>& hexes)>;

/// Empty when there are more than `limit` hexes, or hexes_at gives up.
std::optional<Rings> rings_around(const Mesh& mesh, std::span<const Index> nodes, int n_rings, std::size_t limit,
                                  const HexesAt& hexes_at);
/// The same by looking for the hexes in places near the nodes: a few sweeps over the mesh. at: hexes at the nodes, some
/// or all; empty: not known.
std::optional<Rings> rings_by_place(const Mesh& mesh, std::span<const Index> nodes, std::span<const Index> at,
                                    int n_rings, std::size_t limit);

/// All lists ascending, in numbers of the whole.
struct Patch {
  std::vector<Index> nodes;
  std::vector<Index> hexes;
  /// Its own mesh, ids left out (so index + 1), with what the whole knows of it. Faces between volumes whose lower hex
  /// is outside are not among its surface faces.
  MeshedModel meshed;

  /// Position among `nodes`, -1 where it is not there.
  Index local_node(Index node) const;
};
/// Other elements (mesh/others.h) are not cut out: who changes a patch sees to it that none touches it.
Patch make_patch(const MeshedModel& whole, std::vector<Index> hexes);
/// The same of a mesh that is needed no longer: array by array, so that both are never there at once. Ids stay.
Patch take_patch(MeshedModel& whole, std::vector<Index> hexes);
/// Has any of these hexes a node that another element has too?
bool touch_others(const Mesh& mesh, std::span<const Index> hexes);
/// Gives the mesh of a patch, which has none, the ids of the whole.
void set_ids(const Mesh& whole, const Patch& patch, Mesh& part);

}  // namespace hextwist
