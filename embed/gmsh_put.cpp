#include <cmath>
#include <numeric>

#include "hextwist/base/sorted.h"
#include "hextwist/embed/gmsh_exchange.h"
#include "hextwist/embed/gmsh_internal.h"
#include "hextwist/io/gmsh/gmsh.h"

namespace hextwist {

namespace gmsh_detail {

Quad surface_cycle(const MeshedModel& meshed, std::size_t i) {
  const auto& [mesh, model, association] = meshed;
  const Side side = association.surface_faces[i];
  Quad cycle = face_node_cycle(mesh.hexes[side.hex], side.face);
  const std::vector<int> volumes = model->adjacent({2, association.face_surface[i]}, 3);
  if (volumes.size() == 2 && association.hex_volume[side.hex] != volumes.front()) std::swap(cycle[1], cycle[3]);
  return cycle;
}

std::vector<char> runs_along_curves(const MeshedModel& meshed) {
  const auto& [mesh, model, association] = meshed;
  const auto& edges = association.curve_edges;
  std::vector<char> along(edges.size(), 1);
  std::vector<std::size_t> order(edges.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t e) { return association.edge_curve[e]; });
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    const int curve = association.edge_curve[order[first]];
    while (last < order.size() && association.edge_curve[order[last]] == curve) ++last;
    std::vector<Vec3> middles;
    for (std::size_t i = first; i < last; ++i) {
      const auto [a, b] = edges[order[i]];
      middles.push_back((mesh.points[a] + mesh.points[b]) / 2);
    }
    std::vector<Projection> at(middles.size());
    model->project({1, curve}, middles, {}, at);
    for (std::size_t i = first; i < last; ++i) {
      const auto [a, b] = edges[order[i]];
      along[order[i]] = model->tangent(curve, at[i - first].parameters.u).dot(mesh.points[b] - mesh.points[a]) >= 0;
    }
  }
  return along;
}

}  // namespace gmsh_detail

namespace {

using namespace gmsh_detail;

/// The mesh of a session as Gmsh is to have it.
class Writing {
 public:
  Writing(const MeshedModel& meshed, const GmshLink& link)
      : meshed_(meshed), mesh_(meshed.mesh), link_(link), last_node_(link.last_node), last_element_(link.last_element) {
    for (const auto& [dim, tag] : link.entities) at({dim, tag});
    for (int dim = 0; dim < 4; ++dim)
      for (int id = 1; id <= meshed.model->count(dim); ++id) home_[dim].push_back(home({dim, id}));
    number_nodes();
    nodes();
    hexes();
    quads();
    lines();
    points();
  }
  std::vector<GmshEntity> result() { return std::move(entities_); }

 private:
  const MeshedModel& meshed_;
  const Mesh& mesh_;
  const GmshLink& link_;
  std::size_t last_node_, last_element_;
  std::vector<GmshEntity> entities_;
  std::array<std::vector<std::size_t>, 4> home_;  // [dim][id - 1]: position in entities_ for nodes
  std::vector<std::size_t> node_tag_;

  std::size_t at(Owner entity) {
    const auto found = std::ranges::find_if(
        entities_, [&](const GmshEntity& each) { return each.dim == entity.dim && each.tag == entity.id; });
    if (found != entities_.end()) return static_cast<std::size_t>(found - entities_.begin());
    GmshEntity& made = entities_.emplace_back();
    made.dim = entity.dim;
    made.tag = entity.id;
    return entities_.size() - 1;
  }
  int tag(Owner entity) const { return link_.tag_of[entity.dim][static_cast<std::size_t>(entity.id - 1)]; }

  /// Where nodes of an entity of the model go: to that of Gmsh, or to one around it where Gmsh has none.
  std::size_t home(Owner entity) {
    if (tag(entity) != 0) return at({entity.dim, tag(entity)});
    for (int dim = entity.dim + 1; dim < 4; ++dim)
      for (const int id : meshed_.model->adjacent(entity, dim))
        if (tag({dim, id}) != 0) return at({dim, tag({dim, id})});
    return std::numeric_limits<std::size_t>::max();  // nothing lies on it
  }

  /// Nodes that were there keep their tags.
  void number_nodes() {
    for (Index n = 0; n < mesh_.n_nodes(); ++n) {
      const std::int64_t id = node_id(mesh_, n);
      const auto own = static_cast<std::size_t>(id);
      const bool free = id <= link_.last_own_node && !std::ranges::binary_search(link_.other_nodes, own);
      node_tag_.push_back(free ? own : ++last_node_);
    }
  }

  void nodes() {
    const Association& association = meshed_.association;
    for (Index n = 0; n < mesh_.n_nodes(); ++n) {
      const Owner owner = association.node_owner[n];
      if (!owner) continue;  // of no hex
      GmshEntity& entity = entities_.at(home_[owner.dim][static_cast<std::size_t>(owner.id - 1)]);
      entity.node_tags.push_back(node_tag_[n]);
      entity.coord.insert(entity.coord.end(), mesh_.points[n].data(), mesh_.points[n].data() + 3);
      if (!link_.on_cad || owner.dim == 0 || owner.dim == 3) continue;
      Parameters parameters = association.node_parameters[n];
      if (std::isnan(parameters.u)) parameters = meshed_.model->project(owner, mesh_.points[n]).parameters;
      entity.parametric.push_back(parameters.u);
      if (owner.dim == 2) entity.parametric.push_back(parameters.v);
    }
    // All nodes of an entity have parameters, or none.
    for (GmshEntity& entity : entities_)
      if (entity.parametric.size() != entity.node_tags.size() * static_cast<std::size_t>(entity.dim))
        entity.parametric.clear();
  }

  void add(Owner where, int type, std::size_t element_tag, std::span<const Index> element) {
    GmshEntity& entity = entities_[at_[where.dim].at(static_cast<std::size_t>(where.id - 1))];
    if (entity.element_types.empty()) {
      entity.element_types = {type};
      entity.element_tags.emplace_back();
      entity.element_nodes.emplace_back();
    }
    entity.element_tags[0].push_back(element_tag);
    for (const Index n : element) entity.element_nodes[0].push_back(node_tag_[n]);
  }
  std::array<std::vector<std::size_t>, 4> at_;  // [dim][id - 1]: position in entities_ for elements

  /// Makes the table above; false for entities that Gmsh does not have.
  bool known(Owner entity) {
    auto& table = at_[entity.dim];
    if (table.empty())
      for (std::size_t i = 0; i < link_.tag_of[entity.dim].size(); ++i)
        table.push_back(link_.tag_of[entity.dim][i] == 0 ? std::numeric_limits<std::size_t>::max()
                                                         : at({entity.dim, link_.tag_of[entity.dim][i]}));
    return tag(entity) != 0;
  }
  std::size_t element_tag(int dim, std::span<const Index> nodes) {
    const auto key = element_key(mesh_, nodes);
    const auto& list = link_.elements[dim];
    const Index at = position_in(list, key, [](const auto& each) { return each.first; });
    return at >= 0 ? list[at].second : ++last_element_;
  }

  void hexes() {
    for (Index h = 0; h < mesh_.n_hexes(); ++h) {
      const Owner volume{3, meshed_.association.hex_volume[h]};
      if (!known(volume)) throw Error(to_string(volume) + " is not a volume of Gmsh's model");
      const auto id = static_cast<std::size_t>(hex_id(mesh_, h));
      Hex corners;
      for (int c = 0; c < n_hex_corners; ++c) corners[c] = mesh_.hexes[h][file_corner[c]];
      add(volume, io::gmsh_hex, id <= link_.last_hex ? id : ++last_element_, corners);
    }
  }
  void quads() {
    const Association& association = meshed_.association;
    for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
      const Owner surface{2, association.face_surface[i]};
      if (!known(surface)) continue;
      Quad cycle = surface_cycle(meshed_, i);
      if (link_.turned[2][static_cast<std::size_t>(surface.id - 1)]) std::swap(cycle[1], cycle[3]);
      add(surface, io::gmsh_quad, element_tag(2, cycle), cycle);
    }
  }
  void lines() {
    const Association& association = meshed_.association;
    const std::vector<char> along = runs_along_curves(meshed_);
    for (std::size_t i = 0; i < association.curve_edges.size(); ++i) {
      const Owner curve{1, association.edge_curve[i]};
      if (!known(curve)) continue;
      Edge edge = association.curve_edges[i];
      if (static_cast<bool>(along[i]) == static_cast<bool>(link_.turned[1][static_cast<std::size_t>(curve.id - 1)]))
        std::swap(edge[0], edge[1]);
      add(curve, io::gmsh_line, element_tag(1, edge), edge);
    }
  }
  void points() {
    for (Index n = 0; n < mesh_.n_nodes(); ++n) {
      const Owner owner = meshed_.association.node_owner[n];
      if (owner.dim == 0 && known(owner))
        add(owner, io::gmsh_point, element_tag(0, std::span(&n, 1)), std::span(&n, 1));
    }
  }
};

}  // namespace

std::vector<GmshEntity> put_gmsh(const Session& session, const GmshLink& link) {
  const MeshedModel& meshed = session.meshed();
  if (meshed.mesh.n_hexes() == 0) throw Error("the session has no mesh to put back");
  if (meshed.model != link.model)
    throw Error("the session is on another model than Gmsh's by now: its mesh can't be put back");
  return Writing(meshed, link).result();
}

}  // namespace hextwist
