#include "hextwist/geom/facet/skin.h"

#include <tbb/parallel_sort.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "hextwist/base/sorted.h"
#include "hextwist/base/union_find.h"

namespace hextwist {
namespace {

using Node = std::int32_t;
using QuadNodes = std::array<Node, 4>;

constexpr double rounding = 1e-7;  // degrees

/// One quad at one edge. Sorted, all quads of an edge stand together, edges in lexicographic order.
struct EdgeUse {
  Node a, b;
  std::int32_t quad;
  std::int32_t corner;  ///< the edge runs from this corner of the quad to the next
  auto operator<=>(const EdgeUse&) const = default;
};

/// Degrees between two vectors; 0 if one of them vanishes (a degenerate quad is no reason for a feature).
double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

/// Everything that finding features passes from step to step.
struct Finder {
  std::span<const Vec3> points;
  double feature_angle = 0;
  const FacetLabels* labels = nullptr;
  const FacetMiddles* middles = nullptr;
  SkinFeatures result;
  std::vector<std::array<int, 2>> quad_volumes;  ///< turned like the quads
  std::vector<Vec3> normals;                     ///< per quad
  std::vector<EdgeUse> uses;
  std::vector<std::array<std::size_t, 2>> feature_uses;  ///< per feature edge: range of uses
  std::vector<char> is_vertex;                           ///< per node

  /// Of a quad at a corner, or halfway from there to the next one.
  Vec3 normal_at(std::int32_t quad, int corner) const;
  Vec3 normal_along(const EdgeUse& use) const;
  /// The way from one node to the next where it leaves the first.
  Vec3 way(Node from, Node to) const;
  void turn_quads(std::span<const QuadNodes> quads, std::span<const std::array<int, 2>> volumes);
  void sort_edges();
  bool is_feature(std::size_t first, std::size_t last) const;
  void find_edges_and_surfaces();
  std::vector<int> surfaces_at(std::size_t edge) const;
  void find_vertices();
  bool bends(Node node, Node from, Node to) const;
  int edge_label(Node a, Node b) const;
  void find_curves();
};

void Finder::turn_quads(std::span<const QuadNodes> quads, std::span<const std::array<int, 2>> volumes) {
  result.quads.assign(quads.begin(), quads.end());
  quad_volumes.assign(volumes.begin(), volumes.end());
  normals.resize(quads.size());
  for (std::size_t q = 0; q < quads.size(); ++q) {
    auto& [behind, front] = quad_volumes[q];
    QuadNodes& quad = result.quads[q];
    if (behind == 0 || (front != 0 && front < behind)) {
      std::swap(behind, front);
      std::swap(quad[1], quad[3]);
    }
    assert(behind >= 1);
    result.n_volumes = std::max({result.n_volumes, behind, front});
    normals[q] = (points[quad[2]] - points[quad[0]]).cross(points[quad[3]] - points[quad[1]]);
  }
  if (!middles) return;
  for (const QuadNodes& quad : result.quads) {
    std::array<Vec3, 4> corners, edges;
    for (int c = 0; c < 4; ++c) {
      corners[c] = points[quad[c]];
      edges[c] = middles->middle(points, quad[c], quad[(c + 1) % 4]);
    }
    QuadNodes ascending = quad;
    std::ranges::sort(ascending);
    const Index face = position_in(middles->faces, ascending);
    result.patches.push_back(
        patch_through(corners, edges, face < 0 ? blended_middle(corners, edges) : middles->face_points[face]));
  }
}

Vec3 Finder::normal_at(std::int32_t quad, int corner) const {
  if (!middles) return normals[quad];
  return area_vector(result.patches[quad], corner == 1 || corner == 2, corner >= 2);
}

Vec3 Finder::normal_along(const EdgeUse& use) const {
  if (!middles) return normals[use.quad];
  constexpr std::array<std::array<double, 2>, 4> halfway = {{{0.5, 0}, {1, 0.5}, {0.5, 1}, {0, 0.5}}};
  return area_vector(result.patches[use.quad], halfway[use.corner][0], halfway[use.corner][1]);
}

Vec3 Finder::way(Node from, Node to) const {
  if (!middles) return points[to] - points[from];
  return slope(segment_through(points[from], middles->middle(points, from, to), points[to]), 0);
}

void Finder::sort_edges() {
  uses.reserve(4 * result.quads.size());
  for (std::size_t q = 0; q < result.quads.size(); ++q)
    for (int c = 0; c < 4; ++c) {
      const auto [a, b] = std::minmax(result.quads[q][c], result.quads[q][(c + 1) % 4]);
      uses.push_back({a, b, static_cast<std::int32_t>(q), c});
    }
  tbb::parallel_sort(uses.begin(), uses.end());
}

bool Finder::is_feature(std::size_t first, std::size_t last) const {
  if (last - first != 2) return true;
  const auto p = uses[first].quad, q = uses[first + 1].quad;
  if (labels)
    return quad_volumes[p] != quad_volumes[q] || labels->quads[p] != labels->quads[q] ||
           std::ranges::binary_search(labels->edges, std::array{uses[first].a, uses[first].b});
  return quad_volumes[p] != quad_volumes[q] ||
         angle_between(normal_along(uses[first]), normal_along(uses[first + 1])) > feature_angle + rounding;
}

void Finder::find_edges_and_surfaces() {
  const auto n_quads = result.quads.size();
  std::vector<Index> surfaces = singletons(static_cast<Index>(n_quads));
  for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
    while (last < uses.size() && uses[last].a == uses[first].a && uses[last].b == uses[first].b) ++last;
    if (is_feature(first, last)) {
      result.classification.edges.push_back({uses[first].a, uses[first].b});
      feature_uses.push_back({first, last});
    } else {
      join(surfaces, uses[first].quad, uses[first + 1].quad);
    }
  }
  auto& ids = result.classification.quad_surface;
  ids.resize(n_quads);
  for (std::size_t q = 0; q < n_quads; ++q) {
    const auto lowest = find_root(surfaces, static_cast<Index>(q));
    if (static_cast<std::size_t>(lowest) == q) {
      ids[q] = ++result.n_surfaces;
      result.surface_volumes.push_back(quad_volumes[q]);
    } else {
      ids[q] = ids[lowest];
    }
  }
}

std::vector<int> Finder::surfaces_at(std::size_t edge) const {
  std::vector<int> ids;
  for (std::size_t u = feature_uses[edge][0]; u < feature_uses[edge][1]; ++u)
    ids.push_back(result.classification.quad_surface[uses[u].quad]);
  std::ranges::sort(ids);
  return ids;
}

int Finder::edge_label(Node a, Node b) const {
  return value_of(labels->edges, labels->edge_labels, std::array{std::min(a, b), std::max(a, b)});
}

bool Finder::bends(Node node, Node from, Node to) const {
  if (labels) return edge_label(from, node) != edge_label(node, to);
  return angle_between(-way(node, from), way(node, to)) > feature_angle + rounding;
}

void Finder::find_vertices() {
  const std::size_t n_nodes = points.size();
  is_vertex.assign(n_nodes, 0);

  // Feature edges at each node: how many, and two of them.
  std::vector<int> n_features(n_nodes, 0);
  std::vector<std::array<std::int32_t, 2>> two(n_nodes);
  const auto& edges = result.classification.edges;
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const Node node : edges[e]) {
      if (n_features[node] < 2) two[node][n_features[node]] = static_cast<std::int32_t>(e);
      ++n_features[node];
    }

  // Fans: corners of quads at a node that are joined through edges at it. Two fans touch in the node alone.
  std::vector<Index> fans = singletons(static_cast<Index>(4 * result.quads.size()));
  const auto corner_at = [&](const EdgeUse& use, Node node) {
    const int corner = result.quads[use.quad][use.corner] == node ? use.corner : (use.corner + 1) % 4;
    return 4 * use.quad + corner;
  };
  for (std::size_t u = 1; u < uses.size(); ++u)
    if (uses[u - 1].a == uses[u].a && uses[u - 1].b == uses[u].b)
      for (const Node node : {uses[u].a, uses[u].b}) join(fans, corner_at(uses[u - 1], node), corner_at(uses[u], node));

  std::vector<int> n_fans(n_nodes, 0);
  std::vector<Vec3> mean(n_nodes, Vec3::Zero());
  for (std::size_t q = 0; q < result.quads.size(); ++q)
    for (int c = 0; c < 4; ++c) {
      const auto corner = static_cast<std::int32_t>(4 * q) + c;
      const Node node = result.quads[q][c];
      n_fans[node] += find_root(fans, corner) == corner;
      mean[node] += normal_at(static_cast<std::int32_t>(q), c).stableNormalized();
    }
  for (std::size_t n = 0; n < n_nodes; ++n) {
    const Node node = static_cast<Node>(n);
    if (n_fans[n] > 1 || (n_features[n] != 0 && n_features[n] != 2)) is_vertex[n] = 1;
    if (n_features[n] != 2 || is_vertex[n]) continue;
    const auto other = [&](std::int32_t e) { return edges[e][0] == node ? edges[e][1] : edges[e][0]; };
    is_vertex[n] = bends(node, other(two[n][0]), other(two[n][1])) || surfaces_at(two[n][0]) != surfaces_at(two[n][1]);
  }
  if (labels)
    for (const Node node : labels->vertices)
      if (n_fans[node] > 0) is_vertex[node] = 1;
  // Cone tips: no feature leads there, but the quads around look far from their common direction.
  for (std::size_t q = 0; q < result.quads.size(); ++q)
    for (int c = 0; c < 4; ++c)
      if (const Node node = result.quads[q][c];
          !labels && n_features[node] == 0 &&
          angle_between(normal_at(static_cast<std::int32_t>(q), c), mean[node]) > feature_angle + rounding)
        is_vertex[node] = 1;
  for (std::size_t n = 0; n < n_nodes; ++n)
    if (is_vertex[n]) result.classification.vertex_nodes.push_back(static_cast<Node>(n));
}

void Finder::find_curves() {
  const auto& edges = result.classification.edges;
  std::vector<std::array<std::int32_t, 2>> edges_at(points.size(), {-1, -1});  // of nodes inside curves
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const Node node : edges[e])
      if (!is_vertex[node]) edges_at[node][edges_at[node][0] >= 0] = static_cast<std::int32_t>(e);

  auto& curve_of = result.classification.edge_curve;
  curve_of.assign(edges.size(), 0);
  // From an edge through `node` onwards: appends the nodes that follow, up to a vertex or back at the first edge.
  const auto walk = [&](std::size_t first, Node node, int curve, std::vector<Node>& nodes) {
    auto edge = static_cast<std::int32_t>(first);
    while (!is_vertex[node]) {
      edge = edges_at[node][edges_at[node][0] == edge];
      if (static_cast<std::size_t>(edge) == first) return true;
      curve_of[edge] = curve;
      node = edges[edge][0] == node ? edges[edge][1] : edges[edge][0];
      nodes.push_back(node);
    }
    return false;
  };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (curve_of[e]) continue;
    const int curve = static_cast<int>(result.curve_nodes.size()) + 1;
    curve_of[e] = curve;
    std::vector<Node> nodes = {edges[e][0], edges[e][1]};
    const bool closed = walk(e, edges[e][1], curve, nodes);
    if (!closed) {
      std::vector<Node> before;
      walk(e, edges[e][0], curve, before);
      nodes.insert(nodes.begin(), before.rbegin(), before.rend());
    }
    result.curve_nodes.push_back(std::move(nodes));
  }
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const int surface : surfaces_at(e)) result.surface_curves.push_back({surface, curve_of[e]});
  sort_unique(result.surface_curves);
}

}  // namespace

Vec3 FacetMiddles::middle(std::span<const Vec3> points, std::int32_t a, std::int32_t b) const {
  const Index edge = position_in(edges, std::array{std::min(a, b), std::max(a, b)});
  return edge < 0 ? Vec3((points[a] + points[b]) / 2) : edge_points[edge];
}

SkinFeatures find_skin_features(std::span<const Vec3> points, std::span<const QuadNodes> quads,
                                std::span<const std::array<int, 2>> quad_volumes, double feature_angle,
                                const FacetLabels* labels, const FacetMiddles* middles) {
  if (!(feature_angle >= 0 && feature_angle <= 180))
    throw Error("feature angle must lie between 0 and 180 degrees, not " + std::to_string(feature_angle));
  assert(quads.size() == quad_volumes.size());
  Finder finder;
  finder.points = points;
  finder.feature_angle = feature_angle;
  finder.labels = labels;
  finder.middles = middles;
  finder.turn_quads(quads, quad_volumes);
  finder.sort_edges();
  finder.find_edges_and_surfaces();
  finder.find_vertices();
  finder.find_curves();
  return std::move(finder.result);
}

}  // namespace hextwist
