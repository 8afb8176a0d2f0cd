// To wished sizes, by levels.
#pragma once

#include "hextwist/refine/levels/forest.h"
#include "hextwist/sizing/loop.h"
#include "hextwist/sizing/techniques/wish_internal.h"

namespace hextwist {

/// How well sizes are met by a mesh by levels, whose nodes are where earlier smoothing had moved them, before any are
/// moved again. made: of the input of the state.
SizeReport level_size_report(const RefineResult& made, const State& state);

class LevelSizes {
 public:
  /// forest: grown, of the input. Precondition: the request is for sizes.
  LevelSizes(const Forest& forest, State& state);

  /// The marks that bring the forest's mesh to the sizes. As in passes, nodes are marked at which the wish is less than
  /// the size of a hex; but only those around which all hexes are regular cells of one level, so that no piece of a
  /// transition is cut. What would stay too coarse that way is cut as a whole at its own level, and looked at again.
  /// options.reuse: what was built on the way.
  LevelMarks wishes(LevelOptions& options);
  /// The same, of what was made of these wishes.
  SizeReport report(const RefineResult& made) const;

 private:
  LevelMarks more(const Mesh& mesh, const LevelPieces& pieces, std::span<const std::uint8_t> in_zone) const;

  const Forest& forest_;
  State& state_;
  const Sizes& sizes_;
  const std::shared_ptr<const SizeWish> wish_;
  std::vector<std::uint8_t> in_zone_, in_report_;  // per hex of the input
  int n_levels_ = 0;
};

}  // namespace hextwist
