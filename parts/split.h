// A mesh in parts: each with its own hexes and all nodes of these, under the ids of the whole.
#pragma once

#include <span>
#include <vector>

#include "hextwist/io/file_part.h"
#include "hextwist/mesh/meshed_model.h"

namespace hextwist {

/// Nodes and faces of a mesh that several parts have.
struct Borders {
  struct SharedNode {
    Index node;
    int part;
    auto operator<=>(const SharedNode&) const = default;
  };
  /// A face between hexes of two parts.
  struct SharedFace {
    std::array<Index, 4> nodes;  ///< ascending
    std::array<Side, 2> sides;   ///< the one of the lower part first
    std::array<int, 2> parts;
  };
  std::vector<SharedNode> nodes;  ///< ascending; one for each part that has the node
  std::vector<SharedFace> faces;  ///< by nodes
};
Borders borders_of(std::span<const Hex> hexes, Index n_nodes, std::span<const int> part_of_hex);

struct MeshPart {
  Mesh mesh;
  FilePart file;
};

/// Makes one part after another.
class Splitting {
 public:
  /// part_of_hex: per hex, 0 .. n_parts - 1. The mesh stays where it is meanwhile.
  Splitting(const MeshedModel& whole, std::span<const int> part_of_hex, int n_parts);
  MeshPart part(int number) const;
  /// Nodes that are corners of no hex go to no part.
  Index n_loose_nodes() const { return n_loose_; }

 private:
  const MeshedModel& whole_;
  std::vector<std::vector<Index>> hexes_;  // per part
  Borders borders_;
  FilePart of_all_;
  Index n_loose_ = 0;
};

}  // namespace hextwist
