// Who owns what, in both directions, and how far nodes are from their owners.
#include <algorithm>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/association/association_internal.h"
#include "hextwist/mesh/association/off_model.h"

namespace hextwist {

Owner owner_of_node(const Association& association, Index node) {
  return node >= 0 && node < static_cast<Index>(association.node_owner.size()) ? association.node_owner[node] : Owner{};
}

Owner owner_of_face(const Association& association, const Faces& faces, Index face) {
  const Side side = faces.sides[face][0];
  if (const int surface = value_of(association.surface_faces, association.face_surface, side)) return {2, surface};
  const int volume = association.hex_volume.empty() ? 0 : association.hex_volume[side.hex];
  return volume ? Owner{3, volume} : Owner{};
}

Owner owner_of_edge(const Association& association, const Mesh& mesh, const Edges& edges, const Faces& faces,
                    Index edge) {
  const Edge& nodes = edges.nodes[edge];
  if (const int curve = value_of(association.curve_edges, association.edge_curve, nodes)) return {1, curve};
  for (const Index node : nodes)
    if (owner_of_node(association, node).dim == 3) return association.node_owner[node];
  for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
    const Side side = association.surface_faces[i];
    const Quad& quad = faces.nodes[faces.of_hex[side.hex][side.face]];
    // Neighbours in the bit frame differ in one bit.
    const auto a = std::ranges::find(quad, nodes[0]) - quad.begin(),
               b = std::ranges::find(quad, nodes[1]) - quad.begin();
    if (a < 4 && b < 4 && (a ^ b) != 3) return {2, association.face_surface[i]};
  }
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (std::ranges::find(edges.of_hex[h], edge) != edges.of_hex[h].end())
      return h < static_cast<Index>(association.hex_volume.size()) && association.hex_volume[h]
                 ? Owner{3, association.hex_volume[h]}
                 : Owner{};
  return {};
}

std::vector<Index> nodes_owned_by(const Association& association, Owner entity) {
  std::vector<Index> nodes;
  for (std::size_t n = 0; n < association.node_owner.size(); ++n)
    if (association.node_owner[n] == entity) nodes.push_back(static_cast<Index>(n));
  return nodes;
}

std::vector<Index> nodes_on(const Association& association, const Model& model, Owner entity) {
  std::array<std::vector<char>, 4> wanted;
  for (int dim = 0; dim < 4; ++dim) wanted[dim].assign(model.count(dim) + 1, 0);
  wanted[entity.dim][entity.id] = 1;
  for (int dim = 0; dim < entity.dim; ++dim)
    for (const int id : model.adjacent(entity, dim)) wanted[dim][id] = 1;
  return indices_where(static_cast<Index>(association.node_owner.size()), [&](Index n) {
    const Owner owner = association.node_owner[n];
    if (owner.dim > entity.dim) return false;  // most nodes of most meshes
    return owner && wanted[owner.dim][owner.id];
  });
}

namespace {

OffModel off_model_at(const Mesh& mesh, const Association& association, const Model& model,
                      const std::array<std::vector<Index>, 3>& nodes) {
  OffModel off;
  const double size = model.box().diagonal();
  for (int dim = 0; dim < 3; ++dim) {
    std::vector<int> id;
    std::vector<Vec3> points;
    for (const Index n : nodes[dim]) {
      id.push_back(association.node_owner[n].id);
      points.push_back(mesh.points[n]);
    }
    // Seeded by the stored parameters, which is fast; they may be wrong, so far nodes are projected again without.
    std::vector<Parameters> seeds;
    if (association.node_parameters.size() == association.node_owner.size())
      for (const Index n : nodes[dim]) seeds.push_back(association.node_parameters[n]);
    const auto at = detail::project_all(model, dim, id, points, seeds);
    for (std::size_t i = 0; i < at.size(); ++i) {
      double distance = at[i].distance;
      if (!seeds.empty() && !(distance <= std::max(off.max, 1e-9 * size)))
        distance = std::min(distance, model.project({dim, id[i]}, points[i]).distance);
      if (off.node < 0 || distance > off.max) off = {distance, 0, nodes[dim][i], {dim, id[i]}};
    }
  }
  if (off.max > 0) off.max_relative = off.max / size;
  return off;
}

}  // namespace

OffModel off_model(const Mesh& mesh, const Association& association, const Model& model) {
  std::array<std::vector<Index>, 3> nodes;
  for (std::size_t n = 0; n < association.node_owner.size(); ++n) {
    const int dim = association.node_owner[n].dim;
    if (dim >= 0 && dim <= 2) nodes[dim].push_back(static_cast<Index>(n));
  }
  return off_model_at(mesh, association, model, nodes);
}

OffModel detail::off_model(const Mesh& mesh, const Association& association, const Model& model,
                           std::span<const Index> wanted) {
  std::array<std::vector<Index>, 3> nodes;
  for (const Index n : wanted)
    if (const int dim = association.node_owner[n].dim; dim >= 0 && dim <= 2) nodes[dim].push_back(n);
  return off_model_at(mesh, association, model, nodes);
}

}  // namespace hextwist
