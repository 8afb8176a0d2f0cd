// Checks every guarantee of a complete association.
#include <algorithm>
#include <cmath>

#include "hextwist/mesh/association/association_internal.h"
#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

class Checker {
 public:
  Checker(const Mesh& m, const Association& a, const Model& cad, double relative_tolerance)
      : mesh_(m),
        association_(a),
        model_(cad),
        relative_tolerance_(relative_tolerance),
        faces_(faces(m)),
        edges_(edges(m)) {
    for (int dim = 0; dim < 3; ++dim)
      for (int id = 1; id <= cad.count(dim); ++id) {
        auto& above = above_[dim].emplace_back();
        for (int up = dim + 1; up < 4; ++up) above.push_back(cad.adjacent({dim, id}, up));
      }
  }

  std::vector<std::string> run() {
    if (!sizes()) return std::move(lines_);
    if (volumes() && nodes()) {
      surfaces();
      curves();
      places();
    }
    return std::move(lines_);
  }

 private:
  void say(std::string line) { lines_.push_back(std::move(line)); }
  std::string node_name(Index node) const { return "node " + std::to_string(node_id(mesh_, node)); }
  std::string side_name(Side side) const {
    return "side " + std::to_string(side.face + 1) + " of hex " + std::to_string(hex_id(mesh_, side.hex));
  }
  std::string edge_name(const Edge& edge) const {
    return "edge " + std::to_string(node_id(mesh_, edge[0])) + " " + std::to_string(node_id(mesh_, edge[1]));
  }
  bool exists(Owner owner) const {
    return owner.dim >= 0 && owner.dim <= 3 && owner.id >= 1 && owner.id <= model_.count(owner.dim);
  }
  /// Is the entity the owner, or does it bound it?
  bool on(Owner entity, Owner owner) const {
    if (entity == owner) return true;
    if (entity.dim >= owner.dim) return false;
    const auto& above = above_[entity.dim][entity.id - 1][owner.dim - entity.dim - 1];
    return std::ranges::binary_search(above, owner.id);
  }

  bool sizes() {
    const Association& a = association_;
    const auto need = [&](std::size_t have, std::size_t want, const char* what) {
      if (have != want) say(std::to_string(have) + " " + what + " instead of " + std::to_string(want));
      return have == want;
    };
    bool good = need(a.node_owner.size(), mesh_.points.size(), "node owners");
    good = need(a.node_parameters.size(), mesh_.points.size(), "node parameters") && good;
    good = need(a.hex_volume.size(), mesh_.hexes.size(), "hex volumes") && good;
    good = need(a.edge_curve.size(), a.curve_edges.size(), "curves of curve edges") && good;
    return need(a.face_surface.size(), a.surface_faces.size(), "surfaces of surface faces") && good;
  }

  bool volumes() {
    const std::size_t before = lines_.size();
    for (Index h = 0; h < mesh_.n_hexes(); ++h)
      if (!exists({3, association_.hex_volume[h]}))
        say("hex " + std::to_string(hex_id(mesh_, h)) + " is in volume " + std::to_string(association_.hex_volume[h]) +
            ", which is not");
    return lines_.size() == before;
  }

  bool nodes() {
    const std::size_t before = lines_.size();
    std::vector<char> used(mesh_.points.size(), 0);
    for (const Hex& hex : mesh_.hexes)
      for (const Index node : hex) used[node] = 1;
    for (Index n = 0; n < mesh_.n_nodes(); ++n)
      if (!used[n] && association_.node_owner[n])
        say(node_name(n) + " is of no hex, but owned by " + to_string(association_.node_owner[n]));
      else if (used[n] && !exists(association_.node_owner[n]))
        say(node_name(n) + " is owned by " + to_string(association_.node_owner[n]) + ", which is not");
    return lines_.size() == before;
  }

  void surfaces() {
    const auto& sides = association_.surface_faces;
    if (std::ranges::adjacent_find(sides, std::ranges::greater_equal{}) != sides.end())
      say("surface faces are not ascending");
    face_surface_.assign(faces_.nodes.size(), 0);
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Side side = sides[i];
      const int surface = association_.face_surface[i];
      if (side.hex < 0 || side.hex >= mesh_.n_hexes() || side.face < 0 || side.face >= n_hex_faces) {
        say("surface face " + std::to_string(i) + " is not a side of a hex");
        continue;
      }
      if (!exists({2, surface})) {
        say(side_name(side) + " is on surface " + std::to_string(surface) + ", which is not");
        continue;
      }
      const Index face = faces_.of_hex[side.hex][side.face];
      const auto& [first, second] = faces_.sides[face];
      if (first != side) say(side_name(side) + " is not named by its first hex");
      face_surface_[face] = surface;
      if (second.hex >= 0 && association_.hex_volume[first.hex] == association_.hex_volume[second.hex] &&
          above_[2][surface - 1][0].size() > 1)
        say(side_name(side) + " is on surface " + std::to_string(surface) + " inside volume " +
            std::to_string(association_.hex_volume[first.hex]));
      for (const Side& s : {first, second})
        if (s.hex >= 0 && !on({2, surface}, {3, association_.hex_volume[s.hex]}))
          say(side_name(side) + " is on surface " + std::to_string(surface) + ", which does not bound volume " +
              std::to_string(association_.hex_volume[s.hex]));
      for (const Index node : faces_.nodes[face])
        if (!on(association_.node_owner[node], {2, surface}))
          say(node_name(node) + " of " + side_name(side) + " on surface " + std::to_string(surface) + " is owned by " +
              to_string(association_.node_owner[node]));
    }
    std::vector<char> on_skin(mesh_.points.size(), 0);
    for (std::size_t f = 0; f < faces_.nodes.size(); ++f) {
      const auto& [first, second] = faces_.sides[f];
      const bool needs = second.hex < 0 || association_.hex_volume[first.hex] != association_.hex_volume[second.hex];
      if (needs && face_surface_[f] == 0) say(side_name(first) + " is on the boundary, but on no surface");
      if (needs || face_surface_[f] != 0)
        for (const Index node : faces_.nodes[f]) on_skin[node] = 1;
    }
    for (Index h = 0; h < mesh_.n_hexes(); ++h)
      for (const Index node : mesh_.hexes[h])
        if (!on_skin[node]) {
          const Owner inside{3, association_.hex_volume[h]};
          if (association_.node_owner[node] != inside)
            say(node_name(node) + " inside " + to_string(inside) + " is owned by " +
                to_string(association_.node_owner[node]));
          on_skin[node] = 1;  // said once
        } else if (association_.node_owner[node].dim == 3 &&
                   association_.node_owner[node].id != association_.hex_volume[h]) {
          say(node_name(node) + " of a hex in volume " + std::to_string(association_.hex_volume[h]) + " is owned by " +
              to_string(association_.node_owner[node]));
        }
  }

  void curves() {
    const auto& listed = association_.curve_edges;
    if (std::ranges::adjacent_find(listed, std::ranges::greater_equal{}) != listed.end())
      say("curve edges are not ascending");
    std::vector<int> edge_curve(edges_.nodes.size(), 0);
    std::vector<char> carries(mesh_.points.size(), 0);
    for (std::size_t i = 0; i < listed.size(); ++i) {
      const int curve = association_.edge_curve[i];
      if (!exists({1, curve})) {
        say("curve edge " + std::to_string(i) + " is on curve " + std::to_string(curve) + ", which is not");
        continue;
      }
      const Index edge = find_edge(edges_, listed[i][0], listed[i][1]);
      if (edge < 0 || edges_.nodes[edge] != listed[i]) {
        say("curve edge " + std::to_string(i) + " is not an edge of the mesh, lower node first");
        continue;
      }
      edge_curve[edge] = curve;
      for (const Index node : listed[i]) {
        carries[node] = 1;
        if (!on(association_.node_owner[node], {1, curve}))
          say(node_name(node) + " of " + edge_name(listed[i]) + " on curve " + std::to_string(curve) + " is owned by " +
              to_string(association_.node_owner[node]));
      }
    }
    for (Index n = 0; n < mesh_.n_nodes(); ++n)
      if (association_.node_owner[n].dim == 1 && !carries[n])
        say(node_name(n) + " is owned by " + to_string(association_.node_owner[n]) + " but is on no edge of it");
    // Where two surfaces meet there is a curve, and it bounds both.
    std::vector<int> edge_surface(edges_.nodes.size(), 0);
    for (std::size_t f = 0; f < face_surface_.size(); ++f)
      if (face_surface_[f]) {
        const auto& [hex, face] = faces_.sides[f][0];
        for (int j = 0; j < 4; ++j) {
          const Index edge = edges_.of_hex[hex][face_edge(face, j)];
          const int curve = edge_curve[edge];
          int& other = edge_surface[edge];
          if (curve && !on({1, curve}, {2, face_surface_[f]}))
            say(edge_name(edges_.nodes[edge]) + " is on curve " + std::to_string(curve) +
                ", which does not bound surface " + std::to_string(face_surface_[f]) + " at it");
          if (!curve && other && other != face_surface_[f])
            say(edge_name(edges_.nodes[edge]) + " is between surfaces " + std::to_string(other) + " and " +
                std::to_string(face_surface_[f]) + " but on no curve");
          other = face_surface_[f];
        }
      }
    for (std::size_t e = 0; e < edge_curve.size(); ++e)
      if (edge_curve[e] && !edge_surface[e])
        say(edge_name(edges_.nodes[e]) + " is on curve " + std::to_string(edge_curve[e]) + " but on no surface");
  }

  void places() {
    const double size = model_.box().diagonal();
    for (Index n = 0; n < mesh_.n_nodes(); ++n) {
      const Owner owner = association_.node_owner[n];
      if (owner.dim == 3 || !owner) continue;
      const Parameters at = association_.node_parameters[n];
      const Vec3 place = model_.point(owner, at);
      const double distance = (place - mesh_.points[n]).norm();
      double allowed = std::max(relative_tolerance_ * size, model_.tolerance(owner));
      for (int dim = 0; dim < owner.dim; ++dim)
        for (const int id : model_.adjacent(owner, dim)) allowed = std::max(allowed, model_.tolerance({dim, id}));
      if (!(distance <= allowed))
        say(node_name(n) + " is " + std::to_string(distance) + " from its place on " + to_string(owner));
    }
  }

  const Mesh& mesh_;
  const Association& association_;
  const Model& model_;
  const double relative_tolerance_;
  const Faces faces_;
  const Edges edges_;
  std::array<std::vector<std::vector<std::vector<int>>>, 3> above_;  // [dim][id - 1][higher dim - dim - 1]
  std::vector<int> face_surface_;
  std::vector<std::string> lines_;
};

}  // namespace

std::vector<std::string> check_association(const Mesh& mesh, const Association& association, const Model& model,
                                           double relative_tolerance) {
  return Checker(mesh, association, model, relative_tolerance).run();
}

std::vector<std::string> check_association(const Mesh& mesh, const Association& association, const Model& model) {
  return check_association(mesh, association, model, AssociateOptions().relative_tolerance);
}

}  // namespace hextwist
