// Optimises where the nodes inside the trisecting templates lie, once and for all, and prints the table that the engine
// includes (trisect_places.inc):
//
//   optimize_templates > refine/templates/trisect_places.inc
//
// For each orbit of corner markings: a random search with a fixed seed (evolution strategy of one parent and one child)
// that minimises the sum over the children of q^-p, p rising, q the smaller of shape and scaled Jacobian in the unit
// cube. Nodes on edges and faces stay where TrisectPlaces puts them, as neighbours share them.
#include <cmath>
#include <cstdio>
#include <random>
#include <set>

#include "hextwist/mesh/quality/quality.h"
#include "hextwist/refine/templates/trisect_internal.h"

namespace {

using namespace hextwist;

double child_quality(const CubeMesh& mesh, const Hex& hex) {
  std::array<Vec3, 8> corners;
  for (int c = 0; c < 8; ++c) corners[c] = mesh.points[hex[c]];
  return std::min(quality(Metric::shape, corners), quality(Metric::scaled_jacobian, corners));
}

double worst(const CubeMesh& mesh) {
  double result = 1;
  for (const Hex& hex : mesh.hexes) result = std::min(result, child_quality(mesh, hex));
  return result;
}

double energy(const CubeMesh& mesh, double p) {
  double sum = 0;
  for (const Hex& hex : mesh.hexes) {
    const double q = child_quality(mesh, hex);
    if (q < 1e-3) return std::numeric_limits<double>::infinity();
    sum += std::pow(q, -p);
  }
  return sum;
}

void optimize(CubeMesh& mesh) {
  std::vector<std::size_t> inside;
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    if (is_inside_cube(mesh.points[i])) inside.push_back(i);
  if (inside.empty()) return;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto vary = [&](Vec3& p, double step) {
    for (int axis = 0; axis < 3; ++axis) p[axis] += step * normal(random);
  };
  for (const double p : {4.0, 16.0, 64.0, 200.0}) {
    double best = energy(mesh, p), step = 0.03;
    for (int trial = 0; trial < 4000 + 2000 * static_cast<int>(inside.size()); ++trial) {
      const std::vector<Vec3> before = mesh.points;
      if (trial % 2)
        for (const std::size_t i : inside) vary(mesh.points[i], step);
      else
        vary(mesh.points[inside[random() % inside.size()]], step);
      bool valid = true;
      for (const std::size_t i : inside) valid &= is_inside_cube(mesh.points[i]);
      const double now = valid ? energy(mesh, p) : best;
      if (now < best) {
        best = now;
        step *= 1.5;
      } else {
        mesh.points = before;
        step *= 0.98;
      }
      if (step < 1e-5) step = 0.01;
    }
  }
}

}  // namespace

int main() {
  std::set<int> orbits;
  for (int corners = 0; corners < 256; ++corners) {
    const int mask = edge_mask_of_corners(corners);
    orbits.insert(to_canonical(mask).edge_mask(mask));
  }
  orbits.erase(0);
  orbits.erase(trisect_all);  // a grid already
  for (const int mask : orbits) {
    CubeMesh mesh = trisect_cube(mask, TrisectPlaces{});
    const double before = worst(mesh);
    optimize(mesh);
    std::fprintf(stderr, "mask %03x: %3zu hexes, worst %.4f -> %.4f\n", mask, mesh.hexes.size(), before, worst(mesh));
    std::printf("{0x%03x, {", mask);
    const char* separator = "";
    for (const Vec3& p : mesh.points)
      if (is_inside_cube(p)) {
        std::printf("%s{%.6f, %.6f, %.6f}", separator, p.x(), p.y(), p.z());
        separator = ", ";
      }
    std::printf("}},\n");
  }
}
