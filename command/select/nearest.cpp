// `(at x y z)`: entities by their distance from a point.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "hextwist/command/select/selection.h"
#include "hextwist/geom/facet/bilinear.h"
#include "hextwist/geom/segment.h"
#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

using Values = std::vector<double>;

Values cad_distances(const Model& model, int dim, const Vec3& p) {
  Values result;
  for (int id = 1; id <= model.count(dim); ++id) {
    if (dim < 3) {
      result.push_back(model.project({dim, id}, p).distance);
      continue;
    }
    double least = std::numeric_limits<double>::infinity();
    if (model.contains(id, p))
      least = 0;
    else
      for (const int surface : model.adjacent({3, id}, 2))
        least = std::min(least, model.project({2, surface}, p).distance);
    result.push_back(least);
  }
  return result;
}

Values face_distances(const Selector& selector, const Vec3& p) {
  const auto& points = selector.meshed.mesh.points;
  Values result;
  for (const Quad& quad : selector.topology.faces().nodes)
    result.push_back(std::sqrt(
        closest(BilinearPatch{points[quad[0]], points[quad[1]], points[quad[3]], points[quad[2]]}, p).distance2));
  return result;
}

/// Of a hex that the point is inside of: 0. The face nearest to a point inside the mesh bounds the hex that has it.
Values hex_distances(const Selector& selector, const Vec3& p) {
  const Mesh& mesh = selector.meshed.mesh;
  const Faces& faces = selector.topology.faces();
  const Values to_face = face_distances(selector, p);
  Values result(mesh.hexes.size(), std::numeric_limits<double>::infinity());
  for (std::size_t h = 0; h < mesh.hexes.size(); ++h) {
    int nearest = 0;
    for (int f = 0; f < n_hex_faces; ++f) {
      const double distance = to_face[faces.of_hex[h][f]];
      if (distance < to_face[faces.of_hex[h][nearest]]) nearest = f;
    }
    const auto cycle = face_node_cycle(mesh.hexes[h], nearest);
    const BilinearPatch patch = {mesh.points[cycle[0]], mesh.points[cycle[1]], mesh.points[cycle[2]],
                                 mesh.points[cycle[3]]};
    // On the inner side of its nearest face, and within the box of its corners.
    const PatchFoot foot = closest(patch, p);
    Box box;
    for (const Index node : mesh.hexes[h]) box.add(mesh.points[node]);
    const bool in_box = (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
    const bool inside = in_box && area_vector(patch, foot.s, foot.t).dot(p - point(patch, foot.s, foot.t)) <= 0;
    result[h] = inside ? 0 : to_face[faces.of_hex[h][nearest]];
  }
  return result;
}

}  // namespace

std::vector<double> distances(const Selector& selector, EntityKind kind, const Vec3& p) {
  const Mesh& mesh = selector.meshed.mesh;
  if (is_cad(kind)) return cad_distances(*selector.meshed.model, dimension(kind), p);
  Values result;
  switch (kind) {
    case EntityKind::node:
      for (const Vec3& point : mesh.points) result.push_back((point - p).norm());
      return result;
    case EntityKind::edge:
      for (const Edge& edge : selector.topology.edges().nodes)
        result.push_back(std::sqrt(segment_distance2(mesh.points[edge[0]], mesh.points[edge[1]], p)));
      return result;
    case EntityKind::face:
      return face_distances(selector, p);
    case EntityKind::hex:
      return hex_distances(selector, p);
    default:
      break;
  }
  result.assign(count(selector, kind), std::numeric_limits<double>::infinity());
  for (int k = 0; k < n_entity_kinds; ++k) {
    const auto of = static_cast<EntityKind>(k);
    const bool of_group = kind == EntityKind::group && of != EntityKind::group;
    if (!of_group && !(is_mesh(of) && dimension(of) == dimension(kind))) continue;
    Values to_member;
    for (std::size_t i = 0; i < result.size(); ++i) {
      const auto position = static_cast<Index>(i);
      const std::vector<Index> inside =
          of_group ? members(selector, selector.groups[i], of) : related(selector, kind, {position}, of);
      if (!inside.empty() && to_member.empty()) to_member = distances(selector, of, p);
      for (const Index member : inside) result[i] = std::min(result[i], to_member[member]);
    }
  }
  return result;
}

std::vector<Index> by_distance(const Selector& selector, EntityKind kind, const Vec3& point) {
  const Values distance = distances(selector, kind, point);
  const double size =
      selector.meshed.model ? selector.meshed.model->box().diagonal() : box(selector.meshed.mesh).diagonal();
  const double rounding = 1e-9 * (size + point.norm());
  std::vector<Index> order(distance.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::stable_sort(order, {}, [&](Index i) { return distance[i]; });
  // Runs of entities that are equally near: those that meet at the point or nearest to it.
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && !(distance[order[end]] > distance[order[begin]] + rounding)) ++end;
    if (end - begin < 2) continue;
    std::vector<std::pair<double, Index>> run;
    for (std::size_t i = begin; i < end; ++i) {
      const double off = (middle(selector, kind, order[i]) - point).norm();
      run.emplace_back(std::isnan(off) ? std::numeric_limits<double>::infinity() : off, order[i]);
    }
    std::ranges::sort(run, [&](const auto& a, const auto& b) {
      return std::abs(a.first - b.first) > rounding ? a.first < b.first : a.second < b.second;
    });
    for (std::size_t i = begin; i < end; ++i) order[i] = run[i - begin].second;
  }
  return order;
}

}  // namespace hextwist
