// What a refinement in a patch changes in the whole mesh, and how it is put in there and taken out again.
#pragma once

#include <cstddef>
#include <vector>

#include "hextwist/patch/patch.h"

namespace hextwist {

/// Where in the whole the parts of a refined patch are.
struct PatchNumbers {
  const Patch& patch;
  Index n_nodes = 0, n_hexes = 0;  ///< of the whole, before
  Index n_kept = 0;                ///< hexes of the refined patch 0 .. n_kept - 1 were not cut
  std::vector<Index> local_gone;   ///< hexes of the patch that were, ascending
  std::vector<Index> gone;         ///< the same in the whole

  PatchNumbers(const Patch& of, const MeshedModel& whole, const Mesh& refined_patch);

  Index n_patch_nodes() const { return static_cast<Index>(patch.nodes.size()); }
  /// Node of the patch, before or after.
  Index node(Index local) const {
    return local < n_patch_nodes() ? patch.nodes[local] : local - n_patch_nodes() + n_nodes;
  }
  /// Hex of the refined patch in the refined whole.
  Index refined_hex(Index local) const;
};

/// The difference between two meshes on their model, from which either can be made of the other, in place. Hexes that
/// are kept are called otherwise afterwards (base/sorted.h); in all else what is not mentioned stays.
class Splice {
 public:
  /// Between a whole mesh and itself with its patch refined. Throws Error where it would have too many nodes or hexes.
  Splice(const MeshedModel& whole, const PatchNumbers& numbers, const MeshedModel& refined_patch);

  Index n_nodes(bool after) const {
    return n_nodes_ + (after ? static_cast<Index>(after_.mesh.points.size() - moved_.size()) : 0);
  }
  Index n_hexes(bool after) const { return after ? n_kept() + static_cast<Index>(new_hexes().size()) : n_hexes_; }
  Index n_kept() const { return n_hexes_ - static_cast<Index>(gone_.size()); }
  /// Hexes that were cut, by their index before, and with their nodes; their children.
  const std::vector<Index>& gone() const { return gone_; }
  const std::vector<Hex>& gone_hexes() const { return before_.mesh.hexes; }
  const std::vector<Hex>& new_hexes() const { return after_.mesh.hexes; }

  /// Room in all arrays, so that apply() throws nothing. forward: else back.
  void make_room(MeshedModel& whole, bool forward) const;
  /// Changes the one mesh into the other. Precondition: it is just that one, and there is room.
  void apply(MeshedModel& whole, bool forward) const noexcept;
  /// Of memory held.
  std::size_t bytes() const;

 private:
  Index n_nodes_, n_hexes_;  // before
  std::vector<Index> moved_, gone_;
  bool makes_hex_ids_ = false;
  // What each side has that the other has not, as meshes without connection. Per node: what the moved nodes have, then
  // (after) the new ones; per hex: the gone or the new ones; of lists: items that go or come, each named as on its
  // side.
  MeshedModel before_, after_;
};

/// A copy of the mesh, changed.
MeshedModel spliced(const MeshedModel& whole, const Splice& splice, bool forward = true);

}  // namespace hextwist
