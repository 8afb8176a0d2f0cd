#include "hextwist/refine/levels/overlay.h"

#include <algorithm>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/loose_topology.h"
#include "hextwist/mesh/quality/quality.h"

namespace hextwist {
namespace {

/// A hex that keeps a part of its moved nodes has at least this part of the quality that it would have otherwise: what
/// is low here is lifted afterwards.
constexpr double least_of_quality = 0.1;

/// Nodes go back in so many steps. All the way at once, what they leave behind would hold hexes around no better, and
/// so on through the mesh.
constexpr std::uint8_t n_steps = 4;

/// A node between where the forest puts it (0) and where it had been moved to (n_steps), on what it lies on.
void put_between(MeshedModel& meshed, Index node, const Vec3& bare, const Parameters& bare_at, const Vec3& moved,
                 const Parameters& moved_at, std::uint8_t step) {
  Vec3& place = meshed.mesh.points[node];
  const bool has_owners = !meshed.association.empty();
  const double part = static_cast<double>(step) / n_steps;
  place = step == n_steps ? moved : step == 0 ? bare : Vec3(bare + part * (moved - bare));
  if (!has_owners) return;
  Parameters& at = meshed.association.node_parameters[node];
  at = step == 0 ? bare_at : moved_at;
  const Owner owner = meshed.association.node_owner[node];
  if (step == 0 || step == n_steps || !meshed.model || (owner.dim != 1 && owner.dim != 2)) return;
  const Projection foot = meshed.model->project(owner, place);
  place = foot.point;
  at = foot.parameters;
}

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
  // Per node now: it had been moved, and may go back (1), or may not (2).
  std::vector<std::uint8_t> was_moved(mesh.points.size(), 0);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (const Index old = step.old_node[n]; old >= 0) {
      if (std::ranges::binary_search(pinned, old) && mesh.points[n] != mesh_before.points[old])
        was_moved[n] = 2;
      else if (std::ranges::binary_search(before.nodes, old))
        was_moved[n] = 1;
    }
  const std::vector<Index> asked = indices_where(mesh.n_nodes(), [&](Index n) { return was_moved[n] != 0; });
  Mesh bare;  // the same hexes without it
  bare.points = mesh.points;
  bare.hexes = mesh.hexes;
  const std::vector<Parameters> bare_at = step.mesh.association.node_parameters;
  std::vector<std::uint8_t> on(mesh.points.size(), 0);  // steps
  const auto put = [&](Index n, std::uint8_t to) {
    on[n] = to;
    const Index old = step.old_node[n];
    const bool has_owners = !association_before.empty();
    put_between(step.mesh, n, bare.points[n], has_owners ? bare_at[n] : Parameters(), mesh_before.points[old],
                has_owners ? association_before.node_parameters[old] : Parameters(), to);
  };
  for (const Index n : asked) put(n, n_steps);
  // Some of its nodes are where they had been moved to, and others not.
  const auto is_mixed = [&](Index h) {
    const bool is_new = step.origin.kind[h] != HexOrigin::same;
    bool some_on = false, some_off = false;
    for (const Index n : mesh.hexes[h]) {
      some_on |= on[n] > 0;
      some_off |= on[n] < n_steps && (is_new || was_moved[n] != 0);
    }
    return some_on && some_off;
  };
  std::vector<Index> looked_at = indices_where(mesh.n_hexes(), is_mixed);
  CompressedRows corners;
  while (!looked_at.empty()) {
    const std::vector<double> is = quality(Metric::scaled_jacobian, mesh, looked_at);
    const std::vector<double> without = quality(Metric::scaled_jacobian, bare, looked_at);
    std::vector<Index> back;
    for (std::size_t i = 0; i < looked_at.size(); ++i) {
      if (is[i] > 0 && is[i] >= least_of_quality * without[i]) continue;
      std::uint8_t most = 0;  // of those that may go back
      for (const Index n : mesh.hexes[looked_at[i]])
        if (was_moved[n] == 1) most = std::max(most, on[n]);
      for (const Index n : mesh.hexes[looked_at[i]])
        if (was_moved[n] == 1 && most > 0 && on[n] == most) back.push_back(n);
    }
    sort_unique(back);
    for (const Index n : back) put(n, static_cast<std::uint8_t>(on[n] - 1));
    looked_at.clear();
    if (back.empty()) break;
    if (corners.first.empty()) corners = node_corners(mesh);
    for (const Index n : back)
      for (const Index corner : corners[n])
        if (is_mixed(corner / n_hex_corners)) looked_at.push_back(corner / n_hex_corners);
    sort_unique(looked_at);
  }
  Overlay after;
  for (const Index n : asked) {
    if (on[n] == 0) continue;
    after.nodes.push_back(n);
    after.points.push_back(mesh.points[n]);
    if (!association_before.empty()) after.parameters.push_back(step.mesh.association.node_parameters[n]);
  }
  n_dropped = static_cast<Index>(before.nodes.size());
  for (const Index n : asked)
    if (on[n] == n_steps && std::ranges::binary_search(before.nodes, step.old_node[n])) --n_dropped;
  return after;
}

}  // namespace hextwist
