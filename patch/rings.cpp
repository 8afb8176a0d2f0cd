// Which hexes a patch has.
#include <cmath>
#include <numeric>

#include "hextwist/base/parallel.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/patch/patch.h"

namespace hextwist {
namespace {

/// Places within `reach` of some points, and a little more: cells of a grid.
class Neighbourhood {
 public:
  Neighbourhood(const Mesh& mesh, std::span<const Index> nodes, double reach) {
    Box seeds;
    for (const Index n : nodes) seeds.add(mesh.points[n]);
    const Vec3 extent = seeds.max - seeds.min;
    size_ = std::max(reach, extent.maxCoeff() / max_cells);
    per_size_ = 1 / size_;
    origin_ = seeds.min - Vec3::Constant(size_);
    for (int axis = 0; axis < 3; ++axis) n_[axis] = static_cast<int>(extent[axis] / size_) + 3;
    near_.assign(static_cast<std::size_t>(n_[0]) * n_[1] * n_[2], 0);
    for (const Index n : nodes) {
      std::array<int, 3> at{};
      for (int axis = 0; axis < 3; ++axis)
        at[axis] = static_cast<int>((mesh.points[n][axis] - origin_[axis]) * per_size_);
      for (int z = at[2] - 1; z <= at[2] + 1; ++z)
        for (int y = at[1] - 1; y <= at[1] + 1; ++y)
          for (int x = at[0] - 1; x <= at[0] + 1; ++x)
            if (x >= 0 && y >= 0 && z >= 0 && x < n_[0] && y < n_[1] && z < n_[2]) near_[cell(x, y, z)] = 1;
    }
  }
  bool has(const Vec3& p) const {
    const Vec3 at = (p - origin_) * per_size_;
    if (!(at.x() >= 0 && at.y() >= 0 && at.z() >= 0 && at.x() < n_[0] && at.y() < n_[1] && at.z() < n_[2]))
      return false;
    return near_[cell(static_cast<int>(at.x()), static_cast<int>(at.y()), static_cast<int>(at.z()))] != 0;
  }

 private:
  static constexpr double max_cells = 100;  // along the longest side
  std::size_t cell(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(n_[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(n_[0]) +
           static_cast<std::size_t>(x);
  }
  Vec3 origin_ = Vec3::Zero();
  double size_ = 1, per_size_ = 1;
  std::array<int, 3> n_{};
  std::vector<std::uint8_t> near_;
};

double longest_edge(const Mesh& mesh, std::span<const Index> hexes) {
  double squared = 0;
  for (const Index h : hexes)
    for (int e = 0; e < n_hex_edges; ++e)
      squared = std::max(squared,
                         (mesh.points[mesh.hexes[h][edge_corner(e, 0)]] - mesh.points[mesh.hexes[h][edge_corner(e, 1)]])
                             .squaredNorm());
  return std::sqrt(squared);
}

}  // namespace

std::optional<Rings> rings_around(const Mesh& mesh, std::span<const Index> nodes, int n_rings, std::size_t limit,
                                  const HexesAt& hexes_at) {
  std::vector<bool> reached(mesh.points.size()), taken(mesh.hexes.size());
  std::vector<Index> front(nodes.begin(), nodes.end()), found;
  for (const Index n : front) reached[n] = true;
  std::vector<std::pair<Index, std::uint8_t>> hexes;
  for (int ring = 1; ring <= n_rings && !front.empty(); ++ring) {
    found.clear();
    if (!hexes_at(front, found)) return std::nullopt;
    front.clear();
    for (const Index h : found) {
      if (taken[h]) continue;
      taken[h] = true;
      hexes.emplace_back(h, static_cast<std::uint8_t>(ring));
      for (const Index n : mesh.hexes[h])
        if (!reached[n]) {
          reached[n] = true;
          front.push_back(n);
        }
    }
    if (hexes.size() > limit) return std::nullopt;
  }
  std::ranges::sort(hexes);
  Rings rings;
  for (const auto& [hex, ring] : hexes) {
    rings.hexes.push_back(hex);
    rings.ring.push_back(ring);
  }
  rings.n_rings = n_rings;
  rings.is_all = front.empty();
  return rings;
}

std::optional<Rings> rings_by_place(const Mesh& mesh, std::span<const Index> nodes, std::span<const Index> at,
                                    int n_rings, std::size_t limit) {
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  std::vector<Index> first(at.begin(), at.end());
  if (first.empty()) {
    for (const Index n : nodes) marked[n] = 1;
    first = touching_hexes(mesh.hexes, marked);
  }
  double reach = n_rings * longest_edge(mesh, first);
  constexpr int max_tries = 5;  // hexes may be larger outwards
  for (int i = 0; i < max_tries && reach > 0; ++i, reach *= 3) {
    const Neighbourhood near(mesh, nodes, reach);
    parallel_each(
        mesh.points.size(), [&](std::size_t n) { marked[n] = near.has(mesh.points[n]); }, 1 << 14);
    std::vector<Index> candidates = touching_hexes(mesh.hexes, marked);
    // All that is known is which hexes the marked nodes have.
    std::vector<std::uint8_t> front(mesh.points.size(), 0);
    bool knows_all = true;
    auto rings =
        rings_around(mesh, nodes, n_rings, limit, [&](std::span<const Index> asked, std::vector<Index>& hexes) {
          knows_all = std::ranges::all_of(asked, [&](Index n) { return marked[n] != 0; });
          for (const Index n : asked) front[n] = 1;
          std::erase_if(candidates, [&](Index h) {
            const bool touches = has_marked_corner(mesh.hexes[h], front);
            if (touches) hexes.push_back(h);
            return touches;
          });
          return knows_all;
        });
    if (rings || knows_all) return rings;
  }
  return std::nullopt;
}

}  // namespace hextwist
