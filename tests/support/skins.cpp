#include "support/skins.h"

#include <cmath>
#include <numbers>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/topology.h"
#include "support/grids.h"

namespace hextwist::test {

Skin skin(const Mesh& mesh, std::span<const int> hex_volume) {
  Skin result;
  const Faces all = faces(mesh);
  const auto volume_of = [&](Index hex) { return hex < 0 ? 0 : hex_volume.empty() ? 1 : hex_volume[hex]; };
  for (const auto& [first, second] : all.sides) {
    if (volume_of(first.hex) == volume_of(second.hex)) continue;
    result.quads.push_back(face_node_cycle(mesh.hexes[first.hex], first.face));
    result.volumes.push_back({volume_of(first.hex), volume_of(second.hex)});
  }
  return result;
}

FacetImport facet_model_of(const Mesh& mesh, std::span<const int> hex_volume, double feature_angle) {
  const Skin s = skin(mesh, hex_volume);
  return facet_model(mesh.points, s.quads, s.volumes, {feature_angle});
}

Mesh round_grid(int n, int layers, double height) {
  Mesh mesh = grid(2 * n, 2 * n, layers);
  for (Vec3& p : mesh.points) {
    const double x = p.x() / n - 1, y = p.y() / n - 1;
    p = Vec3(x * std::sqrt(1 - y * y / 2), y * std::sqrt(1 - x * x / 2), p.z() * height / layers);
  }
  return mesh;
}

Mesh twisted_ring(int n, int a, int b, int quarters) {
  Mesh mesh = grid(a, b, n);
  const int section = (a + 1) * (b + 1);
  const double pi = std::numbers::pi;
  for (Vec3& p : mesh.points) {
    const double along = 2 * pi * p.z() / n, turn = pi / 2 * quarters * p.z() / n;
    const double x = (p.x() - a / 2.0) / std::max(a, b), y = (p.y() - b / 2.0) / std::max(a, b);
    const double radius = 4 + x * std::cos(turn) - y * std::sin(turn);
    p = Vec3(radius * std::cos(along), -radius * std::sin(along), x * std::sin(turn) + y * std::cos(turn));
  }
  // The last section is the first one, seen turned.
  const auto joined = [&](Index node) {
    if (node < n * section) return node;
    double x = (node % section) % (a + 1) - a / 2.0, y = (node % section) / (a + 1) - b / 2.0;
    for (int q = 0; q < (quarters % 4 + 4) % 4; ++q) std::swap(x, y), x = -x;
    return static_cast<Index>(std::lround(x + a / 2.0) + (a + 1) * std::lround(y + b / 2.0));
  };
  for (Hex& hex : mesh.hexes)
    for (Index& node : hex) node = joined(node);
  mesh.points.resize(static_cast<std::size_t>(n) * section);
  return mesh;
}

}  // namespace hextwist::test
