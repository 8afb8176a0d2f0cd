#include "hextwist/sizing/techniques/long_directions_internal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hextwist/base/parallel.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/topology.h"
#include "hextwist/sizing/size_report.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

/// Where cuts end, a hex is cut on one side and not on the other. In one that is thinner than this times as long as the
/// cut edges, the pieces would have sharp corners (a tenth: 0.15), so the cuts go on to the next.
constexpr double thinnest_end = 0.4;

/// Cuts in three until a length is no more than sqrt(3) times the wish.
int n_cuts(double length, double wished) {
  int n = 0;
  for (; length > std::numbers::sqrt3 * wished * (1 + 1e-9); length /= 3) ++n;
  return n;
}

/// One direction of one hex, and whether the cuts go on for the sake of later ones: into the next hexes beside it,
/// where later cuts end, and before and behind it, where whole hexes are cut later.
struct Direction {
  Index hex;
  int axis;
  bool beside = false, behind = false;
};

class EdgesToCut {
 public:
  explicit EdgesToCut(const Mesh& mesh)
      : mesh_(mesh), edges_(edges(mesh)), faces_(faces(mesh)), wanted_(mesh.hexes.size(), 0) {}

  void want(const Direction& direction) {
    // A direction that is reached again with more to do is looked at again.
    const int bits = (1 | direction.beside << 3 | direction.behind << 6) << direction.axis;
    if ((wanted_[direction.hex] & bits) == bits) return;
    wanted_[direction.hex] |= static_cast<std::uint16_t>(bits);
    open_.push_back(direction);
  }
  void spread() {
    while (!open_.empty()) {
      const Direction from = open_.back();
      open_.pop_back();
      for (int f = 0; f < n_hex_faces; ++f) {
        const Index shared = faces_.of_hex[from.hex][f];
        const auto& sides = faces_.sides[shared];
        const Side next = sides[0].hex == from.hex && sides[0].face == f ? sides[1] : sides[0];
        if (next.hex < 0) continue;
        if (f >> 1 != from.axis)
          go_beside(from, f, next);
        else if (from.behind)
          want({next.hex, next.face >> 1});
      }
    }
  }
  std::vector<std::uint16_t> masks() const {
    std::vector<std::uint8_t> cut(edges_.nodes.size(), 0);
    for (Index h = 0; h < mesh_.n_hexes(); ++h)
      for (int e = 0; e < n_hex_edges; ++e)
        if (wanted_[h] >> (e >> 2) & 1) cut[edges_.of_hex[h][e]] = 1;
    std::vector<std::uint16_t> result(mesh_.hexes.size());
    parallel_each(result.size(), [&](std::size_t h) {
      int mask = 0;
      for (int e = 0; e < n_hex_edges; ++e) mask |= cut[edges_.of_hex[h][e]] << e;
      result[h] = static_cast<std::uint16_t>(mask);
    });
    return result;
  }

 private:
  /// Behind a face along the direction.
  void go_beside(const Direction& from, int face, const Side& next) {
    Index along = -1;
    for (int j = 0; j < 4; ++j)
      if (const int e = face_edge(face, j); e >> 2 == from.axis) along = edges_.of_hex[from.hex][e];
    for (int j = 0; j < 4; ++j) {
      const int e = face_edge(next.face, j);
      if (edges_.of_hex[next.hex][e] != along) continue;
      const std::array<double, 3> length = lengths(mesh_, next.hex);
      const bool is_too_thin = length[next.face >> 1] < thinnest_end * length[e >> 2];
      if (from.beside || is_too_thin) want({next.hex, e >> 2, from.beside && is_too_thin});
      return;
    }
  }

  const Mesh& mesh_;
  const Edges edges_;
  const Faces faces_;
  std::vector<std::uint16_t> wanted_;  // bits 0 to 2: axes; 3 to 5: those that go on beside; 6 to 8: behind
  std::vector<Direction> open_;
};

/// So many cuts each direction of each hex of the zone needs; hexes that need none may be left out.
struct Needs {
  std::vector<Index> hexes;
  std::vector<std::array<int, 3>> n;  ///< per hex
};

Needs needs(const Mesh& mesh, std::span<const std::uint8_t> in_zone, const SizeField& wish) {
  // No edge is longer than the box around its hex from corner to corner: most hexes need nothing, said at once.
  Needs result{indices_where(mesh.n_hexes(),
                             [&](Index h) {
                               if (!in_zone[h]) return false;
                               return box(mesh, h).diagonal() > std::numbers::sqrt3 * wish.least_at(centroid(mesh, h));
                             }),
               {}};
  const std::vector<double> wished = wished_sizes(mesh, result.hexes, wish);
  result.n.resize(result.hexes.size());
  parallel_each(result.n.size(), [&](std::size_t i) {
    if (!std::isfinite(wished[i])) return;
    const std::array<double, 3> length = lengths(mesh, result.hexes[i]);
    for (int axis = 0; axis < 3; ++axis) result.n[i][axis] = n_cuts(length[axis], wished[i]);
  });
  return result;
}

}  // namespace

UnevenHexes uneven_hexes(const Mesh& mesh, std::span<const std::uint8_t> in_zone, const SizeField& wish, int by) {
  UnevenHexes count;
  for (const auto& n : needs(mesh, in_zone, wish).n) {
    count.n_cut += std::ranges::max(n) > 0;
    count.n_uneven += std::ranges::max(n) - std::ranges::min(n) >= by;
  }
  return count;
}

bool are_uneven(const Mesh& mesh, std::span<const std::uint8_t> in_zone, const SizeField& wish, int by) {
  return static_cast<bool>(uneven_hexes(mesh, in_zone, wish, by));
}

Index count_uneven(const Mesh& mesh, std::span<const std::uint8_t> in_zone, const SizeField& wish) {
  const Needs zone = needs(mesh, in_zone, wish);
  return static_cast<Index>(
      std::ranges::count_if(zone.n, [](const auto& n) { return std::ranges::max(n) > std::ranges::min(n); }));
}

std::vector<std::uint16_t> cuts_of_long_directions(const Mesh& mesh, std::span<const std::uint8_t> in_zone,
                                                   const SizeField& wish) {
  const Needs zone = needs(mesh, in_zone, wish);
  std::vector<Direction> wanted;
  for (std::size_t i = 0; i < zone.hexes.size(); ++i) {
    const auto& n = zone.n[i];
    const int least = std::ranges::min(n), most = std::ranges::max(n);
    for (int axis = 0; axis < 3; ++axis)
      if (n[axis] == most && most > least) wanted.push_back({zone.hexes[i], axis, most > 1, least > 0});
  }
  if (wanted.empty()) return {};
  EdgesToCut cuts(mesh);
  for (const Direction& direction : wanted) cuts.want(direction);
  cuts.spread();
  return cuts.masks();
}

}  // namespace hextwist
