// Goal 11: a front that moves through a mesh, refined before it and coarsened behind (examples/moving_front).
#include "../../examples/moving_front/front.h"

#include "groups.h"
#include "measure.h"

namespace hextwist::bench {
namespace {

/// Hexes after each of ten steps, all together.
std::size_t moved(int n_levels) {
  Session session;
  session.run("create brick x 10 interval 10");
  std::size_t n_hexes = 0;
  for (int step = 0; step < 10; ++step) {
    front::follow(session, front::centre(step), n_levels);
    n_hexes += session.meshed().mesh.hexes.size();
  }
  return n_hexes;
}

}  // namespace

void add_front() {
  const auto itself = [](std::size_t n) { return n; };
  add_rate(
      "front/levels2", [] { return moved(2); }, itself);
  add_rate(
      "front/levels3", [] { return moved(3); }, itself);
}

}  // namespace hextwist::bench
