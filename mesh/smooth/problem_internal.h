// What a smoother works on: the nodes that may move, each with the corners of the hexes around it.
#pragma once

#include <array>
#include <vector>

#include "hextwist/mesh/smooth/lift.h"
#include "hextwist/mesh/smooth/named_internal.h"

namespace hextwist {

/// A hex seen from one of its corners x: the ends of its edges at x, so ordered that det(n0 - x, n1 - x, n2 - x) > 0,
/// and the far corners of the faces (n0, n1), (n0, n2), (n1, n2). Moving x changes four corner matrices of the hex, and
/// the eighth corner is in none of them.
struct Ring {
  std::array<Index, 3> edge;
  std::array<Index, 3> face;  ///< across (0, 1), (0, 2), (1, 2)
};
Ring ring_at(const Hex& hex, int corner);

/// Slot: position of a node in `nodes`. Nodes of one colour share no hex, so they can move at the same time.
struct SmoothProblem {
  std::vector<Index> nodes;         ///< by colour, then ascending
  std::vector<Index> first_colour;  ///< n_colours + 1: slots
  std::vector<Index> first_ring;    ///< per slot, + 1
  std::vector<Ring> rings;
  std::vector<Index> ring_hex;  ///< per ring
  std::vector<Owner> owner;     ///< per slot: dim 1, 2: slides on it; else moves freely
  std::vector<Hold> holds;      ///< of nodes that what the user named holds too
  std::vector<Index> hold;      ///< per slot: position there, -1: none; empty: no node has one
  std::vector<Index> slot;      ///< per node of the mesh, -1: stays
  std::vector<Index> hexes;     ///< around the nodes, ascending
  Index max_rings = 0;          ///< of one node

  const Hold* hold_of(Index of_slot) const {
    return hold.empty() || hold[of_slot] < 0 ? nullptr : &holds[hold[of_slot]];
  }
  /// Does the node slide on something, or move freely?
  bool slides(Index of_slot) const { return owner[of_slot].dim < 3 || hold_of(of_slot); }
  Index n_nodes() const { return static_cast<Index>(nodes.size()); }
  Index n_colours() const { return static_cast<Index>(first_colour.size()) - 1; }
};

SmoothProblem make_smooth_problem(const Mesh& mesh, const Association& association, const Model* model,
                                  const SmoothOptions& options);

/// The mesh that a sweep changes, and where its nodes may go.
struct SmoothState {
  const SmoothProblem& problem;
  Mesh& mesh;
  Association& association;
  const Model* model;
  /// Per slot: to be visited in the next sweep. A node that moves wakes its neighbours.
  std::vector<std::uint8_t> awake;
};

struct SweepRule {
  /// No corner may get a distortion (shape^(-3/2)) above this, and one that has more must get less.
  double limit = std::numeric_limits<double>::infinity();
  /// No corner may get a scaled Jacobian below this, and one that has less must not get still less; 0: anything goes.
  double least_corner = 0;
  double tolerance = 1e-2;  ///< SmoothOptions::tolerance
  /// Energy per corner: h + weight * reference * (h / reference)^16, h: its distortion.
  double weight = 0;
  double reference = 1;
};
struct SweepCount {
  std::int64_t updates = 0;
  std::int64_t moved = 0;  ///< by more than the tolerance
};

SweepCount sweep_mean_ratio(SmoothState& state, const SweepRule& rule);
SweepCount sweep_condition_number(SmoothState& state, const SweepRule& rule);
SweepCount sweep_laplacian(SmoothState& state, const SweepRule& rule);

/// Per hex the largest shape^(-3/2) of its corners; infinite when it is inverted or flat.
void hex_distortions(const Mesh& mesh, std::span<const Index> hexes, std::vector<double>& out);
/// Average over all corners of these hexes.
double average_distortion(const Mesh& mesh, std::span<const Index> hexes);

/// Moves nodes until no hex of the problem is inverted or nothing helps any more. after_sweep(count) returns false to
/// stop. Hexes that were not inverted before are not after.
void untangle(SmoothState& state, int max_sweeps, const std::function<bool(const SweepCount&)>& after_sweep);

/// Sweeps over the nodes of hexes whose scaled Jacobian is below the bound, while no shape falls below its; after_sweep
/// as above.
void lift_low(SmoothState& state, const Bounds& bounds, int max_sweeps,
              const std::function<bool(const SweepCount&)>& after_sweep);

/// Puts nodes back to these places until no hex of the problem is inverted but those that were (ascending), and none
/// is below the bounds.
void take_back(SmoothState& state, const std::vector<Vec3>& points, const std::vector<Parameters>& parameters,
               std::span<const Index> inverted_before, const Bounds& least);

}  // namespace hextwist
