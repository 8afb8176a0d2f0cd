// Steps back and forth: what it takes to make one state of a session from the next, without copies of what is the same.
//
// An array is told from another by the pieces that differ. That finds nodes that moved (the same places), hexes that
// were split (gone from the middle, children at the end) and members that joined a set; where nothing fits, the array
// is kept whole. A small refinement says itself what it changed (sizing/splice_internal.h), and nothing is compared.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hextwist/session/state_internal.h"
#include "hextwist/patch/splice.h"

namespace hextwist {

/// How to make the array `to` from the array `from`. Items are compared bit by bit.
template <class T>
class ArrayDelta {
 public:
  ArrayDelta() = default;
  ArrayDelta(const std::vector<T>& from, const std::vector<T>& to);
  /// Precondition: the `from` it was made with.
  std::vector<T> apply(const std::vector<T>& from) const;
  bool empty() const { return same_; }
  /// Of memory held.
  std::size_t bytes() const { return pieces_.capacity() * sizeof(Piece) + fresh_.capacity() * sizeof(T); }

  /// First n_fresh new items, then n_kept of `from`, beginning at first.
  struct Piece {
    std::size_t n_fresh, first, n_kept;
  };

 private:
  bool same_ = true;
  std::vector<Piece> pieces_;
  std::vector<T> fresh_;
};

/// A list of blocks, sets or fields.
template <class Group, class Item>
struct GroupsDelta {
  struct Entry {
    Group group;      ///< without its items
    Index from = -1;  ///< whose items those of `items` are made from; -1: of nothing
    ArrayDelta<Item> items;
  };
  bool same = true;
  std::vector<Entry> entries;
};

/// The groups of a mesh: their own arrays only.
struct SetsDelta {
  GroupsDelta<Block, Index> blocks;
  GroupsDelta<NodeSet, Index> node_sets;
  GroupsDelta<SideSet, Side> side_sets;
};
SetsDelta sets_delta(const Mesh& from, const Mesh& to);
/// The three lists of `to`; the rest of the result is empty.
Mesh sets_after(const SetsDelta& delta, const Mesh& from);

/// One state of the model made from the one that it is kept beside.
class Step {
 public:
  Step() = default;
  /// command: what led from one to the other.
  Step(std::string command, const ModelState& from, const ModelState& to);
  /// For a change of blocks and sets alone; the model state is otherwise the same.
  Step(std::string command, const ModelState& state, SetsDelta sets);
  /// To a state whose mesh a splice, forward or back, makes of the one that it is kept beside.
  Step(std::string command, const ModelState& to, std::shared_ptr<const Splice> splice, bool forward);

  const std::string& command() const { return command_; }
  void swap_command(Step& other) noexcept { command_.swap(other.command_); }
  std::size_t bytes() const { return bytes_; }
  /// Blocks and sets alone differ.
  bool only_sets() const { return only_sets_; }
  const SetsDelta& sets() const;
  /// Null unless it was made with one. The state it leads to, without its mesh.
  const std::shared_ptr<const Splice>& splice() const { return splice_; }
  bool forward() const { return forward_; }
  const ModelState& state() const { return state_; }
  /// Precondition: the `from` it was made with.
  ModelState apply(const ModelState& from) const;
  /// The state it leads to no longer knows its best and worst hexes: memory that old steps can do without.
  void forget_outliers() noexcept;

 private:
  struct Arrays;
  std::string command_;
  ModelState state_;  // meshed: the mesh where it shares too little with that of `from`, else null
  std::shared_ptr<const Arrays> arrays_;
  std::shared_ptr<const Splice> splice_;
  bool forward_ = false;
  bool only_sets_ = false;
  std::size_t bytes_ = 0, outlier_bytes_ = 0;  // of all, and of these
};

/// Bytes in the arrays of a mesh and its association.
std::size_t bytes_of(const MeshedModel& meshed);

/// What can be undone and redone, latest last.
struct History {
  bool on = true;
  std::size_t limit = 1000000000;  ///< bytes of all steps together
  std::vector<Step> undo, redo;

  std::size_t bytes() const;
  /// Takes a step that has just been done: nothing is left to redo. Throws nothing if there is room in `undo`.
  void add(Step step) noexcept;
  /// While the steps take more than the limit; those to redo that come last go first.
  void drop_oldest() noexcept;
};

}  // namespace hextwist
