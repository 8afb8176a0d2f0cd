// Last resort of placing: what to do about children that came out inverted.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "hextwist/mesh/quality.h"
#include "hextwist/refine/origin.h"
#include "hextwist/refine/place.h"

namespace hextwist {
namespace {

constexpr int max_sweeps = 20;
constexpr int max_halvings = 4;

double smallest_scaled_jacobian(const Mesh& mesh, std::span<const Index> hexes) {
  double smallest = 1;
  for (const Index h : hexes) {
    std::array<Vec3, 8> corners;
    for (int c = 0; c < 8; ++c) corners[c] = mesh.points[mesh.hexes[h][c]];
    // The sign of the corner Jacobian counts first: scaled Jacobian alone would hide a flat corner.
    const double value = quality(Metric::scaled_jacobian, corners);
    smallest = std::min(smallest, value);
  }
  return smallest;
}

/// Hexes around the given nodes: pairs sorted by node.
struct Around {
  std::vector<Index> nodes;               // ascending
  std::vector<std::vector<Index>> hexes;  // per node; few, so small vectors are no burden
};

Around hexes_around(const Mesh& mesh, std::vector<Index> nodes) {
  Around around;
  around.hexes.resize(nodes.size());
  around.nodes = std::move(nodes);
  if (around.nodes.empty()) return around;
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (const Index n : mesh.hexes[h]) {
      const auto found = std::ranges::lower_bound(around.nodes, n);
      if (found != around.nodes.end() && *found == n) around.hexes[found - around.nodes.begin()].push_back(h);
    }
  return around;
}

std::vector<Index> nodes_of(const Mesh& mesh, std::span<const Index> hexes, Index first_node) {
  std::vector<Index> nodes;
  for (const Index h : hexes)
    for (const Index n : mesh.hexes[h])
      if (n >= first_node) nodes.push_back(n);
  std::ranges::sort(nodes);
  nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  return nodes;
}

/// Moves one node so that the worst hex around it gets better; pattern search with shrinking steps.
void improve_node(Mesh& mesh, Index node, std::span<const Index> hexes) {
  double step = 0;
  for (const Index h : hexes)
    for (int c = 0; c < 8; ++c)
      if (mesh.hexes[h][c] == node)
        for (int axis = 0; axis < 3; ++axis)
          step = std::max(step, (mesh.points[mesh.hexes[h][c ^ 1 << axis]] - mesh.points[node]).norm());
  double best = smallest_scaled_jacobian(mesh, hexes);
  for (step *= 0.25; step > 0; step *= 0.5) {
    const double before = best;
    for (int direction = 0; direction < 6; ++direction) {
      const Vec3 here = mesh.points[node];
      mesh.points[node][direction >> 1] += direction & 1 ? step : -step;
      const double value = smallest_scaled_jacobian(mesh, hexes);
      if (value > best)
        best = value;
      else
        mesh.points[node] = here;
    }
    if (best == before && best > 0) return;
    if (step < 1e-4 * (mesh.points[node] - mesh.points[mesh.hexes[hexes[0]][0]]).norm() + 1e-300) return;
  }
}

/// Straight places of the new nodes among `wanted` (ascending).
std::vector<Vec3> straight_places(const Mesh& old_mesh, const Lineage& lineage, std::span<const Index> wanted) {
  std::vector<Vec3> places(wanted.size());
  const auto take = [&](Index node, const Origin& origin) {
    const auto found = std::ranges::lower_bound(wanted, node);
    if (found == wanted.end() || *found != node) return;
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < origin.n; ++i) sum += origin.weight[i] * old_mesh.points[origin.node[i]];
    places[found - wanted.begin()] = sum;
  };
  for (const CutEdge& edge : lineage.edges) for_each_node(lineage, edge, take);
  for (const CutFace& face : lineage.faces) for_each_node(lineage, face, take);
  for (const CutHex& hex : lineage.hexes) for_each_node(lineage, hex, old_mesh.hexes, take);
  return places;
}

}  // namespace

std::vector<Index> inverted_hexes(const Mesh& mesh, Index first) {
  std::vector<std::uint8_t> bad(mesh.hexes.size(), 0);
  tbb::parallel_for(tbb::blocked_range<Index>(first, mesh.n_hexes(), 1024), [&](const auto& range) {
    for (Index h = range.begin(); h != range.end(); ++h) bad[h] = !(min_corner_jacobian(mesh, h) > 0);
  });
  std::vector<Index> result;
  for (Index h = first; h < mesh.n_hexes(); ++h)
    if (bad[h]) result.push_back(h);
  return result;
}

std::vector<Disappointment> repair_children(const Mesh& old_mesh, const Split& split, const Model* model, Mesh& mesh,
                                            Association& association) {
  std::vector<Disappointment> rows;
  std::vector<Index> bad = inverted_hexes(mesh, split.n_kept());
  const Index first_new = split.lineage.n_old_nodes;
  const auto owner = [&](Index node) { return association.empty() ? Owner{3, 1} : association.node_owner[node]; };

  // 1. Move nodes inside volumes.
  const auto untangle = [&] {
    for (int sweep = 0; sweep < max_sweeps && !bad.empty(); ++sweep) {
      std::vector<Index> nodes = nodes_of(mesh, bad, first_new);
      std::erase_if(nodes, [&](Index n) { return owner(n).dim != 3; });
      if (nodes.empty()) return;
      const Around around = hexes_around(mesh, std::move(nodes));
      for (std::size_t i = 0; i < around.nodes.size(); ++i) improve_node(mesh, around.nodes[i], around.hexes[i]);
      std::vector<Index> now = inverted_hexes(mesh, split.n_kept());
      const bool stuck = sweep > 4 && now == bad;
      bad = std::move(now);
      if (stuck) return;
    }
  };
  untangle();
  if (bad.empty()) return rows;

  // 2. Back off from the CAD.
  std::vector<Index> backed_off;
  for (int halving = 1; halving <= max_halvings && !bad.empty(); ++halving) {
    const std::vector<Index> nodes = nodes_of(mesh, bad, first_new);
    const std::vector<Vec3> straight = straight_places(old_mesh, split.lineage, nodes);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      mesh.points[nodes[i]] = halving == max_halvings ? straight[i] : Vec3((mesh.points[nodes[i]] + straight[i]) / 2);
    backed_off.insert(backed_off.end(), nodes.begin(), nodes.end());
    bad = inverted_hexes(mesh, split.n_kept());
    untangle();
  }
  std::ranges::sort(backed_off);
  backed_off.erase(std::ranges::unique(backed_off).begin(), backed_off.end());
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
