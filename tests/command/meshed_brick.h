// A grid of unit cubes on its analytic brick with a complete association: no file and no CAD kernel needed.
#pragma once

#include <algorithm>

#include "hextwist/mesh/corners.h"
#include "hextwist/patch/refine.h"
#include "support/analytic_model.h"
#include "support/grids.h"

namespace hextwist::test {

inline MeshedModel meshed_brick(int a, int b, int c) {
  MeshedModel result{grid(a, b, c), analytic_brick(a, b, c), {}};
  const std::array<int, 3> n = {a, b, c};
  // The entity that a set of nodes shares: per axis fixed at one end, or free.
  const auto owner_of = [&](std::span<const Index> nodes) {
    int n_fixed = 0, bits = 0, fixed = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side)
        if (std::ranges::all_of(nodes, [&](Index i) { return result.mesh.points[i][axis] == side * n[axis]; })) {
          ++n_fixed;
          bits |= side << axis;
          fixed |= 1 << axis;
        }
    if (n_fixed == 3) return Owner{0, 1 + bits};
    if (n_fixed == 2) {
      const int axis = fixed == 6 ? 0 : fixed == 5 ? 1 : 2;
      return Owner{1, 1 + 4 * axis + gather_bits(axis, bits)};
    }
    if (n_fixed == 1) {
      const int axis = fixed == 1 ? 0 : fixed == 2 ? 1 : 2;
      return Owner{2, 1 + 2 * axis + (bits >> axis & 1)};
    }
    return Owner{3, 1};
  };
  Association& to = result.association;
  for (Index i = 0; i < result.mesh.n_nodes(); ++i) {
    to.node_owner.push_back(owner_of({&i, 1}));
    const Owner owner = to.node_owner.back();
    to.node_parameters.push_back(owner.dim == 1 || owner.dim == 2
                                     ? result.model->project(owner, result.mesh.points[i]).parameters
                                     : Parameters{});
  }
  for (const Edge& edge : edges(result.mesh).nodes)
    if (const Owner owner = owner_of(edge); owner.dim == 1) {
      to.curve_edges.push_back(edge);
      to.edge_curve.push_back(owner.id);
    }
  for (const Side side : boundary_sides(faces(result.mesh))) {
    to.surface_faces.push_back(side);
    to.face_surface.push_back(owner_of(face_nodes(result.mesh.hexes[side.hex], side.face)).id);
  }
  to.hex_volume.assign(result.mesh.hexes.size(), 1);
  return result;
}

}  // namespace hextwist::test
