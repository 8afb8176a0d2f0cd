#include "hextwist/refine/carry.h"

#include <algorithm>
#include <functional>

#include "hextwist/base/large_array.h"
#include "hextwist/base/parallel.h"
#include "hextwist/refine/origin.h"

namespace hextwist {
namespace {

/// Calls per_node(new node, its origin) for all new nodes, in parallel.
template <typename Body>
void for_each_new_node(const Mesh& old_mesh, const Lineage& lineage, const Body& per_node) {
  parallel_each(lineage.edges.size(), [&](std::size_t i) { for_each_node(lineage, lineage.edges[i], per_node); });
  parallel_each(lineage.faces.size(), [&](std::size_t i) { for_each_node(lineage, lineage.faces[i], per_node); });
  parallel_each(lineage.hexes.size(),
                [&](std::size_t i) { for_each_node(lineage, lineage.hexes[i], old_mesh.hexes, per_node); });
}

/// Fills ids[first], ... with next, next + 1, ...
void count_on(std::vector<std::int64_t>& ids, std::size_t first, std::int64_t next) {
  parallel_each(ids.size() - first, [&](std::size_t i) { ids[first + i] = next + static_cast<std::int64_t>(i); });
}

/// Old values, and room for those of the new nodes.
template <class T>
std::vector<T> of_old_nodes(const std::vector<T>& old, Index n_nodes) {
  std::vector<T> values = copy_large(old, static_cast<std::size_t>(n_nodes));
  resize_large(values, static_cast<std::size_t>(n_nodes));
  return values;
}

/// Node ids stay with the nodes. Hex ids of hexes that were cut are gone for good.
void carry_ids(const Mesh& old_mesh, const Split& split, Mesh& mesh) {
  if (!old_mesh.node_ids.empty()) {
    mesh.node_ids = of_old_nodes(old_mesh.node_ids, split.n_nodes);
    count_on(mesh.node_ids, old_mesh.node_ids.size(), old_mesh.node_ids.back() + 1);
  }
  if (split.lineage.hexes.empty()) {
    mesh.hex_ids = old_mesh.hex_ids;
    return;
  }
  resize_for_overwrite(mesh.hex_ids, mesh.hexes.size());
  parallel_each(split.n_kept(), [&](std::size_t i) { mesh.hex_ids[i] = hex_id(old_mesh, split.lineage.parent[i]); });
  count_on(mesh.hex_ids, split.n_kept(), hex_id(old_mesh, old_mesh.n_hexes() - 1) + 1);
}

/// Calls use(new side) for the side itself or the sides of the children that make it up.
template <typename Use>
void for_each_child_side(const Split& split, Side old_side, const Use& use) {
  const Index first = split.first_child[old_side.hex];
  if (!split.is_cut(old_side.hex)) return use(Side{first, old_side.face});
  const HexTemplate& of = split.lineage.table->hex(split.lineage.hexes[split.cut_index(old_side.hex)].code);
  for (const ChildSide& child : of.side[old_side.face]) use(Side{first + child.child, child.face});
}

/// The old hexes of an ascending list that were not cut, then the children of those that were: ascending.
std::vector<Index> carried_hexes(const std::vector<Index>& old_hexes, const Split& split) {
  const std::vector<CutHex>& cut = split.lineage.hexes;
  const auto end_of = [&](auto at) {
    return at + 1 == cut.end() ? static_cast<Index>(split.lineage.parent.size()) : std::next(at)->first_child;
  };
  // Calls keep(hex) for the members begin, ... that were not cut and use(entry of cut) for the others.
  const auto for_each_member = [&](Index begin, Index end, const auto& keep, const auto& use) {
    auto at = cut.begin();
    for (Index i = begin; i < end; ++i) {
      const Index h = old_hexes[i];
      if (!split.is_cut(h)) {
        keep(h);
        continue;
      }
      if (at->hex != h) at = std::lower_bound(at, cut.end(), h, [](const CutHex& a, Index hex) { return a.hex < hex; });
      use(at);
      if (at + 1 != cut.end()) ++at;
    }
  };
  struct Place {
    std::size_t kept = 0, child = 0;
  };
  constexpr Index size = 1 << 14;
  const auto n = static_cast<Index>(old_hexes.size());
  std::vector<Place> first(n_chunks(n, size) + 1);
  parallel_chunks(n, size, [&](Index chunk, Index begin, Index end) {
    Place counted;
    for_each_member(
        begin, end, [&](Index) { ++counted.kept; },
        [&](auto at) { counted.child += static_cast<std::size_t>(end_of(at) - at->first_child); });
    first[chunk + 1] = counted;
  });
  for (std::size_t chunk = 1; chunk < first.size(); ++chunk) {
    first[chunk].kept += first[chunk - 1].kept;
    first[chunk].child += first[chunk - 1].child;
  }
  const std::size_t n_kept = first.back().kept;
  std::vector<Index> carried;
  resize_for_overwrite(carried, n_kept + first.back().child);
  parallel_chunks(n, size, [&](Index chunk, Index begin, Index end) {
    Index* kept = carried.data() + first[chunk].kept;
    Index* child = carried.data() + n_kept + first[chunk].child;
    for_each_member(
        begin, end, [&](Index h) { *kept++ = split.first_child[h]; },
        [&](auto at) {
          for (Index c = at->first_child; c < end_of(at); ++c) *child++ = c;
        });
  });
  return carried;
}

void carry_blocks(const Mesh& old_mesh, const Split& split, Mesh& mesh) {
  for (const Block& block : old_mesh.blocks)
    mesh.blocks.push_back({block.id, block.name, carried_hexes(block.hexes, split)});
}

/// Sorts what begins with the sides of hexes that were not cut, in order.
template <class List, class SideOf>
void sort_sides(List& list, Index n_kept, const SideOf& side_of) {
  const auto kept_end = std::ranges::stable_partition(list, [&](const auto& item) {
                          return std::invoke(side_of, item).hex < n_kept;
                        }).begin();
  std::ranges::sort(kept_end, list.end(), {}, side_of);
}

void carry_side_sets(const Mesh& old_mesh, const Split& split, Mesh& mesh) {
  for (const SideSet& set : old_mesh.side_sets) {
    SideSet carried{set.id, set.name, {}};
    for (const Side side : set.sides)
      for_each_child_side(split, side, [&](Side child) { carried.sides.push_back(child); });
    sort_sides(carried.sides, split.n_kept(), std::identity{});
    mesh.side_sets.push_back(std::move(carried));
  }
}

void carry_node_sets(const Mesh& old_mesh, const Lineage& lineage, Mesh& mesh) {
  std::vector<std::uint8_t> member(mesh.points.size());
  for (const NodeSet& set : old_mesh.node_sets) {
    std::ranges::fill(member, 0);
    for (const Index n : set.nodes) member[n] = 1;
    for_each_new_node(old_mesh, lineage, [&](Index node, const Origin& origin) {
      member[node] = std::ranges::all_of(origin.nodes(), [&](Index n) { return member[n] != 0; });
    });
    NodeSet carried{set.id, set.name, set.nodes};
    for (Index n = lineage.n_old_nodes; n < mesh.n_nodes(); ++n)
      if (member[n]) carried.nodes.push_back(n);
    mesh.node_sets.push_back(std::move(carried));
  }
}

void carry_fields(const Mesh& old_mesh, const Lineage& lineage, Mesh& mesh) {
  for (const Field& field : old_mesh.fields) {
    Field carried{field.name, field.on, field.components, {}};
    const std::size_t width = field.components;
    if (field.on == Field::On::node) {
      carried.values = field.values;
      carried.values.resize(mesh.points.size() * width);
      for_each_new_node(old_mesh, lineage, [&](Index node, const Origin& origin) {
        for (std::size_t c = 0; c < width; ++c) {
          double sum = 0;
          for (int i = 0; i < origin.n; ++i) sum += origin.weight[i] * field.values[origin.node[i] * width + c];
          carried.values[node * width + c] = sum;
        }
      });
    } else {
      carried.values.resize(mesh.hexes.size() * width);
      parallel_each(mesh.hexes.size(), [&](std::size_t h) {
        std::copy_n(field.values.begin() + static_cast<std::ptrdiff_t>(lineage.parent[h] * width), width,
                    carried.values.begin() + static_cast<std::ptrdiff_t>(h * width));
      });
    }
    mesh.fields.push_back(std::move(carried));
  }
}

/// Owners of the nodes on cut edges and faces: volume of their hex, unless the face or the edge is on the CAD.
void carry_node_owners(const Association& old, const Split& split, Association& association) {
  const Lineage& lineage = split.lineage;
  const auto set_nodes = [&](Index first, std::size_t n, Owner owner) {
    for (std::size_t s = 0; s < n; ++s) association.node_owner[first + s] = owner;
  };
  const auto n_edge_nodes = [&](const CutEdge& edge) { return lineage.table->edge[edge.code].at.size(); };
  parallel_each(lineage.edges.size(), [&](std::size_t i) {
    const CutEdge& edge = lineage.edges[i];
    set_nodes(edge.first_node, n_edge_nodes(edge), {3, old.hex_volume[edge.hex]});
  });
  parallel_each(lineage.faces.size(), [&](std::size_t i) {
    const CutFace& face = lineage.faces[i];
    set_nodes(face.first_node, lineage.table->face[face.code].at.size(), {3, old.hex_volume[face.side.hex]});
  });
  parallel_each(lineage.hexes.size(), [&](std::size_t i) {
    const CutHex& hex = lineage.hexes[i];
    set_nodes(hex.first_node, lineage.table->hex(hex.code).inside.size(), {3, old.hex_volume[hex.hex]});
  });
  for (std::size_t i = 0; i < old.surface_faces.size(); ++i) {
    const Side side = old.surface_faces[i];
    if (!split.is_cut(side.hex)) continue;
    const Index cut = split.cut_index(side.hex);
    const Owner owner{2, old.face_surface[i]};
    for (int j = 0; j < 4; ++j)
      if (const Index number = split.hex_edges[cut][face_edge(side.face, j)]; number >= 0)
        set_nodes(lineage.edges[number].first_node, n_edge_nodes(lineage.edges[number]), owner);
    if (const Index number = split.hex_faces[cut][side.face]; number >= 0)
      set_nodes(lineage.faces[number].first_node, lineage.table->face[lineage.faces[number].code].at.size(), owner);
  }
}

/// Curve edges and their nodes.
void carry_curve_edges(const Association& old, const Lineage& lineage, Association& association) {
  struct Owned {
    Edge edge;
    int curve;
  };
  std::vector<Owned> owned;
  for (std::size_t i = 0; i < old.curve_edges.size(); ++i) {
    for_each_child_edge(lineage, old.curve_edges[i], [&](const Edge& edge) {
      owned.push_back({edge, old.edge_curve[i]});
      for (const Index node : edge)
        if (node >= lineage.n_old_nodes) association.node_owner[node] = {1, old.edge_curve[i]};
    });
  }
  std::ranges::sort(owned, {}, &Owned::edge);
  for (const Owned& item : owned) {
    association.curve_edges.push_back(item.edge);
    association.edge_curve.push_back(item.curve);
  }
}

void carry_surface_faces(const Association& old, const Split& split, const Mesh& mesh, Association& association) {
  struct Owned {
    Side side;
    int surface;
  };
  std::vector<Owned> owned;
  for (std::size_t i = 0; i < old.surface_faces.size(); ++i)
    for_each_child_side(split, old.surface_faces[i], [&](Side side) { owned.push_back({side, old.face_surface[i]}); });

  // A face between volumes is named by the lower hex. Where that one was cut (so its children come last) and the one
  // behind was not, the other side has become the lower one.
  const bool several_volumes =
      std::ranges::adjacent_find(old.hex_volume, std::ranges::not_equal_to{}) != old.hex_volume.end();
  if (several_volumes) {
    std::vector<std::size_t> moved;
    std::vector<Quad> quads;
    for (std::size_t i = 0; i < owned.size(); ++i)
      if (owned[i].side.hex >= split.n_kept()) {
        moved.push_back(i);
        quads.push_back(face_nodes(mesh.hexes[owned[i].side.hex], owned[i].side.face));
      }
    const std::vector<Side> sides = quads.empty() ? std::vector<Side>{} : find_sides(mesh, quads);
    for (std::size_t i = 0; i < moved.size(); ++i) owned[moved[i]].side = sides[i];
  }
  if (several_volumes)
    std::ranges::sort(owned, {}, &Owned::side);
  else
    sort_sides(owned, split.n_kept(), &Owned::side);
  association.surface_faces.reserve(owned.size());
  association.face_surface.reserve(owned.size());
  for (const Owned& item : owned) {
    association.surface_faces.push_back(item.side);
    association.face_surface.push_back(item.surface);
  }
}

Association carried_association(const Association& old, const Split& split, const Mesh& mesh) {
  Association association;
  if (old.empty()) return association;
  association.node_owner = of_old_nodes(old.node_owner, split.n_nodes);
  association.node_parameters = of_old_nodes(old.node_parameters, split.n_nodes);
  resize_for_overwrite(association.hex_volume, split.lineage.parent.size());
  parallel_each(split.lineage.parent.size(),
                [&](std::size_t h) { association.hex_volume[h] = old.hex_volume[split.lineage.parent[h]]; });
  carry_node_owners(old, split, association);
  carry_curve_edges(old, split.lineage, association);
  carry_surface_faces(old, split, mesh, association);
  return association;
}

}  // namespace

Carried carry(const Mesh& old_mesh, const Association& old_association, Split& split) {
  Carried carried;
  Mesh& mesh = carried.mesh;
  mesh.hexes = std::move(split.hexes);
  mesh.points = of_old_nodes(old_mesh.points, split.n_nodes);
  carried.association = carried_association(old_association, split, mesh);
  for_each_new_node(old_mesh, split.lineage, [&](Index node, const Origin& origin) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < origin.n; ++i) sum += origin.weight[i] * old_mesh.points[origin.node[i]];
    mesh.points[node] = sum;
  });
  carry_ids(old_mesh, split, mesh);
  carry_blocks(old_mesh, split, mesh);
  carry_side_sets(old_mesh, split, mesh);
  carry_node_sets(old_mesh, split.lineage, mesh);
  carry_fields(old_mesh, split.lineage, mesh);
  return carried;
}

}  // namespace hextwist
