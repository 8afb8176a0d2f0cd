// From what is asked for to what is done: the one place that rules on which wishes go together.
#pragma once

#include <optional>

#include "hextwist/sizing/request.h"

namespace hextwist {

/// How a request is carried out; a technique each (techniques/technique.h).
enum class Approach {
  uniform,              ///< the whole model, every edge in equal pieces
  trisect,              ///< hexes and layers of hexes in 27 (section 4)
  levels,               ///< the same so that no piece of a transition is cut again, and back (levelling.h)
  eight,                ///< the same in eight where sheets allow it (sections 5.1 to 5.3)
  parallel,             ///< around nodes, edges and faces (section 5.1)
  combination,          ///< the same and along them (section 5.4)
  thickness,            ///< edges behind surfaces
  layers,               ///< boundary layers
  sheets,               ///< edges of sheets
  size_by_levels,       ///< to wished sizes, by levels
  size_by_threes,       ///< by trisecting whatever is too large
  size_by_halves,       ///< and one into eight where that comes nearer
  size_by_directions,   ///< and what is too long in some directions only in these alone, before
  size_by_combination,  ///< and by the combination at the target
  nearest_size,         ///< whichever of two of these comes nearer to the wish
};

struct Plan {
  Approach approach = Approach::trisect;
  /// Hexes that are cut lie in so many rings around the target (1: they touch it), but for those that filling or
  /// enclosing adds. None: anywhere, since sheets, sizes, gradation or the whole model decide.
  std::optional<int> reach = std::nullopt;
};

/// Whether whole hexes are cut by levels. (Filled regions are convex by cutting what is there.)
inline bool is_regular(const Request& request) {
  return request.transition != Transition::nested && request.concave == Concave::templates;
}

/// Whether sizes that grow from the target may be met by the combination there.
inline bool may_combine(const Target& target, const Sizes& sizes) {
  return sizes.size && sizes.bias > 1 && !is_solid(target.kind) && !target.depth && !target.radius;
}

/// Whether a size that is the same everywhere may be met by one into eight.
inline bool may_halve(const Request& request) {
  const Sizes& sizes = std::get<Sizes>(request.how);
  return request.method != Method::single && sizes.bias <= 1 && !sizes.field;
}

/// Throws Error for unknown ids, options out of range and wishes that do not go together.
Plan plan(const MeshedModel& input, const Request& request);

}  // namespace hextwist
