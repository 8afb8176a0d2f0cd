// All arrays here are made alike: the places where hexes name a node are listed per node (count, prefix sum, scatter,
// sort); an edge or face belongs to its lowest node, so each node can then sort and number its own few on its own.
#include "hextwist/mesh/topology.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <tuple>

#include "hextwist/base/large_array.h"
#include "hextwist/base/parallel.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/loose_topology.h"

namespace hextwist {
namespace {

constexpr Index max_hexes = std::numeric_limits<Index>::max() / 12;  // edge uses fit an Index

/// Counts to ends, for scattering backwards: every item then lowers the entry of its list by one, after which the
/// entries are starts.
void counts_to_ends(std::vector<Index>& first) {
  running_sums(
      static_cast<Index>(first.size()), 0, [&](Index i) { return first[i]; },
      [&](Index i, std::int64_t sum) { first[i] += static_cast<Index>(sum); });
}

Index fetch_add(Index& counter, Index step) {
  return std::atomic_ref<Index>(counter).fetch_add(step, std::memory_order_relaxed);
}

void sort_lists(CompressedRows& lists) {
  parallel_ranges(lists.size(), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
      std::sort(lists.items.begin() + lists.first[i], lists.items.begin() + lists.first[i + 1]);
  });
}

/// Most lists are of a few items.
template <class T>
void sort_few(std::vector<T>& items) {
  constexpr std::size_t few = 24;
  if (items.size() > few) std::ranges::sort(items);
  for (std::size_t i = 1; i < items.size(); ++i) {  // by insertion
    if (!(items[i] < items[i - 1])) continue;
    const T item = items[i];
    std::size_t at = i;
    for (; at > 0 && item < items[at - 1]; --at) items[at] = items[at - 1];
    items[at] = item;
  }
}

/// Hexes around a node are all over the mesh, where it was refined. Waiting for them takes longer than all else.
void fetch_ahead(std::span<const Hex> hexes, const CompressedRows& corners, Index row) {
#if defined(__GNUC__)
  constexpr Index ahead = 6;
  if (row + ahead < corners.size())
    for (const Index corner : corners[row + ahead]) __builtin_prefetch(&hexes[corner >> 3]);
#endif
}

void fetch_for_writing([[maybe_unused]] const void* place) {
#if defined(__GNUC__)
  __builtin_prefetch(place, 1);
#endif
}

/// One use of an edge by a hex, at the edge's lower node: the other node, and which use it is (3 * place + axis,
/// place in the list of the node's corners). In one integer, so that sorting is quick.
using EdgeUse = std::uint64_t;

/// Edges that belong to a node: those to higher nodes. One from the node to itself (of a hex that names a node twice)
/// is taken at its lower corner only.
void collect_edges(const Mesh& mesh, Index node, const CompressedRows& corners, std::vector<EdgeUse>& uses) {
  uses.clear();
  fetch_ahead(mesh.hexes, corners, node);
  std::uint64_t use = 0;
  for (const Index corner : corners[node]) {
    const Hex& hex = mesh.hexes[corner >> 3];
    for (int axis = 0; axis < 3; ++axis, ++use) {
      const Index other = hex[(corner & 7) ^ (1 << axis)];
      if (other > node || (other == node && !(corner >> axis & 1)))
        uses.push_back(static_cast<EdgeUse>(other) << 32 | use);
    }
  }
  sort_few(uses);
}

/// Calls f(first, last) for each run of equal items in a sorted list.
template <class T, class Same, class F>
void for_runs(std::span<const T> items, Same same, F f) {
  for (std::size_t begin = 0, end; begin < items.size(); begin = end) {
    for (end = begin + 1; end < items.size() && same(items[begin], items[end]);) ++end;
    f(items.subspan(begin, end - begin));
  }
}
constexpr auto same_edge = [](EdgeUse a, EdgeUse b) { return a >> 32 == b >> 32; };
constexpr auto same_face = [](const FaceUse& a, const FaceUse& b) { return a.is_same_face(b); };

}  // namespace

void collect_faces(std::span<const Hex> hexes, const CompressedRows& corners, Index first_node, Index node,
                   std::vector<FaceUse>& uses) {
  uses.clear();
  fetch_ahead(hexes, corners, node - first_node);
  for (const Index corner : corners[node - first_node]) {
    const Hex& hex = hexes[corner >> 3];
    const int c = corner & 7;
    // Corners whose nodes come after this one: a node that a face names twice keeps the face where it stands first.
    const auto comes_after = [&](int d) { return hex[d] > node - (d > c ? 1 : 0); };
    const std::array<bool, 3> next = {comes_after(c ^ 1), comes_after(c ^ 2), comes_after(c ^ 4)};
    if (next[0] + next[1] + next[2] < 2) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const int u = 1 << (axis == 0), v = axis == 2 ? 2 : 4;
      if (!next[axis == 0 ? 1 : 0] || !next[axis == 2 ? 1 : 2] || !comes_after(c ^ u ^ v)) continue;
      const int place = ((c & u) != 0) + 2 * ((c & v) != 0);
      uses.emplace_back(Side{corner >> 3, 2 * axis + (c >> axis & 1)}, place, hex[c ^ u ^ v], hex[c ^ u], hex[c ^ v]);
    }
  }
  sort_few(uses);
}

bool fit_together(std::span<const FaceUse> uses) {
  for (std::size_t begin = 0, end; begin < uses.size(); begin = end) {
    for (end = begin + 1; end < uses.size() && uses[end].is_same_face(uses[begin]);) ++end;
    if (end - begin > 2) return false;
    if (end - begin == 2 && uses[begin].turns_to_low() == uses[begin + 1].turns_to_low()) return false;
    for (std::size_t i = 0; i < begin; ++i) {
      std::array<Index, 3> one = {uses[i].diagonal(), uses[i].low(), uses[i].high()},
                           other = {uses[begin].diagonal(), uses[begin].low(), uses[begin].high()};
      if (std::int64_t{one[0]} + one[1] + one[2] != std::int64_t{other[0]} + other[1] + other[2]) continue;
      std::ranges::sort(one);
      std::ranges::sort(other);
      if (one == other && !uses[i].is_same_face(uses[begin])) return false;
    }
  }
  return true;
}

void check_nodes(const Mesh& mesh) {
  if (mesh.hexes.size() > max_hexes)
    throw Error("a mesh of " + std::to_string(mesh.hexes.size()) + " hexes: more than " + std::to_string(max_hexes) +
                " cannot be numbered");
  Index bad = mesh.n_hexes();
  parallel_ranges(mesh.n_hexes(), [&](Index begin, Index end) {
    for (Index h = begin; h < end; ++h)
      if (!std::ranges::all_of(mesh.hexes[h], [&](Index node) { return node >= 0 && node < mesh.n_nodes(); }))
        atomic_min(bad, h);
  });
  if (bad < mesh.n_hexes())
    throw Error("hex " + std::to_string(hex_id(mesh, bad)) + " names a node that does not exist");
}

std::int64_t counts_to_starts(std::vector<Index>& counts) {
  return running_sums(
      static_cast<Index>(counts.size()), 0, [&](Index i) { return counts[i]; },
      [&](Index i, std::int64_t sum) { counts[i] = static_cast<Index>(sum); });
}

CompressedRows node_corners(std::span<const Hex> hexes, Index begin, Index end) {
  // Each thread has a range of nodes and walks along the hexes that have some of them: no counter is shared, every list
  // comes out ascending.
  const auto n_parts = static_cast<Index>(n_threads());
  const Index n_nodes = end - begin;
  const auto for_each_part = [&](auto&& each) {
    parallel_ranges(
        n_parts,
        [&](Index from, Index to) {
          for (Index part = from; part < to; ++part) {
            const auto low = static_cast<std::int64_t>(n_nodes) * part / n_parts;
            const auto high = static_cast<std::int64_t>(n_nodes) * (part + 1) / n_parts;
            each(static_cast<Index>(begin + low), static_cast<std::uint32_t>(high - low));
          }
        },
        1);
  };
  constexpr Index size = 512;
  const auto n_hexes = static_cast<Index>(hexes.size());
  std::vector<std::pair<Index, Index>> nodes_of_chunk(static_cast<std::size_t>(n_chunks(n_hexes, size)),
                                                      {begin, end - 1});
  if (n_parts > 1)
    parallel_chunks(n_hexes, size, [&](Index chunk, Index from, Index to) {
      auto& [low, high] = nodes_of_chunk[chunk];
      std::tie(low, high) = std::pair(end, begin - 1);
      for (Index h = from; h < to; ++h) {
        const auto [least, most] = std::ranges::minmax(hexes[h]);
        low = std::min(low, least);
        high = std::max(high, most);
      }
    });
  const auto has_none = [&](Index chunk, Index low, std::uint32_t width) {
    return nodes_of_chunk[chunk].second < low || std::int64_t{nodes_of_chunk[chunk].first} - low >= width;
  };
  CompressedRows corners;
  resize_large(corners.first, static_cast<std::size_t>(n_nodes) + 1);
  for_each_part([&](Index low, std::uint32_t width) {
    for (Index chunk = 0; chunk < std::ssize(nodes_of_chunk); ++chunk) {
      if (has_none(chunk, low, width)) continue;
      for (Index h = chunk * size; h < std::min(chunk * size + size, n_hexes); ++h)
        for (const Index node : hexes[h])
          if (static_cast<std::uint32_t>(node - low) < width) ++corners.first[node - begin];
    }
  });
  counts_to_ends(corners.first);
  resize_for_overwrite(corners.items, static_cast<std::size_t>(corners.first.back()));
  for_each_part([&](Index low, std::uint32_t width) {
    for (auto chunk = static_cast<Index>(nodes_of_chunk.size()) - 1; chunk >= 0; --chunk) {
      if (has_none(chunk, low, width)) continue;
      for (Index h = std::min(chunk * size + size, n_hexes) - 1; h >= chunk * size; --h)
        for (int c = 7; c >= 0; --c)
          if (const Index node = hexes[h][c]; static_cast<std::uint32_t>(node - low) < width)
            corners.items[--corners.first[node - begin]] = 8 * h + c;
    }
  });
  return corners;
}

CompressedRows node_corners(std::span<const Hex> hexes, Index n_nodes) {
  return node_corners(hexes, 0, n_nodes);
}

CompressedRows node_corners(const Mesh& mesh) {
  check_nodes(mesh);
  return node_corners(mesh.hexes, mesh.n_nodes());
}

Edges edges(const Mesh& mesh) {
  const CompressedRows corners = node_corners(mesh);
  Edges result;
  resize_large(result.first_of_node, mesh.points.size() + 1);
  parallel_ranges(mesh.n_nodes(), [&](Index begin, Index end) {
    std::vector<EdgeUse> uses;
    for (Index node = begin; node < end; ++node) {
      collect_edges(mesh, node, corners, uses);
      for_runs(std::span<const EdgeUse>(uses), same_edge, [&](auto) { ++result.first_of_node[node]; });
    }
  });
  counts_to_starts(result.first_of_node);
  resize_for_overwrite(result.nodes, static_cast<std::size_t>(result.first_of_node.back()));
  resize_for_overwrite(result.of_hex, mesh.hexes.size());
  parallel_ranges(mesh.n_nodes(), [&](Index begin, Index end) {
    std::vector<EdgeUse> uses;
    for (Index node = begin; node < end; ++node) {
      collect_edges(mesh, node, corners, uses);
      Index edge = result.first_of_node[node];
      for_runs(std::span<const EdgeUse>(uses), same_edge, [&](std::span<const EdgeUse> run) {
        result.nodes[edge] = {node, static_cast<Index>(run[0] >> 32)};
        for (const EdgeUse use : run) {
          const std::uint32_t place = static_cast<std::uint32_t>(use) / 3, axis = static_cast<std::uint32_t>(use) % 3;
          const Index corner = corners[node][place];
          const int c = corner & 7;
          result.of_hex[corner >> 3][edge_between(c, c ^ (1 << axis))] = edge;
        }
        ++edge;
      });
    }
  });
  return result;
}

LooseFaces loose_faces(const Mesh& mesh) {
  return loose_faces(mesh, node_corners(mesh));
}

LooseFaces loose_faces(const Mesh& mesh, const CompressedRows& corners) {
  LooseFaces result;
  Faces& faces = result.faces;
  resize_for_overwrite(faces.first_of_node, mesh.points.size() + 1);
  resize_for_overwrite(faces.of_hex, mesh.hexes.size());
  // Looking at the hexes around a node takes longest, so what was found is kept until its faces have numbers: of so few
  // nodes at a time that it stays in the cache.
  constexpr Index chunk_size = 512, window = 64 * chunk_size;
  struct Uses {
    std::vector<FaceUse> all;
    std::array<Index, chunk_size> end_of_node;
    Index n_faces;
  };
  std::vector<Uses> uses_of_chunk(static_cast<std::size_t>(n_chunks(std::min(mesh.n_nodes(), window), chunk_size)));
  std::atomic<bool> crowded = false, fit = true;
  Index n_faces = 0;
  for (Index first = 0, last; first < mesh.n_nodes(); first = last) {
    last = first + std::min(window, mesh.n_nodes() - first);
    parallel_chunks(last - first, chunk_size, [&](Index chunk, Index begin, Index end) {
      std::vector<FaceUse> uses;
      Uses& kept = uses_of_chunk[chunk];
      kept.all.clear();
      kept.n_faces = 0;
      for (Index i = begin; i < end; ++i) {
        collect_faces(mesh.hexes, corners, 0, first + i, uses);
        for_runs(std::span<const FaceUse>(uses), same_face, [&](auto run) {
          ++kept.n_faces;
          if (run.size() > 2) crowded = true;
        });
        if (!hextwist::fit_together(uses)) fit = false;
        kept.all.insert(kept.all.end(), uses.begin(), uses.end());
        kept.end_of_node[i - begin] = static_cast<Index>(kept.all.size());
      }
    });
    for (Index chunk = 0; chunk < n_chunks(last - first, chunk_size); ++chunk)
      n_faces += std::exchange(uses_of_chunk[chunk].n_faces, n_faces);  // those before it
    // Room for as many at each node as so far: arrays are seldom moved.
    if (static_cast<std::size_t>(n_faces) > faces.nodes.capacity()) {
      const auto all = static_cast<std::size_t>(1.02 * n_faces * (static_cast<double>(mesh.n_nodes()) / last));
      grow_large(faces.nodes, all - faces.nodes.size());
      grow_large(faces.sides, all - faces.sides.size());
    }
    resize_for_overwrite(faces.nodes, static_cast<std::size_t>(n_faces));
    resize_for_overwrite(faces.sides, static_cast<std::size_t>(n_faces));
    parallel_chunks(last - first, chunk_size, [&](Index chunk, Index begin, Index end) {
      const Uses& kept = uses_of_chunk[chunk];
      Index face = kept.n_faces, from = 0;
      for (Index i = begin; i < end; ++i) {
        const Index node = first + i, to = kept.end_of_node[i - begin];
        const auto uses = std::span<const FaceUse>(kept.all).subspan(from, to - from);
        constexpr Index ahead = 32;
        for (Index u = from; u < to && u + ahead < std::ssize(kept.all); ++u)
          fetch_for_writing(&faces.of_hex[kept.all[u + ahead].side().hex]);
        from = to;
        faces.first_of_node[node] = face;
        for_runs(uses, same_face, [&](std::span<const FaceUse> run) {
          faces.sides[face][1] = {};
          for (std::size_t k = 0; k < run.size(); ++k) {
            const Side side = run[k].side();
            if (k < 2) faces.sides[face][k] = side;
            faces.of_hex[side.hex][side.face] = face;
          }
          faces.nodes[face++] = run[0].nodes(node);
        });
      }
    });
  }
  faces.first_of_node.back() = n_faces;
  result.fit_together = fit;
  if (crowded)
    for (Index h = 0; h < mesh.n_hexes(); ++h)
      for (int f = 0; f < n_hex_faces; ++f) {
        const Index face = faces.of_hex[h][f];
        const auto& sides = faces.sides[face];
        if (sides[0] != Side{h, f} && sides[1] != Side{h, f}) result.more.push_back({face, {h, f}});
      }
  std::ranges::sort(result.more);
  return result;
}

Faces faces(const Mesh& mesh) {
  LooseFaces loose = loose_faces(mesh);
  if (!loose.more.empty()) {
    const auto& [face, third] = loose.more.front();
    const auto& sides = loose.faces.sides[face];
    throw Error("hexes " + std::to_string(hex_id(mesh, sides[0].hex)) + ", " +
                std::to_string(hex_id(mesh, sides[1].hex)) + " and " + std::to_string(hex_id(mesh, third.hex)) +
                " share one face: at most two can");
  }
  return std::move(loose.faces);
}

Index find_edge(const Edges& edges, Index a, Index b) {
  const auto [low, high] = std::minmax(a, b);
  if (low < 0 || low + 1 >= std::ssize(edges.first_of_node)) return -1;
  const auto bucket = edges.nodes.begin();
  const auto end = bucket + edges.first_of_node[low + 1];
  const auto found = std::lower_bound(bucket + edges.first_of_node[low], end, Edge{low, high});
  return found != end && *found == Edge{low, high} ? static_cast<Index>(found - edges.nodes.begin()) : -1;
}

Index find_face(const Faces& faces, const Quad& nodes) {
  Quad wanted = nodes;
  std::ranges::sort(wanted);
  if (wanted[0] < 0 || wanted[0] + 1 >= std::ssize(faces.first_of_node)) return -1;
  for (Index face = faces.first_of_node[wanted[0]]; face < faces.first_of_node[wanted[0] + 1]; ++face) {
    Quad quad = faces.nodes[face];
    std::ranges::sort(quad);
    if (quad == wanted) return face;
  }
  return -1;
}

CompressedRows node_hexes(const Mesh& mesh) {
  CompressedRows lists = node_corners(mesh);
  parallel_ranges(static_cast<Index>(lists.items.size()), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) lists.items[i] >>= 3;
  });
  return lists;
}

CompressedRows edge_hexes(const Edges& edges, Index n_hexes) {
  CompressedRows lists;
  lists.first.assign(edges.nodes.size() + 1, 0);
  parallel_ranges(n_hexes, [&](Index begin, Index end) {
    for (Index h = begin; h < end; ++h)
      for (const Index edge : edges.of_hex[h]) fetch_add(lists.first[edge], 1);
  });
  counts_to_ends(lists.first);
  lists.items.resize(lists.first.back());
  parallel_ranges(n_hexes, [&](Index begin, Index end) {
    for (Index h = begin; h < end; ++h)
      for (const Index edge : edges.of_hex[h]) lists.items[fetch_add(lists.first[edge], -1) - 1] = h;
  });
  sort_lists(lists);
  return lists;
}

std::vector<Side> boundary_sides(const Faces& faces) {
  std::vector<Side> sides;
  for (Index h = 0; h < std::ssize(faces.of_hex); ++h)
    for (int f = 0; f < n_hex_faces; ++f)
      if (faces.sides[faces.of_hex[h][f]][1].hex < 0) sides.push_back({h, f});
  return sides;
}

std::vector<Side> find_sides(const Mesh& mesh, std::span<const Quad> quads) {
  if (quads.empty()) return {};
  // Quads by lowest node; then every face of every hex looks there, which costs nothing in most places.
  const auto known = [&](Index node) { return node >= 0 && node < mesh.n_nodes(); };
  std::vector<Quad> sorted(quads.begin(), quads.end());
  CompressedRows of_node;
  of_node.first.assign(mesh.points.size() + 1, 0);
  for (Quad& quad : sorted) {
    std::ranges::sort(quad);
    if (known(quad[0])) ++of_node.first[quad[0]];
  }
  counts_to_ends(of_node.first);
  of_node.items.resize(of_node.first.back());
  for (std::size_t q = 0; q < sorted.size(); ++q)
    if (known(sorted[q][0])) of_node.items[--of_node.first[sorted[q][0]]] = static_cast<Index>(q);

  constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();
  std::vector<std::int64_t> found(quads.size(), none);  // 6 * hex + face, the lowest
  parallel_ranges(mesh.n_hexes(), [&](Index begin, Index end) {
    for (Index h = begin; h < end; ++h)
      for (int f = 0; f < n_hex_faces; ++f) {
        Quad face = face_nodes(mesh.hexes[h], f);
        const Index lowest = std::ranges::min(face);
        if (!known(lowest) || of_node[lowest].empty()) continue;
        std::ranges::sort(face);
        for (const Index q : of_node[lowest])
          if (sorted[q] == face) atomic_min(found[q], std::int64_t{6} * h + f);
      }
  });
  std::vector<Side> sides(quads.size());
  for (std::size_t q = 0; q < quads.size(); ++q)
    if (found[q] != none) sides[q] = {static_cast<Index>(found[q] / 6), static_cast<std::int32_t>(found[q] % 6)};
  return sides;
}

}  // namespace hextwist
