#include <algorithm>
#include <cmath>

#include "hextwist/base/union_find.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/loose_topology.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/validate/validate.h"
#include "hextwist/mesh/validate/validate_parts.h"

namespace hextwist {
namespace {

/// Faces with two hexes: f(hex, hex, whether they turn alike).
template <class F>
void for_pairs(const Mesh& mesh, const LooseFaces& loose, F f) {
  std::size_t next = 0;
  for (Index face = 0; face < std::ssize(loose.faces.sides); ++face) {
    const auto& [a, b] = loose.faces.sides[face];
    while (next < loose.more.size() && loose.more[next].first < face) ++next;
    const bool crowded = next < loose.more.size() && loose.more[next].first == face;
    if (b.hex >= 0 && !crowded) f(a.hex, b.hex, turn_alike(mesh.hexes[a.hex], a.face, mesh.hexes[b.hex], b.face));
  }
}

/// Per hex 1 where it differs from the orientation of its part.
std::vector<char> against_their_part(const Mesh& mesh, const LooseFaces& loose, const std::vector<double>& volumes) {
  struct Neighbour {
    Index hex;
    bool alike;
  };
  std::vector<Index> first(mesh.hexes.size() + 1, 0);
  for_pairs(mesh, loose, [&](Index a, Index b, bool) {
    ++first[a + 1];
    ++first[b + 1];
  });
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  std::vector<Neighbour> neighbours(first.back());
  std::vector<Index> next(first.begin(), first.end() - 1);
  for_pairs(mesh, loose, [&](Index a, Index b, bool alike) {
    neighbours[next[a]++] = {b, alike};
    neighbours[next[b]++] = {a, alike};
  });

  constexpr char unseen = 2;
  std::vector<char> against(mesh.hexes.size(), unseen);
  std::vector<Index> part;
  for (Index start = 0; start < mesh.n_hexes(); ++start) {
    if (against[start] != unseen) continue;
    against[start] = 0;
    part.assign(1, start);
    double total = 0;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Index h = part[i];
      if (std::isfinite(volumes[h])) total += against[h] ? -volumes[h] : volumes[h];
      for (Index n = first[h]; n < first[h + 1]; ++n) {
        const auto& [other, alike] = neighbours[n];
        if (against[other] != unseen) continue;
        against[other] = static_cast<char>(alike ? !against[h] : against[h]);
        part.push_back(other);
      }
    }
    if (total < 0)
      for (const Index h : part) against[h] = static_cast<char>(!against[h]);
  }
  return against;
}

/// Hexes to turn: those against their part, by patches of negative volume.
std::vector<Index> mirrored_hexes(const Mesh& mesh, const std::vector<double>& volumes) {
  const LooseFaces loose = loose_faces(mesh);
  const std::vector<char> against = against_their_part(mesh, loose, volumes);
  std::vector<Index> patch = singletons(mesh.n_hexes());
  for_pairs(mesh, loose, [&](Index a, Index b, bool alike) {
    if (!alike && against[a] && against[b]) join(patch, a, b);
  });
  std::vector<double> total(mesh.hexes.size(), 0);
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (against[h] && std::isfinite(volumes[h])) total[find_root(patch, h)] += volumes[h];
  return indices_where(mesh.n_hexes(), [&](Index h) { return against[h] && total[find_root(patch, h)] < 0; });
}

}  // namespace

bool turn_alike(const Hex& a, int f, const Hex& b, int g) {
  const auto cycle = face_node_cycle(a, f), other = face_node_cycle(b, g);
  const auto at = std::ranges::find(other, cycle[0]) - other.begin();
  return at < 4 && other[(at + 1) & 3] == cycle[1];
}

OrientationRepair repair_orientation(Mesh& mesh) {
  OrientationRepair repair;
  check_nodes(mesh);
  const std::vector<double> jacobians = min_corner_jacobian(mesh);
  if (std::ranges::all_of(jacobians, [](double j) { return !(j < 0); })) return repair;
  std::vector<double> volumes(mesh.hexes.size());
  parallel_ranges(mesh.n_hexes(), [&](Index begin, Index end) {
    for (Index h = begin; h < end; ++h) volumes[h] = volume(mesh, h);
  });
  if (std::ranges::all_of(volumes, [](double v) { return !(v < 0); })) return repair;

  repair.flipped = mirrored_hexes(mesh, volumes);
  for (const Index h : repair.flipped)
    for (int c = 0; c < 4; ++c) std::swap(mesh.hexes[h][c], mesh.hexes[h][c + 4]);
  if (repair.flipped.empty()) return repair;
  for (SideSet& set : mesh.side_sets) {
    for (Side& side : set.sides) side = side_after(repair, side);
    std::ranges::sort(set.sides);
  }
  const std::size_t n = repair.flipped.size();
  if (n == mesh.hexes.size())
    repair.notice =
        n == 1 ? "the hex was inside out: turned" : "all " + std::to_string(n) + " hexes were inside out: turned";
  else if (n == 1)
    repair.notice = "hex " + std::to_string(hex_id(mesh, repair.flipped[0])) + " was inside out: turned";
  else
    repair.notice = std::to_string(n) + " hexes were inside out: turned (the first is hex " +
                    std::to_string(hex_id(mesh, repair.flipped[0])) + ")";
  return repair;
}

Side side_after(const OrientationRepair& repair, Side side) {
  if (side.face >= 4 && std::ranges::binary_search(repair.flipped, side.hex)) side.face ^= 1;
  return side;
}

}  // namespace hextwist
