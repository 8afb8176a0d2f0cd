#include "hextwist/sizing/target_distance.h"

#include <cmath>

#include "hextwist/base/parallel.h"
#include "hextwist/geom/facet/bilinear.h"
#include "hextwist/geom/segment.h"
#include "hextwist/mesh/locate.h"
#include "hextwist/mesh/topology.h"

namespace hextwist {

TargetDistance::TargetDistance(const MeshedModel& input, EntityKind kind, std::span<const Index> targets)
    : model_(input.model) {
  const Mesh& mesh = input.mesh;
  const auto add = [&](std::span<const Index> nodes) {
    for (const Index n : nodes) corners_.push_back(mesh.points[n]);
  };
  switch (kind) {
    case EntityKind::node:
      n_corners_ = 1;
      add(targets);
      break;
    case EntityKind::edge: {
      n_corners_ = 2;
      const Edges all = edges(mesh);
      for (const Index e : targets) add(all.nodes[e]);
      break;
    }
    case EntityKind::face: {
      n_corners_ = 4;
      const Faces all = faces(mesh);
      for (const Index f : targets) {
        const Quad& q = all.nodes[f];
        add(Quad{q[0], q[1], q[3], q[2]});
      }
      break;
    }
    case EntityKind::hex:
      n_corners_ = 8;
      for (const Index h : targets) add(mesh.hexes[h]);
      break;
    default:
      for (const Index id : targets) {
        entities_.push_back({static_cast<int>(kind) - static_cast<int>(EntityKind::vertex), id});
        boxes_.push_back(model_->box(entities_.back()));
      }
      return;
  }
  std::vector<Box> boxes(corners_.size() / static_cast<std::size_t>(n_corners_));
  for (std::size_t i = 0; i < corners_.size(); ++i) boxes[i / static_cast<std::size_t>(n_corners_)].add(corners_[i]);
  tree_ = BoxTree(boxes);
  Box& all = boxes_.emplace_back();
  for (const Vec3& p : corners_) all.add(p);
}

double TargetDistance::from_mesh(const Vec3& p) const {
  const NearItem near = tree_.nearest(p, [&](std::int32_t i) {
    const Vec3* x = corners_.data() + static_cast<std::ptrdiff_t>(i) * n_corners_;
    if (n_corners_ == 1) return (*x - p).squaredNorm();
    if (n_corners_ == 2) return segment_distance2(x[0], x[1], p);
    if (n_corners_ == 4) return closest(BilinearPatch{x[0], x[1], x[2], x[3]}, p).distance2;
    const double d = closest_place(std::span<const Vec3, 8>(x, 8), p).distance;
    return d * d;
  });
  return std::sqrt(near.distance2);
}

// Lowers out to the distance from the entity, asking it only where its box is nearer than what is known.
void TargetDistance::from_entity(Owner entity, const Box& box, std::span<const Vec3> points,
                                 std::span<double> out) const {
  if (entity.dim == 3) {
    for (std::size_t i = 0; i < points.size(); ++i)
      if (distance2(box, points[i]) == 0 && model_->contains(entity.id, points[i])) out[i] = 0;
    for (const int surface : model_->adjacent(entity, 2))
      from_entity({2, surface}, model_->box({2, surface}), points, out);
    return;
  }
  std::vector<std::size_t> open;
  std::vector<Vec3> asked;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (distance2(box, points[i]) >= out[i] * out[i]) continue;
    open.push_back(i);
    asked.push_back(points[i]);
  }
  std::vector<Projection> found(asked.size());
  model_->project(entity, asked, {}, found);
  for (std::size_t k = 0; k < open.size(); ++k) out[open[k]] = std::min(out[open[k]], found[k].distance);
}

void TargetDistance::evaluate(std::span<const Vec3> points, std::span<double> out) const {
  parallel_ranges(
      static_cast<Index>(points.size()),
      [&](Index begin, Index end) {
        const auto n = static_cast<std::size_t>(end - begin);
        const std::span<const Vec3> some = points.subspan(static_cast<std::size_t>(begin), n);
        const std::span<double> to = out.subspan(static_cast<std::size_t>(begin), n);
        if (n_corners_ > 0) {
          for (std::size_t i = 0; i < n; ++i) to[i] = from_mesh(some[i]);
          return;
        }
        std::ranges::fill(to, std::numeric_limits<double>::infinity());
        for (std::size_t e = 0; e < entities_.size(); ++e) from_entity(entities_[e], boxes_[e], some, to);
      },
      512);
}

double TargetDistance::at_least(const Vec3& point) const {
  double least2 = std::numeric_limits<double>::infinity();
  for (const Box& box : boxes_) least2 = std::min(least2, distance2(box, point));
  return std::sqrt(least2);
}

}  // namespace hextwist
