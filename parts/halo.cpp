#include "hextwist/parts/halo.h"

#include <algorithm>
#include <numeric>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/topology.h"
#include "hextwist/parts/join.h"
#include "hextwist/patch/patch.h"

namespace hextwist {

std::vector<std::int64_t> skin_nodes(const Mesh& part) {
  std::vector<std::uint8_t> is_there(part.points.size(), 0);
  for (const Side& side : boundary_sides(faces(part)))
    for (const Index n : face_nodes(part.hexes[side.hex], side.face)) is_there[n] = 1;
  std::vector<std::int64_t> ids;
  for (Index n = 0; n < part.n_nodes(); ++n)
    if (is_there[n]) ids.push_back(node_id(part, n));
  return ids;
}

HaloSearch::HaloSearch(const Mesh& part, int number, int n_parts, std::vector<NodeAtOthers> shared)
    : part_(part), number_(number), shared_(std::move(shared)), around_(static_cast<std::size_t>(n_parts)) {
  first_hex_.assign(part.points.size() + 2, 0);
  for (const Hex& hex : part.hexes)
    for (const Index n : hex) ++first_hex_[n + 2];
  std::partial_sum(first_hex_.begin(), first_hex_.end(), first_hex_.begin());
  hex_at_.resize(part.hexes.size() * 8);
  for (Index h = 0; h < part.n_hexes(); ++h)
    for (const Index n : part.hexes[h]) hex_at_[first_hex_[n + 1]++] = h;
  for (const NodeAtOthers& at : shared_)
    for (const int other : at.parts) reach(other, at.node);
}

void HaloSearch::reach(int other, Index node) {
  Around& around = around_[other];
  if (around.has_node.empty()) {
    around.has_node.resize(part_.points.size(), 0);
    around.has_hex.resize(part_.hexes.size(), 0);
  }
  if (around.has_node[node]) return;
  around.has_node[node] = 1;
  around.front.push_back(node);
}

std::vector<std::vector<HaloSearch::Reached>> HaloSearch::next_ring(std::span<const Reached> told) {
  for (const Reached& each : told) reach(static_cast<int>(each.of), find_node(part_, each.node));
  std::vector<std::vector<Reached>> to(around_.size());
  for (int other = 0; other < std::ssize(around_); ++other) {
    Around& around = around_[other];
    const std::vector<Index> front = std::move(around.front);
    around.front.clear();
    for (const Index n : front)
      for (Index i = first_hex_[n]; i < first_hex_[n + 1]; ++i) {
        if (around.has_hex[hex_at_[i]]) continue;
        around.has_hex[hex_at_[i]] = 1;
        for (const Index m : part_.hexes[hex_at_[i]]) reach(other, m);
      }
    for (const Index n : around.front) {
      const Index at = position_in(shared_, n, &NodeAtOthers::node);
      if (at < 0) continue;
      for (const int third : shared_[at].parts)
        if (third != other && third != number_) to[third].push_back({other, node_id(part_, n)});
    }
  }
  return to;
}

std::vector<Index> HaloSearch::hexes_around(int other) const {
  std::vector<Index> hexes;
  const Around& around = around_[other];
  for (std::size_t h = 0; h < around.has_hex.size(); ++h)
    if (around.has_hex[h]) hexes.push_back(static_cast<Index>(h));
  return hexes;
}

namespace {

/// Per hex the ring that it lies in around the part's own, `outside` beyond.
constexpr std::uint8_t outside = 255;
std::vector<std::uint8_t> rings_of(const Mesh& mesh, std::span<const int> owner, int number, int n_rings) {
  std::vector<std::uint8_t> ring(mesh.hexes.size(), outside), reached(mesh.points.size(), 0);
  for (std::size_t h = 0; h < ring.size(); ++h)
    if (owner[h] == number) ring[h] = 0;
  bool grows = true;
  for (int r = 0; r <= n_rings && grows; ++r) {
    grows = r == 0;
    for (std::size_t h = 0; h < ring.size() && r > 0; ++h)
      if (ring[h] == outside && std::ranges::any_of(mesh.hexes[h], [&](Index n) { return reached[n] != 0; })) {
        ring[h] = static_cast<std::uint8_t>(r);
        grows = true;
      }
    for (std::size_t h = 0; h < ring.size(); ++h)
      if (ring[h] == r)
        for (const Index n : mesh.hexes[h]) reached[n] = 1;
  }
  return ring;
}

}  // namespace

LocalMesh local_mesh(const MeshedModel& own, int number, std::span<const HaloPiece> pieces, int n_rings,
                     std::int64_t n_hexes, const std::function<std::string(int)>& name) {
  MeshedModel all;
  {
    std::vector<const MeshedModel*> to_join = {&own};
    for (const HaloPiece& piece : pieces) to_join.push_back(&piece.meshed);
    all = join(std::span<const MeshedModel* const>(to_join),
               [&](std::size_t i) { return name(i == 0 ? number : pieces[i - 1].owner); });
  }
  all.model = own.model;
  const Mesh& mesh = all.mesh;
  std::vector<int> owner(mesh.hexes.size(), number);
  for (const HaloPiece& piece : pieces)
    for (Index h = 0; h < piece.meshed.mesh.n_hexes(); ++h)
      owner[find_hex(mesh, hex_id(piece.meshed.mesh, h))] = piece.owner;
  std::vector<std::uint8_t> ring = rings_of(mesh, owner, number, n_rings);
  LocalMesh local;
  local.n_rings = n_rings;
  const auto take = [&](Index h) {
    local.base.hex.push_back(hex_id(mesh, h));
    local.base.ring.push_back(ring[h]);
    local.base.owner.push_back(owner[h]);
  };
  if (std::ranges::find(ring, outside) == ring.end()) {
    for (Index h = 0; h < mesh.n_hexes(); ++h) take(h);
    for (Index n = 0; n < mesh.n_nodes(); ++n) local.base.node.push_back(node_id(mesh, n));
    local.meshed = std::move(all);
    local.meshed.mesh.node_ids.clear();
    local.meshed.mesh.hex_ids.clear();
  } else {
    std::vector<Index> hexes;
    for (Index h = 0; h < mesh.n_hexes(); ++h)
      if (ring[h] != outside) hexes.push_back(h), take(h);
    Patch patch = take_patch(all, std::move(hexes));
    for (const Index n : patch.nodes) local.base.node.push_back(node_id(mesh, n));
    local.meshed = std::move(patch.meshed);
  }
  local.is_all = std::ssize(local.base.hex) == n_hexes;
  local.base_of.resize(local.base.hex.size());
  std::iota(local.base_of.begin(), local.base_of.end(), 0);
  return local;
}

}  // namespace hextwist
