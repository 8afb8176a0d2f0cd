// Which way each volume is swept, and how many intervals each curve has. Included by mesh/fill/*.cpp only.
#pragma once

#include "hextwist/mesh/fill/facts_internal.h"
#include "hextwist/mesh/fill/fill.h"

namespace hextwist::fill {

/// A curve between caps at one end, and the one between caps at the other end that it becomes.
struct Partner {
  int curve = 0, other = 0;
  bool same_way = true;
};

struct Sweep {
  int volume = 0;
  bool is_ball = false;                       ///< then there is nothing else
  bool is_turned = false;                     ///< all the way round: there are sides alone
  std::vector<int> sides = {};                ///< surfaces along which it goes
  std::array<std::vector<int>, 2> caps = {};  ///< those at its ends
  std::vector<Chain> along = {};              ///< from the vertices of the first caps to the other end
  std::vector<Partner> partners = {};         ///< where both ends have several caps
};

/// Has the cap a mesh of its own making, without a QuadMesher?
bool is_regular(const SurfaceFacts& surface);

/// A sweep for each volume. Throws Error naming those that have none, and why. can_pave: caps of any form will do.
std::vector<Sweep> find_sweeps(const Facts& facts, const std::vector<int>& volumes, bool can_pave);

/// Per curve id - 1. intervals: instead of a size; 0: none. most_turning: radians within an interval. Throws Error
/// where the sides of surfaces cannot have the same numbers.
std::vector<int> find_intervals(const Facts& facts, const std::vector<Sweep>& sweeps, double size, int intervals,
                                double most_turning);

}  // namespace hextwist::fill
