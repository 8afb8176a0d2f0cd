// Which hexes of others lie around a part: its halo.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "hextwist/parts/local_mesh.h"

namespace hextwist {

/// A node of a part that other parts have too.
struct NodeAtOthers {
  Index node;
  std::vector<int> parts;  ///< the others, ascending
};

/// Ids of the nodes on the skin of a part, ascending: only these can be another part's too.
std::vector<std::int64_t> skin_nodes(const Mesh& part);

/// Looks for the hexes of one part that lie in the halos of others, ring by ring; all parts do so side by side. Where a
/// ring comes to a node that a third part has too, that part is told and goes on from there.
class HaloSearch {
 public:
  /// shared: ascending by node.
  HaloSearch(const Mesh& part, int number, int n_parts, std::vector<NodeAtOthers> shared);

  /// "The halo of part `of` has come to this node."
  struct Reached {
    std::int64_t of = 0, node = 0;  ///< node: id
  };
  /// One ring more around each other part. told: by others after the ring before. Returns what to tell each part.
  std::vector<std::vector<Reached>> next_ring(std::span<const Reached> told);
  /// Whether there may be a ring more; told or not.
  bool goes_on() const {
    return std::ranges::any_of(around_, [](const Around& around) { return !around.front.empty(); });
  }
  /// The hexes that lie in the rings of another part so far, ascending.
  std::vector<Index> hexes_around(int other) const;

 private:
  struct Around {
    std::vector<std::uint8_t> has_node, has_hex;  // empty: nothing yet
    std::vector<Index> front;
  };
  void reach(int other, Index node);
  const Mesh& part_;
  int number_;
  std::vector<NodeAtOthers> shared_;
  std::vector<Index> first_hex_, hex_at_;  // per node its hexes
  std::vector<Around> around_;             // per part
};

/// What others have sent.
struct HaloPiece {
  MeshedModel meshed;
  int owner = 0;
};

/// A part and what lies around it, in the order of the whole. own and the pieces have their ids. Of the pieces only
/// what lies in these rings is taken. n_hexes: of the whole mesh. name: what messages call a part.
LocalMesh local_mesh(const MeshedModel& own, int number, std::span<const HaloPiece> pieces, int n_rings,
                     std::int64_t n_hexes, const std::function<std::string(int)>& name);

}  // namespace hextwist
