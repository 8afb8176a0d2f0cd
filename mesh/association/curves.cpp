// Edges of the skin to curves, its nodes to vertices.
//
// An edge between quads on different surfaces lies on a curve that bounds all of them. An edge within one surface lies
// on a seam of it if both ends do and the seam stays with the edge in between; meshes need not follow seams.
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/association/association_internal.h"

namespace hextwist::detail {
namespace {

// As for faces: an edge over 120 degrees of a circle is 0.29 of its length away from it in the middle.
constexpr double max_curve_sagitta = 0.35;

struct Candidate {
  Index edge;
  int curve;
  bool tagged;
};

bool near_box(const Box& box, const Vec3& p, double distance) {
  return (p.array() >= box.min.array() - distance).all() && (p.array() <= box.max.array() + distance).all();
}

std::vector<int> surfaces_at(const SkinEdges& edges, std::span<const int> quad_surface, Index e) {
  std::vector<int> ids;
  for (const Index q : edges.quads[e]) ids.push_back(quad_surface[q]);
  sort_unique(ids);
  return ids;
}

std::vector<int> common_curves(const ModelFacts& facts, std::span<const int> surfaces) {
  std::vector<int> common = facts.surface_curves[surfaces[0] - 1];
  for (const int s : surfaces.subspan(1)) common = intersection(common, facts.surface_curves[s - 1]);
  return common;
}

std::vector<Candidate> candidates_of(const ModelFacts& facts, const Skin& skin, const SkinEdges& edges, Index e,
                                     std::span<const int> surfaces, int tag) {
  std::vector<Candidate> result;
  if (surfaces.size() > 1) {
    for (const int curve : common_curves(facts, surfaces)) result.push_back({e, curve, curve == tag});
    return result;
  }
  for (const int curve : facts.surface_seams[surfaces[0] - 1]) {
    const double reach = facts.node_tolerance(1, curve);
    if (near_box(facts.curve_box[curve - 1], skin.points[edges.nodes[e][0]], reach) &&
        near_box(facts.curve_box[curve - 1], skin.points[edges.nodes[e][1]], reach))
      result.push_back({e, curve, curve == tag});
  }
  return result;
}

std::string user_id(const Mesh& mesh, const Skin& skin, Index node) {
  return std::to_string(node_id(mesh, skin.nodes[node]));
}

std::string list_of(const char* kind, std::span<const int> ids) {
  std::string text = kind;
  for (std::size_t i = 0; i < ids.size(); ++i)
    text += (i == 0 ? " " : i + 1 == ids.size() ? " and " : ", ") + std::to_string(ids[i]);
  return text;
}

[[noreturn]] void throw_no_curve(const ModelFacts& facts, const Mesh& mesh, const Skin& skin, const SkinEdges& edges,
                                 Index e, std::span<const int> surfaces, int curve) {
  const auto [a, b] = edges.nodes[e];
  std::string text = "the mesh edge between nodes " + user_id(mesh, skin, a) + " and " + user_id(mesh, skin, b) +
                     " parts " + list_of("surfaces", surfaces);
  if (curve == 0) throw Error(text + ", which share no curve");
  const auto at_a = facts.model.project(Owner{1, curve}, skin.points[a]);
  const auto at_b = facts.model.project(Owner{1, curve}, skin.points[b]);
  const bool second = at_b.distance > at_a.distance;
  throw Error(text + ", but node " + user_id(mesh, skin, second ? b : a) + " lies " +
              std::to_string(second ? at_b.distance : at_a.distance) + " from their curve " + std::to_string(curve) +
              ": the mesh does not follow the curves of the model");
}

/// Nodes that are as far from a vertex as the nearest, within this times the model size, are doubles of it: cracks and
/// contact have them on purpose.
constexpr double double_node = 1e-10;

/// Puts nodes that stand at CAD vertices on them: per vertex the nearest node within tolerance of which no face or
/// edge lies on an entity that the vertex does not bound, and its doubles.
void match_vertices(const ModelFacts& facts, const Skin& skin, const CompressedRows& node_surfaces,
                    const CompressedRows& node_curves, CurveMatch& match) {
  std::vector<Index> by_x(skin.nodes.size());
  std::iota(by_x.begin(), by_x.end(), 0);
  const auto x = [&](Index n) { return skin.points[n].x(); };
  tbb::parallel_sort(by_x, [&](Index a, Index b) { return std::pair(x(a), a) < std::pair(x(b), b); });
  for (int vertex = 1; vertex <= static_cast<int>(facts.vertex_surfaces.size()); ++vertex) {
    const Vec3 at = facts.model.point({0, vertex}, {});
    const double reach = facts.node_tolerance(0, vertex);
    const auto fits = [&](Index n) {
      return std::ranges::includes(facts.vertex_surfaces[vertex - 1], node_surfaces[n]) &&
             std::ranges::includes(facts.vertex_curves[vertex - 1], node_curves[n]);
    };
    Index best = -1;
    double best_distance = reach;
    for (auto i = std::ranges::lower_bound(by_x, at.x() - reach, {}, x); i != by_x.end() && x(*i) <= at.x() + reach;
         ++i) {
      const double distance = (skin.points[*i] - at).norm();
      if (distance > best_distance || (best >= 0 && distance == best_distance && *i > best)) continue;
      if (fits(*i)) {
        best = *i;
        best_distance = distance;
      }
    }
    if (best < 0 || (match.node_owner[best].dim == 0 && match.node_at[best].distance <= best_distance)) continue;
    const Vec3 place = skin.points[best];
    const double apart = double_node * facts.size;
    for (auto i = std::ranges::lower_bound(by_x, place.x() - apart, {}, x);
         i != by_x.end() && x(*i) <= place.x() + apart; ++i) {
      if (*i != best && ((skin.points[*i] - place).norm() > apart || !fits(*i))) continue;
      match.node_owner[*i] = {0, vertex};
      match.node_at[*i] = {at, {}, (skin.points[*i] - at).norm()};
    }
  }
}

[[noreturn]] void throw_no_vertex(const ModelFacts& facts, const Mesh& mesh, const Skin& skin, Index node,
                                  const char* kind, std::span<const Index> ids) {
  std::string text = "node " + user_id(mesh, skin, node) + " joins " + list_of(kind, ids);
  int nearest = 0;
  double distance = std::numeric_limits<double>::infinity();
  for (int v = 1; v <= facts.model.count(0); ++v) {
    const double d = (facts.model.point({0, v}, {}) - skin.points[node]).norm();
    if (d < distance) {
      distance = d;
      nearest = v;
    }
  }
  throw Error(text + " but is at no vertex of the model" +
              (nearest
                   ? " (the nearest, vertex " + std::to_string(nearest) + ", is " + std::to_string(distance) + " away)"
                   : ""));
}

}  // namespace

CurveMatch match_curves(const ModelFacts& facts, const Mesh& mesh, const Skin& skin, const SkinEdges& edges,
                        const SurfaceMatch& surfaces, std::span<const int> tags) {
  const auto n_edges = static_cast<Index>(edges.nodes.size());
  std::vector<Candidate> candidates;
  const auto first_surface = [&](Index e) { return surfaces.quad_surface[edges.quads[e][0]]; };
  const auto parts_surfaces = [&](Index e) {
    return std::ranges::any_of(edges.quads[e], [&](Index q) { return surfaces.quad_surface[q] != first_surface(e); });
  };
  for (const Index e : indices_where(
           n_edges, [&](Index i) { return !facts.surface_seams[first_surface(i) - 1].empty() || parts_surfaces(i); })) {
    const auto ids = surfaces_at(edges, surfaces.quad_surface, e);
    const auto more = candidates_of(facts, skin, edges, e, ids, tags.empty() ? 0 : tags[e]);
    if (parts_surfaces(e) && more.empty()) throw_no_curve(facts, mesh, skin, edges, e, ids, 0);
    candidates.insert(candidates.end(), more.begin(), more.end());
  }
  // Both ends and the middle of each edge onto each of its candidates.
  std::vector<int> id;
  std::vector<Vec3> points;
  std::vector<double> length;
  for (const Candidate& c : candidates) {
    const Vec3 &a = skin.points[edges.nodes[c.edge][0]], &b = skin.points[edges.nodes[c.edge][1]];
    id.insert(id.end(), 3, c.curve);
    points.insert(points.end(), {a, b, (a + b) / 2});
    length.push_back((a - b).norm());
  }
  const auto at = project_all(facts.model, 1, id, points);

  CurveMatch match;
  match.edge_curve.assign(n_edges, 0);
  match.node_owner.assign(skin.nodes.size(), {});
  match.node_at.resize(skin.nodes.size());
  std::vector<std::pair<Index, Index>> node_curve, node_surface(4 * skin.quads.size());
  for (std::size_t i = 0, end = 0; i < candidates.size(); i = end) {
    const Index e = candidates[i].edge;
    const bool parts = parts_surfaces(e);
    std::size_t best = candidates.size(), nearest = i;
    double best_score = 0, nearest_end = std::numeric_limits<double>::infinity();
    for (end = i; end < candidates.size() && candidates[end].edge == e; ++end) {
      const double ends = std::max(at[3 * end].distance, at[3 * end + 1].distance);
      const double middle = at[3 * end + 2].distance;
      const double reach = facts.node_tolerance(1, candidates[end].curve);
      if (ends < nearest_end) {
        nearest_end = ends;
        nearest = end;
      }
      const bool follows = middle <= max_curve_sagitta * length[end] + reach;
      if (ends > reach || (!parts && !follows)) continue;
      // A tag that fits goes before everything.
      const double score = candidates[end].tagged && follows ? -1 : (ends + middle) / length[end];
      if (best == candidates.size() || score < best_score - 1e-9) {
        best = end;
        best_score = score;
      }
    }
    if (best == candidates.size()) {
      if (!parts) continue;
      throw_no_curve(facts, mesh, skin, edges, e, surfaces_at(edges, surfaces.quad_surface, e),
                     candidates[nearest].curve);
    }
    match.edge_curve[e] = candidates[best].curve;
    for (int k = 0; k < 2; ++k) {
      const Index node = edges.nodes[e][k];
      node_curve.emplace_back(node, candidates[best].curve);
      match.node_owner[node] = {1, candidates[best].curve};
      match.node_at[node] = at[3 * best + k];
    }
  }

  parallel_each(skin.quads.size(), [&](std::size_t q) {
    for (std::size_t c = 0; c < 4; ++c) node_surface[4 * q + c] = {skin.quads[q][c], surfaces.quad_surface[q]};
  });
  const CompressedRows curves_at = group(skin.n_nodes(), node_curve);
  const CompressedRows surfaces_of = group(skin.n_nodes(), node_surface);
  match_vertices(facts, skin, surfaces_of, curves_at, match);
  for (Index n = 0; n < skin.n_nodes(); ++n) {
    if (match.node_owner[n].dim == 0) continue;
    if (curves_at[n].size() > 1) throw_no_vertex(facts, mesh, skin, n, "curves", curves_at[n]);
    if (match.node_owner[n].dim == 1) continue;
    if (surfaces_of[n].size() > 1) throw_no_vertex(facts, mesh, skin, n, "surfaces", surfaces_of[n]);
    match.node_owner[n] = {2, surfaces_of[n][0]};
    match.node_at[n] = surfaces.node_at[n];
  }
  return match;
}

}  // namespace hextwist::detail
