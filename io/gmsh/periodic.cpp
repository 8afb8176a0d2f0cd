// Periodic entities of a Gmsh file after a refinement: which nodes are images of which.
//
// The entities are found by the pairs that the file had, whose ids stay; the other pairs by the map between them. Where
// both sides were not refined alike there are no pairs to write, and a notice says so.
#include <Eigen/Geometry>
#include <numeric>

#include "hextwist/base/sorted.h"
#include "hextwist/io/gmsh/plan_internal.h"

namespace hextwist::io {
namespace {

/// Nodes of two places nearer than this part of the size of their box are images of each other.
constexpr double image_tolerance = 1e-6;

using OnEntity = std::pair<int, Index>;  // entity, node

/// Nodes on the closure of each entity of a dimension, by entity.
std::vector<OnEntity> nodes_on_entities(const Mesh& mesh, const Association& tags, int dim) {
  std::vector<OnEntity> result;
  if (dim == 0)
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      if (const Owner at = owner(tags, n); at.dim == 0) result.emplace_back(at.id, n);
  if (dim == 1)
    for (std::size_t i = 0; i < tags.curve_edges.size(); ++i)
      for (const Index n : tags.curve_edges[i]) result.emplace_back(tags.edge_curve[i], n);
  if (dim == 2)
    for (std::size_t i = 0; i < tags.surface_faces.size(); ++i)
      for (const Index n : face_nodes(mesh.hexes[tags.surface_faces[i].hex], tags.surface_faces[i].face))
        result.emplace_back(tags.face_surface[i], n);
  sort_unique(result);
  return result;
}

/// The entity with the fewest nodes that has all of these, and its nodes; 0 where there is none.
std::pair<int, std::vector<Index>> entity_with(const std::vector<OnEntity>& on, std::vector<Index> nodes) {
  sort_unique(nodes);
  std::pair<int, std::vector<Index>> best{0, {}};
  for (std::size_t i = 0, end = 0; i < on.size(); i = end) {
    std::size_t n_found = 0;
    while (end < on.size() && on[end].first == on[i].first)
      n_found += std::ranges::binary_search(nodes, on[end++].second);
    if (n_found != nodes.size() || (best.first > 0 && end - i >= best.second.size())) continue;
    best = {on[i].first, {}};
    for (std::size_t k = i; k < end; ++k) best.second.push_back(on[k].second);
  }
  return best;
}

std::vector<Index> nodes_of(const std::vector<OnEntity>& on, int entity) {
  std::vector<Index> result;
  for (auto at = std::ranges::lower_bound(on, OnEntity{entity, 0}); at != on.end() && at->first == entity; ++at)
    result.push_back(at->second);
  return result;
}

Eigen::Affine3d map_between(const Mesh& mesh, const std::vector<double>& affine,
                            const std::vector<std::array<Index, 2>>& pairs) {
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  if (affine.size() == 16) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) map(row, column) = affine[static_cast<std::size_t>(4 * row + column)];
    return map;
  }
  // As rigid as a periodic boundary is.
  Eigen::Matrix3Xd from(3, std::ssize(pairs)), to(3, std::ssize(pairs));
  for (Index k = 0; k < static_cast<Index>(pairs.size()); ++k) {
    to.col(k) = mesh.points[pairs[k][0]];
    from.col(k) = mesh.points[pairs[k][1]];
  }
  const Vec3 shift = (to - from).rowwise().mean();
  if (((to - from).colwise() - shift).colwise().norm().maxCoeff() <= image_tolerance * (1 + shift.norm()))
    map.translation() = shift;
  else
    map.matrix() = Eigen::umeyama(from, to, false);
  return map;
}

/// For each of `nodes` the one of `images` that lies where the map takes it; empty where that is not one to one.
std::vector<std::array<Index, 2>> images_of(const Mesh& mesh, const std::vector<Index>& images,
                                            const std::vector<Index>& nodes, const Eigen::Affine3d& map) {
  if (images.empty() || images.size() != nodes.size()) return {};
  Box size;
  for (const Index n : images) size.add(mesh.points[n]);
  const double near = image_tolerance * std::max(size.diagonal(), mesh.points[images[0]].norm() * 1e-6);
  std::vector<std::pair<double, Index>> by_x;
  for (const Index n : images) by_x.emplace_back(mesh.points[n].x(), n);
  std::ranges::sort(by_x);
  std::vector<std::array<Index, 2>> result;
  std::vector<Index> taken;
  for (const Index n : nodes) {
    const Vec3 p = map * mesh.points[n];
    Index image = -1;
    double distance = near;
    for (auto at = std::ranges::lower_bound(by_x, std::pair(p.x() - near, Index{0}));
         at != by_x.end() && at->first <= p.x() + near; ++at)
      if (const double d = (mesh.points[at->second] - p).norm(); d <= distance) distance = d, image = at->second;
    if (image < 0) return {};
    taken.push_back(image);
    result.push_back({image, n});
  }
  sort_unique(taken);
  if (taken.size() != nodes.size()) return {};
  std::ranges::sort(result);
  return result;
}

}  // namespace

std::vector<PlannedPeriodic> plan_periodic(const Mesh& mesh, const Association& association,
                                           const std::vector<PeriodicPairs>& before,
                                           std::vector<std::string>& notices) {
  std::vector<PlannedPeriodic> result;
  std::array<std::vector<OnEntity>, 3> on;
  std::size_t n_lost = 0;
  std::string first_lost;
  constexpr std::array<const char*, 3> names = {"vertices", "curves", "surfaces"};
  for (const PeriodicPairs& link : before) {
    const auto lost = [&](const std::string& why) {
      if (n_lost++ == 0)
        first_lost = std::string(names[static_cast<std::size_t>(std::clamp(link.dim, 0, 2))]) + " " +
                     std::to_string(link.entity) + " and " + std::to_string(link.of) + " of the file: " + why;
    };
    if (link.dim < 0 || link.dim > 2 || (link.nodes.empty() && link.affine.size() != 16)) {
      lost("there are no pairs");
      continue;
    }
    std::vector<std::array<Index, 2>> known;
    std::array<std::vector<Index>, 2> sides;
    bool all = true;
    for (const auto& [a, b] : link.nodes) {
      known.push_back({find_node(mesh, a), find_node(mesh, b)});
      all = all && known.back()[0] >= 0 && known.back()[1] >= 0;
      sides[0].push_back(known.back()[0]);
      sides[1].push_back(known.back()[1]);
    }
    if (!all) {
      lost("some of their nodes are gone");
      continue;
    }
    auto& of_dim = on[static_cast<std::size_t>(link.dim)];
    if (of_dim.empty()) of_dim = nodes_on_entities(mesh, association, link.dim);
    auto [entity, images] = entity_with(of_dim, sides[0]);
    auto [of, nodes] = entity_with(of_dim, sides[1]);
    if (known.empty()) {
      // Gmsh pairs only what lies inside a surface: of one that had nothing there, the map decides.
      entity = link.entity, images = nodes_of(of_dim, entity);
      of = link.of, nodes = nodes_of(of_dim, of);
      if (images.empty() || nodes.empty()) entity = 0;
    }
    if (entity == 0 || of == 0) {
      lost("their nodes are not on one entity each");
      continue;
    }
    const Eigen::Affine3d map = map_between(mesh, link.affine, known);
    PlannedPeriodic planned{link.dim, entity, of, {}, images_of(mesh, images, nodes, map)};
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) planned.affine.push_back(map.matrix()(row, column));
    const bool same =
        std::ranges::all_of(known, [&](const auto& pair) { return std::ranges::binary_search(planned.nodes, pair); });
    if (planned.nodes.empty() || !same) {
      lost("their nodes are not images of each other any more");
      continue;
    }
    result.push_back(std::move(planned));
  }
  if (n_lost > 0)
    notices.push_back("pairs of nodes of " +
                      counted(static_cast<std::int64_t>(n_lost), "periodic entity", "periodic entities") +
                      " left out; the first are " + first_lost);
  return result;
}

}  // namespace hextwist::io
