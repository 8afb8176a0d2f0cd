// A front moves through a mesh, and the refinement with it: moving_front [LEVELS [STEPS [OUTPUT.vtu]]]
//
// The front is a sphere of radius 2.2 in a grid of 10 x 10 x 10. A solver would say which hexes need to be finer and
// which may be coarser; here those are the ones that the sphere meets, and all others. Fields go along: "x" is linear
// and stays so.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "front.h"

namespace {

using namespace hextwist;

/// What the same front takes on a mesh where nothing was before.
Index fresh_count(const MeshedModel& base, const Vec3& centre, int n_levels) {
  Session session;
  session.take(base, true);
  front::follow(session, centre, n_levels);
  return session.meshed().mesh.n_hexes();
}

}  // namespace

int main(int argc, char** argv) try {
  const int n_levels = argc > 1 ? std::stoi(argv[1]) : 2, n_steps = argc > 2 ? std::stoi(argv[2]) : 10;
  Session session;
  session.run("create brick x 10 interval 10");
  MeshedModel base = session.meshed();
  Field x{"x", Field::On::node, 1, {}};
  for (const Vec3& p : base.mesh.points) x.values.push_back(p.x());
  base.mesh.fields.push_back(x);
  session.take(base, true);

  std::cout << "step    hexes    fresh  scaled Jacobian  field off by  seconds\n";
  for (int step = 0; step < n_steps; ++step) {
    const Vec3 centre = front::centre(step);
    const auto begin = std::chrono::steady_clock::now();
    front::follow(session, centre, n_levels);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    const Mesh& mesh = session.meshed().mesh;
    double off = 0;
    const Field& field = *std::ranges::find(mesh.fields, "x", &Field::name);
    for (Index n = 0; n < mesh.n_nodes(); ++n) off = std::max(off, std::abs(field.values[n] - mesh.points[n].x()));
    std::printf("%4d %8d %8d %16.3f %13.1e %8.3f\n", step, mesh.n_hexes(), fresh_count(base, centre, n_levels),
                summarize(quality(Metric::scaled_jacobian, mesh)).min, off, seconds.count());
  }
  if (argc > 3) session.export_mesh(argv[3]);
  session.run("coarsen hex all levels 9");
  std::cout << "coarsened: " << session.meshed().mesh.n_hexes() << " hexes\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
