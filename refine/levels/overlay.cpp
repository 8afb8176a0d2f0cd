#include "hextwist/refine/levels/overlay.h"

#include <algorithm>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/quality/quality.h"

namespace hextwist {
namespace {

/// A hex that keeps a part of its moved nodes has at least this part of the quality that it would have otherwise.
constexpr double least_of_quality = 0.5;

}  // namespace

Overlay overlay_after(const Overlay& before, std::span<const Index> moved, const MeshedModel& meshed) {
  Overlay after;
  after.nodes = union_of(before.nodes, moved);
  after.points = items_at(meshed.mesh.points, after.nodes);
  if (!meshed.association.empty()) after.parameters = items_at(meshed.association.node_parameters, after.nodes);
  return after;
}

Overlay put_on(const Overlay& before, const Mesh& mesh_before, const Association& association_before,
               std::span<const Index> pinned, LevelStep& step, Index& n_dropped) {
  n_dropped = 0;
  if (before.empty() && pinned.empty()) return {};
  Mesh& mesh = step.mesh.mesh;
  // Per node now: on it, and may be taken off again (1), or may not (2).
  std::vector<std::uint8_t> on(mesh.points.size(), 0);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (const Index old = step.old_node[n]; old >= 0) {
      if (std::ranges::binary_search(pinned, old) && mesh.points[n] != mesh_before.points[old])
        on[n] = 2;
      else if (std::ranges::binary_search(before.nodes, old))
        on[n] = 1;
    }
  const auto is_same = [&](Index h) { return step.origin.kind[h] == HexOrigin::same; };

  const std::vector<Index> asked = indices_where(mesh.n_nodes(), [&](Index n) { return on[n] != 0; });
  Mesh bare;  // the same hexes without it
  bare.points = mesh.points;
  bare.hexes = mesh.hexes;
  for (const Index n : asked) mesh.points[n] = mesh_before.points[step.old_node[n]];
  for (bool changed = true; changed;) {
    std::vector<Index> mixed;
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      const Hex& hex = mesh.hexes[h];
      const auto n_on = std::ranges::count_if(hex, [&](Index n) { return on[n] != 0; });
      const auto n_off = std::ranges::count_if(hex, [&](Index n) {
        return on[n] == 0 && (!is_same(h) || std::ranges::binary_search(before.nodes, step.old_node[n]));
      });
      if (n_on > 0 && n_off > 0) mixed.push_back(h);
    }
    const std::vector<double> is = quality(Metric::scaled_jacobian, mesh, mixed);
    const std::vector<double> without = quality(Metric::scaled_jacobian, bare, mixed);
    changed = false;
    for (std::size_t i = 0; i < mixed.size(); ++i) {
      if (is[i] > 0 && is[i] >= least_of_quality * without[i]) continue;
      for (const Index n : mesh.hexes[mixed[i]])
        if (on[n] == 1) {
          on[n] = 0;
          mesh.points[n] = bare.points[n];
          changed = true;
        }
    }
  }
  Overlay after;
  for (const Index n : asked) {
    if (on[n] == 0) continue;
    after.nodes.push_back(n);
    after.points.push_back(mesh.points[n]);
    if (association_before.empty()) continue;
    step.mesh.association.node_parameters[n] = association_before.node_parameters[step.old_node[n]];
    after.parameters.push_back(step.mesh.association.node_parameters[n]);
  }
  n_dropped = static_cast<Index>(before.nodes.size());
  for (const Index n : after.nodes)
    if (std::ranges::binary_search(before.nodes, step.old_node[n])) --n_dropped;
  return after;
}

}  // namespace hextwist
