// CGAL's tree bounds and traverses; the query "all triangles within slack of the closest" is a traversal of our own,
// because the closest triangle of a tessellation need not carry the closest point of the surface behind it.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>

#include "hextwist/geom/triangle_tree_internal.h"

namespace hextwist {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Traits = CGAL::AABB_traits<Kernel, Primitive>;
using Tree = CGAL::AABB_tree<Traits>;
using TreeNode = CGAL::AABB_node<Traits>;

Kernel::Point_3 to_cgal(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}
Vec3 from_cgal(const Kernel::Point_3& p) {
  return {p.x(), p.y(), p.z()};
}

// Collects candidates while the bound best + slack shrinks.
struct Collect {
  Vec3 p;
  double slack;
  double best;
  const Triangles& triangles;
  std::vector<NearTriangle>& out;

  static constexpr bool go_further() { return true; }

  void intersection(const Kernel::Point_3&, const Primitive& primitive) {
    const int index = static_cast<int>(primitive.id() - triangles.begin());
    const Kernel::Triangle_3& t = *primitive.id();
    const Vec3 a = from_cgal(t[0]), b = from_cgal(t[1]), c = from_cgal(t[2]);
    const Vec3 w = closest_weights(p, a, b, c);
    const double distance = (w[0] * a + w[1] * b + w[2] * c - p).norm();
    if (distance > best + slack) return;
    best = std::min(best, distance);
    out.push_back({index, distance, w});
  }

  bool do_intersect(const Kernel::Point_3&, const TreeNode& node) const {
    const CGAL::Bbox_3 box = node.bbox();
    double square = 0;
    for (int i = 0; i < 3; ++i) {
      const double outside = std::max({box.min(i) - p[i], p[i] - box.max(i), 0.0});
      square += outside * outside;
    }
    return square <= (1 + 1e-12) * (best + slack) * (best + slack);
  }
};

}  // namespace

Vec3 closest_weights(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  // Regions of the triangle's plane in turn: three corners, three edges, inside.
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double s = d1 - d3 > 0 ? d1 / (d1 - d3) : 0;
    return {1 - s, s, 0};
  }
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double s = d2 - d6 > 0 ? d2 / (d2 - d6) : 0;
    return {1 - s, 0, s};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double length = d4 - d3 + d5 - d6;
    const double s = length > 0 ? (d4 - d3) / length : 0;
    return {0, 1 - s, s};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return {1, 0, 0};  // a needle without area
  return {va / sum, vb / sum, vc / sum};
}

struct TriangleTree::Impl {
  Triangles triangles;
  Tree tree;
};

TriangleTree::TriangleTree(const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles)
    : impl_(std::make_unique<Impl>()) {
  impl_->triangles.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) {
    impl_->triangles.emplace_back(to_cgal(points[static_cast<std::size_t>(a)]),
                                  to_cgal(points[static_cast<std::size_t>(b)]),
                                  to_cgal(points[static_cast<std::size_t>(c)]));
  }
  impl_->tree.insert(impl_->triangles.cbegin(), impl_->triangles.cend());
  impl_->tree.build();
  impl_->tree.accelerate_distance_queries();
}

TriangleTree::~TriangleTree() = default;
TriangleTree::TriangleTree(TriangleTree&&) noexcept = default;
TriangleTree& TriangleTree::operator=(TriangleTree&&) noexcept = default;

void TriangleTree::closest(const Vec3& p, double slack, std::vector<NearTriangle>& out) const {
  out.clear();
  const Kernel::Point_3 query = to_cgal(p);
  // The hint is a corner; rounding must not make its triangle lie beyond it.
  const double hint = (1 + 1e-12) * (from_cgal(impl_->tree.best_hint(query).first) - p).norm() + 1e-300;
  Collect collect{p, slack, hint, impl_->triangles, out};
  impl_->tree.traversal(query, collect);
  std::erase_if(out, [&](const NearTriangle& t) { return t.distance > collect.best + slack; });
  std::sort(out.begin(), out.end(), [](const NearTriangle& a, const NearTriangle& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
  });
}

}  // namespace hextwist
