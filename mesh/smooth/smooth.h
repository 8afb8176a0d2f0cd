// Smoothing and untangling: moves nodes so that hexes get better shapes.
//
// Guarantees, whatever the scheme and the options:
//  1. the smallest shape and the smallest scaled Jacobian (quality.h) of the hexes around nodes that moved are not
//  below
//     what they were (0 when one of them was inverted; of a scaled Jacobian above 0.9 that much is kept), and no hex is
//     inverted (validity.h) that was not;
//  2. only `nodes` move, never `fixed` ones, nodes on vertices, or boundary nodes whose curve or surface is not known.
//     Nodes on curves and surfaces stay on them (they are results of Model::project) and their parameters follow;
//  3. what the user named inside the mesh keeps its shape: block boundaries, side sets, sheets, lines and points of
//  node
//     sets. Their nodes slide in the plane or along the line that they span, and stay where that bends;
//  4. the same bits for any number of threads.
//
// The default scheme minimises a distortion that is convex in the place of each single node, node by node with exact
// first and second derivatives, while a term of high power lifts the worst hexes; then takes back what that cost the
// average, holding the smallest shape; at last lifts scaled Jacobians below 0.3. docs/smoothing.md has energies, line
// search and stopping rule.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hextwist/geom/model.h"
#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/quality/quality.h"

namespace HEXTWIST_API hextwist {

/// What smoothing is after.
enum class SmoothScheme {
  mean_ratio,        ///< shape; untangles first where that is needed
  condition_number,  ///< |A| |A^-1| / 3 at the corners (Knupp 2000) instead; untangles likewise
  laplacian,         ///< to the average of the edge neighbours, where guarantee 1 allows it
  untangle,          ///< only until no hex is inverted
};
/// "mean ratio", "condition number", "laplacian", "untangle".
const char* name(SmoothScheme scheme);
/// By name; case, '_' and '-' do not matter. Throws Error listing the known ones.
SmoothScheme smooth_scheme(std::string_view name);

/// Which nodes move, how, and how long.
struct SmoothOptions {
  SmoothScheme scheme = SmoothScheme::mean_ratio;  ///< the default is the best for nearly all meshes
  /// Nodes that may move, in any order; none given: all.
  std::optional<std::vector<Index>> nodes;
  /// Nodes that stay, whatever `nodes` says.
  std::vector<Index> fixed;
  /// Hex fields (by name) whose jumps keep their place like block boundaries do; those there are not do nothing.
  std::vector<std::string> keep_jumps;
  /// Boundary nodes stay, even where their owner is known.
  bool fix_boundary = false;
  /// Boundary nodes without a known curve or surface move freely in space (else they stay).
  bool free_boundary = false;
  /// Sweeps over the nodes at most, all stages together. >= 0.
  int iterations = 100;
  /// A node is at rest when its step is shorter than this times its edges; the end is when all but one in a
  /// thousand are, or (mean ratio) when a sweep gains less than a thousandth of the average distortion above 1. > 0.
  double tolerance = 1e-2;
  /// The worst hexes are lifted as far as the average shape stays above its start less this. Shape units; infinite:
  /// the worst at any price; below 0: the average must rise by as much.
  double average_loss = 0;
  /// Fill SmoothReport::history (costs a pass over the hexes per sweep).
  bool record_history = false;
};

/// State after a sweep.
struct SmoothStep {
  const char* stage = "";    ///< "start", "untangle", "shape", "worst", "average", "laplacian", "condition number",
                             ///< "corners"
  double min_shape = 0;      ///< over the hexes around the nodes that could move
  double average_shape = 0;  ///< over the same hexes
  double energy = 0;         ///< average over the corners of (shape at the corner)^(-3/2); infinite while inverted
  std::int64_t node_updates = 0;  ///< so far
  double seconds = 0;             ///< so far
};

/// What smoothing has done.
struct SmoothReport {
  Index n_nodes = 0;                ///< that could move
  Summary shape_before;             ///< over the hexes around those nodes
  Summary shape_after;              ///< over the same hexes
  Index inverted_before = 0;        ///< among these hexes
  std::vector<Index> not_repaired;  ///< hexes that are inverted still, ascending
  int sweeps = 0;                   ///< over the nodes, all stages together
  std::int64_t node_updates = 0;    ///< optimisations of one node's place
  bool converged = false;           ///< ended because nothing moved or improved any more
  bool stopped = false;             ///< by the progress callback
  double seconds = 0;               ///< wall clock
  std::vector<SmoothStep> history;  ///< the start and every sweep, if asked for (SmoothOptions::record_history)
};

/// Called after each sweep with the stage and a fraction 0..1 of the sweeps allowed; false: stop with what is reached.
using SmoothProgress = std::function<bool(const char* stage, double fraction)>;

/// Smooths in place. association may be empty, model null: then all boundary nodes stay (but see the options), and
/// parameters are left alone. The mesh must be valid but for inverted hexes.
/// Throws Error when options are out of range or name nodes that do not exist.
SmoothReport smooth(Mesh& mesh, Association& association, const Model* model, const SmoothOptions& options = {},
                    const SmoothProgress& progress = {});

}  // namespace hextwist
