// Moving, turning, mirroring and scaling, of points and of models.
#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "hextwist/geom/model.h"

namespace hextwist {

/// p -> factor * turn * p + shift.
struct Similarity {
  double factor = 1;                                   ///< above 0
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< orthogonal
  Vec3 shift = Vec3::Zero();

  Vec3 of(const Vec3& p) const { return factor * (turn * p) + shift; }
  bool mirrors() const { return turn.col(0).cross(turn.col(1)).dot(turn.col(2)) < 0; }
};

/// The model with every point moved, under the same ids and names; parameters of points may be others. Throws Error if
/// it did not come from OpenCASCADE.
std::shared_ptr<const Model> moved(const Model& model, const Similarity& similarity);

}  // namespace hextwist
