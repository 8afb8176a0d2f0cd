#include "hextwist/refine/node_sets.h"

#include <algorithm>
#include <atomic>

#include "hextwist/base/parallel.h"
#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

using Flags = std::vector<std::uint8_t>;

void raise(std::uint8_t& flag) {
  std::atomic_ref<std::uint8_t>(flag).store(1, std::memory_order_relaxed);
}

struct Carrier {
  const Mesh& old_mesh;
  const Association& old;
  const Split& split;
  const Association& now;
  const Lineage& lineage = split.lineage;
  bool knows = !old.empty();
  std::vector<std::array<int, n_hex_faces>> face_surface = {};  // per cut hex, 0 none

  void find_faces() {
    face_surface.resize(lineage.hexes.size());
    for (std::size_t i = 0; i < old.surface_faces.size(); ++i)
      if (const Side side = old.surface_faces[i]; split.is_cut(side.hex))
        face_surface[split.cut_index(side.hex)][side.face] = old.face_surface[i];
  }

  std::vector<Index> carried(const NodeSet& set) const {
    Flags member(static_cast<std::size_t>(split.n_nodes), 0);
    for (const Index n : set.nodes) member[n] = 1;
    const auto is_in = [&](const auto& nodes) {
      return std::ranges::all_of(nodes, [&](Index n) { return member[n] != 0; });
    };
    // All nodes of an item on this entity are in the set: is it part of it?
    const auto is_part = [&](Owner entity, const auto& nodes) {
      return !knows || std::ranges::any_of(nodes, [&](Index n) { return old.node_owner[n] == entity; }) ||
             std::ranges::binary_search(set.meant, entity);
    };
    const auto is_inside = [&](Index n) { return old.node_owner[n].dim == 3; };

    Flags edges(lineage.edges.size(), 0), faces(lineage.faces.size(), 0), hexes(lineage.hexes.size(), 0);
    parallel_each(lineage.hexes.size(), [&](std::size_t cut) {
      const Index h = lineage.hexes[cut].hex;
      const Hex& hex = old_mesh.hexes[h];
      if (std::ranges::count_if(hex, [&](Index n) { return member[n] != 0; }) < 4) return;
      const bool whole = is_in(hex) && is_part({3, knows ? old.hex_volume[h] : 0}, hex);
      if (whole) hexes[cut] = 1;
      for (int f = 0; f < n_hex_faces; ++f) {
        const auto quad = face_nodes(hex, f);
        if (!whole) {
          if (!is_in(quad)) continue;
          const int surface = knows ? face_surface[cut][f] : 0;
          if (!is_part(surface > 0 ? Owner{2, surface} : Owner{3, knows ? old.hex_volume[h] : 0}, quad)) continue;
          // A volume that is meant is so by whole hexes.
          if (surface == 0 && knows && std::ranges::none_of(quad, is_inside)) continue;
        }
        if (const Index face = split.hex_faces[cut][f]; face >= 0) raise(faces[face]);
        for (int j = 0; j < 4; ++j)
          if (const Index edge = split.hex_edges[cut][face_edge(f, j)]; edge >= 0) raise(edges[edge]);
      }
    });
    Flags along;  // per old node: the set goes on from there along a curve or surface
    for (std::size_t e = 0; e < lineage.edges.size(); ++e) {
      const CutEdge& edge = lineage.edges[e];
      if (edges[e] || !member[edge.a] || !member[edge.b]) continue;
      if (!knows) {
        edges[e] = 1;
        continue;
      }
      const Owner owner = now.node_owner[edge.first_node];
      const std::array<Index, 2> ends = {edge.a, edge.b};
      if (owner.dim < 3) {
        edges[e] = is_part(owner, ends);
        continue;
      }
      if (std::ranges::none_of(ends, is_inside)) continue;
      if (along.empty()) along = goes_along(member, is_in, is_part);
      edges[e] = std::ranges::none_of(ends, [&](Index n) { return along[n] != 0; });
    }

    const auto join = [&](const Flags& flags, const auto& items, const auto& n_new) {
      parallel_each(items.size(), [&](std::size_t i) {
        if (flags[i]) std::fill_n(member.begin() + items[i].first_node, n_new(items[i]), std::uint8_t{1});
      });
    };
    join(edges, lineage.edges, [&](const CutEdge& edge) { return lineage.table->edge[edge.code].at.size(); });
    join(faces, lineage.faces, [&](const CutFace& face) { return lineage.table->face[face.code].at.size(); });
    join(hexes, lineage.hexes, [&](const CutHex& hex) { return lineage.table->hex(hex.code).inside.size(); });
    std::vector<Index> result = set.nodes;
    for (Index n = lineage.n_old_nodes; n < split.n_nodes; ++n)
      if (member[n]) result.push_back(n);
    return result;
  }

  Flags goes_along(const Flags& member, const auto& is_in, const auto& is_part) const {
    Flags along(member.size(), 0);
    const auto take = [&](Owner entity, const auto& nodes) {
      if (is_in(nodes) && is_part(entity, nodes))
        for (const Index n : nodes) along[n] = 1;
    };
    for (std::size_t i = 0; i < old.curve_edges.size(); ++i) take({1, old.edge_curve[i]}, old.curve_edges[i]);
    for (std::size_t i = 0; i < old.surface_faces.size(); ++i) {
      const Side side = old.surface_faces[i];
      take({2, old.face_surface[i]}, face_nodes(old_mesh.hexes[side.hex], side.face));
    }
    return along;
  }
};

}  // namespace

std::vector<std::vector<Index>> carried_node_sets(const Mesh& old_mesh, const Association& old, const Split& split,
                                                  const Association& now) {
  std::vector<std::vector<Index>> result;
  if (old_mesh.node_sets.empty()) return result;
  Carrier carrier{old_mesh, old, split, now};
  if (carrier.knows) carrier.find_faces();
  for (const NodeSet& set : old_mesh.node_sets) result.push_back(carrier.carried(set));
  return result;
}

}  // namespace hextwist
