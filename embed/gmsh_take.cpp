#include <algorithm>
#include <map>
#include <set>

#include "hextwist/base/sorted.h"
#include "hextwist/embed/gmsh_exchange.h"
#include "hextwist/embed/gmsh_internal.h"
#include "hextwist/geom/occ/model.h"
#include "hextwist/geom/renumbered_model.h"
#include "hextwist/io/gmsh/gmsh.h"
#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

using namespace gmsh_detail;

std::string name(const GmshEntity& entity) {
  return to_string(Owner{entity.dim, entity.tag});
}

/// The mesh, its tags, and what has to be remembered, from the arrays of all entities.
class Reading {
 public:
  MeshFile file;
  GmshLink link;
  std::vector<Quad> cycles;  ///< per quad with a tag, in the order of tags.surface_faces: as Gmsh has it

  explicit Reading(const GmshModel& gmsh) : gmsh_(gmsh) {
    hexes();
    nodes();
    for (const GmshEntity& entity : gmsh.entities) boundary(entity);
    place_elements();
    sort_tags();
    groups();
  }

 private:
  const GmshModel& gmsh_;
  std::vector<std::array<Index, 2>> lines_;  // per curve edge, as Gmsh has it
  std::vector<std::size_t> own_;             // tags of the nodes of hexes, ascending
  std::vector<std::pair<const GmshEntity*, std::size_t>> line_source_, quad_source_;  // entity and tag

  Index find(std::size_t node) const { return position_in(own_, node); }

  void hexes() {
    struct Found {
      std::size_t tag;
      const std::size_t* nodes;
      int volume;
    };
    std::vector<Found> found;
    for (const GmshEntity& entity : gmsh_.entities)
      for (std::size_t t = 0; t < entity.element_types.size(); ++t) {
        const io::GmshType* type = io::gmsh_type(entity.element_types[t]);
        const auto& tags = entity.element_tags[t];
        for (const std::size_t tag : tags) link.last_element = std::max(link.last_element, tag);
        if (tags.empty() || (type && type->dim < 3)) continue;
        if (entity.element_types[t] != io::gmsh_hex || entity.dim != 3)
          throw Error("element " + std::to_string(tags.front()) + " of " + name(entity) + " is a " +
                      (type ? type->name : "type " + std::to_string(entity.element_types[t])) +
                      "; only 8-node hexes in volumes are accepted");
        for (std::size_t i = 0; i < tags.size(); ++i)
          found.push_back({tags[i], entity.element_nodes[t].data() + 8 * i, entity.tag});
        link.entities.push_back({3, entity.tag});
      }
    if (found.empty()) throw Error("there are no hexes in Gmsh's model: generate the mesh first");
    std::ranges::sort(found, {}, &Found::tag);
    for (const Found& hex : found) own_.insert(own_.end(), hex.nodes, hex.nodes + 8);
    sort_unique(own_);
    Mesh& mesh = file.mesh;
    for (const Found& hex : found) {
      Hex& to = mesh.hexes.emplace_back();
      for (int c = 0; c < n_hex_corners; ++c) to[file_corner[c]] = find(hex.nodes[c]);
      mesh.hex_ids.push_back(static_cast<std::int64_t>(hex.tag));
      file.tags.hex_volume.push_back(hex.volume);
    }
    link.last_hex = found.back().tag;
  }

  void nodes() {
    Mesh& mesh = file.mesh;
    mesh.node_ids.assign(own_.begin(), own_.end());
    mesh.points.assign(own_.size(), Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    file.tags.node_owner.resize(own_.size());
    file.tags.node_parameters.resize(own_.size());
    link.last_own_node = mesh.node_ids.back();
    for (const GmshEntity& entity : gmsh_.entities)
      for (std::size_t i = 0; i < entity.node_tags.size(); ++i) {
        link.last_node = std::max(link.last_node, entity.node_tags[i]);
        const Index node = find(entity.node_tags[i]);
        if (node < 0) {
          link.other_nodes.push_back(entity.node_tags[i]);
          continue;
        }
        mesh.points[node] = Vec3(entity.coord.data() + 3 * i);
        file.tags.node_owner[node] = {entity.dim, entity.tag};
      }
    sort_unique(link.other_nodes);
    for (std::size_t n = 0; n < own_.size(); ++n)
      if (!mesh.points[n].allFinite())
        throw Error("node " + std::to_string(own_[n]) + " of a hex is in no entity of Gmsh's model");
  }

  /// Points, lines and quads: all of an entity, or none.
  void boundary(const GmshEntity& entity) {
    if (entity.dim == 3) return;
    const auto is_own = [&](std::size_t node) { return find(node) >= 0; };
    bool touched = std::ranges::any_of(entity.node_tags, is_own);
    for (const auto& nodes : entity.element_nodes) touched = touched || std::ranges::any_of(nodes, is_own);
    if (!touched) return;
    link.entities.push_back({entity.dim, entity.tag});
    for (std::size_t t = 0; t < entity.element_types.size(); ++t) {
      const auto& tags = entity.element_tags[t];
      if (tags.empty()) continue;
      const int type = entity.element_types[t];
      if (type != io::gmsh_kept[entity.dim]) {
        const io::GmshType* known = io::gmsh_type(type);
        throw Error("element " + std::to_string(tags.front()) + " of " + name(entity) + " is a " +
                    (known ? known->name : "type " + std::to_string(type)) + ", which is not " +
                    (entity.dim == 2 ? "a side" : "an edge") + " of a hex");
      }
      elements(entity, tags, entity.element_nodes[t]);
    }
  }

  void elements(const GmshEntity& entity, const std::vector<std::size_t>& tags, const std::vector<std::size_t>& nodes) {
    const std::size_t width = entity.dim == 0 ? 1 : entity.dim == 1 ? 2 : 4;
    std::vector<Index> at;
    at.reserve(nodes.size());
    for (const std::size_t node : nodes) at.push_back(find(node));
    for (std::size_t i = 0; i < tags.size(); ++i) {
      const std::span<const Index> one(at.data() + width * i, width);
      if (std::ranges::find(one, -1) != one.end()) refuse(entity, tags[i]);
      link.elements[entity.dim].emplace_back(element_key(file.mesh, one), tags[i]);
    }
    for (std::size_t i = 0; i < tags.size() && entity.dim == 1; ++i) {
      lines_.push_back({at[2 * i], at[2 * i + 1]});
      file.tags.curve_edges.push_back({std::min(at[2 * i], at[2 * i + 1]), std::max(at[2 * i], at[2 * i + 1])});
      file.tags.edge_curve.push_back(entity.tag);
      line_source_.emplace_back(&entity, tags[i]);
    }
    for (std::size_t i = 0; i < tags.size() && entity.dim == 2; ++i) {
      cycles.push_back({at[4 * i], at[4 * i + 1], at[4 * i + 2], at[4 * i + 3]});
      file.tags.face_surface.push_back(entity.tag);
      quad_source_.emplace_back(&entity, tags[i]);
    }
  }

  /// All quads and lines at once: each search looks at every hex.
  void place_elements() {
    file.tags.surface_faces = find_sides(file.mesh, cycles);
    for (std::size_t i = 0; i < cycles.size(); ++i)
      if (file.tags.surface_faces[i].hex < 0) refuse(*quad_source_[i].first, quad_source_[i].second);
    const std::vector<char> good = io::are_edges(file.mesh, file.tags.curve_edges);
    for (std::size_t i = 0; i < good.size(); ++i)
      if (!good[i]) refuse(*line_source_[i].first, line_source_[i].second);
  }

  [[noreturn]] static void refuse(const GmshEntity& entity, std::size_t tag) {
    throw Error("element " + std::to_string(tag) + " of " + name(entity) + " is not " +
                (entity.dim == 2   ? "a side"
                 : entity.dim == 1 ? "an edge"
                                   : "a corner") +
                " of a hex");
  }

  void sort_tags() {
    for (auto& list : link.elements) std::ranges::sort(list);
    Association& tags = file.tags;
    sort_by(tags.surface_faces, [&](const auto& order) {
      reorder(tags.face_surface, order);
      reorder(cycles, order);
    });
    sort_by(tags.curve_edges, [&](const auto& order) {
      reorder(tags.edge_curve, order);
      reorder(lines_, order);
    });
  }

  template <class T>
  static void reorder(std::vector<T>& values, const std::vector<std::size_t>& order) {
    std::vector<T> sorted;
    sorted.reserve(order.size());
    for (const std::size_t i : order) sorted.push_back(values[i]);
    values = std::move(sorted);
  }
  /// Ascending, and once each: of elements on one face or edge the first counts.
  template <class T, class F>
  static void sort_by(std::vector<T>& keys, F others) {
    std::vector<std::size_t> order(keys.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    sort_unique(order, [&](std::size_t i) { return keys[i]; });
    reorder(keys, order);
    others(order);
  }

  /// Physical groups as blocks and sets.
  void groups() {
    Mesh& mesh = file.mesh;
    const Association& tags = file.tags;
    for (const int dim : {3, 2, 0, 1})
      for (const GmshGroup& group : gmsh_.groups) {
        if (group.dim != dim || group.tag < 1) continue;
        const std::set<int> of(group.entities.begin(), group.entities.end());
        if (dim == 3) {
          Block& block = io::group_of_id(mesh.blocks, group.tag);
          block.name = group.name;
          for (Index h = 0; h < mesh.n_hexes(); ++h)
            if (of.contains(tags.hex_volume[h])) block.hexes.push_back(h);
        } else if (dim == 2) {
          SideSet& set = io::group_of_id(mesh.side_sets, group.tag);
          set.name = group.name;
          std::vector<Quad> quads;
          for (std::size_t i = 0; i < cycles.size(); ++i)
            if (of.contains(tags.face_surface[i])) quads.push_back(cycles[i]);
          set.sides = io::oriented_sides(mesh, quads);
          sort_unique(set.sides);
        } else {
          const bool taken = std::ranges::find(mesh.node_sets, group.tag, &NodeSet::id) != mesh.node_sets.end();
          NodeSet& set = io::group_of_id(mesh.node_sets, taken ? io::free_id(mesh.node_sets) : group.tag);
          set.name = group.name;
          for (Index n = 0; n < mesh.n_nodes(); ++n)
            if (tags.node_owner[n].dim == dim && of.contains(tags.node_owner[n].id)) set.nodes.push_back(n);
          for (std::size_t e = 0; dim == 1 && e < tags.curve_edges.size(); ++e)
            if (of.contains(tags.edge_curve[e]))
              set.nodes.insert(set.nodes.end(), tags.curve_edges[e].begin(), tags.curve_edges[e].end());
          sort_unique(set.nodes);
        }
      }
  }

 public:
  const std::vector<std::array<Index, 2>>& lines() const { return lines_; }
};

/// Which entity of the model is which of Gmsh, from the nodes, edges, faces and hexes that lie on both.
class Matching {
 public:
  Matching(const MeshFile& file, const Association& found, const Model& model, bool on_cad) : on_cad_(on_cad) {
    for (int dim = 0; dim < 4; ++dim) tag_of[dim].assign(static_cast<std::size_t>(model.count(dim)), 0);
    const Association& tags = file.tags;
    for (std::size_t h = 0; h < found.hex_volume.size(); ++h) match(3, found.hex_volume[h], tags.hex_volume[h]);
    merge(2, tags.surface_faces, tags.face_surface, found.surface_faces, found.face_surface);
    merge(1, tags.curve_edges, tags.edge_curve, found.curve_edges, found.edge_curve);
    for (std::size_t n = 0; n < found.node_owner.size(); ++n)
      if (found.node_owner[n].dim == tags.node_owner[n].dim)
        match(found.node_owner[n].dim, found.node_owner[n].id, tags.node_owner[n].id);
  }
  std::array<std::vector<int>, 4> tag_of;

 private:
  bool on_cad_;
  std::array<std::map<int, int>, 4> id_of_;

  void match(int dim, int id, int tag) {
    if (dim < 0 || tag == 0) return;
    int& known = tag_of[dim][static_cast<std::size_t>(id - 1)];
    const auto [at, fresh] = id_of_[dim].try_emplace(tag, id);
    if (known == tag) return;
    if (known != 0 || (on_cad_ && !fresh))
      throw Error("the mesh is not classified as it lies on the CAD: elements of " + to_string(Owner{dim, tag}) +
                  (known != 0 ? " lie where those of " + to_string(Owner{dim, known}) + " do"
                              : " lie on several entities of it"));
    known = tag;
  }
  template <class Item>
  void merge(int dim, const std::vector<Item>& tagged, const std::vector<int>& tags, const std::vector<Item>& found,
             const std::vector<int>& ids) {
    std::size_t i = 0;
    for (std::size_t k = 0; k < tagged.size(); ++k) {
      while (i < found.size() && found[i] < tagged[k]) ++i;
      if (i < found.size() && found[i] == tagged[k]) match(dim, ids[i], tags[k]);
    }
  }
};

/// Ids by tags: a tag up to n is the id, the others take what is left, in ascending order.
Renumbering renumbering_of(const std::array<std::vector<int>, 4>& tag_of, std::vector<std::string>& notices) {
  Renumbering result;
  for (int dim = 0; dim < 4; ++dim) {
    const auto& tags = tag_of[dim];
    const auto n = tags.size();
    result.id[dim].assign(n, 0);
    result.name[dim].resize(n);
    std::vector<char> taken(n, 0);
    std::vector<std::pair<int, std::size_t>> others;
    for (std::size_t i = 0; i < n; ++i) {
      const auto tag = static_cast<std::size_t>(tags[i]);
      if (tag >= 1 && tag <= n && !taken[tag - 1]) {
        result.id[dim][i] = tags[i];
        taken[tag - 1] = 1;
      } else {
        others.emplace_back(tags[i] == 0 ? std::numeric_limits<int>::max() : tags[i], i);
      }
    }
    std::ranges::sort(others);
    std::size_t free = 0;
    std::string list;
    for (const auto& [tag, i] : others) {
      while (taken[free]) ++free;
      taken[free] = 1;
      result.id[dim][i] = static_cast<int>(free) + 1;
      if (tags[i] == 0) continue;
      result.name[dim][i] = "tag" + std::to_string(tag);
      list += (list.empty() ? "" : ", ") + std::to_string(tag) + " is " + std::to_string(free + 1);
    }
    if (!list.empty())
      notices.push_back(std::string(dimension_name(dim)) + " tags of Gmsh have gaps: in commands " + list +
                        "; or by name, as in '" + dimension_name(dim) + " tag" + std::to_string(others.front().first) +
                        "'");
  }
  return result;
}

/// Whether the elements of curves and surfaces run against them, by majority.
void find_turned(GmshLink& link, const Reading& reading, const MeshedModel& meshed) {
  const auto& [mesh, model, association] = meshed;
  std::array<std::vector<int>, 3> votes;
  for (const int dim : {1, 2}) votes[dim].assign(static_cast<std::size_t>(model->count(dim)), 0);
  const Association& tags = reading.file.tags;
  for (std::size_t i = 0, k = 0; k < tags.surface_faces.size(); ++k) {
    while (i < association.surface_faces.size() && association.surface_faces[i] < tags.surface_faces[k]) ++i;
    if (i == association.surface_faces.size() || association.surface_faces[i] != tags.surface_faces[k]) continue;
    const int surface = association.face_surface[i];
    const Quad own = surface_cycle(meshed, i);
    const auto at = std::ranges::find(own, reading.cycles[k][0]) - own.begin();
    votes[2][static_cast<std::size_t>(surface - 1)] += own[(at + 1) % 4] == reading.cycles[k][1] ? 1 : -1;
  }
  const std::vector<char> along = runs_along_curves(meshed);
  for (std::size_t i = 0, k = 0; k < tags.curve_edges.size(); ++k) {
    while (i < association.curve_edges.size() && association.curve_edges[i] < tags.curve_edges[k]) ++i;
    if (i == association.curve_edges.size() || association.curve_edges[i] != tags.curve_edges[k]) continue;
    const bool same = reading.lines()[k][0] == association.curve_edges[i][0];
    votes[1][static_cast<std::size_t>(association.edge_curve[i] - 1)] += same == static_cast<bool>(along[i]) ? 1 : -1;
  }
  for (const int dim : {1, 2})
    for (const int sum : votes[dim]) link.turned[dim].push_back(sum < 0);
}

}  // namespace

GmshLink take_gmsh(Session& session, const GmshModel& gmsh, const std::filesystem::path& brep) {
  Reading reading(gmsh);
  GmshLink& link = reading.link;
  link.on_cad = !brep.empty();
  std::vector<std::string> notices;
  MeshedModel meshed;
  meshed.mesh = reading.file.mesh;
  if (link.on_cad) {
    meshed.model = read_cad(brep).model;
    AssociateResult found = associate(meshed.mesh, *meshed.model);
    meshed.association = std::move(found.association);
    notices = std::move(found.notices);
  } else {
    FacetResult found = associate_with_own_skin(meshed.mesh, {.tags = &reading.file.tags});
    meshed.model = std::move(found.model);
    meshed.association = std::move(found.association);
  }
  const Matching matching(reading.file, meshed.association, *meshed.model, link.on_cad);
  const Renumbering ids = renumbering_of(matching.tag_of, notices);
  for (int dim = 0; dim < 4; ++dim) {
    link.tag_of[dim].resize(matching.tag_of[dim].size());
    for (std::size_t i = 0; i < link.tag_of[dim].size(); ++i)
      link.tag_of[dim][static_cast<std::size_t>(ids.id[dim][i] - 1)] = matching.tag_of[dim][i];
  }
  meshed.model = renumbered(meshed.model, ids);
  Association& association = meshed.association;
  for (Owner& owner : association.node_owner) owner = ids.of(owner);
  for (int& id : association.edge_curve) id = ids.of({1, id}).id;
  for (int& id : association.face_surface) id = ids.of({2, id}).id;
  for (int& id : association.hex_volume) id = ids.of({3, id}).id;
  link.model = meshed.model;
  find_turned(link, reading, meshed);
  session.take(std::move(meshed), link.on_cad, notices);
  return std::move(link);
}

}  // namespace hextwist
