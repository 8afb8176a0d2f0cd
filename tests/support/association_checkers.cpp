#include "support/association_checkers.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "hextwist/mesh/corners.h"

namespace hextwist::test {
namespace {

testing::AssertionResult no(const std::string& what) {
  return testing::AssertionFailure() << what;
}

bool bounds(const Model& model, Owner small, Owner large) {
  if (small == large) return true;
  if (small.dim >= large.dim) return false;
  const auto ids = model.adjacent(small, large.dim);
  return std::ranges::find(ids, large.id) != ids.end();
}

/// Is the volume on both sides of the surface where this face is?
bool lies_inside(const Model& model, int surface, int volume, const Mesh& mesh, Side side) {
  constexpr double step = 1e-4;  // of the model
  const Quad quad = face_node_cycle(mesh.hexes[side.hex], side.face);
  const Vec3 middle = (mesh.points[quad[0]] + mesh.points[quad[1]] + mesh.points[quad[2]] + mesh.points[quad[3]]) / 4;
  const Projection at = model.project({2, surface}, middle);
  const Vec3 off = step * model.box().diagonal() * model.normal(surface, at.parameters);
  return model.contains(volume, at.point + off) && model.contains(volume, at.point - off);
}

}  // namespace

testing::AssertionResult on_model(const Mesh& mesh, const Association& association, const Model& model,
                                  double relative_tolerance, double outside) {
  if (association.node_owner.size() != mesh.points.size()) return no("owners are missing");
  const double allowed = relative_tolerance * model.box().diagonal();
  std::set<Index> used;
  for (const Hex& hex : mesh.hexes) used.insert(hex.begin(), hex.end());
  for (const Index n : used) {
    const Owner owner = association.node_owner[n];
    const std::string name = "node " + std::to_string(n) + " of " + to_string(owner);
    if (owner.dim < 0 || owner.id < 1 || owner.id > model.count(owner.dim)) return no(name + " has no real owner");
    if (owner.dim == 3) {
      if (model.contains(owner.id, mesh.points[n])) continue;
      double distance = std::numeric_limits<double>::infinity();
      for (int s = 1; s <= model.count(2) && outside > 0; ++s)
        if (bounds(model, {2, s}, owner)) distance = std::min(distance, model.project({2, s}, mesh.points[n]).distance);
      if (!(distance <= outside)) return no(name + " is outside");
      continue;
    }
    const double distance = model.project(owner, mesh.points[n]).distance;
    if (!(distance <= allowed)) return no(name + " is off by " + std::to_string(distance));
    const double place = (model.point(owner, association.node_parameters[n]) - mesh.points[n]).norm();
    if (!(place <= allowed)) return no(name + " is not at its parameters by " + std::to_string(place));
  }
  return testing::AssertionSuccess();
}

testing::AssertionResult complete(const Mesh& mesh, const Association& association, const Model& model) {
  using Key = std::array<Index, 4>;
  std::map<Key, std::vector<Side>> quads;
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (int f = 0; f < n_hex_faces; ++f) {
      Key key = face_nodes(mesh.hexes[h], f);
      std::ranges::sort(key);
      quads[key].push_back({h, f});
    }
  const auto& volume = association.hex_volume;
  if (volume.size() != mesh.hexes.size()) return no("volumes are missing");
  std::map<Side, int> wanted;  // surface of each side that must have one
  for (const auto& [key, sides] : quads)
    if (sides.size() == 1 || volume[sides[0].hex] != volume[sides[1].hex]) wanted[sides[0]] = 0;
  // A surface inside a volume has faces between its hexes.
  std::set<Side> between;
  for (const auto& [key, sides] : quads)
    if (sides.size() == 2 && volume[sides[0].hex] == volume[sides[1].hex]) between.insert(sides[0]);
  for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
    const Side side = association.surface_faces[i];
    if (!between.contains(side)) continue;
    if (!lies_inside(model, association.face_surface[i], volume[side.hex], mesh, side))
      return no("a surface face is not on the boundary");
    wanted[side] = 0;
  }
  if (association.surface_faces.size() != wanted.size()) return no("as many surface faces as boundary faces");
  std::map<Edge, std::set<int>> surfaces_at_edge;
  std::set<Index> boundary_nodes;
  for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
    const Side side = association.surface_faces[i];
    if (!wanted.contains(side)) return no("a surface face is not on the boundary");
    wanted[side] = association.face_surface[i];
    const Owner surface{2, association.face_surface[i]};
    if (!bounds(model, surface, {3, volume[side.hex]})) return no(to_string(surface) + " does not bound the hex at it");
    const auto cycle = face_node_cycle(mesh.hexes[side.hex], side.face);
    for (int k = 0; k < 4; ++k) {
      boundary_nodes.insert(cycle[k]);
      surfaces_at_edge[{std::min(cycle[k], cycle[(k + 1) % 4]), std::max(cycle[k], cycle[(k + 1) % 4])}].insert(
          surface.id);
      if (!bounds(model, association.node_owner[cycle[k]], surface))
        return no("node " + std::to_string(cycle[k]) + " of a face on " + to_string(surface) + " is owned by " +
                  to_string(association.node_owner[cycle[k]]));
    }
  }
  for (const auto& [side, surface] : wanted)
    if (surface == 0) return no("a boundary face of hex " + std::to_string(side.hex) + " has no surface");
  std::map<Edge, int> curve_of;
  for (std::size_t i = 0; i < association.curve_edges.size(); ++i) {
    const Edge edge = association.curve_edges[i];
    const Owner curve{1, association.edge_curve[i]};
    if (!surfaces_at_edge.contains(edge)) return no("a curve edge is not on the boundary");
    if (!curve_of.emplace(edge, curve.id).second) return no("a curve edge stands twice");
    for (const Index node : edge)
      if (!bounds(model, association.node_owner[node], curve))
        return no("node " + std::to_string(node) + " of an edge on " + to_string(curve) + " is owned by " +
                  to_string(association.node_owner[node]));
    for (const int surface : surfaces_at_edge[edge])
      if (!bounds(model, curve, {2, surface})) return no(to_string(curve) + " does not bound a surface at its edge");
  }
  for (const auto& [edge, surfaces] : surfaces_at_edge)
    if (surfaces.size() > 1 && !curve_of.contains(edge))
      return no("edge " + std::to_string(edge[0]) + " " + std::to_string(edge[1]) + " between surfaces has no curve");
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (const Index node : mesh.hexes[h]) {
      const Owner owner = association.node_owner[node], inside{3, volume[h]};
      if (!boundary_nodes.contains(node) && owner != inside)
        return no("inner node " + std::to_string(node) + " is owned by " + to_string(owner));
      if (boundary_nodes.contains(node) && owner.dim == 3)
        return no("boundary node " + std::to_string(node) + " is owned by " + to_string(owner));
    }
  return testing::AssertionSuccess();
}

testing::AssertionResult same_owners(const Association& a, const Association& b) {
  if (a.node_owner.size() != b.node_owner.size()) return no("different numbers of nodes");
  for (std::size_t n = 0; n < a.node_owner.size(); ++n)
    if (a.node_owner[n] != b.node_owner[n])
      return no("node " + std::to_string(n) + ": " + to_string(a.node_owner[n]) + " and " + to_string(b.node_owner[n]));
  if (a.surface_faces != b.surface_faces) return no("different surface faces");
  for (std::size_t i = 0; i < a.face_surface.size(); ++i)
    if (a.face_surface[i] != b.face_surface[i])
      return no("face " + std::to_string(a.surface_faces[i].face) + " of hex " +
                std::to_string(a.surface_faces[i].hex) + ": surfaces " + std::to_string(a.face_surface[i]) + " and " +
                std::to_string(b.face_surface[i]));
  if (a.curve_edges != b.curve_edges)
    return no("different curve edges: " + std::to_string(a.curve_edges.size()) + " and " +
              std::to_string(b.curve_edges.size()));
  for (std::size_t i = 0; i < a.edge_curve.size(); ++i)
    if (a.edge_curve[i] != b.edge_curve[i])
      return no("edge " + std::to_string(a.curve_edges[i][0]) + " " + std::to_string(a.curve_edges[i][1]) +
                ": curves " + std::to_string(a.edge_curve[i]) + " and " + std::to_string(b.edge_curve[i]));
  if (a.hex_volume != b.hex_volume) return no("different volumes");
  return testing::AssertionSuccess();
}

}  // namespace hextwist::test
