// What a refinement reports and returns.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hextwist/mesh/meshed_model.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/validate/validate.h"
#include "hextwist/refine/levels/level_origin.h"

namespace HEXTWIST_API hextwist {

struct Extremes;
struct Levelling;

/// Seconds per stage of a refinement, in the order run.
struct StageTime {
  std::string stage;   ///< "targets", "split", "place", ..., as Progress has them
  double seconds = 0;  ///< wall clock, all passes together
};

/// Edges of hexes compared with the wish, direction by direction (the longest of four counts).
struct DirectionSizes {
  Index n_longer = 0;   ///< by more than sqrt(3)
  Index n_shorter = 0;  ///< by more than sqrt(3)
};

/// How many hexes of a zone are larger or smaller than wished.
struct SizesMet {
  std::int64_t n_hexes = 0;       ///< of the zone
  std::int64_t n_coarser = 0;     ///< ratio above sqrt(3)
  std::int64_t n_finer = 0;       ///< below 1 / sqrt(3)
  std::int64_t n_much_finer = 0;  ///< below 1 / 3
  /// Counts those of another zone as well.
  void add(const SizesMet& more) {
    n_hexes += more.n_hexes;
    n_coarser += more.n_coarser;
    n_finer += more.n_finer;
    n_much_finer += more.n_much_finer;
  }
  /// Part of the zone within a factor sqrt(3) of the wish, 0..1; 1 for an empty zone.
  double met() const {
    return n_hexes == 0 ? 1 : 1 - static_cast<double>(n_coarser + n_finer) / static_cast<double>(n_hexes);
  }
};

/// How well a request for sizes was met, as hexes were cut. The zone: the hexes at which it was wished for (with a
/// bias: the hexes that it made and those at the target). The actual size of a hex is the cube root of its volume; the
/// wished one that at its centroid.
struct SizeReport {
  int n_passes = 0;           ///< run, of those that Sizes::max_passes allows
  std::vector<Index> hexes;   ///< of the zone, ascending
  std::vector<double> ratio;  ///< per hex of the zone: actual size / wished size
  Index n_coarser = 0;        ///< ratio above sqrt(3)
  Index n_finer = 0;          ///< below 1 / sqrt(3)
  Index n_much_finer = 0;     ///< below 1 / 3
  std::vector<Index> unmet;   ///< hexes that would be cut again if there were passes left, ascending
  /// Of hexes that were too long in some directions only, when the request came.
  std::optional<DirectionSizes> directions;
  /// Where nodes were moved for better shapes after that: the counts of the mesh as it is handed out.
  std::optional<SizesMet> moved;
  /// The counts by themselves.
  SizesMet counts() const { return {static_cast<std::int64_t>(hexes.size()), n_coarser, n_finer, n_much_finer}; }
  /// Part of the zone within a factor sqrt(3) of the wish, 0..1; 1 for an empty zone.
  double met() const { return counts().met(); }
};

/// New hexes of low quality: more than there were.
struct PoorHexes {
  double limit = 0;               ///< scaled Jacobian below which a hex counts
  Index count = 0;                ///< how many new hexes are below
  double smallest = 0;            ///< of them
  std::vector<Index> worst = {};  ///< at most five of them, the worst first
};

/// What a refinement has done. Of a dry run the counts are those of the real one, and nothing of the result is
/// measured.
struct Report {
  std::int64_t hexes_before = 0;   ///< of the input
  std::int64_t hexes_after = 0;    ///< of the result; of a dry run what it would have
  std::int64_t nodes_before = 0;   ///< of the input
  std::int64_t nodes_after = 0;    ///< of the result; of a dry run what it would have
  std::int64_t graded_cells = 0;   ///< cells that are cut for the sake of those around them alone (Transition::regular)
  std::int64_t filled_hexes = 0;   ///< hexes that joined the region because of Concave::fill
  Summary shape_before;            ///< over all hexes of the input; count 0: not measured
  Summary shape_after;             ///< over all hexes of the result
  Summary scaled_jacobian_before;  ///< over all hexes of the input
  Summary scaled_jacobian_after;   ///< over all hexes of the result
  OffModel off_cad;                ///< of the result
  std::shared_ptr<const Extremes> extremes;  ///< of the result (extremes.h), for who refines it again
  double volume_before = 0;                  ///< sum over the hexes of the input, model units cubed
  double volume_after = 0;          ///< sum over the hexes of the result; it changes where new nodes follow the CAD
  std::vector<OffOwner> off_nodes;  ///< nodes that were left off their owner
  bool off_nodes_allowed = false;   ///< the request said so; else each is a violation
  std::vector<Index> flat_hexes;    ///< flat compared with the input (outcome.h): each is a violation
  PoorHexes poor;                   ///< count 0: there are none
  bool has_smoothed = false;        ///< because it was asked for, or shapes were too poor
  /// What was decided by looking at all of the mesh at once, so that a part of it alone might be refined in another
  /// way. Empty: nothing was.
  std::string by_whole;
  std::vector<Violation> violations;  ///< of the result; empty unless something is wrong with it
  std::optional<SizeReport> sizes;    ///< of a request for sizes; absent for a dry run
  std::vector<std::string> notices;   ///< decisions taken, one line each
  std::vector<StageTime> seconds;     ///< in the order run
  double total_seconds = 0;           ///< their sum
  std::size_t peak_memory_bytes = 0;  ///< of the process so far
};

/// Called now and then with a stage name and its progress 0..1; returns false to cancel (the call then throws
/// Cancelled and nothing has changed).
using Progress = std::function<bool(const char* stage, double fraction)>;
/// Thrown when a progress callback has returned false. what() is "cancelled".
struct Cancelled : Error {
  Cancelled() : Error("cancelled") {}
};

/// What refine() returns.
struct RefineResult {
  MeshedModel refined;  ///< on the model of the input; empty for a dry run
  /// Per hex, the hex of the input that it lies in; of those that it came from (`came_from`), the first. Empty for a
  /// dry run.
  std::vector<Index> origin;
  Report report;  ///< with violations: the mesh is not to be kept
  /// Of a result by levels: for Request::levelling of the next request. Null: the result is a new base.
  std::shared_ptr<const Levelling> levelling = nullptr;
  /// Of a result by levels, but for the first one of a base: where each hex comes from in full. Else empty: came_from()
  /// of patch/adapt.h answers in any case.
  LevelOrigin came_from = {};
  /// Likewise: per node the node of the input that it is, -1: a new one. Empty: those of the input come first.
  std::vector<Index> old_node = {};
  std::vector<Index> smoothed = {};  ///< nodes that smoothing or lifting moved in the end, ascending
};

}  // namespace hextwist
