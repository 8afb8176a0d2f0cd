// What a part of a mesh has to know of the whole, so that sizes are met in it as by passes over the whole.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hextwist/refine/plans/combine.h"
#include "hextwist/sizing/report.h"
#include "hextwist/sizing/request.h"

namespace hextwist {

class SizeWish;

/// A request for sizes, looked at over the whole mesh.
struct SizesOfAll {
  const MeshedModel& input;
  const Request& request;
  std::shared_ptr<const SizeWish> wish;
  std::vector<std::string> told;          ///< what is to be said of the target
  std::vector<Index> region;              ///< hexes of the target, ascending
  std::vector<std::uint8_t> in_zone;      ///< where sizes are wished for: a byte per hex
  std::vector<Index> too_large, too_far;  ///< hexes that are, ascending; nodes of edges that are too long, two for each

  /// Throws as the passes do.
  SizesOfAll(const MeshedModel& input, const Request& request);
  /// No hex is too large, nor any edge along the target too long: nothing is to be cut.
  bool are_met() const { return too_large.empty() && too_far.empty(); }
  /// The report on some hexes of the region, ascending.
  SizeReport report(std::vector<Index> hexes) const;
  /// Of such hexes in each of their directions.
  DirectionSizes directions(std::span<const Index> hexes) const;
  /// So many more hexes it takes at the very least.
  double least_more() const;
};

/// The same in the numbers of a part, and what is outside of it.
struct SizesInPart {
  const SizesOfAll& all;
  std::span<const Index> nodes;  ///< those of the part, ascending
  std::vector<Index> region;
  Index n_outside = 0;       ///< hexes
  Index n_base_outside = 0;  ///< those of the base of levels
  double worst_shape_outside = 1;
  SizeReport outside;  ///< on hexes of the region

  std::span<const std::uint8_t> ring;  ///< per hex of the part: how far it is from what asks
  int farthest = 0;                    ///< ring in which anything was cut, by whatever was tried

  bool is_too_small = false;  ///< something begins outside: only the whole will do

  void note_cut(Index hex) { farthest = std::max(farthest, int{ring[hex]}); }
  /// Nodes, edges and faces of the target; what is to be said of it goes to `told`.
  CombinationTarget target(std::vector<std::string>& told) const;
  /// part_nodes (kept), hexes: those of the part, ascending.
  SizesInPart(const SizesOfAll& of, std::span<const Index> part_nodes, std::span<const Index> hexes);
};

}  // namespace hextwist
