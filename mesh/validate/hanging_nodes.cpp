// Nodes of the skin that lie on skin quads of other hexes. A tree of boxes over the skin nodes finds the few that come
// near a quad, however unevenly they are spread; Newton's method on the bilinear quad decides. What lies on the other
// side of a crack or in contact lies there rightly; edges of the skin within the quad tell.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "hextwist/base/box_tree.h"
#include "hextwist/base/large_array.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/union_find.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/validate/validate_parts.h"

namespace hextwist {
namespace {

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

/// A bilinear quad, with what is needed to tell quickly that something is far from it.
struct Patch {
  Vec3 p, a, b, c;           ///< point (u, v) is p + u a + v b + u v c
  Vec3 normal;               ///< unit
  double low = 0, high = 0;  ///< of normal . point
  Box box;
  double tolerance = 0;
  double shortest = 0;  ///< edge
  std::array<Vec3, 4> corners;

  Vec3 at(double u, double v) const { return p + u * a + v * b + u * v * c; }
};

/// Nothing for quads that are not finite, or not convex: their hexes are inverted.
std::optional<Patch> make_patch(const std::array<Vec3, 4>& corners, double mesh_size) {
  Patch patch;
  patch.corners = corners;
  patch.p = corners[0];
  patch.a = corners[1] - corners[0];
  patch.b = corners[2] - corners[0];
  patch.c = corners[3] - corners[2] - patch.a;
  const Vec3 normal = cross(corners[3] - corners[0], corners[2] - corners[1]);
  if (!(normal.norm() > 0) || !std::isfinite(normal.norm())) return {};
  patch.normal = normal / normal.norm();
  for (int k = 0; k < 4; ++k)
    if (!(cross(patch.a + (k >> 1) * patch.c, patch.b + (k & 1) * patch.c).dot(normal) > 0)) return {};
  const std::array<double, 4> lengths = {patch.a.norm(), patch.b.norm(), (patch.a + patch.c).norm(),
                                         (patch.b + patch.c).norm()};
  patch.shortest = std::ranges::min(lengths);
  patch.tolerance = std::min(1e-3 * patch.shortest, 1e-6 * (mesh_size + std::ranges::max(lengths)));
  patch.low = INFINITY;
  patch.high = -INFINITY;
  for (const Vec3& corner : corners) {
    patch.box.add(corner);
    patch.low = std::min(patch.low, patch.normal.dot(corner));
    patch.high = std::max(patch.high, patch.normal.dot(corner));
  }
  patch.box.min.array() -= patch.tolerance;
  patch.box.max.array() += patch.tolerance;
  patch.low -= patch.tolerance;
  patch.high += patch.tolerance;
  return patch;
}

bool overlap(const Patch& patch, const Box& box) {
  if ((box.min.array() > patch.box.max.array()).any() || (box.max.array() < patch.box.min.array()).any()) return false;
  const double middle = patch.normal.dot(0.5 * (box.min + box.max));
  const double reach = patch.normal.cwiseAbs().dot(0.5 * (box.max - box.min));
  return middle - reach <= patch.high && middle + reach >= patch.low;
}

/// Nowhere on the quad, in its inside, in edge 0..3: at u = 0, u = 1, v = 0, v = 1, or at corner 0..3 (and 4).
enum Place { off = -2, inside = -1, at_corner = 4 };

/// Place of x, or its edge or corner.
int place(const Patch& patch, const Vec3& x) {
  Box point;
  point.add(x);
  if (!overlap(patch, point)) return off;
  for (int k = 0; k < 4; ++k)
    if ((x - patch.corners[k]).norm() <= patch.tolerance) return at_corner + k;
  double u = 0.5, v = 0.5;
  for (int step = 0; step < 20; ++step) {
    const Vec3 r = patch.at(u, v) - x, s = patch.a + v * patch.c, t = patch.b + u * patch.c;
    const double ss = s.dot(s), st = s.dot(t), tt = t.dot(t), det = ss * tt - st * st;
    if (!(det > 0)) return off;
    const double du = (st * t.dot(r) - tt * s.dot(r)) / det, dv = (st * s.dot(r) - ss * t.dot(r)) / det;
    u = std::clamp(u + du, -1.0, 2.0);
    v = std::clamp(v + dv, -1.0, 2.0);
    if (std::abs(du) + std::abs(dv) < 1e-13) break;
  }
  const double inside_u = std::clamp(u, 0.0, 1.0), inside_v = std::clamp(v, 0.0, 1.0);
  if ((patch.at(inside_u, inside_v) - x).norm() > patch.tolerance) return off;
  const std::array<double, 4> gaps = {u, 1 - u, v, 1 - v};
  const auto nearest = std::ranges::min_element(gaps);
  return *nearest <= patch.tolerance / patch.shortest ? static_cast<int>(nearest - gaps.begin()) : inside;
}

/// A node of the skin on a quad of a hex that does not have it.
struct Found {
  Index node;
  Index quad;  ///< position in the skin
  int where;   ///< Place
};

constexpr int edge_ends[4][2] = {{0, 2}, {1, 3}, {0, 1}, {2, 3}};  // corners of the edges of a quad

/// Edges of the skin from marked nodes, ascending.
std::vector<Edge> edges_from(const Mesh& mesh, std::span<const Side> skin, const std::vector<char>& marked) {
  std::vector<Edge> edges;
  for (const Side& side : skin) {
    const auto cycle = face_node_cycle(mesh.hexes[side.hex], side.face);
    for (int k = 0; k < 4; ++k) {
      const Index a = cycle[k], b = cycle[(k + 1) & 3];
      if (marked[a]) edges.push_back({a, b});
      if (marked[b]) edges.push_back({b, a});
    }
  }
  sort_unique(edges);
  return edges;
}

/// The nodes found on one quad. The mesh hangs together at one that edges of the skin join to both ends of the edge
/// that it lies in, or to all corners of the face. Across a crack such edges come from nodes that both sides share (its
/// front), but lead on to nodes that only one side has; in contact they come from nowhere.
class OnQuad {
 public:
  OnQuad(std::span<const Found> found, const std::array<Index, 4>& corners, std::span<const Edge> edges)
      : found_(found),
        edges_(edges),
        in_face_(singletons(static_cast<Index>(found.size()) + 4)),
        along_edge_(in_face_) {
    for (std::size_t i = 0; i < found.size(); ++i) number_.emplace_back(found[i].node, static_cast<Index>(i));
    for (int k = 0; k < 4; ++k) number_.emplace_back(corners[k], number_of_corner(k));
    std::ranges::sort(number_);
    for (std::size_t i = 0; i < found.size(); ++i)
      for (const Edge& edge : edges_of(found[i].node)) {
        const Index at = position_in(number_, edge[1], &std::pair<Index, Index>::first);
        if (at < 0) continue;
        const Index other = number_[at].second;
        join(in_face_, static_cast<Index>(i), other);
        if (lies_in_edge(other, found[i].where)) join(along_edge_, static_cast<Index>(i), other);
      }
  }

  bool hangs(Index i) {
    const int where = found_[i].where;
    if (where < 0) {
      for (int k = 0; k < 4; ++k)
        if (find_root(in_face_, number_of_corner(k)) != find_root(in_face_, i)) return false;
      return true;
    }
    for (const int k : edge_ends[where])
      if (find_root(along_edge_, number_of_corner(k)) != find_root(along_edge_, i)) return false;
    return true;
  }

 private:
  Index number_of_corner(int k) const { return static_cast<Index>(found_.size()) + k; }
  std::span<const Edge> edges_of(Index node) const {
    const auto range = std::ranges::equal_range(edges_, node, {}, [](const Edge& e) { return e[0]; });
    return {range.begin(), range.end()};
  }
  /// Is it in this edge, or one of its ends?
  bool lies_in_edge(Index number, int edge) const {
    if (edge < 0 || edge >= at_corner) return false;
    if (number < std::ssize(found_)) return found_[number].where == edge;
    const Index corner = number - static_cast<Index>(found_.size());
    return corner == edge_ends[edge][0] || corner == edge_ends[edge][1];
  }
  std::span<const Found> found_;
  std::span<const Edge> edges_;
  std::vector<Index> in_face_, along_edge_;      ///< joined nodes: those found, then corners
  std::vector<std::pair<Index, Index>> number_;  ///< of a node there, ascending
};

/// The skin quads around each node that has some, as 4 * quad + corner.
CompressedRows quads_around(const Mesh& mesh, std::span<const Side> skin) {
  CompressedRows rows;
  resize_large(rows.first, mesh.points.size() + 1);
  for (const Side& side : skin)
    for (const Index node : face_nodes(mesh.hexes[side.hex], side.face)) ++rows.first[node];
  Index end = 0;
  for (Index& first : rows.first) first = end += first;
  rows.items.resize(static_cast<std::size_t>(end));
  for (Index q = static_cast<Index>(skin.size()) - 1; q >= 0; --q) {
    const auto nodes = face_nodes(mesh.hexes[skin[q].hex], skin[q].face);
    for (int k = 3; k >= 0; --k) rows.items[--rows.first[nodes[k]]] = 4 * q + k;
  }
  return rows;
}

}  // namespace

bool may_have_joined_nodes(const Mesh& mesh, std::span<const Side> skin) {
  // A chain of edges of the skin within a quad begins at one of its corners (see OnQuad): with a node next to that
  // corner which lies on the quad, and so in the box around it.
  const CompressedRows around = quads_around(mesh, skin);
  std::atomic<bool> found = false;
  parallel_ranges(static_cast<Index>(skin.size()), [&](Index begin, Index end) {
    for (Index q = begin; q < end && !found.load(std::memory_order_relaxed); ++q) {
      const Hex& hex = mesh.hexes[skin[q].hex];
      const auto nodes = face_nodes(hex, skin[q].face);
      Box box;
      for (const Index node : nodes) box.add(mesh.points[node]);
      constexpr double most_tolerance = 1e-3;  // of an edge: make_patch()
      const Vec3 margin = Vec3::Constant(most_tolerance * box.diagonal());
      box = {box.min - margin, box.max + margin};
      for (const Index node : nodes)
        for (const Index use : around[node]) {
          const auto other = face_nodes(mesh.hexes[skin[use >> 2].hex], skin[use >> 2].face);
          for (const int along : {1, 2}) {
            const Index next = other[(use & 3) ^ along];
            const Vec3& p = mesh.points[next];
            // Not finite: not outside either.
            const bool outside = (p.array() < box.min.array()).any() || (p.array() > box.max.array()).any();
            if (!outside && !std::ranges::count(hex, next)) found = true;
          }
        }
    }
  });
  return found;
}

std::vector<HangingNode> hanging_nodes(const Mesh& mesh, std::span<const Side> skin) {
  std::vector<char> on_skin(mesh.points.size(), 0);
  Box box;
  for (const Side& side : skin)
    for (const Index node : face_nodes(mesh.hexes[side.hex], side.face))
      if (mesh.points[node].allFinite()) {
        on_skin[node] = 1;
        box.add(mesh.points[node]);
      }
  const std::vector<Index> nodes = indices_where(mesh.n_nodes(), [&](Index node) { return on_skin[node] != 0; });
  std::vector<Box> boxes(nodes.size());
  parallel_each(nodes.size(), [&](std::size_t i) { boxes[i] = {mesh.points[nodes[i]], mesh.points[nodes[i]]}; });
  const BoxTree tree(boxes);
  const double size = box.diagonal();

  constexpr Index chunk_size = 256;
  const auto n = static_cast<Index>(skin.size());
  std::vector<std::vector<Found>> of_chunk(n_chunks(n, chunk_size));
  parallel_chunks(n, chunk_size, [&](Index chunk, Index begin, Index end) {
    for (Index q = begin; q < end; ++q) {
      const Hex& hex = mesh.hexes[skin[q].hex];
      std::array<Vec3, 4> corners;
      for (int k = 0; k < 4; ++k) corners[k] = mesh.points[hex[face_corner(skin[q].face, k)]];
      const auto patch = make_patch(corners, size);
      if (!patch) continue;
      tree.visit([&](const Box& b) { return overlap(*patch, b); },
                 [&](std::int32_t i) {
                   const Index node = nodes[i];
                   if (std::ranges::count(hex, node)) return;
                   if (const int where = place(*patch, mesh.points[node]); where != off)
                     of_chunk[chunk].push_back({node, q, where});
                 });
    }
  });
  std::vector<Found> found;
  for (const auto& list : of_chunk) found.insert(found.end(), list.begin(), list.end());
  std::vector<HangingNode> result;
  if (std::ranges::all_of(found, [](const Found& f) { return f.where >= at_corner; })) return result;

  std::vector<char> marked(mesh.points.size(), 0);
  for (const Found& f : found) marked[f.node] = 1;
  const std::vector<Edge> edges = edges_from(mesh, skin, marked);
  for (std::size_t begin = 0, end = 0; begin < found.size(); begin = end) {
    while (end < found.size() && found[end].quad == found[begin].quad) ++end;
    const Side side = skin[found[begin].quad];
    const std::array<Index, 4> corners = face_nodes(mesh.hexes[side.hex], side.face);
    const std::span<const Found> here = std::span(found).subspan(begin, end - begin);
    OnQuad on_quad(here, corners, edges);
    for (Index i = 0; i < std::ssize(here); ++i) {
      if (here[i].where >= at_corner) continue;
      HangingNode hanging{here[i].node, side.hex};
      if (here[i].where >= 0) {
        hanging.edge = {corners[edge_ends[here[i].where][0]], corners[edge_ends[here[i].where][1]]};
        std::ranges::sort(hanging.edge);
      }
      hanging.is_joined = on_quad.hangs(i);
      result.push_back(hanging);
    }
  }
  // Two quads of a hex may tell of its edge: joined if either says so.
  std::ranges::sort(result, std::ranges::greater{});
  result.erase(std::ranges::unique(result, {}, &HangingNode::key).begin(), result.end());
  std::ranges::reverse(result);
  return result;
}

bool has_joined_nodes(const Mesh& mesh, std::span<const Side> skin) {
  return may_have_joined_nodes(mesh, skin) && std::ranges::any_of(hanging_nodes(mesh, skin), &HangingNode::is_joined);
}

}  // namespace hextwist
