// Two meshes on their models that are the same to the bit.
#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "hextwist/patch/refine.h"

namespace hextwist::test {

/// Names the first array that differs. NaN equals NaN.
inline testing::AssertionResult same_bits(const MeshedModel& a, const MeshedModel& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() &&
           (x.empty() || std::memcmp(static_cast<const void*>(x.data()), static_cast<const void*>(y.data()),
                                     x.size() * sizeof x[0]) == 0);
  };
  const auto differ = [](const char* what) { return testing::AssertionFailure() << what << " differ"; };
  if (!same(a.mesh.points, b.mesh.points)) return differ("points");
  if (a.mesh.hexes != b.mesh.hexes) return differ("hexes");
  if (a.mesh.node_ids != b.mesh.node_ids) return differ("node ids");
  if (a.mesh.hex_ids != b.mesh.hex_ids) return differ("hex ids");
  if (a.mesh.blocks != b.mesh.blocks) return differ("blocks");
  if (a.mesh.node_sets != b.mesh.node_sets) return differ("node sets");
  if (a.mesh.side_sets != b.mesh.side_sets) return differ("side sets");
  if (a.mesh.fields.size() != b.mesh.fields.size()) return differ("numbers of fields");
  for (std::size_t i = 0; i < a.mesh.fields.size(); ++i)
    if (a.mesh.fields[i].name != b.mesh.fields[i].name || !same(a.mesh.fields[i].values, b.mesh.fields[i].values))
      return differ("fields");
  if (a.association.node_owner != b.association.node_owner) return differ("owners");
  if (!same(a.association.node_parameters, b.association.node_parameters)) return differ("parameters");
  if (a.association.curve_edges != b.association.curve_edges) return differ("curve edges");
  if (a.association.edge_curve != b.association.edge_curve) return differ("curves of edges");
  if (a.association.surface_faces != b.association.surface_faces) return differ("surface faces");
  if (a.association.face_surface != b.association.face_surface) return differ("surfaces of faces");
  if (a.association.hex_volume != b.association.hex_volume) return differ("volumes of hexes");
  if (a.model != b.model) return differ("models");
  return testing::AssertionSuccess();
}

}  // namespace hextwist::test
