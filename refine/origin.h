// The old nodes that a new node lies between, with weights.
#pragma once

#include <array>
#include <span>

#include "hextwist/refine/fitted.h"
#include "hextwist/refine/lineage.h"
#include "hextwist/refine/templates/split_table.h"

namespace hextwist {

/// Nodes of the cut edge (n = 2), face (4) or hex (8); weights of the linear, bilinear or trilinear map, sum 1.
struct Origin {
  int n = 0;
  std::array<Index, 8> node{};
  std::array<double, 8> weight{};
  std::span<const Index> nodes() const { return {node.data(), static_cast<std::size_t>(n)}; }
};

template <typename Body>
void for_each_node(const Lineage& lineage, const CutEdge& edge, const Body& body) {
  Index node = edge.first_node;
  for (const double t : lineage.table->edge[edge.code].at) body(node++, Origin{2, {edge.a, edge.b}, {1 - t, t}});
}

/// points: of the old mesh, for nodes that are fitted to the face; none: where the template has them.
template <typename Body>
void for_each_node(const Lineage& lineage, const CutFace& face, const Body& body, std::span<const Vec3> points = {}) {
  Index node = face.first_node;
  std::array<Vec3, 4> corner;
  FacePlaces room;
  std::span<const std::array<double, 2>> places = lineage.table->face[face.code].at;
  if (!points.empty()) {
    for (int k = 0; k < 4; ++k) corner[k] = points[face.corners[k]];
    places = fitted_places(*lineage.table, face.code, corner, room);
  }
  for (const auto& [u, v] : places) {
    const auto& c = face.corners;
    body(node++, Origin{4, {c[0], c[1], c[2], c[3]}, {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}});
  }
}

template <typename Body>
void for_each_node(const Lineage& lineage, const CutHex& hex, std::span<const Hex> old_hexes, const Body& body,
                   std::span<const Vec3> points = {}) {
  Index node = hex.first_node;
  const HexTemplate& of = lineage.table->hex(hex.code);
  if (of.inside.empty()) return;
  const FittedHex fitted(*lineage.table, of, old_hexes[hex.hex], points);
  for (std::size_t s = 0; s < of.inside.size(); ++s) {
    const Vec3 at = fitted[s];
    Origin origin{8, old_hexes[hex.hex], {}};
    for (int c = 0; c < 8; ++c) {
      origin.weight[c] = 1;
      for (int axis = 0; axis < 3; ++axis) origin.weight[c] *= c >> axis & 1 ? at[axis] : 1 - at[axis];
    }
    body(node++, origin);
  }
}

}  // namespace hextwist
