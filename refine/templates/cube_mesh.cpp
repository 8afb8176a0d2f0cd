#include "hextwist/refine/templates/cube_mesh.h"

namespace hextwist {

Index CubeMesh::add(const Vec3& p) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if ((points[i] - p).cwiseAbs().maxCoeff() < 1e-9) return static_cast<Index>(i);
  points.push_back(p);
  return static_cast<Index>(points.size()) - 1;
}

void CubeMesh::add_hex(const std::array<Vec3, 8>& corners) {
  Hex hex;
  for (int c = 0; c < 8; ++c) hex[c] = add(corners[c]);
  hexes.push_back(hex);
}

std::array<Vec3, 8> unit_corners() {
  std::array<Vec3, 8> result;
  for (int c = 0; c < 8; ++c) result[c] = Vec3(c & 1, c >> 1 & 1, c >> 2 & 1);
  return result;
}

bool is_inside_cube(const Vec3& p) {
  return p.minCoeff() > 1e-9 && p.maxCoeff() < 1 - 1e-9;
}

Vec3 trilinear(const std::array<Vec3, 8>& corners, const Vec3& at) {
  Vec3 sum = Vec3::Zero();
  for (int c = 0; c < 8; ++c) {
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) weight *= c >> axis & 1 ? at[axis] : 1 - at[axis];
    if (weight != 0) sum += weight * corners[c];
  }
  return sum;
}

void add_mapped(CubeMesh& mesh, const CubeMesh& piece, const std::array<Vec3, 8>& corners) {
  std::vector<Index> index(piece.points.size());
  for (std::size_t i = 0; i < index.size(); ++i) index[i] = mesh.add(trilinear(corners, piece.points[i]));
  for (const Hex& hex : piece.hexes) {
    Hex mapped;
    for (int c = 0; c < 8; ++c) mapped[c] = index[hex[c]];
    mesh.hexes.push_back(mapped);
  }
}

}  // namespace hextwist
