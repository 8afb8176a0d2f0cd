// The check at the end of a refinement: is this mesh in order? Faces are examined for one range of nodes at a time and
// then dropped; only those with nothing behind are kept.
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>

#include "hextwist/base/parallel.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/loose_topology.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/mesh/validate/validate.h"
#include "hextwist/mesh/validate/validate_parts.h"

namespace hextwist {
namespace {

/// f(i) for i in 0..n until one is false.
template <class F>
bool all_hold(Index n, const F& holds) {
  std::atomic<bool> all = true;
  parallel_ranges(n, [&](Index begin, Index end) {
    for (Index i = begin; i < end && all.load(std::memory_order_relaxed); ++i)
      if (!holds(i)) all = false;
  });
  return all;
}

bool is_on_eight_nodes(const Mesh& mesh, const Hex& hex) {
  for (int i = 0; i < 8; ++i) {
    if (hex[i] < 0 || hex[i] >= mesh.n_nodes()) return false;
    for (int j = 0; j < i; ++j)
      if (hex[i] == hex[j]) return false;
  }
  return true;
}

/// The faces of one node: at most two hexes each, on different sides; no four nodes joined in two orders. (Two hexes on
/// the same eight nodes fail here: on the same side of their faces, in another order, or one of them is inverted.)
bool faces_are_sound(const Mesh& mesh, std::span<const FaceUse> uses, std::vector<Side>& skin) {
  for (std::size_t begin = 0, end; begin < uses.size(); begin = end) {
    for (end = begin + 1; end < uses.size() && uses[end].key() == uses[begin].key();) ++end;
    const Side a = uses[begin].side();
    if (end - begin == 1) skin.push_back(a);
    if (end - begin > 2) return false;
    if (end - begin == 2) {
      const Side b = uses[begin + 1].side();
      if (turn_alike(mesh.hexes[a.hex], a.face, mesh.hexes[b.hex], b.face)) return false;
    }
    for (std::size_t i = 0; i < begin; ++i) {
      std::array<Index, 3> one = {uses[i].diagonal, uses[i].low, uses[i].high},
                           other = {uses[begin].diagonal, uses[begin].low, uses[begin].high};
      if (std::int64_t{one[0]} + one[1] + one[2] != std::int64_t{other[0]} + other[1] + other[2]) continue;
      std::ranges::sort(one);
      std::ranges::sort(other);
      if (one == other && uses[i].key() != uses[begin].key()) return false;
    }
  }
  return true;
}

/// The faces whose lowest node is in begin .. end - 1; sides with nothing behind go to skin.
bool faces_are_sound(const Mesh& mesh, Index begin, Index end, std::vector<Side>& skin) {
  const CompressedRows corners = node_corners(mesh.hexes, begin, end);
  constexpr Index size = 4096;
  std::vector<std::vector<Side>> of_chunk(n_chunks(end - begin, size));
  std::atomic<bool> sound = true;
  parallel_chunks(end - begin, size, [&](Index chunk, Index from, Index to) {
    std::vector<FaceUse> uses;
    for (Index i = from; i < to && sound.load(std::memory_order_relaxed); ++i) {
      collect_faces(mesh.hexes, begin + i, corners[i], uses);
      if (!faces_are_sound(mesh, uses, of_chunk[chunk])) sound = false;
    }
  });
  for (const auto& list : of_chunk) skin.insert(skin.end(), list.begin(), list.end());
  return sound;
}

/// How many nodes are looked at together: a few hundred megabytes of lists.
constexpr Index nodes_at_once = 8 << 20;

}  // namespace

bool is_sound_without_skin(const Mesh& mesh, std::vector<Side>& skin, bool known_valid) {
  skin.clear();
  if (!all_hold(mesh.n_nodes(), [&](Index n) { return mesh.points[n].allFinite(); })) return false;
  if (!all_hold(mesh.n_hexes(), [&](Index h) { return is_on_eight_nodes(mesh, mesh.hexes[h]); })) return false;
  check_nodes(mesh);  // for their number
  if (!known_valid && !all_valid(mesh)) return false;
  for (std::int64_t begin = 0; begin < mesh.n_nodes(); begin += nodes_at_once) {
    const auto end = static_cast<Index>(std::min<std::int64_t>(begin + nodes_at_once, mesh.n_nodes()));
    if (!faces_are_sound(mesh, static_cast<Index>(begin), end, skin)) return false;
  }
  tbb::parallel_sort(skin.begin(), skin.end());
  return true;
}

bool has_only_warnings(const Mesh& mesh, bool known_valid) {
  std::vector<Side> skin;
  return is_sound_without_skin(mesh, skin, known_valid) && !has_joined_nodes(mesh, skin);
}

}  // namespace hextwist
