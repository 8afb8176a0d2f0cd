// Steps back and forth: what it takes to make one state of a session from the next, without copies of what is the same.
//
// A small refinement says itself what it changed (patch/splice.h); other meshes are compared (array_delta_internal.h).
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hextwist/patch/splice.h"
#include "hextwist/session/array_delta_internal.h"
#include "hextwist/session/state_internal.h"

namespace hextwist {

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
  void forget_extremes() noexcept;

 private:
  std::string command_;
  ModelState state_;  // meshed: the mesh where it shares too little with that of `from`, else null
  std::shared_ptr<const MeshedDelta> arrays_;
  std::shared_ptr<const Splice> splice_;
  bool forward_ = false;
  bool only_sets_ = false;
  std::size_t bytes_ = 0, extreme_bytes_ = 0;  // of all, and of these
};

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
