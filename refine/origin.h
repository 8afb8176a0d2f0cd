// The old nodes that a new node lies between, with weights.
#pragma once

#include <array>
#include <span>

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

template <typename Body>
void for_each_node(const Lineage& lineage, const CutFace& face, const Body& body) {
  Index node = face.first_node;
  for (const auto& [u, v] : lineage.table->face[face.code].at) {
    const auto& c = face.corners;
    body(node++, Origin{4, {c[0], c[1], c[2], c[3]}, {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}});
  }
}

template <typename Body>
void for_each_node(const Lineage& lineage, const CutHex& hex, std::span<const Hex> old_hexes, const Body& body) {
  Index node = hex.first_node;
  for (const Vec3& at : lineage.table->hex(hex.code).inside) {
    Origin origin{8, old_hexes[hex.hex], {}};
    for (int c = 0; c < 8; ++c) {
      origin.weight[c] = 1;
      for (int axis = 0; axis < 3; ++axis) origin.weight[c] *= c >> axis & 1 ? at[axis] : 1 - at[axis];
    }
    body(node++, origin);
  }
}

}  // namespace hextwist
