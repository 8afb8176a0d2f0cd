// How far points are from what a request names.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "hextwist/base/box_tree.h"
#include "hextwist/sizing/request.h"

namespace hextwist {

/// Distance from the nearest target of a request: from the CAD entity itself where it is one (0 inside a volume), else
/// from the nodes, the straight edges, the bilinear faces, the trilinear hexes (0 inside), as the mesh has them now.
class TargetDistance {
 public:
  /// Keeps the model and copies of the mesh entities; the mesh may go.
  TargetDistance(const MeshedModel& input, EntityKind kind, std::span<const Index> targets);

  /// out: one per point. Runs on all threads; may be called from several.
  void evaluate(std::span<const Vec3> points, std::span<double> out) const;
  /// No more than the distance of the point; cheap: that from boxes around the targets.
  double at_least(const Vec3& point) const;

 private:
  void from_entity(Owner entity, const Box& box, std::span<const Vec3> points, std::span<double> out) const;
  double from_mesh(const Vec3& p) const;

  std::shared_ptr<const Model> model_;
  std::vector<Owner> entities_;
  std::vector<Box> boxes_;  // of the entities; one of all mesh entities
  int n_corners_ = 0;       // of each mesh entity: 1 node, 2 edge, 4 face (cycle), 8 hex
  std::vector<Vec3> corners_;
  BoxTree tree_;
};

}  // namespace hextwist
