// The techniques: what each of them cuts next. The loop (sizing/loop.h) does the cutting.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hextwist/refine/lineage.h"
#include "hextwist/refine/templates/split_table.h"
#include "hextwist/sizing/plan.h"

namespace hextwist {

class State;

/// What one pass cuts: a code of the table per hex of the current mesh.
struct Cut {
  std::shared_ptr<const SplitTable> table;
  std::vector<std::uint16_t> codes;
  /// Hexes of earlier passes are cut again: smooth them first where they are too thin for that.
  bool cuts_again = false;
};

class Technique {
 public:
  Technique() = default;
  Technique(const Technique&) = delete;
  Technique& operator=(const Technique&) = delete;
  virtual ~Technique() = default;

  /// The next cut of the current mesh; nothing: done.
  virtual std::optional<Cut> next(State& state) = 0;
  /// What it remembers of the mesh, in the numbers of the next one, after its cut was made.
  virtual void follow(const Lineage& lineage, const Mesh& before, const Mesh& after) = 0;
  /// Called in the end: what there is to report.
  virtual void finish(State&) {}
};

/// A technique at its start. Not for Approach::nearest_size, which compares two.
std::unique_ptr<Technique> make_technique(Approach approach, State& state);

}  // namespace hextwist
