// Nodes of the skin that lie on skin quads of other hexes. A tree of boxes over the skin nodes finds the few that come
// near a quad, however unevenly they are spread; Newton's method on the bilinear quad decides.
#include <algorithm>
#include <cmath>
#include <optional>

#include "hextwist/base/box_tree.h"
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

/// Nowhere on the quad, in its inside, or in edge 0..3: at u = 0, u = 1, v = 0, v = 1.
enum Place { off = -2, inside = -1 };

/// Place of x, or its edge. Corners are off.
int place(const Patch& patch, const Vec3& x) {
  Box point;
  point.add(x);
  if (!overlap(patch, point)) return off;
  for (const Vec3& corner : patch.corners)
    if ((x - corner).norm() <= patch.tolerance) return off;
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

}  // namespace

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
  std::vector<std::vector<HangingNode>> of_chunk(n_chunks(n, chunk_size));
  parallel_chunks(n, chunk_size, [&](Index chunk, Index begin, Index end) {
    for (const Side& side : skin.subspan(begin, end - begin)) {
      const Hex& hex = mesh.hexes[side.hex];
      std::array<Vec3, 4> corners;
      for (int k = 0; k < 4; ++k) corners[k] = mesh.points[hex[face_corner(side.face, k)]];
      const auto patch = make_patch(corners, size);
      if (!patch) continue;
      tree.visit([&](const Box& b) { return overlap(*patch, b); },
                 [&](std::int32_t i) {
                   const Index node = nodes[i];
                   if (std::ranges::count(hex, node)) return;
                   const int where = place(*patch, mesh.points[node]);
                   if (where == off) return;
                   Edge edge = {-1, -1};
                   if (where != inside) {
                     constexpr int ends[4][2] = {{0, 2}, {1, 3}, {0, 1}, {2, 3}};
                     for (int end_of = 0; end_of < 2; ++end_of)
                       edge[end_of] = hex[face_corner(side.face, ends[where][end_of])];
                     std::ranges::sort(edge);
                   }
                   of_chunk[chunk].push_back({node, side.hex, edge});
                 });
    }
  });
  std::vector<HangingNode> found;
  for (const auto& list : of_chunk) found.insert(found.end(), list.begin(), list.end());
  if (found.empty()) return found;

  sort_unique(found);
  std::vector<Index> part = singletons(mesh.n_nodes());
  parallel_ranges(mesh.n_hexes(), [&](Index begin, Index end) {
    for (Index h = begin; h < end; ++h)
      for (int c = 1; c < 8; ++c) join(part, mesh.hexes[h][0], mesh.hexes[h][c]);
  });
  for (HangingNode& h : found) h.same_part = find_root(part, h.node) == find_root(part, mesh.hexes[h.hex][0]);
  return found;
}

}  // namespace hextwist
