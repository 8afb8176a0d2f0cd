// Association of a mesh with the facet model of its own skin.
#include <algorithm>
#include <optional>

#include "hextwist/base/sorted.h"
#include "hextwist/geom/facet/model.h"
#include "hextwist/mesh/association/association_internal.h"
#include "hextwist/mesh/association/parameters.h"
#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

/// Volume of each hex: its block, in the blocks' order, where every hex is in exactly one; else 1.
std::vector<int> volumes_of_blocks(const Mesh& mesh) {
  std::vector<int> volume(mesh.hexes.size(), 0);
  int n = 0;
  for (const Block& block : mesh.blocks) {
    if (block.hexes.empty()) continue;
    ++n;
    for (const Index hex : block.hexes) {
      if (volume[hex] != 0) return std::vector<int>(mesh.hexes.size(), 1);
      volume[hex] = n;
    }
  }
  if (std::ranges::find(volume, 0) != volume.end()) return std::vector<int>(mesh.hexes.size(), 1);
  return volume;
}

/// The tags of volumes, numbered from 1.
std::vector<int> volumes_of_tags(std::span<const int> tags) {
  std::vector<int> known(tags.begin(), tags.end());
  sort_unique(known);
  std::vector<int> volume;
  for (const int tag : tags) volume.push_back(position_in(known, tag) + 1);
  return volume;
}

/// Tags as labels of the skin.
struct Labels {
  std::vector<int> quads;
  std::vector<Index> vertices;
  FacetLabels view;

  Labels(const Association& tags, std::span<const Side> sides) : quads(sides.size(), 0) {
    for (std::size_t q = 0; q < quads.size(); ++q) quads[q] = value_of(tags.surface_faces, tags.face_surface, sides[q]);
    for (std::size_t n = 0; n < tags.node_owner.size(); ++n)
      if (tags.node_owner[n].dim == 0) vertices.push_back(static_cast<Index>(n));
    view = {quads, tags.curve_edges, tags.edge_curve, vertices};
  }
  Labels(const Labels&) = delete;
};

/// Does any middle of an edge or a face lie elsewhere than straight edges and bilinear faces have it?
bool bends(const Mesh& mesh, const MiddleNodes& middles) {
  constexpr double straight = 1e-10;  // of the length
  const auto& x = mesh.points;
  for (std::size_t e = 0; e < middles.edges.size(); ++e) {
    const auto [a, b] = middles.edges[e];
    if ((middles.edge_points[e] - (x[a] + x[b]) / 2).norm() > straight * (x[b] - x[a]).norm()) return true;
  }
  for (std::size_t f = 0; f < middles.faces.size(); ++f) {
    const Quad& q = middles.faces[f];
    if ((middles.face_points[f] - (x[q[0]] + x[q[1]] + x[q[2]] + x[q[3]]) / 4).norm() >
        straight * (x[q[3]] - x[q[0]]).norm())
      return true;
  }
  return false;
}

}  // namespace

std::vector<Parameters> projected_parameters(const Model& model, const Mesh& mesh, std::span<const Owner> owners) {
  std::vector<Parameters> parameters(owners.size());
  for (int dim = 1; dim <= 2; ++dim) {
    std::vector<Index> nodes;
    std::vector<int> id;
    std::vector<Vec3> points;
    for (std::size_t n = 0; n < owners.size(); ++n)
      if (owners[n].dim == dim) {
        nodes.push_back(static_cast<Index>(n));
        id.push_back(owners[n].id);
        points.push_back(mesh.points[n]);
      }
    const auto at = detail::project_all(model, dim, id, points);
    for (std::size_t i = 0; i < nodes.size(); ++i) parameters[nodes[i]] = at[i].parameters;
  }
  return parameters;
}

FacetResult associate_with_own_skin(const Mesh& mesh, const SkinOptions& options) {
  if (mesh.hexes.empty()) throw Error("the mesh has no hexes to associate");
  FacetResult result;
  Association& association = result.association;
  const Association* tags = options.tags;
  association.hex_volume = tags ? volumes_of_tags(tags->hex_volume) : volumes_of_blocks(mesh);
  const auto& volume = association.hex_volume;

  const Faces made = options.faces ? Faces() : faces(mesh);
  const Faces& mesh_faces = options.faces ? *options.faces : made;
  std::vector<Quad> quads;
  std::vector<std::array<int, 2>> quad_volumes;
  // Hex by hex, so that the sides ascend.
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (int f = 0; f < n_hex_faces; ++f) {
      const auto& [first, second] = mesh_faces.sides[mesh_faces.of_hex[h][f]];
      const int front = second.hex < 0 ? 0 : volume[second.hex];
      if (first != Side{h, f} || front == volume[h]) continue;
      association.surface_faces.push_back(first);
      quads.push_back(face_node_cycle(mesh.hexes[h], f));
      quad_volumes.push_back({volume[h], front});
    }

  std::optional<Labels> labels;
  if (tags) labels.emplace(*tags, association.surface_faces);
  const bool curved = options.middles && bends(mesh, *options.middles);
  FacetMiddles middles;
  if (curved)
    middles = {options.middles->edges, options.middles->edge_points, options.middles->faces,
               options.middles->face_points};
  FacetImport import = facet_model(mesh.points, quads, quad_volumes,
                                   {.feature_angle = options.feature_angle,
                                    .labels = labels ? &labels->view : nullptr,
                                    .middles = curved ? &middles : nullptr});
  const FacetClassification& pieces = import.classification;
  association.face_surface = pieces.quad_surface;
  association.curve_edges = pieces.edges;
  association.edge_curve = pieces.edge_curve;

  // The lowest dimension wins.
  auto& owner = association.node_owner;
  owner.assign(mesh.points.size(), {});
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (const Index node : mesh.hexes[h]) owner[node] = {3, volume[h]};
  for (std::size_t q = 0; q < quads.size(); ++q)
    for (const Index node : quads[q]) owner[node] = {2, pieces.quad_surface[q]};
  for (std::size_t e = 0; e < pieces.edges.size(); ++e)
    for (const Index node : pieces.edges[e]) owner[node] = {1, pieces.edge_curve[e]};
  for (std::size_t v = 0; v < pieces.vertex_nodes.size(); ++v)
    owner[pieces.vertex_nodes[v]] = {0, static_cast<std::int32_t>(v + 1)};
  association.node_parameters = projected_parameters(*import.model, mesh, owner);
  result.model = std::move(import.model);
  return result;
}

}  // namespace hextwist
