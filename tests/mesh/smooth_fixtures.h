// Meshes for the smoother to repair, and what it must keep.
#pragma once

#include <random>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/smooth/smooth.h"
#include "hextwist/mesh/topology.h"
#include "support/grids.h"

namespace hextwist::test {

/// Per node: on the skin.
inline std::vector<char> on_skin(const Mesh& mesh) {
  std::vector<char> result(mesh.points.size(), 0);
  for (const auto [hex, face] : boundary_sides(faces(mesh)))
    for (const Index node : face_nodes(mesh.hexes[hex], face)) result[node] = 1;
  return result;
}

/// Moves nodes off the skin by up to `size` in each direction.
inline void shake(Mesh& mesh, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> offset(-size, size);
  const auto skin = on_skin(mesh);
  for (Index i = 0; i < mesh.n_nodes(); ++i)
    if (!skin[i]) mesh.points[i] += Vec3(offset(random), offset(random), offset(random));
}

/// Smooths with the skin fixed.
inline SmoothReport smooth_inside(Mesh& mesh, const SmoothOptions& options = {}) {
  Association nothing;
  return smooth(mesh, nothing, nullptr, options);
}

inline double min_shape(const Mesh& mesh) {
  return summarize(quality(Metric::shape, mesh)).min;
}

inline double min_scaled_jacobian(const Mesh& mesh) {
  return summarize(quality(Metric::scaled_jacobian, mesh)).min;
}

}  // namespace hextwist::test
