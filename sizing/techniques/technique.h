// The techniques: what each of them cuts next. The loop (sizing/loop.h) does the cutting.
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hextwist/refine/lineage.h"
#include "hextwist/refine/templates/split_table.h"
#include "hextwist/sizing/plan.h"

namespace hextwist {

class State;

/// When a pass comes among all those that a request may lead to: the earlier ones may have nothing to cut, and then are
/// left out.
struct Turn {
  int round = 0;  ///< of numsplit, or level
  int step = 0;   ///< 0: enclosing or all there is, 1: trisecting along what was enclosed
  int part = 0;   ///< of an enclosing that can't be made at once
  auto operator<=>(const Turn&) const = default;
};

/// What one pass cuts: a code of the table per hex of the current mesh.
struct Cut {
  std::shared_ptr<const SplitTable> table;
  std::vector<std::uint16_t> codes;
  /// Hexes of earlier passes are cut again: smooth them first where they are too thin for that.
  bool cuts_again = false;
  Turn turn = {};  ///< of techniques that go hex by hex; others have no use for it
  /// Per node the round of filling concave places in which it was marked, 0: none. Empty: there was no filling.
  std::vector<std::uint8_t> filled = {};
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
