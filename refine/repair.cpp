// Last resort of placing: what to do about children that came out inverted.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/loose_topology.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/periodic.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/mesh/smooth/smooth.h"
#include "hextwist/refine/origin.h"
#include "hextwist/refine/place.h"

namespace hextwist {
namespace {

constexpr int max_halvings = 4;

/// How far untangling may reach: layers of hexes around the inverted ones; whether old nodes inside volumes may move
/// too, and whether new nodes may slide along their curves and surfaces. Whether the nodes of these layers start from
/// where they were placed, or from what the last try has left; sweeps at most.
struct RepairReach {
  int layers;
  bool old_nodes;
  bool slide;
  bool afresh = false;
  int sweeps = 100;
};
/// Nodes inside volumes move first: those on the CAD lie evenly, and one that slides away to make room makes other
/// hexes thin for the next pass. A failed try leaves nodes crowded together, and more freedom hardly separates them
/// again: hexes stay inverted, or the skin folds over itself. So the widest reach starts afresh.
constexpr RepairReach reaches[] = {{2, false, false}, {1, false, true}, {2, false, true}, {3, true, true, true, 300}};
constexpr RepairReach backed_off_reach = {1, false, false};  // sliding would put nodes back on the CAD

/// What does not move.
struct Staying {
  std::span<const Index> fixed;
  std::span<const std::string> keep_jumps;
  void tell(SmoothOptions& options) const {
    options.fixed.assign(fixed.begin(), fixed.end());
    options.keep_jumps.assign(keep_jumps.begin(), keep_jumps.end());
  }
};

/// Untangles around the bad hexes, and smooths a little so that they are not only just right. Old nodes on the CAD
/// stay. Returns the hexes that are inverted still.
std::vector<Index> untangle(const Split& split, const Model* model, Mesh& mesh, Association& association,
                            const std::vector<Index>& bad, RepairReach reach, const Staying& stays,
                            const SmoothProgress& progress) {
  const auto may_move = [&](Index n) {
    const bool inside = association.empty() || association.node_owner[n].dim == 3;
    return n < split.lineage.n_old_nodes ? reach.old_nodes && inside : reach.slide || inside;
  };
  SmoothOptions options;
  options.scheme = SmoothScheme::untangle;
  options.iterations = reach.sweeps;
  stays.tell(options);
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
  for (const CutFace& face : lineage.faces) for_each_node(lineage, face, take);
  for (const CutHex& hex : lineage.hexes) for_each_node(lineage, hex, old_mesh.hexes, take);
  return places;
}

/// Hexes around each of these nodes (ascending).
std::vector<std::vector<Index>> hexes_around(const Mesh& mesh, std::span<const Index> nodes) {
  std::vector<std::vector<Index>> around(nodes.size());
  std::vector<std::uint8_t> wanted(mesh.points.size(), 0);
  for (const Index n : nodes) wanted[n] = 1;
  for (const Index h : touching_hexes(mesh.hexes, wanted))
    for (const Index n : mesh.hexes[h])
      if (wanted[n]) around[position_in(nodes, n)].push_back(h);
  return around;
}

/// Brings nodes (ascending) that were moved off their owners back, step by step: each goes as far as the hexes around
/// it allow, then the others around give way, in the end those on the CAD too, which slide. Returns those that are off
/// still.
std::vector<Index> return_to_owners(const Model& model, Mesh& mesh, Association& association, std::vector<Index> nodes,
                                    const Staying& stays, const SmoothProgress& progress) {
  constexpr int max_rounds = 30, sweeps = 8, layers = 2;
  constexpr double least_part = 0.05;
  for (int round = 0; round < max_rounds && !nodes.empty(); ++round) {
    const std::vector<std::vector<Index>> around = hexes_around(mesh, nodes);
    std::vector<Index> left, hexes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      Vec3& place = mesh.points[nodes[i]];
      const Vec3 from = place;
      const Projection to = model.project(association.node_owner[nodes[i]], from);
      double part = 1;
      for (; part > least_part; part /= 2) {
        place = part == 1 ? to.point : Vec3(from + part * (to.point - from));
        if (inverted_hexes(mesh, around[i]).empty()) break;
        place = from;
      }
      association.node_parameters[nodes[i]] = to.parameters;
      if (part == 1) continue;
      left.push_back(nodes[i]);
      hexes.insert(hexes.end(), around[i].begin(), around[i].end());
    }
    nodes = std::move(left);
    if (nodes.empty()) break;
    SmoothOptions options;
    options.iterations = sweeps;
    options.fix_boundary = round < max_rounds / 2;
    stays.tell(options);
    options.fixed.insert(options.fixed.end(), nodes.begin(), nodes.end());
    options.nodes = nodes_of_hexes(mesh, with_layers(mesh, sorted_unique(std::move(hexes)), layers));
    if (smooth(mesh, association, &model, options, progress).stopped) break;
  }
  return nodes;
}

}  // namespace

std::vector<OffOwner> repair_children(const Mesh& old_mesh, const Split& split, const Model* model, Mesh& mesh,
                                      Association& association, const RepairOptions& options, bool* had_to) {
  std::vector<OffOwner> rows;
  const Staying stays{options.fixed, options.keep_jumps};
  const SmoothProgress& progress = options.progress;
  std::vector<Index> bad = inverted_hexes(mesh, split.n_kept());
  if (had_to) *had_to = !bad.empty();
  const Index first_new = split.lineage.n_old_nodes;
  const auto owner = [&](Index node) { return association.empty() ? Owner{3, 1} : association.node_owner[node]; };

  // 1. Move nodes in space and along their curves and surfaces.
  if (bad.empty()) return rows;
  const std::vector<Vec3> placed = mesh.points;
  const std::vector<Parameters> placed_parameters = association.node_parameters;
  const auto put_back = [&](std::span<const Index> nodes) {
    for (const Index n : nodes) {
      mesh.points[n] = placed[n];
      if (!placed_parameters.empty()) association.node_parameters[n] = placed_parameters[n];
    }
    bad = inverted_hexes(mesh, split.n_kept());
  };
  const auto try_all = [&](const Staying& staying) {
    for (const RepairReach reach : reaches) {
      if (bad.empty()) return;
      if (reach.afresh) put_back(nodes_of_hexes(mesh, with_layers(mesh, bad, reach.layers)));
      bad = untangle(split, model, mesh, association, bad, reach, staying, progress);
    }
  };
  if (!options.repeated_surfaces.empty()) {
    const std::vector<Index> staying =
        union_of(sorted_unique(std::vector<Index>(options.fixed.begin(), options.fixed.end())),
                 nodes_on_surfaces(mesh, association, options.repeated_surfaces));
    try_all({staying, options.keep_jumps});
    if (bad.empty()) return rows;
    put_back(nodes_of_hexes(mesh, with_layers(mesh, bad, reaches[std::size(reaches) - 1].layers)));
  }
  try_all(stays);
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
    if (!bad.empty()) bad = untangle(split, model, mesh, association, bad, backed_off_reach, stays, progress);
  }
  sort_unique(backed_off);
  std::erase_if(backed_off, [&](Index node) { return !model || owner(node).dim > 2; });
  if (!backed_off.empty() && bad.empty())
    backed_off = return_to_owners(*model, mesh, association, std::move(backed_off), stays, progress);
  for (const Index node : backed_off) {
    const Owner on = owner(node);
    const Projection projection = model->project(on, mesh.points[node]);
    association.node_parameters[node] = projection.parameters;
    if (projection.distance > 0) rows.push_back({node, on, projection.distance});
  }
  return rows;
}

}  // namespace hextwist
