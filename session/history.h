// Steps back and forth: what it takes to make one state of a session from the next, without copies of what is the same.
//
// A small refinement says itself what it changed (patch/splice.h); other meshes are compared (array_delta_internal.h).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "hextwist/patch/splice.h"
#include "hextwist/session/array_delta_internal.h"
#include "hextwist/session/mesh_holder.h"
#include "hextwist/session/state.h"

namespace hextwist {

/// The mesh is the same.
struct SameMesh {};
/// It has too little in common with the other to tell the difference: kept as it is.
struct WholeMesh {
  std::size_t bytes;
  MeshHolder meshed = {};
};
struct ArraysChange {
  std::unique_ptr<const MeshedDelta> arrays;
};
/// Blocks and sets alone differ.
struct SetsChange {
  SetsDelta sets;
};
/// A small refinement, or its way back.
struct SpliceChange {
  std::shared_ptr<const Splice> splice;
  bool forward = true;
};
/// How a mesh is made from another.
using MeshChange = std::variant<SameMesh, WholeMesh, ArraysChange, SetsChange, SpliceChange>;

/// How to make `to` from `from`; a WholeMesh is left to be put in.
MeshChange difference(const MeshedModel& from, const MeshedModel& to);
/// A copy of `from`, changed. Precondition: the `from` the change was made with, and there is a change to make.
MeshedModel changed(const MeshedModel& from, const MeshChange& change);
/// Exchanges blocks and sets with those of another mesh.
void swap_sets(Mesh& mesh, Mesh& lists) noexcept;

/// One state of the model made from the one that it is kept beside.
struct Step {
  std::string command;  ///< what led from one to the other
  ModelState state;     ///< that it leads to
  MeshChange mesh;
  std::size_t bytes = 0, extreme_bytes = 0;  ///< of all, and of the best and worst hexes that the state knows

  Step(std::string said, const ModelState& from, const ModelState& to, MeshChange change);
  /// The state it leads to no longer knows its best and worst hexes: memory that old steps can do without.
  void forget_extremes() noexcept;
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
