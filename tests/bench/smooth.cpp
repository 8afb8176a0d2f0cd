// Goal 7: smoothing.
#include "hextwist/mesh/smooth/smooth.h"

#include <chrono>
#include <ctime>
#include <limits>
#include <random>

#include "groups.h"
#include "hextwist/io/io.h"
#include "measure.h"
#include "meshes.h"

namespace hextwist::bench {
namespace {

constexpr double mesquite_min = 0.363, mesquite_average = 0.819;

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

Mesh shaken() {
  constexpr int side = 40;
  Mesh mesh = cube(side);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  for (Vec3& p : mesh.points)
    if (p.cwiseAbs().maxCoeff() < side / 2 - 0.5) p += Vec3(shift(random), shift(random), shift(random));
  return mesh;
}

/// Vertex updates per CPU second.
double updates() {
  const Threads limit(1);
  Mesh mesh = shaken();
  Association none;
  SmoothOptions options;
  options.fix_boundary = true;
  options.iterations = 20;
  const double start = cpu_seconds();
  const SmoothReport report = smooth(mesh, none, nullptr, options);
  return static_cast<double>(report.node_updates) / (cpu_seconds() - start);
}

/// CPU microseconds per hex until the teapot is as good as Mesquite makes it (shapes both).
double teapot() {
  const auto file = data_file("mesh/teaport_14941.mesh");
  if (file.empty()) return std::numeric_limits<double>::quiet_NaN();
  const Threads limit(1);
  const Mesh input = read_mesh(file).mesh;
  SmoothOptions options;
  options.fix_boundary = true;
  for (options.iterations = 1; options.iterations <= 100; ++options.iterations) {
    Mesh mesh = input;
    Association none;
    const double start = cpu_seconds();
    smooth(mesh, none, nullptr, options);
    const double seconds = cpu_seconds() - start;
    const Summary shape = summarize(quality(Metric::shape, mesh));
    if (shape.min >= mesquite_min && shape.average >= mesquite_average) return 1e6 * seconds / mesh.n_hexes();
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

void add_smooth() {
  add_value("smooth/updates", updates);
  add_value("smooth/teapot", teapot);
}

}  // namespace hextwist::bench
