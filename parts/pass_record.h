// What passes over a part of a mesh made, for numbering it as passes over the whole would have.
//
// A part is refined with hexes of others around it (its halo), by the same passes as any mesh. Nodes and hexes of the
// part are in the order of the whole, so what is new comes in the order of the whole as well (docs/design.md, "In a
// patch"). Its place there is the number of all that is new before it, anywhere: sums of counts over old nodes and
// hexes. A node of any but the outermost ring has all its edges and faces here, as it has all hexes around it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/refine/lineage.h"
#include "hextwist/sizing/techniques/technique.h"

namespace hextwist {

/// Of one old node or hex: what it brings.
struct BroughtBy {
  Index old;               ///< index in the mesh before the pass
  Index first = 0, n = 0;  ///< new nodes: local numbers first .. first + n - 1
  Index first_child = 0, n_children = 0;
  Index ring = 0;  ///< the lowest of the hexes that have it
};

struct PassRecord {
  Turn turn;
  Index n_old_nodes = 0, n_old_hexes = 0, n_nodes = 0, n_hexes = 0;
  std::vector<BroughtBy> edges;  ///< per node: nodes on edges of which it is the lower end
  std::vector<BroughtBy> faces;  ///< per node: nodes in faces of which it is the lowest
  std::vector<BroughtBy> hexes;  ///< per hex that is cut
  /// Hexes that are not cut: before and after the pass.
  std::vector<std::array<Index, 2>> kept;
};
/// Leaves only what nodes and hexes of these rings bring.
void keep_rings(PassRecord& record, int n_rings);

/// Follows the passes over a mesh whose hexes lie in rings around a part.
class PassRecorder {
 public:
  explicit PassRecorder(std::vector<std::uint8_t> ring) : ring_(std::move(ring)), history_(ring_.size(), 0) {}
  /// hexes: those before the pass. filled: as in Cut.
  void record(const Turn& turn, const Lineage& lineage, std::span<const Hex> hexes_before,
              std::span<const std::uint8_t> filled);
  std::vector<PassRecord> records;
  /// Per hex of the mesh now.
  const std::vector<std::uint8_t>& ring() const { return ring_; }
  /// Per hex of the mesh now: which passes have cut what it comes of, how, and which piece it is. Two parts that made
  /// the same hex in another way have other numbers.
  const std::vector<std::uint64_t>& history() const { return history_; }

 private:
  std::vector<std::uint8_t> ring_;
  std::vector<std::uint64_t> history_;
};

/// Adds to a number that stands for all that was added.
constexpr void mix(std::uint64_t& digest, std::uint64_t word) {
  digest = (digest ^ word) * 0x9E3779B97F4A7C15ULL;
  digest ^= digest >> 29;
}

}  // namespace hextwist
