// The pieces that associate() is made of; association.cpp puts them together.
#pragma once

#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hextwist/mesh/association/association.h"

namespace hextwist::detail {

/// What the inner loops need to know of a model, as arrays; entity id i stands at i - 1.
struct ModelFacts {
  ModelFacts(const Model& model, double relative_tolerance);

  const Model& model;
  double size;       ///< diagonal of the model's box
  double tolerance;  ///< how far a node may lie off, model units
  /// Per dimension 0..2 and entity: the tolerance above, or what the CAD's own pieces need where that is more.
  std::array<std::vector<double>, 3> entity_tolerance;
  double loosest = 0;  ///< of all curves, and which one
  int loosest_curve = 0;
  std::vector<std::vector<int>> vertex_curves, vertex_surfaces, curve_surfaces, surface_volumes;
  std::vector<std::vector<int>> surface_curves;  ///< without degenerate ones (sphere poles, cone tips)
  /// Curves that bound this surface alone: the seams of closed surfaces.
  std::vector<std::vector<int>> surface_seams;
  std::vector<Box> curve_box;
  std::vector<char> degenerate;  ///< per curve: no length
  /// Per surface: inside a volume, both of whose sides are in it. Empty: none is known to be.
  std::vector<char> embedded;

  double node_tolerance(int dim, int id) const { return entity_tolerance[dim][id - 1]; }
  bool is_embedded(int surface) const { return !embedded.empty() && embedded[surface - 1]; }
  /// Do hexes lie on both sides of the surface?
  bool is_inside(int surface) const { return surface_volumes[surface - 1].size() == 2 || is_embedded(surface); }
};

/// Tags of a file that name entities of the model and items of the mesh; the others are left out with a notice.
struct Tags {
  std::vector<int> hex_volume;                      ///< empty unless every hex has one
  std::vector<std::pair<Index, int>> face_surface;  ///< mesh face, surface; ascending
  std::vector<std::pair<Edge, int>> edge_curve;     ///< ascending
  std::vector<std::pair<Index, int>> node_vertex;   ///< ascending
};
Tags usable_tags(const Mesh& mesh, const Faces& faces, const Model& model, const Association& tags,
                 std::vector<std::string>& notices);

/// Says which tags the association overruled.
void compare_with_tags(const Mesh& mesh, const Faces& faces, const Tags& tags, const Association& association,
                       std::vector<std::string>& notices);

/// Some faces of a mesh as a surface mesh of its own. "Node" and "quad" below are positions in these arrays.
struct Skin {
  std::vector<Side> sides;   ///< ascending: the first hex's side
  std::vector<Index> faces;  ///< per quad: the mesh's face
  std::vector<Index> nodes;  ///< per node: the mesh's node; ascending
  std::vector<Vec3> points;  ///< per node
  std::vector<Quad> quads;   ///< nodes, cyclic, counter-clockwise seen from outside of sides[i].hex

  Index n_quads() const { return static_cast<Index>(quads.size()); }
  Index n_nodes() const { return static_cast<Index>(nodes.size()); }
};
/// faces: indices of mesh faces, any order, each once.
Skin make_skin(const Mesh& mesh, const Faces& faces, std::span<const Index> selected);

/// The skin's edges, each with its quads.
struct SkinEdges {
  std::vector<Edge> nodes;  ///< ascending, lower node first
  CompressedRows quads;
};
SkinEdges make_edges(const Skin& skin);

/// Distinct values per node, ascending, from (node, value) pairs in any order.
CompressedRows group(Index n_nodes, std::span<const std::pair<Index, Index>> pairs);

/// Projects points[i] onto entity id[i] of one dimension, seeds[i] given or seeds empty; on all threads.
std::vector<Projection> project_all(const Model& model, int dim, std::span<const int> id, std::span<const Vec3> points,
                                    std::span<const Parameters> seeds = {});

/// Which surface each quad lies on: 0 where there is none. node_at: for nodes of quads that have one, their place on
/// the surface of one of those quads.
struct SurfaceMatch {
  std::vector<int> quad_surface;
  std::vector<Projection> node_at;
};
/// tags: per quad a surface to be tried first, 0 none; or empty.
/// A quad lies on a surface when its corners do, within tolerance; among several such surfaces its centre and its
/// normal decide.
SurfaceMatch match_surfaces(const ModelFacts& facts, const Skin& skin, std::span<const int> tags);
/// The faces inside the mesh that lie on surfaces between two volumes, or on embedded ones, by geometry alone;
/// ascending.
std::vector<Index> find_walls(const ModelFacts& facts, const Mesh& mesh, const Faces& faces);

/// Volume of each hex; walls: faces that part volumes (and perhaps some that do not), with the surface of each.
/// Returns "" or what contradicts the model.
std::string match_volumes(const ModelFacts& facts, const Mesh& mesh, const Faces& faces, const Skin& skin,
                          std::span<const int> quad_surface, std::vector<int>& hex_volume);

/// Owners of the skin's edges and nodes.
struct CurveMatch {
  std::vector<int> edge_curve;  ///< per skin edge, 0: none
  std::vector<Owner> node_owner;
  std::vector<Projection> node_at;
};
/// tags: per skin edge a curve to be preferred where it fits, 0 none; or empty. Throws Error when an edge between two
/// surfaces lies on none of their common curves, or a node between curves on none of their vertices.
CurveMatch match_curves(const ModelFacts& facts, const Mesh& mesh, const Skin& skin, const SkinEdges& edges,
                        const SurfaceMatch& surfaces, std::span<const int> tags);

/// Throws the Error for quads on no surface: names the worst node, its distance and the nearest surface, and guesses
/// at units.
[[noreturn]] void throw_off_model(const ModelFacts& facts, const Mesh& mesh, const Skin& skin,
                                  std::span<const int> quad_surface);

/// Notices: entities of the model without any part of the mesh, volumes that differ.
void notice_coverage(const ModelFacts& facts, const Mesh& mesh, const Association& association,
                     std::vector<std::string>& notices);

/// "3 4 7", or "3 4 7 ... (120 in all)".
std::string first_ids(std::span<const std::int64_t> ids);

}  // namespace hextwist::detail
