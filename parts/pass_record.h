// What passes over a part of a mesh made, for numbering it as passes over the whole would have.
//
// A part is refined with hexes of others around it (its halo), by the same passes as any mesh. Nodes and hexes of the
// part are in the order of the whole, so what is new comes in the order of the whole as well (docs/design.md, "In a
// patch"). Its place there is the number of all that is new before it, anywhere: sums of counts over old nodes and
// hexes. Each old node of the part's own hexes has all its edges and faces here, as it has all hexes around it.
#pragma once

#include <cstdint>
#include <vector>

#include "hextwist/refine/lineage.h"

namespace hextwist {

/// Of one old node or hex: what it brings.
struct BroughtBy {
  Index old;               ///< index in the mesh before the pass
  Index first = 0, n = 0;  ///< new nodes: local numbers first .. first + n - 1
  Index first_child = 0, n_children = 0;
};

struct PassRecord {
  enum class Kind { enclose, trisect, other } kind = Kind::other;
  Index n_old_nodes = 0, n_old_hexes = 0, n_nodes = 0, n_hexes = 0;
  std::vector<BroughtBy> edges;  ///< per node of own hexes: nodes on edges of which it is the lower end
  std::vector<BroughtBy> faces;  ///< per node of own hexes: nodes in faces of which it is the lowest
  std::vector<BroughtBy> hexes;  ///< per own hex that is cut
  /// Own hexes that are not cut: before and after the pass.
  std::vector<std::array<Index, 2>> kept;
};

/// Follows the passes over a mesh of which some hexes are a part's own.
class PassRecorder {
 public:
  explicit PassRecorder(std::vector<std::uint8_t> is_own) : is_own_(std::move(is_own)) {}
  /// hexes: those before the pass.
  void record(const Lineage& lineage, std::span<const Hex> hexes_before);
  std::vector<PassRecord> records;
  /// Per hex of the mesh now.
  const std::vector<std::uint8_t>& is_own() const { return is_own_; }

 private:
  std::vector<std::uint8_t> is_own_;
};

}  // namespace hextwist
