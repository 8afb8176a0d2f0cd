// Coincident nodes made one, so that hexes that only touch share faces.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace hextwist {

struct MergeResult {
  Mesh mesh;
  std::vector<Index> node_now;       ///< per node before: what it is now
  Index n_gone = 0;                  ///< nodes that became others
  Index n_faces = 0;                 ///< pairs of faces that became one
  std::vector<std::string> notices;  ///< fields that had several values at a place
};

/// Of nodes that chains of steps no longer than the tolerance (model units) connect, the one with the lowest id stays,
/// where it is, with its values. Hexes, blocks, sets, fields and other elements go on with it. wanted: per node, may it
/// be merged (with others that may)? Empty: all may.
/// Throws Error, naming ids, where nodes of one hex or other element would become one, or a face would have three
/// hexes, or two hexes the same nodes.
MergeResult merge_nodes(const Mesh& mesh, double tolerance, std::span<const std::uint8_t> wanted = {});

}  // namespace hextwist
