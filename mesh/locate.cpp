#include "hextwist/mesh/locate.h"

#include <Eigen/LU>
#include <numeric>

#include "hextwist/geom/facet/bilinear.h"
#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

constexpr double inside_slack = 1e-12;  // of the unit cube: neighbours must not leave a crack between them

}  // namespace

Vec3 trilinear_point(std::span<const Vec3, 8> x, const Vec3& at) {
  const auto along_x = [&](int c) -> Vec3 { return (1 - at.x()) * x[c] + at.x() * x[c | 1]; };
  const auto along_y = [&](int c) -> Vec3 { return (1 - at.y()) * along_x(c) + at.y() * along_x(c | 2); };
  return (1 - at.z()) * along_y(0) + at.z() * along_y(4);
}

std::array<Vec3, 3> trilinear_derivatives(std::span<const Vec3, 8> corners, const Vec3& at) {
  std::array<Vec3, 3> columns = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int e = 0; e < n_hex_edges; ++e) {
    const int axis = e >> 2, low = edge_corner(e, 0);
    double weight = 1;
    for (int other = 0; other < 3; ++other)
      if (other != axis) weight *= low >> other & 1 ? at[other] : 1 - at[other];
    columns[axis] += weight * (corners[edge_corner(e, 1)] - corners[low]);
  }
  return columns;
}

bool find_natural_coordinates(std::span<const Vec3, 8> corners, const Vec3& p, Vec3& at) {
  at.setConstant(0.5);
  const double size2 = (corners[7] - corners[0]).squaredNorm() + (corners[6] - corners[1]).squaredNorm();
  for (int i = 0; i < 20; ++i) {
    const Vec3 miss = p - trilinear_point(corners, at);
    if (miss.squaredNorm() <= 1e-28 * size2) return true;
    Eigen::Matrix3d jacobian;
    const auto columns = trilinear_derivatives(corners, at);
    for (int axis = 0; axis < 3; ++axis) jacobian.col(axis) = columns[axis];
    const Vec3 step = jacobian.partialPivLu().solve(miss);
    if (!step.allFinite()) return false;
    at += step;
    if (at.minCoeff() < -2 || at.maxCoeff() > 3) return false;
    if (step.squaredNorm() < 1e-30) return true;
  }
  return (p - trilinear_point(corners, at)).squaredNorm() <= 1e-20 * size2;
}

HexPlace closest_place(std::span<const Vec3, 8> corners, const Vec3& p) {
  HexPlace place;
  if (find_natural_coordinates(corners, p, place.at) && place.at.minCoeff() >= -inside_slack &&
      place.at.maxCoeff() <= 1 + inside_slack) {
    place.at = place.at.cwiseMax(0.0).cwiseMin(1.0);
    return place;
  }
  double best = std::numeric_limits<double>::infinity();
  for (int f = 0; f < n_hex_faces; ++f) {
    const auto c = [&](int k) { return corners[face_corner(f, k)]; };
    const PatchFoot foot = closest(BilinearPatch{c(0), c(1), c(3), c(2)}, p);
    if (foot.distance2 >= best) continue;
    best = foot.distance2;
    const int axis = f >> 1;
    place.at[axis] = f & 1;
    place.at[axis == 0] = foot.s;
    place.at[axis == 2 ? 1 : 2] = foot.t;
  }
  place.distance = std::sqrt(best);
  return place;
}

HexLocator::HexLocator(const Mesh& mesh, std::span<const Index> hexes) : hexes_(hexes.begin(), hexes.end()) {
  std::vector<Box> boxes(hexes_.size());
  corners_.resize(hexes_.size());
  for (std::size_t i = 0; i < hexes_.size(); ++i) {
    corners_[i] = corners_of(mesh, hexes_[i]);
    for (const Vec3& corner : corners_[i]) boxes[i].add(corner);
  }
  tree_ = BoxTree(boxes);
}

HexLocator::HexLocator(const Mesh& mesh)
    : HexLocator(mesh, [&] {
        std::vector<Index> all(mesh.hexes.size());
        std::iota(all.begin(), all.end(), 0);
        return all;
      }()) {}

HexPlace HexLocator::locate(const Vec3& p) const {
  const NearItem near = tree_.nearest(p, [&](std::int32_t i) {
    const double d = closest_place(corners_[i], p).distance;
    return d * d;
  });
  if (near.item < 0) return {};
  HexPlace place = closest_place(corners_[near.item], p);
  place.hex = hexes_[near.item];
  return place;
}

}  // namespace hextwist
