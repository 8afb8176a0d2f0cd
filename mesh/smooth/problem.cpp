#include "hextwist/mesh/smooth/problem_internal.h"

#include <algorithm>
#include <bit>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/topology.h"

namespace hextwist {
namespace {

void check_node(const Mesh& mesh, Index node) {
  if (node < 0 || node >= mesh.n_nodes())
    throw Error("smooth: no node with index " + std::to_string(node) + " in a mesh of " +
                std::to_string(mesh.n_nodes()) + " nodes");
}

/// Per node: may it move, and on what. Owner dim -1: stays; 1, 2: slides; 3: free.
std::vector<Owner> freedom(const Mesh& mesh, const Association& association, const Model* model,
                           const SmoothOptions& options) {
  const Owner stays, anywhere{3, 0};
  std::vector<Owner> result(mesh.points.size(), options.nodes ? stays : anywhere);
  if (options.nodes)
    for (const Index node : *options.nodes) {
      check_node(mesh, node);
      result[node] = anywhere;
    }
  for (const Index node : options.fixed) {
    check_node(mesh, node);
    result[node] = stays;
  }
  const auto restrict_boundary_node = [&](Index node, Owner owner) {
    if (!result[node]) return;
    if (options.fix_boundary || owner.dim == 0)
      result[node] = stays;
    else if (model != nullptr && (owner.dim == 1 || owner.dim == 2) && owner.id >= 1 &&
             owner.id <= model->count(owner.dim))
      result[node] = owner;
    else
      result[node] = options.free_boundary ? anywhere : stays;
  };
  std::vector<std::uint8_t> known(mesh.points.size(), 0);
  if (!association.empty())
    for (Index node = 0; node < mesh.n_nodes(); ++node)
      if (const Owner owner = association.node_owner[node]) {
        known[node] = 1;
        if (owner.dim < 3) restrict_boundary_node(node, owner);
      }
  if (std::ranges::find(known, 0) == known.end()) return result;
  // Owners are missing: the skin tells which nodes are on the boundary.
  const Faces mesh_faces = faces(mesh);
  for (const auto [hex, face] : boundary_sides(mesh_faces))
    for (const Index node : face_nodes(mesh.hexes[hex], face))
      if (!known[node]) restrict_boundary_node(node, Owner{});
  return result;
}

/// What the user named holds nodes too; those that it holds altogether stay.
Holds hold_named(const Mesh& mesh, const Association& association, const SmoothOptions& options,
                 std::vector<Owner>& free_on) {
  std::vector<std::uint8_t> may_move(free_on.size());
  for (std::size_t n = 0; n < free_on.size(); ++n) may_move[n] = free_on[n] ? 1 : 0;
  Holds holds = named_holds(mesh, association, may_move, options.keep_jumps);
  for (std::size_t n = 0; n < holds.of_node.size(); ++n)
    if (holds.of_node[n] >= 0 && holds.list[holds.of_node[n]].n == 3) free_on[n] = Owner{};
  return holds;
}

/// Greedy colours in the order of the slots; corners: per slot 8 * hex + corner.
std::vector<Index> colour(const Mesh& mesh, const std::vector<Index>& slot, const CompressedRows& corners) {
  std::vector<Index> colour_of(corners.size(), -1);
  std::vector<Index> taken;  // per colour: the last slot that could not have it
  for (Index s = 0; s < corners.size(); ++s) {
    for (const Index corner : corners[s])
      for (const Index node : mesh.hexes[corner / 8])
        if (const Index other = slot[node]; other >= 0 && colour_of[other] >= 0) taken[colour_of[other]] = s;
    Index c = 0;
    while (c < static_cast<Index>(taken.size()) && taken[c] == s) ++c;
    if (c == static_cast<Index>(taken.size())) taken.push_back(-1);
    colour_of[s] = c;
  }
  return colour_of;
}

}  // namespace

Ring ring_at(const Hex& hex, int corner) {
  // Seen from a corner with an odd number of high coordinates the axes are left-handed.
  const bool odd = std::popcount(static_cast<unsigned>(corner)) % 2 == 1;
  const int a = odd ? 2 : 1, b = odd ? 1 : 2, c = 4;
  return {{hex[corner ^ a], hex[corner ^ b], hex[corner ^ c]},
          {hex[corner ^ a ^ b], hex[corner ^ a ^ c], hex[corner ^ b ^ c]}};
}

SmoothProblem make_smooth_problem(const Mesh& mesh, const Association& association, const Model* model,
                                  const SmoothOptions& options) {
  std::vector<Owner> free_on = freedom(mesh, association, model, options);
  SmoothProblem problem;
  const Holds holds = hold_named(mesh, association, options, free_on);
  problem.holds = holds.list;
  problem.slot.assign(mesh.points.size(), -1);
  std::vector<Index> used;  // movable nodes, ascending
  CompressedRows corners;   // per movable node, ascending: 8 * hex + corner
  {
    std::vector<Index> count(mesh.points.size(), 0);
    for (const Hex& hex : mesh.hexes)
      for (const Index node : hex)
        if (free_on[node]) ++count[node];
    corners.first.push_back(0);
    for (Index node = 0; node < mesh.n_nodes(); ++node)
      if (count[node] > 0) {
        problem.slot[node] = static_cast<Index>(used.size());
        used.push_back(node);
        corners.first.push_back(corners.first.back() + count[node]);
        problem.max_rings = std::max(problem.max_rings, count[node]);
      }
    corners.items.resize(corners.first.back());
    std::vector<Index> next(corners.first.begin(), corners.first.end() - 1);
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      bool touched = false;
      for (int c = 0; c < 8; ++c)
        if (const Index s = problem.slot[mesh.hexes[h][c]]; s >= 0) {
          corners.items[next[s]++] = 8 * h + c;
          touched = true;
        }
      if (touched) problem.hexes.push_back(h);
    }
  }
  const std::vector<Index> colour_of = colour(mesh, problem.slot, corners);

  // Counting sort by colour.
  const Index n_colours = used.empty() ? 0 : *std::ranges::max_element(colour_of) + 1;
  problem.first_colour.assign(n_colours + 1, 0);
  for (const Index c : colour_of) ++problem.first_colour[c + 1];
  for (Index c = 0; c < n_colours; ++c) problem.first_colour[c + 1] += problem.first_colour[c];
  std::vector<Index> next(problem.first_colour.begin(), problem.first_colour.end() - 1);
  std::vector<Index> order(used.size());
  for (Index s = 0; s < static_cast<Index>(used.size()); ++s) order[next[colour_of[s]]++] = s;

  problem.first_ring.push_back(0);
  for (const Index s : order) {
    const Index node = used[s];
    problem.slot[node] = problem.n_nodes();
    problem.nodes.push_back(node);
    problem.owner.push_back(free_on[node]);
    if (!holds.of_node.empty()) problem.hold.push_back(holds.of_node[node]);
    for (const Index corner : corners[s]) {
      problem.rings.push_back(ring_at(mesh.hexes[corner / 8], corner % 8));
      problem.ring_hex.push_back(corner / 8);
    }
    problem.first_ring.push_back(static_cast<Index>(problem.rings.size()));
  }
  return problem;
}

}  // namespace hextwist
