#include "hextwist/mesh/association/meant.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "hextwist/base/union_find.h"
#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

/// One number per entity, by dimension and id.
template <class T>
struct PerEntity {
  std::array<std::vector<T>, 4> of;
  explicit PerEntity(const std::array<int, 4>& n) {
    for (int dim = 0; dim < 4; ++dim) of[dim].assign(static_cast<std::size_t>(n[dim]) + 1, T{});
  }
  auto& operator[](Owner entity) { return of[entity.dim][entity.id]; }
};

/// Which nodes are in a set, and what that says of entities.
class Members {
 public:
  Members(const Mesh& mesh, const Association& association, const std::vector<Index>& nodes)
      : mesh_(mesh),
        association_(association),
        member_(mesh.points.size(), 0),
        n_(highest_ids()),
        own_(n_),
        lacks_(n_) {
    for (const Index n : nodes) member_[n] = 1;
    for (std::size_t n = 0; n < association.node_owner.size(); ++n) {
      const Owner owner = association.node_owner[n];
      if (!owner) continue;
      ++own_[owner];
      if (!member_[n]) lacks_[owner] = 1;
    }
    for_each_item([&](Owner entity, std::span<const Index> around) {
      for (const Index n : around)
        if (!member_[n]) lacks_[entity] = 1;
    });
  }

  bool holds(Owner entity) { return entity.id >= 1 && entity.id <= n_[entity.dim] && !lacks_[entity]; }

  std::vector<Owner> meant(std::vector<Owner>* left_out) {
    // By rule 1; per node a bit for each dimension of such an entity that it is on.
    std::vector<std::uint8_t> on(mesh_.points.size(), 0);
    const auto is_plain = [&](Owner entity) { return own_[entity] > 0 && !lacks_[entity]; };
    for_each_item([&](Owner entity, std::span<const Index> around) {
      if (is_plain(entity))
        for (const Index n : around) on[n] |= static_cast<std::uint8_t>(1 << entity.dim);
    });
    // By rule 2: of which entities do others have all nodes?
    PerEntity<std::uint8_t> is_there(n_), on_no_surface(n_), on_no_curve(n_);
    for_each_item([&](Owner entity, std::span<const Index> around) {
      is_there[entity] = 1;
      if (own_[entity] > 0 || lacks_[entity]) return;
      for (const Index n : around) {
        if (!(on[n] & 1 << 2)) on_no_surface[entity] = 1;
        if (!(on[n] & 1 << 1)) on_no_curve[entity] = 1;
      }
    });
    const Rings rings = find_rings([&](int surface) {
      const Owner entity{2, surface};
      return own_[entity] == 0 && !lacks_[entity] && on_no_surface[entity];
    });
    std::vector<Owner> result;
    for (int dim = 1; dim <= 3; ++dim)
      for (int id = 1; id <= n_[dim]; ++id) {
        const Owner entity{dim, id};
        if (!is_there[entity] || lacks_[entity]) continue;
        const bool by_surfaces = !on_no_surface[entity], by_curves = !on_no_curve[entity];
        const bool in_ring = dim == 2 && rings.surface[id];
        const bool is_others = by_surfaces || in_ring || (dim == 1 && (by_curves || rings.across[id]));
        if (own_[entity] > 0 || !is_others)
          result.push_back(entity);
        else if (left_out && (dim == 3 || in_ring))
          left_out->push_back(entity);
      }
    return result;
  }

 private:
  std::array<int, 4> highest_ids() const {
    std::array<int, 4> n{};
    for (const Owner owner : association_.node_owner)
      if (owner) n[owner.dim] = std::max(n[owner.dim], owner.id);
    for (const int id : association_.edge_curve) n[1] = std::max(n[1], id);
    for (const int id : association_.face_surface) n[2] = std::max(n[2], id);
    for (const int id : association_.hex_volume) n[3] = std::max(n[3], id);
    return n;
  }
  /// Calls use(entity, nodes) for the edges of curves, the faces of surfaces, the hexes of volumes.
  template <class Use>
  void for_each_item(const Use& use) const {
    for (std::size_t i = 0; i < association_.curve_edges.size(); ++i)
      use(Owner{1, association_.edge_curve[i]}, association_.curve_edges[i]);
    for (std::size_t i = 0; i < association_.surface_faces.size(); ++i) {
      const Side side = association_.surface_faces[i];
      use(Owner{2, association_.face_surface[i]}, face_nodes(mesh_.hexes[side.hex], side.face));
    }
    for (std::size_t h = 0; h < association_.hex_volume.size(); ++h)
      if (association_.hex_volume[h] > 0) use(Owner{3, association_.hex_volume[h]}, mesh_.hexes[h]);
  }
  /// Surfaces that together have more than one rim, and the curves that lead across them from one to another.
  struct Rings {
    std::vector<std::uint8_t> surface, across;  // by id
  };
  template <class Wanted>
  Rings find_rings(const Wanted& is_wanted) const {
    Rings rings{std::vector<std::uint8_t>(static_cast<std::size_t>(n_[2]) + 1, 0),
                std::vector<std::uint8_t>(static_cast<std::size_t>(n_[1]) + 1, 0)};
    std::vector<std::pair<Edge, int>> uses;  // of edges by surfaces
    for (std::size_t i = 0; i < association_.surface_faces.size(); ++i) {
      if (!is_wanted(association_.face_surface[i])) continue;
      const Side side = association_.surface_faces[i];
      const auto cycle = face_node_cycle(mesh_.hexes[side.hex], side.face);
      for (std::size_t k = 0; k < 4; ++k)
        uses.push_back({{std::min(cycle[k], cycle[(k + 1) % 4]), std::max(cycle[k], cycle[(k + 1) % 4])},
                        association_.face_surface[i]});
    }
    if (uses.empty()) return rings;
    std::ranges::sort(uses);
    // Surfaces that share an edge go together; edges of one face alone are the rims.
    std::vector<Index> group = singletons(n_[2] + 1), node = singletons(mesh_.n_nodes());
    std::vector<std::pair<Edge, int>> rim, inside;
    for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
      while (j < uses.size() && uses[j].first == uses[i].first) join(group, uses[i].second, uses[j++].second);
      (j - i > 1 ? inside : rim).push_back(uses[i]);
      if (j - i == 1) join(node, uses[i].first[0], uses[i].first[1]);
    }
    std::vector<Index> first_rim(static_cast<std::size_t>(n_[2]) + 1, -1);
    std::vector<std::uint8_t> is_ring(first_rim.size(), 0);  // by group
    for (const auto& [edge, surface] : rim) {
      Index& first = first_rim[find_root(group, surface)];
      if (first < 0) first = find_root(node, edge[0]);
      if (first != find_root(node, edge[0])) is_ring[find_root(group, surface)] = 1;
    }
    for (const auto& use : uses) rings.surface[use.second] = is_ring[find_root(group, use.second)];
    std::erase_if(inside, [&](const auto& use) { return !rings.surface[use.second]; });
    for (std::size_t i = 0; i < association_.curve_edges.size(); ++i)
      if (std::ranges::binary_search(inside, association_.curve_edges[i], {}, &std::pair<Edge, int>::first))
        rings.across[association_.edge_curve[i]] = 1;
    return rings;
  }

  const Mesh& mesh_;
  const Association& association_;
  std::vector<std::uint8_t> member_;
  std::array<int, 4> n_;
  PerEntity<Index> own_;           // nodes that it owns
  PerEntity<std::uint8_t> lacks_;  // nodes of it that are not in the set: any?
};

/// Those of the highest dimension: the others are mostly their rims.
std::string text_of(const std::vector<Owner>& entities) {
  constexpr std::size_t most = 6;
  std::string text;
  std::size_t n = 0;
  for (const Owner entity : entities)
    if (entity.dim == entities.back().dim && n++ < most) text += (n > 1 ? ", " : "") + to_string(entity);
  return text.empty() ? "single nodes" : text + (n > most ? ", ..." : "");
}

}  // namespace

std::vector<Owner> meant_entities(const Mesh& mesh, const Association& association, const std::vector<Index>& nodes,
                                  std::vector<Owner>* left_out) {
  return Members(mesh, association, nodes).meant(left_out);
}

std::vector<Owner> held_entities(const Mesh& mesh, const Association& association, const std::vector<Index>& nodes,
                                 const std::vector<Owner>& entities) {
  Members members(mesh, association, nodes);
  std::vector<Owner> held;
  std::ranges::copy_if(entities, std::back_inserter(held), [&](Owner entity) { return members.holds(entity); });
  return held;
}

std::string left_out_text(const NodeSet& set, const std::vector<Owner>& meant, const std::vector<Owner>& left_out) {
  const std::string id = std::to_string(set.id);
  return "nodeset " + id + (set.name.empty() ? "" : " '" + set.name + "'") + " is taken as " + text_of(meant) +
         ", not as " + text_of(left_out) +
         ", which has no nodes but these: what is new between them will not join it ('nodeset " + id + " add " +
         to_string(left_out.front()) + "' if it should)";
}

void find_meant_entities(Mesh& mesh, const Association& association, std::vector<std::string>& notices) {
  for (NodeSet& set : mesh.node_sets) {
    if (!set.meant.empty() || set.nodes.empty()) continue;
    std::vector<Owner> left_out;
    set.meant = meant_entities(mesh, association, set.nodes, &left_out);
    if (!left_out.empty()) notices.push_back(left_out_text(set, set.meant, left_out));
  }
}

}  // namespace hextwist
