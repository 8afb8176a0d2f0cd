#include "hextwist/mesh/periodic.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/topology.h"

namespace hextwist {
namespace {

constexpr double relative_tolerance = 1e-6;

/// What of the mesh lies on a surface.
struct OnSurface {
  std::vector<Quad> quads;  // corners ascending, as a set
  std::vector<Index> nodes;
  std::vector<double> reach;  // per node: its shortest edge there
};

OnSurface side_of(const Mesh& mesh, const Association& association, int surface) {
  OnSurface side;
  std::vector<std::pair<Index, double>> lengths;
  for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
    if (association.face_surface[i] != surface) continue;
    const Side& at = association.surface_faces[i];
    Quad quad = face_node_cycle(mesh.hexes[at.hex], at.face);
    for (int c = 0; c < 4; ++c) {
      const Index a = quad[c], b = quad[(c + 1) % 4];
      const double length = (mesh.points[a] - mesh.points[b]).norm();
      lengths.emplace_back(a, length);
      lengths.emplace_back(b, length);
    }
    std::ranges::sort(quad);
    side.quads.push_back(quad);
  }
  std::ranges::sort(lengths);
  for (const auto& [n, length] : lengths)
    if (side.nodes.empty() || side.nodes.back() != n) {
      side.nodes.push_back(n);
      side.reach.push_back(length);
    }
  sort_unique(side.quads);
  return side;
}

std::string pair_text(const PeriodicPair& pair) {
  return "surface " + std::to_string(pair.of) + " does not repeat on surface " + std::to_string(pair.surface);
}

/// Nearest of some nodes, looked for along the axis in which they spread most.
class Nearest {
 public:
  Nearest(const Mesh& mesh, const std::vector<Index>& nodes) : mesh_(mesh) {
    Box box;
    for (const Index n : nodes) box.add(mesh.points[n]);
    (box.max - box.min).maxCoeff(&axis_);
    for (const Index n : nodes) sorted_.emplace_back(mesh.points[n][axis_], n);
    std::ranges::sort(sorted_);
  }
  /// -1: none within `near`.
  std::pair<Index, double> of(const Vec3& p, double near) const {
    std::pair<Index, double> best{-1, near};
    for (auto at = std::ranges::lower_bound(sorted_, std::pair(p[axis_] - near, Index{0}));
         at != sorted_.end() && at->first <= p[axis_] + near; ++at)
      if (const double d = (mesh_.points[at->second] - p).norm(); d <= best.second) best = {at->second, d};
    return best;
  }

 private:
  const Mesh& mesh_;
  int axis_ = 0;
  std::vector<std::pair<double, Index>> sorted_;
};

Vec3 middle_of(const Mesh& mesh, const std::vector<Index>& nodes) {
  Vec3 sum = Vec3::Zero();
  for (const Index n : nodes) sum += mesh.points[n];
  return sum / static_cast<double>(nodes.size());
}

/// The direction of a surface that is flat, outwards; zero where it bends.
Vec3 flat_normal(const Mesh& mesh, const Association& association, int surface) {
  Vec3 sum = Vec3::Zero();
  double area = 0;
  for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
    if (association.face_surface[i] != surface) continue;
    const Side& at = association.surface_faces[i];
    const Quad quad = face_node_cycle(mesh.hexes[at.hex], at.face);
    const Vec3 twice = (mesh.points[quad[2]] - mesh.points[quad[0]]).cross(mesh.points[quad[3]] - mesh.points[quad[1]]);
    sum += twice;
    area += twice.norm();
  }
  return sum.norm() < area * (1 - relative_tolerance) ? Vec3::Zero().eval() : sum.normalized().eval();
}

}  // namespace

double periodic_tolerance(const Mesh& mesh) {
  return relative_tolerance * box(mesh).diagonal();
}

std::vector<NodePair> node_pairs(const Mesh& mesh, const Association& association, const PeriodicPair& pair,
                                 std::optional<double> near) {
  const OnSurface of = side_of(mesh, association, pair.of), images = side_of(mesh, association, pair.surface);
  for (const auto& [side, surface] : {std::pair(&of, pair.of), std::pair(&images, pair.surface)})
    if (side->quads.empty()) throw Error("no face of the mesh lies on surface " + std::to_string(surface));
  const auto differ = [&](const std::string& how) { return Error(pair_text(pair) + ": " + how); };
  if (of.quads.size() != images.quads.size())
    throw differ("there are " + counted(std::ssize(of.quads), "face") + " on one and " +
                 std::to_string(images.quads.size()) + " on the other");
  if (of.nodes.size() != images.nodes.size())
    throw differ("there are " + counted(std::ssize(of.nodes), "node") + " on one and " +
                 std::to_string(images.nodes.size()) + " on the other");
  constexpr double part = 0.25;  // of the shortest edge at a node
  const Nearest nearest(mesh, images.nodes);
  std::vector<NodePair> result;
  std::vector<Index> taken;
  for (std::size_t i = 0; i < of.nodes.size(); ++i) {
    const Index n = of.nodes[i];
    const double reach = near.value_or(part * of.reach[i]);
    const Index image = nearest.of(pair.image(mesh.points[n]), reach).first;
    if (image < 0) throw differ("node " + std::to_string(node_id(mesh, n)) + " has no image there");
    result.push_back({n, image});
    taken.push_back(image);
  }
  sort_unique(taken);
  if (taken.size() != result.size()) throw differ("two of its nodes have the same image");
  for (Quad quad : of.quads) {
    const Quad corners = quad;
    for (Index& n : quad) n = result[position_in(of.nodes, n)][1];
    std::ranges::sort(quad);
    if (!std::ranges::binary_search(images.quads, quad))
      throw differ("the face with node " + std::to_string(node_id(mesh, corners[0])) + " and node " +
                   std::to_string(node_id(mesh, corners[3])) + " has no image there");
  }
  return result;
}

PeriodicPair find_periodic_pair(const Mesh& mesh, const Association& association, int of, int surface) {
  const OnSurface from = side_of(mesh, association, of), to = side_of(mesh, association, surface);
  for (const auto& [side, id] : {std::pair(&from, of), std::pair(&to, surface)})
    if (side->quads.empty()) throw Error("no face of the mesh lies on surface " + std::to_string(id));
  const double near = periodic_tolerance(mesh);
  PeriodicPair pair{.of = of, .surface = surface};
  pair.shift = middle_of(mesh, to.nodes) - middle_of(mesh, from.nodes);
  std::string why;
  try {
    static_cast<void>(node_pairs(mesh, association, pair, near));
    return pair;
  } catch (const Error& error) {
    why = error.what();
  }
  const Vec3 a = flat_normal(mesh, association, of), b = flat_normal(mesh, association, surface);
  const Vec3 axis = (-a).cross(b);
  if (a.norm() > 0 && b.norm() > 0 && axis.norm() > relative_tolerance) {
    // About the line in which both planes meet; what points out of one points into the other.
    const double angle = std::atan2(axis.norm(), (-a).dot(b));
    pair.turn = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
    Eigen::Matrix3d rows;
    rows << a.transpose(), b.transpose(), axis.normalized().transpose();
    const Vec3 point =
        rows.colPivHouseholderQr().solve(Vec3(a.dot(mesh.points[from.nodes[0]]), b.dot(mesh.points[to.nodes[0]]), 0));
    pair.shift = point - pair.turn * point;
    try {
      static_cast<void>(node_pairs(mesh, association, pair, near));
      return pair;
    } catch (const Error&) {
      why += "; nor does a rotation about the line in which they meet take one to the other";
    }
  }
  throw Error(why + " (by the translation that takes its middle there)");
}

std::vector<Index> repeat_places(MeshedModel& meshed, std::span<const PeriodicPair> pairs) {
  Mesh& mesh = meshed.mesh;
  Association& association = meshed.association;
  std::vector<std::vector<NodePair>> nodes;
  for (const PeriodicPair& pair : pairs) nodes.push_back(node_pairs(mesh, association, pair));
  const double tolerance = periodic_tolerance(mesh), exact = 1e-6 * tolerance;
  std::vector<Index> moved;
  // A node that repeats one that repeats another comes to rest after that: as many rounds as there are pairs.
  for (std::size_t round = 0; round <= pairs.size(); ++round)
    for (std::size_t k = 0; k < pairs.size(); ++k)
      for (const auto& [of, image] : nodes[k]) {
        const Vec3 place = pairs[k].image(mesh.points[of]);
        if ((place - mesh.points[image]).norm() <= exact) continue;
        const Owner owner = association.node_owner[image];
        Vec3 on_cad = place;
        if (meshed.model && owner.dim >= 0 && owner.dim <= 2) {
          const Projection at = meshed.model->project(owner, place);
          on_cad = at.point;
          association.node_parameters[image] = at.parameters;
        }
        if (!((on_cad - place).norm() <= tolerance))
          throw Error("surface " + std::to_string(pairs[k].surface) + " of the CAD does not repeat surface " +
                      std::to_string(pairs[k].of) + ": node " + std::to_string(node_id(mesh, image)) + " would lie " +
                      short_number((on_cad - place).norm()) + " off it");
        if ((on_cad - mesh.points[image]).norm() <= exact) continue;
        mesh.points[image] = on_cad;
        moved.push_back(image);
      }
  sort_unique(moved);
  return moved;
}

void check_periodic(const MeshedModel& meshed, std::span<const PeriodicPair> pairs) {
  for (const PeriodicPair& pair : pairs)
    static_cast<void>(node_pairs(meshed.mesh, meshed.association, pair, 4 * periodic_tolerance(meshed.mesh)));
}

std::vector<Index> nodes_on_surfaces(const Mesh& mesh, const Association& association, std::span<const int> surfaces) {
  std::vector<Index> result;
  for (const int surface : surfaces) result = union_of(result, side_of(mesh, association, surface).nodes);
  return result;
}

std::vector<int> periodic_surfaces(std::span<const PeriodicPair> pairs) {
  std::vector<int> result;
  for (const PeriodicPair& pair : pairs) result.insert(result.end(), {pair.of, pair.surface});
  return sorted_unique(std::move(result));
}

std::vector<Index> periodic_nodes(const Mesh& mesh, const Association& association,
                                  std::span<const PeriodicPair> pairs) {
  return nodes_on_surfaces(mesh, association, periodic_surfaces(pairs));
}

}  // namespace hextwist
