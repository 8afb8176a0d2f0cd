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

/// The faces whose lowest node is in begin .. end - 1; sides with nothing behind go to skin.
bool faces_are_sound(const Mesh& mesh, Index begin, Index end, std::vector<Side>& skin) {
  const CompressedRows corners = node_corners(mesh.hexes, begin, end);
  constexpr Index size = 4096;
  std::vector<std::vector<Side>> of_chunk(n_chunks(end - begin, size));
  std::atomic<bool> sound = true;
  parallel_chunks(end - begin, size, [&](Index chunk, Index from, Index to) {
    std::vector<FaceUse> uses;
    for (Index i = from; i < to && sound.load(std::memory_order_relaxed); ++i) {
      collect_faces(mesh.hexes, corners, begin, begin + i, uses);
      if (!faces_are_sound(uses, of_chunk[chunk])) sound = false;
    }
  });
  for (const auto& list : of_chunk) skin.insert(skin.end(), list.begin(), list.end());
  return sound;
}

/// Whether all are finite, each on eight nodes, and valid.
bool hexes_are_sound(const Mesh& mesh, bool known_valid) {
  if (!all_hold(mesh.n_nodes(), [&](Index n) { return mesh.points[n].allFinite(); })) return false;
  if (!are_on_eight_nodes(mesh)) return false;
  check_nodes(mesh);  // for their number
  return known_valid || all_valid(mesh);
}

/// How many nodes are looked at together: a few hundred megabytes of lists.
constexpr Index nodes_at_once = 8 << 20;

}  // namespace

bool faces_are_sound(std::span<const FaceUse> uses, std::vector<Side>& skin) {
  if (!fit_together(uses)) return false;
  for (std::size_t i = 0; i < uses.size(); ++i)
    if (i + 1 < uses.size() && uses[i].is_same_face(uses[i + 1]))
      ++i;
    else
      skin.push_back(uses[i].side());
  return true;
}

bool are_on_eight_nodes(const Mesh& mesh, Index first) {
  return all_hold(mesh.n_hexes() - first, [&](Index i) { return is_on_eight_nodes(mesh, mesh.hexes[first + i]); });
}

bool is_sound_without_skin(const Mesh& mesh, std::vector<Side>& skin, bool known_valid) {
  skin.clear();
  if (!hexes_are_sound(mesh, known_valid)) return false;
  for (std::int64_t begin = 0; begin < mesh.n_nodes(); begin += nodes_at_once) {
    const auto end = static_cast<Index>(std::min<std::int64_t>(begin + nodes_at_once, mesh.n_nodes()));
    if (!faces_are_sound(mesh, static_cast<Index>(begin), end, skin)) return false;
  }
  tbb::parallel_sort(skin.begin(), skin.end());
  return true;
}

bool is_sound_without_skin(const Mesh& mesh, std::vector<Side>& skin, SoundTopology& topology) {
  skin.clear();
  if (!hexes_are_sound(mesh, false)) return false;
  topology.corners = node_corners(mesh.hexes, mesh.n_nodes());
  LooseFaces loose = loose_faces(mesh, topology.corners);
  if (!loose.fit_together) return false;
  const Faces& faces = topology.faces = std::move(loose.faces);
  const auto is_open = [&](Index face) { return faces.sides[face][1].hex < 0; };
  for (const Index face : indices_where(static_cast<Index>(faces.sides.size()), is_open))
    skin.push_back(faces.sides[face][0]);
  tbb::parallel_sort(skin.begin(), skin.end());
  return true;
}

bool has_only_warnings(const Mesh& mesh, bool known_valid) {
  std::vector<Side> skin;
  return is_sound_without_skin(mesh, skin, known_valid) && !has_joined_nodes(mesh, skin);
}

}  // namespace hextwist
