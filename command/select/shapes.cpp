#include "hextwist/command/select/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "hextwist/base/sorted.h"
#include "hextwist/base/union_find.h"

namespace hextwist {
namespace {

/// Entities go on smoothly where they turn by less than this.
const double smooth_cosine = std::cos(15 * 3.14159265358979323846 / 180);

Box box_of(const Model& model, const std::vector<int>& curves) {
  Box result;
  for (const int curve : curves) result.add(model.box({1, curve}));
  return result;
}

/// Tangents of a curve that point away from it at a vertex of its.
std::vector<Vec3> tangents_out(const Model& model, int curve, int vertex) {
  const CurveRange range = model.range(curve);
  const Vec3 at = model.point({0, vertex}, {});
  const std::array<double, 2> ends = {range.first, range.last};
  std::array<double, 2> off{};
  for (int k = 0; k < 2; ++k) off[k] = (model.point({1, curve}, {ends[k], 0}) - at).norm();
  std::vector<Vec3> result;
  const double near = std::min(off[0], off[1]) + 1e-6 * model.box().diagonal();
  for (int k = 0; k < 2; ++k)
    if (off[k] <= near) result.push_back((k == 0 ? -1 : 1) * model.tangent(curve, ends[k]));
  return result;
}

void next_curves(const Model& model, int curve, std::vector<int>& found) {
  for (const int vertex : model.adjacent({1, curve}, 0))
    for (const Vec3& out : tangents_out(model, curve, vertex)) {
      double best = -smooth_cosine;
      int next = 0;
      for (const int other : model.adjacent({0, vertex}, 1)) {
        if (other == curve) continue;
        for (const Vec3& back : tangents_out(model, other, vertex))
          if (back.norm() > 0 && out.dot(back) < best) {
            best = out.dot(back);
            next = other;
          }
      }
      if (next > 0) found.push_back(next);
    }
}

void next_surfaces(const Model& model, int surface, std::vector<int>& found) {
  for (const int curve : model.adjacent({2, surface}, 1)) {
    const CurveRange range = model.range(curve);
    const Vec3 at = model.point({1, curve}, {(range.first + range.last) / 2, 0});
    const auto normal = [&](int of) { return model.normal(of, model.project({2, of}, at).parameters); };
    const Vec3 own = normal(surface);
    for (const int other : model.adjacent({1, curve}, 2))
      if (other != surface && std::abs(own.dot(normal(other))) > smooth_cosine) found.push_back(other);
  }
}

/// Three places on a surface that are far from each other.
std::array<Vec3, 3> normals_of(const Model& model, int surface) {
  const Box box = model.box({2, surface});
  const Vec3 size = box.max - box.min;
  const std::array<Vec3, 3> at = {box.max, box.min, box.min + Vec3(size.x(), 0, size.z())};
  std::array<Vec3, 3> result;
  for (int k = 0; k < 3; ++k) result[k] = model.normal(surface, model.project({2, surface}, at[k]).parameters);
  return result;
}

}  // namespace

std::vector<std::vector<int>> surface_loops(const Model& model, int surface) {
  const std::vector<int> curves = model.adjacent({2, surface}, 1);
  std::vector<Index> parent = singletons(static_cast<Index>(curves.size()));
  std::vector<std::pair<int, Index>> at_vertex;
  for (std::size_t i = 0; i < curves.size(); ++i)
    for (const int vertex : model.adjacent({1, curves[i]}, 0)) at_vertex.emplace_back(vertex, static_cast<Index>(i));
  std::ranges::sort(at_vertex);
  for (std::size_t k = 1; k < at_vertex.size(); ++k)
    if (at_vertex[k].first == at_vertex[k - 1].first) join(parent, at_vertex[k].second, at_vertex[k - 1].second);
  std::vector<std::vector<int>> loops(curves.size());
  for (std::size_t i = 0; i < curves.size(); ++i) loops[find_root(parent, static_cast<Index>(i))].push_back(curves[i]);
  std::erase_if(loops, [](const auto& loop) { return loop.empty(); });
  std::ranges::stable_sort(loops, std::greater<>(), [&](const auto& loop) { return box_of(model, loop).diagonal(); });
  return loops;
}

bool is_hole(const Model& model, int curve) {
  for (const int surface : model.adjacent({1, curve}, 2)) {
    Box outer;
    for (const std::vector<int>& loop : surface_loops(model, surface)) {
      const Box own = box_of(model, loop);
      const double rounding = 1e-9 * model.box().diagonal();
      if (!outer.empty() && std::ranges::find(loop, curve) != loop.end() &&
          ((own.min - outer.min).array() >= -rounding).all() && ((outer.max - own.max).array() >= -rounding).all() &&
          own.diagonal() < outer.diagonal() - rounding)
        return true;
      outer.add(own.min);
      outer.add(own.max);
    }
  }
  return false;
}

std::vector<int> smooth_chain(const Model& model, int dim, std::vector<int> ids) {
  std::vector<int> found;
  std::vector<char> is_in(static_cast<std::size_t>(model.count(dim)) + 1, 0);
  for (const int id : ids) is_in[id] = 1;
  for (std::size_t at = 0; at < ids.size(); ++at) {
    found.clear();
    dim == 1 ? next_curves(model, ids[at], found) : next_surfaces(model, ids[at], found);
    for (const int next : found)
      if (!is_in[next]) {
        is_in[next] = 1;
        ids.push_back(next);
      }
  }
  sort_unique(ids);
  return ids;
}

std::optional<Direction> direction(const Model& model, Owner entity) {
  if (entity.dim == 1) {
    const CurveRange range = model.range(entity.id);
    const auto tangent = [&](double part) {
      return model.tangent(entity.id, range.first + part * (range.last - range.first));
    };
    const Vec3 first = tangent(0.05), middle = tangent(0.4), last = tangent(0.95);
    constexpr double straight = 1e-6;
    if (first.norm() == 0) return std::nullopt;
    if (first.cross(middle).norm() < straight && first.cross(last).norm() < straight) return Direction{first, false};
    const Vec3 normal = first.cross(middle);
    if (model.type(entity) != "circle" || normal.norm() == 0) return std::nullopt;
    return Direction{normal.normalized(), true};
  }
  const std::array<Vec3, 3> n = normals_of(model, entity.id);
  constexpr double flat = 1e-6;
  const Vec3 first = n[1] - n[0], second = n[2] - n[0];
  if (first.norm() < flat && second.norm() < flat)
    return n[0].norm() > 0 ? std::optional(Direction{n[0], true}) : std::nullopt;
  const std::string type = model.type(entity);
  if (type == "cylinder") {
    const Vec3 one = n[0].cross(n[1]), other = n[0].cross(n[2]);
    const Vec3 axis = one.norm() > other.norm() ? one : other;
    if (axis.norm() > flat) return Direction{axis.normalized(), false};
  }
  if (type == "cone") {
    const Vec3 axis = first.cross(second);
    if (axis.norm() > flat) return Direction{axis.normalized(), false};
  }
  return std::nullopt;
}

std::optional<Vec3> centre(const Model& model, Owner entity) {
  const double r = radius(model, entity);
  const std::string type = model.type(entity);
  if (!(r > 0) || type == "torus") return std::nullopt;
  if (entity.dim == 1) {
    const CurveRange range = model.range(entity.id);
    const Vec3 tangent = model.tangent(entity.id, range.first);
    const double on = range.first + std::min(1.0, 0.4 * (range.last - range.first));
    const Vec3 axis = tangent.cross(model.tangent(entity.id, on)).normalized();
    return model.point(entity, {range.first, 0}) + r * axis.cross(tangent);
  }
  const Box box = model.box(entity);
  const Projection p = model.project(entity, box.max), q = model.project(entity, box.min);
  const Vec3 a = model.normal(entity.id, p.parameters), b = model.normal(entity.id, q.parameters);
  const double side = (q.point - p.point).dot(b - a) >= 0 ? 1 : -1;
  Vec3 result = p.point - side * r * a;
  if (const auto axis = direction(model, entity))
    result += axis->along.dot((box.min + box.max) / 2 - result) * axis->along;
  return result;
}

bool is_aligned(const Direction& a, const Direction& b, bool across) {
  constexpr double tolerance = 1.6e-3;
  const bool same = (a.is_normal == b.is_normal) != across;
  return same ? a.along.cross(b.along).norm() < tolerance : std::abs(a.along.dot(b.along)) < tolerance;
}

EntityKind meeting_kind(EntityKind kind) {
  switch (kind) {
    case EntityKind::vertex:
    case EntityKind::surface:
      return EntityKind::curve;
    case EntityKind::curve:
      return EntityKind::vertex;
    case EntityKind::volume:
      return EntityKind::surface;
    case EntityKind::node:
    case EntityKind::face:
      return EntityKind::edge;
    case EntityKind::edge:
    case EntityKind::nodeset:
      return EntityKind::node;
    default:
      return EntityKind::face;
  }
}

}  // namespace hextwist
