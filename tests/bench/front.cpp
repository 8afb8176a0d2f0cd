// Goal 11: a front that moves through a mesh, refined before it and coarsened behind (examples/moving_front).
#include "../../examples/moving_front/front.h"

#include <ctime>

#include "groups.h"
#include "measure.h"

namespace hextwist::bench {
namespace {

/// Million hexes a CPU second on one thread: those of the mesh after each of ten steps, all together.
double moved(int n_levels) {
  const Threads limit(1);
  Session session;
  session.run("create brick x 10 interval 10");
  double n_hexes = 0;
  const std::clock_t start = std::clock();
  for (int step = 0; step < 10; ++step) {
    front::follow(session, front::centre(step), n_levels);
    n_hexes += session.meshed().mesh.n_hexes();
  }
  return 1e-6 * n_hexes * CLOCKS_PER_SEC / static_cast<double>(std::clock() - start);
}

}  // namespace

void add_front() {
  add_value("front/levels2", [] { return moved(2); });
  add_value("front/levels3", [] { return moved(3); });
}

}  // namespace hextwist::bench
