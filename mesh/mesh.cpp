#include "hextwist/mesh/mesh.h"

#include <algorithm>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/quality/quality.h"

namespace hextwist {
namespace {

std::int64_t id_of(std::span<const std::int64_t> ids, Index index) {
  return ids.empty() ? std::int64_t{index} + 1 : ids[index];
}

Index find_id(std::span<const std::int64_t> ids, Index n, std::int64_t id) {
  if (ids.empty()) return id >= 1 && id <= n ? static_cast<Index>(id - 1) : -1;
  return position_in(ids, id);
}

}  // namespace

std::int64_t node_id(const Mesh& mesh, Index node) {
  return id_of(mesh.node_ids, node);
}
std::int64_t hex_id(const Mesh& mesh, Index hex) {
  return id_of(mesh.hex_ids, hex);
}
Index find_node(const Mesh& mesh, std::int64_t id) {
  return find_id(mesh.node_ids, mesh.n_nodes(), id);
}
Index find_hex(const Mesh& mesh, std::int64_t id) {
  return find_id(mesh.hex_ids, mesh.n_hexes(), id);
}

Box box(const Mesh& mesh) {
  Box result;
  for (const Vec3& p : mesh.points) result.add(p);
  return result;
}
Box box(const Mesh& mesh, Index hex) {
  Box result;
  for (const Index n : mesh.hexes[hex]) result.add(mesh.points[n]);
  return result;
}

double volume(const Mesh& mesh, Index hex) {
  // The Jacobian determinant of a trilinear map is at most quadratic in each variable, so two Gauss points per
  // direction integrate it exactly.
  constexpr double low = 0.21132486540518711775;  // (1 - 1/sqrt(3)) / 2
  const std::array<Vec3, 8> x = corners_of(mesh, hex);
  double sum = 0;
  for (int gauss = 0; gauss < 8; ++gauss) {
    std::array<double, 3> at;
    for (int axis = 0; axis < 3; ++axis) at[axis] = gauss >> axis & 1 ? 1 - low : low;
    std::array<Vec3, 3> derivative;
    for (int axis = 0; axis < 3; ++axis) {
      derivative[axis].setZero();
      for (int c = 0; c < 8; ++c) {
        double weight = c >> axis & 1 ? 1 : -1;
        for (int other = 0; other < 3; ++other)
          if (other != axis) weight *= c >> other & 1 ? at[other] : 1 - at[other];
        derivative[axis] += weight * x[c];
      }
    }
    sum += derivative[0].dot(Vec3(derivative[1].y() * derivative[2].z() - derivative[1].z() * derivative[2].y(),
                                  derivative[1].z() * derivative[2].x() - derivative[1].x() * derivative[2].z(),
                                  derivative[1].x() * derivative[2].y() - derivative[1].y() * derivative[2].x()));
  }
  return sum / 8;
}

double volume(const Mesh& mesh) {
  double sum = 0;
  for (const double of_hex : quality(Metric::volume, mesh)) sum += of_hex;
  return sum;
}

}  // namespace hextwist
