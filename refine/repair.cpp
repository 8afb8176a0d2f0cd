// Last resort of placing: what to do about children that came out inverted.
#include <algorithm>
#include <cmath>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/loose_topology.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/smooth/smooth.h"
#include "hextwist/refine/origin.h"
#include "hextwist/refine/place.h"

namespace hextwist {
namespace {

constexpr int max_halvings = 4;

/// How far untangling may reach: layers of hexes around the inverted ones; whether old nodes inside volumes may move
/// too, and whether new nodes may slide along their curves and surfaces. Whether the nodes of these layers start from
/// where they were placed, or from what the last try has left; sweeps at most.
struct Reach {
  int layers;
  bool old_nodes;
  bool slide;
  bool afresh = false;
  int sweeps = 100;
};
/// Nodes inside volumes move first: those on the CAD lie evenly, and one that slides away to make room makes other
/// hexes thin for the next pass. A failed try leaves nodes crowded together, and more freedom hardly separates them
/// again: hexes stay inverted, or the skin folds over itself. So the widest reach starts afresh.
constexpr Reach reaches[] = {{2, false, false}, {1, false, true}, {2, false, true}, {3, true, true, true, 300}};
constexpr Reach backed_off_reach = {1, false, false};  // sliding would put nodes back on the CAD

/// Untangles around the bad hexes, and smooths a little so that they are not only just right. Old nodes on the CAD
/// stay. Returns the hexes that are inverted still.
std::vector<Index> untangle(const Split& split, const Model* model, Mesh& mesh, Association& association,
                            const std::vector<Index>& bad, Reach reach, std::span<const Index> fixed,
                            const SmoothProgress& progress) {
  const auto may_move = [&](Index n) {
    const bool inside = association.empty() || association.node_owner[n].dim == 3;
    return n < split.lineage.n_old_nodes ? reach.old_nodes && inside : reach.slide || inside;
  };
  SmoothOptions options;
  options.scheme = SmoothScheme::untangle;
  options.iterations = reach.sweeps;
  options.fixed.assign(fixed.begin(), fixed.end());
  options.nodes = nodes_of_hexes(mesh, with_layers(mesh, bad, reach.layers));
  std::erase_if(*options.nodes, [&](Index n) { return !may_move(n); });
  if (smooth(mesh, association, model, options, progress).not_repaired.empty()) {
    options.scheme = SmoothScheme::mean_ratio;
    options.iterations = 10;
    smooth(mesh, association, model, options, progress);
  }
  return inverted_hexes(mesh, reach.old_nodes ? 0 : split.n_kept());
}

/// Straight places of the new nodes among `wanted` (ascending).
std::vector<Vec3> straight_places(const Mesh& old_mesh, const Lineage& lineage, std::span<const Index> wanted) {
  std::vector<Vec3> places(wanted.size());
  const auto take = [&](Index node, const Origin& origin) {
    const Index at = position_in(wanted, node);
    if (at < 0) return;
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < origin.n; ++i) sum += origin.weight[i] * old_mesh.points[origin.node[i]];
    places[at] = sum;
  };
  for (const CutEdge& edge : lineage.edges) for_each_node(lineage, edge, take);
  for (const CutFace& face : lineage.faces) for_each_node(lineage, face, take, old_mesh.points);
  for (const CutHex& hex : lineage.hexes) for_each_node(lineage, hex, old_mesh.hexes, take, old_mesh.points);
  return places;
}

}  // namespace

std::vector<OffOwner> repair_children(const Mesh& old_mesh, const Split& split, const Model* model, Mesh& mesh,
                                      Association& association, std::span<const Index> fixed,
                                      const SmoothProgress& progress) {
  std::vector<OffOwner> rows;
  std::vector<Index> bad = inverted_hexes(mesh, split.n_kept());
  const Index first_new = split.lineage.n_old_nodes;
  const auto owner = [&](Index node) { return association.empty() ? Owner{3, 1} : association.node_owner[node]; };

  // 1. Move nodes in space and along their curves and surfaces.
  if (bad.empty()) return rows;
  const std::vector<Vec3> placed = mesh.points;
  const std::vector<Parameters> placed_parameters = association.node_parameters;
  for (const Reach reach : reaches) {
    if (bad.empty()) return rows;
    if (reach.afresh) {
      for (const Index n : nodes_of_hexes(mesh, with_layers(mesh, bad, reach.layers))) {
        mesh.points[n] = placed[n];
        if (!placed_parameters.empty()) association.node_parameters[n] = placed_parameters[n];
      }
      bad = inverted_hexes(mesh, split.n_kept());
    }
    bad = untangle(split, model, mesh, association, bad, reach, fixed, progress);
  }
  if (bad.empty()) return rows;

  // 2. Back off from the CAD.
  std::vector<Index> backed_off;
  for (int halving = 1; halving <= max_halvings && !bad.empty(); ++halving) {
    const std::vector<Index> nodes = nodes_of_hexes(mesh, bad, first_new);
    const std::vector<Vec3> straight = straight_places(old_mesh, split.lineage, nodes);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      mesh.points[nodes[i]] = halving == max_halvings ? straight[i] : Vec3((mesh.points[nodes[i]] + straight[i]) / 2);
    backed_off.insert(backed_off.end(), nodes.begin(), nodes.end());
    bad = inverted_hexes(mesh, split.n_kept());
    if (!bad.empty()) bad = untangle(split, model, mesh, association, bad, backed_off_reach, fixed, progress);
  }
  sort_unique(backed_off);
  for (const Index node : backed_off) {
    const Owner on = owner(node);
    if (!model || on.dim > 2) continue;
    const Projection projection = model->project(on, mesh.points[node]);
    association.node_parameters[node] = projection.parameters;
    if (projection.distance > 0) rows.push_back({node, on, projection.distance});
  }
  return rows;
}

}  // namespace hextwist
