// A front that moves through a mesh: a sphere of radius 2.2 in a grid of 10 x 10 x 10, and the refinement that follows
// it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "hextwist/hextwist.h"

namespace front {

constexpr double radius = 2.2;

/// Its centre at a step: past the corners of cells, so that no step is like another.
inline hextwist::Vec3 centre(int step) {
  return {-4.9 + 0.53 * step, 0.07 * step, 0.03 * step};
}

/// Does the sphere pass between the corners of a hex?
inline bool meets(const hextwist::Mesh& mesh, const hextwist::Hex& hex, const hextwist::Vec3& centre) {
  const auto is_outside = [&](hextwist::Index n) { return (mesh.points[n] - centre).norm() > radius; };
  const auto n_outside = std::ranges::count_if(hex, is_outside);
  return n_outside > 0 && n_outside < 8;
}

/// Finer where the front is, coarser where it is not: by one level a call, until nothing changes.
inline void follow(hextwist::Session& session, const hextwist::Vec3& centre, int n_levels) {
  using namespace hextwist;
  for (int call = 0; call <= n_levels; ++call) {
    const Mesh& mesh = session.meshed().mesh;
    const auto level = std::ranges::find(mesh.fields, "level", &Field::name);
    std::vector<std::int8_t> changes(mesh.hexes.size());
    for (std::size_t h = 0; h < changes.size(); ++h) {
      const double is = level == mesh.fields.end() ? 0 : level->values[h];
      if (!meets(mesh, mesh.hexes[h], centre))
        changes[h] = -1;
      else if (is < n_levels)
        changes[h] = 1;
    }
    const AdaptOutcome outcome = session.adapt(changes);
    if (std::ranges::all_of(outcome.came_from.kind, [](HexOrigin kind) { return kind == HexOrigin::same; })) return;
  }
}

}  // namespace front
