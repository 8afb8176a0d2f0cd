// One refinement as asked for, run through all layers: targets, marks, split, carry, place, improve, verify.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hextwist/geom/model.h"
#include "hextwist/mesh/association.h"
#include "hextwist/mesh/mesh.h"
#include "hextwist/mesh/quality.h"
#include "hextwist/mesh/validate.h"
#include "hextwist/refine/lineage.h"
#include "hextwist/refine/place.h"

namespace hextwist {

/// A mesh, the model it lies on, and who owns what. model may be null only when the association is empty.
struct MeshedModel {
  Mesh mesh;
  std::shared_ptr<const Model> model;
  Association association;
};

enum class TargetKind { node, edge, face, hex, vertex, curve, surface, volume };
const char* name(TargetKind kind);

/// What to do where a region is concave: templates of their own, or filling it up as the paper does (section 4.3).
enum class Concave { templates, fill };

/// Which technique of the paper (table 1).
enum class Method {
  automatic,    ///< single for hexes and volumes and for depth >= 1; combination for all else
  single,       ///< trisecting: section 4
  parallel,     ///< enclosing at half: section 5.1 to 5.3; hexes, volumes and depth >= 1 one into eight (eight.h)
  combination,  ///< enclosing at a third, then trisecting along the target: section 5.4
};

/// "auto", "single", "parallel", "combination".
const char* name(Method method);

/// Which entities to refine and how much.
struct Request {
  TargetKind kind = TargetKind::hex;
  /// Mesh entities by index (0-based; edges and faces as numbered by edges() and faces()), CAD entities by id.
  /// Ascending, each once.
  std::vector<Index> targets = {};
  /// How often each target edge is cut in three. 1 .. 8. All volumes of the model together are refined uniformly
  /// instead: every edge in numsplit + 1 pieces, 1 .. 29.
  int numsplit = 1;
  /// Layers of hexes around the target that are refined fully too: 0 exactly the target (for nodes, edges, faces and
  /// what the CAD calls so: the combination technique), 1 every hex that touches it, ... Default: 0; 1 for
  /// Method::single of anything but hexes and volumes.
  std::optional<int> depth = std::nullopt;
  Method method = Method::automatic;
  Concave concave = Concave::templates;
  bool smooth = false;            ///< smooth the new hexes and two layers around them (smooth.h) after the last pass
  std::vector<Index> fixed = {};  ///< nodes (0-based) that neither smoothing nor the repair of children moves
  bool dry_run = false;           ///< count only: the result holds no mesh
};

/// Seconds per stage of a refinement, in the order run.
struct StageTime {
  std::string stage;
  double seconds = 0;
};

struct Report {
  std::int64_t hexes_before = 0, hexes_after = 0;
  std::int64_t nodes_before = 0, nodes_after = 0;
  std::int64_t filled_hexes = 0;  ///< hexes that joined the region because of Concave::fill
  Summary shape_before, shape_after;
  Summary scaled_jacobian_before, scaled_jacobian_after;
  OffModel off_cad;
  double volume_before = 0, volume_after = 0;
  std::vector<Disappointment> off_nodes;  ///< nodes that were left off their owner
  std::vector<Violation> violations;      ///< of the result; empty unless something is wrong with it
  std::vector<std::string> notices;       ///< decisions taken, one line each
  std::vector<StageTime> seconds;
  double total_seconds = 0;
  std::size_t peak_memory_bytes = 0;  ///< of the process so far
};

/// Called now and then with a stage name and its progress 0..1; returns false to cancel (the call then throws
/// Cancelled and nothing has changed).
using Progress = std::function<bool(const char* stage, double fraction)>;
struct Cancelled : Error {
  Cancelled() : Error("cancelled") {}
};

struct RefineResult {
  MeshedModel refined;
  Lineage lineage;  ///< of the last pass
  Report report;
};

/// Runs a request. The input is not changed. The result is conformal and all-hex; it is uninverted and on the model
/// unless the report has violations (the caller decides whether to keep such a mesh; the program does not).
/// Throws Error for unknown ids, out-of-range options, CAD targets without a model; Cancelled.
RefineResult refine(const MeshedModel& input, const Request& request, const Progress& progress = {});

}  // namespace hextwist
