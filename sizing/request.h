// One refinement as asked for, run through all layers: targets, marks, split, carry, place, improve, verify.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hextwist/geom/model.h"
#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/mesh.h"
#include "hextwist/mesh/meshed_model.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/validate/validate.h"
#include "hextwist/refine/lineage.h"
#include "hextwist/refine/place.h"

namespace hextwist {

struct Extremes;
class SizeField;

enum class TargetKind { node, edge, face, hex, vertex, curve, surface, volume };
const char* name(TargetKind kind);

/// What to do where a region is concave: templates of their own, or filling it up as the paper does (section 4.3).
enum class Concave { templates, fill };

/// Which technique of the paper (table 1).
enum class Method {
  automatic,    ///< single for hexes and volumes and for depth >= 1; combination for all else; with sizes single or
                ///< parallel or combination, whichever comes nearer to them (docs/commands.md has the rule)
  single,       ///< trisecting: section 4
  parallel,     ///< enclosing at half: section 5.1 to 5.3; hexes, volumes and depth >= 1 one into eight (eight.h)
  combination,  ///< enclosing at a third, then trisecting along the target: section 5.4
};

/// "auto", "single", "parallel", "combination".
const char* name(Method method);

/// Request::numsplit is at most this where not all volumes of the model are refined together: 3^8 pieces per edge.
inline constexpr int max_numsplit = 8;

/// What to do about the hex field of levels (adapt.h), which says how often hexes were cut in all directions at once.
enum class Levels {
  ignored,  ///< children have the value of their parent, like that of any other field
  counted,  ///< children of a hex that is cut in all directions are one above it
  graded,   ///< and more hexes are cut so that none shares a node with one more than one level below its own (sizes by
            ///< threes, and numsplit of whole hexes)
};

/// Instead of targets: the hex sheets (mesh/sheets.h) that edges belong to. Their edges are cut in three, once; nothing
/// else is.
struct SheetRequest {
  std::vector<Index> edges = {};  ///< as numbered by edges(); each chooses the sheet that cuts it
  /// The sheets that cross those at the edges instead: across the other directions of the hexes around the edges.
  bool crossing = false;
  std::optional<double> greater_than = std::nullopt;  ///< leave edges alone that are no longer than this
  std::optional<double> factor = std::nullopt;        ///< or than this times the shortest edge of the sheets
};

/// Layers along the target in the hexes that touch it: boundary layers.
struct LayerRequest {
  int n_layers = 2;  ///< that each of these hexes is cut into, 1 .. 50
  double growth =
      1;  ///< thickness of a layer / thickness of the one before it, which is nearer to the target. 0.1 .. 10
};

/// Which entities to refine and how much.
struct Request {
  TargetKind kind = TargetKind::hex;
  /// Mesh entities by index (0-based; edges and faces as numbered by edges() and faces()), CAD entities by id.
  /// Ascending, each once.
  std::vector<Index> targets = {};
  /// How often each target edge is cut in three. 1 .. max_numsplit. All volumes of the model together are refined
  /// uniformly instead: every edge in numsplit + 1 pieces, 1 .. 29.
  int numsplit = 1;
  /// Layers of hexes around the target that are refined fully too: 0 exactly the target (for nodes, edges, faces and
  /// what the CAD calls so: the combination technique), 1 every hex that touches it, ... Default: 0; 1 for
  /// Method::single of anything but hexes and volumes.
  std::optional<int> depth = std::nullopt;
  /// Instead of depth: hexes whose centroid lies within this distance of the target entity (the CAD entity itself
  /// where it is one).
  std::optional<double> radius = std::nullopt;

  /// Instead of numsplit: elements of about this size. Edges are cut while they are longer than sqrt(3) times the
  /// wished size, so that they end within a factor sqrt(3) of it.
  std::optional<double> size = std::nullopt;
  /// With size: 1, the size is wished for at the target only (the hexes that depth or radius choose; by default those
  /// that touch it); above 1, everywhere, growing by bias - 1 per unit of distance from the target entity, so that
  /// neighbours grow by about that factor; depth or radius then limit where. With a size field: the wished sizes are
  /// lowered so that they grow by at most that much.
  double bias = 1;
  /// Wished size by place (size_field.h), in the hexes of the target; with a size, the smaller of both counts.
  std::shared_ptr<const SizeField> size_field = nullptr;
  /// Sizes are approached in passes that each cut by up to three; after so many the rest is reported as unmet. 1 .. 30.
  int max_passes = 12;

  /// Refinement in one direction only. Of surfaces and faces: the edges that leave them are cut in three (numsplit
  /// times), and so on from hex to hex to the other side of the mesh.
  bool through_thickness = false;
  std::optional<LayerRequest> layers = std::nullopt;  ///< of anything but hexes and volumes
  std::optional<SheetRequest> sheets = std::nullopt;  ///< kind and targets are then not looked at

  Method method = Method::automatic;
  Concave concave = Concave::templates;
  Levels levels = Levels::ignored;
  bool smooth = false;            ///< smooth the new hexes and two layers around them (smooth.h) after the last pass
  std::vector<Index> fixed = {};  ///< nodes (0-based) that neither smoothing nor the repair of children moves
  bool dry_run = false;           ///< count only: the result holds no mesh
};

/// Seconds per stage of a refinement, in the order run.
struct StageTime {
  std::string stage;
  double seconds = 0;
};

/// How well a request for sizes was met. The zone: the hexes at which it was wished for (with a bias: the hexes that it
/// made and those at the target). The actual size of a hex is the cube root of its volume; the wished one that at its
/// centroid.
struct SizeReport {
  int n_passes = 0;
  std::vector<Index> hexes;   ///< of the zone, ascending
  std::vector<double> ratio;  ///< per hex of the zone: actual size / wished size
  Index n_coarser = 0;        ///< ratio above sqrt(3)
  Index n_finer = 0;          ///< below 1 / sqrt(3)
  Index n_much_finer = 0;     ///< below 1 / 3
  std::vector<Index> unmet;   ///< hexes that would be cut again if there were passes left, ascending
  /// Part of the zone within a factor sqrt(3) of the wish, 0..1; 1 for an empty zone.
  double met() const {
    const auto n = static_cast<double>(hexes.size());
    return hexes.empty() ? 1 : 1 - static_cast<double>(n_coarser + n_finer) / n;
  }
};

struct Report {
  std::int64_t hexes_before = 0, hexes_after = 0;
  std::int64_t nodes_before = 0, nodes_after = 0;
  std::int64_t filled_hexes = 0;  ///< hexes that joined the region because of Concave::fill
  Summary shape_before, shape_after;
  Summary scaled_jacobian_before, scaled_jacobian_after;
  OffModel off_cad;
  std::shared_ptr<const Extremes> extremes;  ///< of the result (extremes.h), for who refines it again
  double volume_before = 0, volume_after = 0;
  std::vector<OffOwner> off_nodes;    ///< nodes that were left off their owner
  std::vector<Violation> violations;  ///< of the result; empty unless something is wrong with it
  std::optional<SizeReport> sizes;    ///< of a request for sizes; absent for a dry run
  std::vector<std::string> notices;   ///< decisions taken, one line each
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
  Lineage lineage;            ///< of the last pass
  std::vector<Index> origin;  ///< over all passes: per hex, the hex of the input that it lies in; empty for a dry run
  Report report;
};

}  // namespace hextwist
