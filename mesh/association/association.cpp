#include "hextwist/mesh/association/association.h"

#include <algorithm>

#include "hextwist/base/large_array.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/association/association_internal.h"

namespace hextwist {
namespace {

using namespace detail;

/// Tag per quad, 0 none.
std::vector<int> quad_tags(const Skin& skin, const Tags& tags) {
  std::vector<int> result(skin.quads.size(), 0);
  if (tags.face_surface.empty()) return {};
  for (std::size_t q = 0; q < result.size(); ++q) {
    const auto at = std::ranges::lower_bound(tags.face_surface, std::pair(skin.faces[q], 0));
    if (at != tags.face_surface.end() && at->first == skin.faces[q]) result[q] = at->second;
  }
  return result;
}

/// Tag per skin edge, 0 none. Both lists ascend by the mesh's nodes.
std::vector<int> edge_tags(const Skin& skin, const SkinEdges& edges, const Tags& tags) {
  std::vector<int> result(edges.nodes.size(), 0);
  auto tag = tags.edge_curve.begin();
  for (std::size_t e = 0; e < result.size() && tag != tags.edge_curve.end(); ++e) {
    const Edge nodes = {skin.nodes[edges.nodes[e][0]], skin.nodes[edges.nodes[e][1]]};
    while (tag != tags.edge_curve.end() && tag->first < nodes) ++tag;
    if (tag != tags.edge_curve.end() && tag->first == nodes) result[e] = tag->second;
  }
  return result;
}

std::vector<Index> boundary(const Faces& faces) {
  return indices_where(static_cast<Index>(faces.sides.size()), [&](Index f) { return faces.sides[f][1].hex < 0; });
}

std::vector<Index> faces_between(const Faces& faces, std::span<const int> hex_volume) {
  return indices_where(static_cast<Index>(faces.sides.size()), [&](Index f) {
    const auto& [first, second] = faces.sides[f];
    return second.hex >= 0 && hex_volume[first.hex] != hex_volume[second.hex];
  });
}

/// The skin with its surfaces, and the volumes.
struct Parted {
  Skin skin;
  SurfaceMatch surfaces;
  std::vector<int> hex_volume;
  std::string problem;  ///< "" or why the walls cannot be right
};

Parted part(const ModelFacts& facts, const Mesh& mesh, const Faces& faces, std::vector<Index> walls, const Tags& tags) {
  Parted result;
  auto selected = boundary(faces);
  selected.insert(selected.end(), walls.begin(), walls.end());
  result.skin = make_skin(mesh, faces, selected);
  result.surfaces = match_surfaces(facts, result.skin, quad_tags(result.skin, tags));
  const auto& quad_surface = result.surfaces.quad_surface;
  for (Index q = 0; q < result.skin.n_quads(); ++q)
    if (quad_surface[q] == 0) {
      if (faces.sides[result.skin.faces[q]][1].hex < 0) throw_off_model(facts, mesh, result.skin, quad_surface);
      result.problem = "face of hex " + std::to_string(hex_id(mesh, result.skin.sides[q].hex)) +
                       " parts volumes, but lies on no surface";
      return result;
    }
  result.problem = match_volumes(facts, mesh, faces, result.skin, quad_surface, result.hex_volume);
  return result;
}

/// Takes out walls that have one volume on both sides, but for those on embedded surfaces.
void drop_false_walls(const ModelFacts& facts, const Mesh& mesh, const Faces& faces, Parted& parted) {
  const auto is_wall = [&](Index q) {
    const auto& [first, second] = faces.sides[parted.skin.faces[q]];
    return second.hex < 0 || parted.hex_volume[first.hex] != parted.hex_volume[second.hex] ||
           facts.is_embedded(parted.surfaces.quad_surface[q]);
  };
  const std::vector<Index> walls = indices_where(parted.skin.n_quads(), is_wall);
  if (std::ssize(walls) == parted.skin.n_quads()) return;
  std::vector<Index> kept;
  Parted old = std::move(parted);
  parted = {{}, {}, std::move(old.hex_volume), {}};
  for (const Index q : walls) {
    kept.push_back(old.skin.faces[q]);
    parted.surfaces.quad_surface.push_back(old.surfaces.quad_surface[q]);
  }
  parted.skin = make_skin(mesh, faces, kept);  // the order stays
  for (const Index node : parted.skin.nodes)
    parted.surfaces.node_at.push_back(old.surfaces.node_at[position_in(old.skin.nodes, node)]);
}

Parted part_by_tags_or_geometry(const ModelFacts& facts, const Mesh& mesh, const Faces& faces, const Tags& tags,
                                std::vector<std::string>& notices) {
  const std::vector<Index> embedded = facts.embedded.empty() ? std::vector<Index>() : find_walls(facts, mesh, faces);
  if (facts.model.count(3) == 1) return part(facts, mesh, faces, embedded, tags);
  if (!tags.hex_volume.empty()) {
    Parted parted = part(facts, mesh, faces, union_of(faces_between(faces, tags.hex_volume), embedded), tags);
    if (parted.problem.empty()) return parted;
    notices.push_back("the geometry contradicts the volume tags: " + parted.problem + "; all ignored");
  }
  Parted parted = part(facts, mesh, faces, find_walls(facts, mesh, faces), tags);
  if (!parted.problem.empty()) throw Error(parted.problem);
  return parted;
}

/// Surfaces that can only lie inside their volume: no face of the boundary is on them.
std::vector<char> unused_surfaces(const ModelFacts& facts, const Parted& parted) {
  std::vector<char> unused(facts.surface_volumes.size(), 1);
  for (const int surface : parted.surfaces.quad_surface) unused[surface - 1] = 0;
  for (std::size_t s = 0; s < unused.size(); ++s)
    if (facts.surface_volumes[s].size() != 1) unused[s] = 0;
  if (std::ranges::find(unused, 1) == unused.end()) unused.clear();
  return unused;
}

/// The skin with everything that lies on it.
struct Matched {
  Parted parted;
  SkinEdges edges;
  CurveMatch curves;
};
Matched match(const ModelFacts& facts, const Mesh& mesh, const Faces& faces, const Tags& tags,
              std::vector<std::string>& notices) {
  Matched result{part_by_tags_or_geometry(facts, mesh, faces, tags, notices), {}, {}};
  drop_false_walls(facts, mesh, faces, result.parted);
  const Skin& skin = result.parted.skin;
  result.edges = make_edges(skin);
  result.curves =
      match_curves(facts, mesh, skin, result.edges, result.parted.surfaces, edge_tags(skin, result.edges, tags));
  return result;
}

/// Surfaces embedded in a volume own faces inside the mesh, where it follows them.
Matched match_with_embedded(ModelFacts& facts, const Mesh& mesh, const Faces& faces, const Tags& tags,
                            std::vector<std::string>& notices) {
  Matched result = match(facts, mesh, faces, tags, notices);
  facts.embedded = unused_surfaces(facts, result.parted);
  if (facts.embedded.empty()) return result;
  const std::vector<int>& volume = result.parted.hex_volume;
  if (std::ranges::all_of(find_walls(facts, mesh, faces), [&](Index face) {
        return volume[faces.sides[face][0].hex] != volume[faces.sides[face][1].hex];
      })) {
    facts.embedded.clear();
    return result;
  }
  std::vector<std::string> told_again;
  try {
    return match(facts, mesh, faces, tags, told_again);
  } catch (const Error& error) {
    notices.push_back("faces of the CAD inside its volumes own nothing of the mesh, which does not follow them: " +
                      std::string(error.what()));
    facts.embedded.clear();
    return result;
  }
}

/// Every node of a hex to a volume of one of its hexes; where these differ, the node is on a surface and gets another
/// owner later.
void own_by_volumes(const Mesh& mesh, Association& association) {
  resize_large(association.node_owner, mesh.points.size());
  const auto set = [](int& target, int value) { std::atomic_ref(target).store(value, std::memory_order_relaxed); };
  parallel_each(mesh.hexes.size(), [&](std::size_t h) {
    for (const Index node : mesh.hexes[h]) {
      set(association.node_owner[node].dim, 3);
      set(association.node_owner[node].id, association.hex_volume[h]);
    }
  });
}

}  // namespace

AssociateResult associate(const Mesh& mesh, const Model& model, const Association* given,
                          const AssociateOptions& options) {
  if (mesh.hexes.empty()) throw Error("the mesh has no hexes to associate");
  if (model.count(3) == 0) throw Error("the model has no volume");
  AssociateResult result;
  ModelFacts facts(model, options.relative_tolerance);
  const Faces made = options.faces ? Faces() : faces(mesh);
  const Faces& mesh_faces = options.faces ? *options.faces : made;
  Tags tags;
  if (given && options.use_tags) tags = usable_tags(mesh, mesh_faces, model, *given, result.notices);

  Matched matched = match_with_embedded(facts, mesh, mesh_faces, tags, result.notices);
  auto& [parted, edges, curves] = matched;
  const Skin& skin = parted.skin;

  Association& association = result.association;
  association.hex_volume = std::move(parted.hex_volume);
  association.surface_faces = skin.sides;
  association.face_surface = parted.surfaces.quad_surface;
  for (std::size_t e = 0; e < edges.nodes.size(); ++e)
    if (curves.edge_curve[e]) {
      association.curve_edges.push_back({skin.nodes[edges.nodes[e][0]], skin.nodes[edges.nodes[e][1]]});
      association.edge_curve.push_back(curves.edge_curve[e]);
    }
  own_by_volumes(mesh, association);
  resize_large(association.node_parameters, mesh.points.size());
  for (Index n = 0; n < skin.n_nodes(); ++n) {
    const Index node = skin.nodes[n];
    association.node_owner[node] = curves.node_owner[n];
    if (curves.node_owner[n].dim > 0) association.node_parameters[node] = curves.node_at[n].parameters;
    if (curves.node_at[n].distance > result.max_distance || result.worst_node < 0) {
      result.max_distance = curves.node_at[n].distance;
      result.worst_node = node;
    }
  }
  if (facts.loosest > facts.tolerance)
    result.notices.push_back("the CAD is loose: its curve " + std::to_string(facts.loosest_curve) + " may lie " +
                             short_number(facts.loosest) + " off its surfaces, and so may the mesh");
  compare_with_tags(mesh, mesh_faces, tags, association, result.notices);
  notice_coverage(facts, mesh, association, result.notices);
  return result;
}

}  // namespace hextwist
