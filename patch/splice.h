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

/// Items of an ascending list that go and that come, each named as it is on its own side of the change; with their
/// values where the list has another beside it.
template <class Item>
struct ListEdit {
  std::vector<Item> out, in;
  std::vector<int> out_values, in_values;
};

/// The difference between two meshes on their model, from which either can be made of the other, in place. Hexes that
/// are kept are called otherwise afterwards (base/sorted.h); in all else what is not mentioned stays.
class Splice {
 public:
  /// Between a whole mesh and itself with its patch refined. Throws Error where it would have too many nodes or hexes.
  Splice(const MeshedModel& whole, const PatchNumbers& numbers, const MeshedModel& refined_patch);

  Index n_nodes(bool after) const { return n_nodes_ + (after ? static_cast<Index>(new_points_.size()) : 0); }
  Index n_hexes(bool after) const { return after ? n_kept() + static_cast<Index>(new_hexes_.size()) : n_hexes_; }
  Index n_kept() const { return n_hexes_ - static_cast<Index>(gone_.size()); }
  /// Hexes that were cut, by their index before, and with their nodes; their children.
  const std::vector<Index>& gone() const { return gone_; }
  const std::vector<Hex>& gone_hexes() const { return gone_hexes_; }
  const std::vector<Hex>& new_hexes() const { return new_hexes_; }

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
  struct Moved {
    std::vector<Vec3> points;
    std::vector<Parameters> parameters;
  };
  Moved before_, after_;  // per moved node
  std::vector<Vec3> new_points_;
  std::vector<std::int64_t> new_node_ids_, new_hex_ids_, gone_hex_ids_;
  std::vector<Owner> new_owners_;
  std::vector<Parameters> new_parameters_;
  std::vector<Hex> new_hexes_, gone_hexes_;
  std::vector<int> new_volumes_, gone_volumes_;
  std::vector<std::vector<double>> new_values_, gone_values_;  // per field
  ListEdit<Edge> curve_edges_;
  ListEdit<Side> surface_faces_;
  std::vector<ListEdit<Index>> blocks_, node_sets_;
  std::vector<ListEdit<Side>> side_sets_;
};

/// A copy of the mesh, changed.
MeshedModel spliced(const MeshedModel& whole, const Splice& splice, bool forward = true);

}  // namespace hextwist
