// Limits on how fast sizes may change from place to place.
#pragma once

#include <span>

#include "hextwist/mesh/topology.h"

namespace hextwist {

/// Lowers the sizes of nodes until along every edge they grow by at most `slope` times its length: the largest such
/// sizes that are nowhere above the given ones. Infinite sizes are lowered too, unless all are. slope >= 0.
/// Dijkstra's algorithm from the small sizes outwards.
void limit_gradation(const Edges& edges, std::span<const Vec3> points, double slope, std::span<double> sizes);

}  // namespace hextwist
