// A mesh that came with all that an Exodus file may have.
#pragma once

#include <limits>
#include <memory>

#include "hextwist/io/exodus/exodus_internal.h"
#include "support/grids.h"

namespace hextwist::test {

inline std::shared_ptr<const std::vector<double>> list(std::vector<double> values) {
  return std::make_shared<const std::vector<double>>(std::move(values));
}
inline double load(const Vec3& p) {
  return 1 + p.x() / 2 + p.y() / 4;
}

/// A grid of 4 x 2 x 2 with everything that a file may have.
inline Mesh with_extras() {
  Mesh mesh = grid(4, 2, 2);
  mesh.blocks = {{0, "left", {}}, {7, "right", {}}};
  for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.blocks[h % 4 > 1].hexes.push_back(h);
  mesh.node_sets = {{0, "end", {}}, {3, "ends", {}}};
  mesh.side_sets = {{4, "hot", {}}};
  auto extras = std::make_shared<FileResults>();
  extras->times = {0, 1, 2.5};
  extras->step = 2;
  TimedValues t{"T", {}}, a{"a", {}}, energy{"energy", {}}, flux{"flux", {}}, reaction{"reaction", {}};
  SetExtras end{0, {}, {}, {3}, {}}, ends{3, {}, {}, {}, {}}, hot{4, {}, {}, {}, {}};
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    if (mesh.points[n].x() == 0) mesh.node_sets[0].nodes.push_back(n);
    if (mesh.points[n].x() != 4) continue;
    mesh.node_sets[1].nodes.push_back(n);
    ends.nodes.push_back(n);
    ends.factors.push_back(load(mesh.points[n]));
  }
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (h < 8) {
      mesh.side_sets[0].sides.push_back({h, 4});
      hot.sides.push_back({h, 4});
      for (const int corner : io::exodus_cycle(4)) hot.factors.push_back(load(mesh.points[mesh.hexes[h][corner]]));
    }
  for (const double time : extras->times) {
    std::vector<double> on_nodes, on_hexes, on_sides, on_ends;
    for (const Vec3& p : mesh.points) on_nodes.push_back(time * p.x());
    for (Index h = 0; h < mesh.n_hexes(); ++h)
      on_hexes.push_back(h % 4 > 1 ? std::numeric_limits<double>::quiet_NaN() : time + h);
    for (std::size_t i = 0; i < hot.sides.size(); ++i) on_sides.push_back(10 * time + hot.sides[i].hex);
    for (const Index n : ends.nodes) on_ends.push_back(time * mesh.points[n].y());
    t.at.push_back(list(on_nodes)), a.at.push_back(list(on_hexes)), flux.at.push_back(list(on_sides));
    reaction.at.push_back(list(on_ends)), energy.at.push_back(list({time * time}));
  }
  mesh.fields = {{"T", Field::On::node, 1, *t.at.back()}, {"a", Field::On::hex, 1, *a.at.back()}};
  hot.variables = {flux};
  ends.variables = {reaction};
  extras->on_nodes = {t}, extras->on_hexes = {a}, extras->of_all = {energy};
  std::vector<double> density(mesh.hexes.size(), std::numeric_limits<double>::quiet_NaN());
  for (const Index h : mesh.blocks[1].hexes) density[h] = 7.8 + h;
  extras->attributes = {{"density", {list(density)}}};
  extras->blocks = {{7, {"density"}}};
  extras->node_sets = {end, ends};
  extras->side_sets = {hot};
  extras->properties = {{FileResults::Of::block, "MATERIAL", {{0, 11}, {7, 12}}}};
  extras->title = "a wedge under load";
  extras->coordinate_names = {"r", "s", "t"};
  extras->info = {"first line", "second line"};
  extras->qa = {{"MESHER", "1.2", "01/02/2026", "10:20:30"}};
  place_in_itself(mesh, *extras);
  mesh.results = extras;
  return mesh;
}

}  // namespace hextwist::test
