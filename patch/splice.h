// What a refinement in a patch changes in the whole mesh, and how it is put in there and taken out again.
#pragma once

#include <cstddef>
#include <vector>

#include "hextwist/base/sorted.h"
#include "hextwist/patch/patch.h"

namespace hextwist {

/// Where in the whole the parts of a changed patch are.
struct PatchNumbers {
  const Patch& patch;
  Reindexing nodes, hexes;  ///< of the whole
  /// Per node and hex of the changed patch: the same in the patch before, -1 where it is new.
  std::vector<Index> old_node, old_hex;
  std::vector<Index> node, hex;                     ///< and its number in the changed whole
  std::vector<Index> local_gone_nodes, local_gone;  ///< nodes and hexes of the patch that are no more, ascending
  std::vector<Index> come_nodes, come;  ///< those of the changed patch that are new, by their order in the whole
  /// Ids of these, and whether the whole has explicit ones afterwards (before, it has them where it has arrays of
  /// them).
  std::vector<std::int64_t> node_ids, hex_ids;
  bool has_node_ids = false, has_hex_ids = false;

  /// Of a patch refined by passes: hexes that were cut are gone, all that is new comes last, and no node goes.
  PatchNumbers(const Patch& of, const MeshedModel& whole, const Mesh& refined_patch);
  /// same_node, same_hex: what becomes old_node and old_hex. whole_place: where a new hex is in the changed whole, -1:
  /// at the end. New nodes are at the end. Ids are to be filled in.
  PatchNumbers(const Patch& of, const MeshedModel& whole, std::vector<Index> same_node, std::vector<Index> same_hex,
               std::span<const Index> whole_place);
};

/// The difference between two meshes on their model, from which either can be made of the other, in place. Nodes and
/// hexes that stay may be called otherwise afterwards (Reindexing); in all else what is not mentioned stays.
class Splice {
 public:
  /// Hexes of the whole, before and after, before which none has nodes that are called otherwise on the other side.
  struct RenamedFrom {
    Index before = 0, after = 0;
  };
  /// Between a whole mesh and itself with its patch changed. Throws Error where it would have too many nodes or hexes.
  Splice(const MeshedModel& whole, const PatchNumbers& numbers, const MeshedModel& refined_patch,
         RenamedFrom first_renamed);
  Splice(const MeshedModel& whole, const PatchNumbers& numbers, const MeshedModel& refined_patch)
      : Splice(whole, numbers, refined_patch, RenamedFrom()) {}

  Index n_nodes(bool after) const { return after ? nodes_.n_after(n_nodes_) : n_nodes_; }
  Index n_hexes(bool after) const { return after ? hexes_.n_after(n_hexes_) : n_hexes_; }
  const Reindexing& nodes() const { return nodes_; }
  const Reindexing& hexes() const { return hexes_; }
  /// No node goes, and new hexes are the last.
  bool only_appends() const {
    return nodes_.gone.empty() && (hexes_.come.empty() || hexes_.come.front() == n_hexes_ - std::ssize(hexes_.gone));
  }
  /// Hexes that go and that come, with their nodes.
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
  Reindexing nodes_, hexes_;
  std::vector<Index> moved_;  // nodes that stay, by their numbers before
  RenamedFrom first_renamed_;
  struct Ids {
    bool before, after;  // whether there are arrays of them
  } node_ids_{}, hex_ids_{};
  // What each side has that the other has not, as meshes without connection. Per node: what the moved nodes have, then
  // those that go or come; per hex: those that go or come; of lists: items that go or come, each named as on its side.
  MeshedModel before_, after_;
  mutable std::vector<Index>
      names_;  // of nodes from the first one that is called otherwise, between make_room and apply
};

/// A copy of the mesh, changed.
MeshedModel spliced(const MeshedModel& whole, const Splice& splice, bool forward = true);

}  // namespace hextwist
