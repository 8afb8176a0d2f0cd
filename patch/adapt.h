// Adaptive analysis: which hexes are too coarse comes from a solver, the refined mesh and where it came from go back.
//
//   AdaptOptions options{.levelling = levelling_of(base)};           // base: std::shared_ptr<const MeshedModel>
//   AdaptResult next = adapt(*base, changes, options);               // changes[h]: +1 finer, -1 coarser, 0
//   options.levelling = next.levelling;                              // how it came about, for the next step
//   next = adapt(next.refined, more_changes, options);
//
// Fields of the mesh go along (refine/levels/transfer.h says how); next.came_from says where each hex comes from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/sizing/report.h"
#include "hextwist/sizing/request.h"

namespace HEXTWIST_API hextwist {

/// A levelling in which nothing is cut yet.
std::shared_ptr<const Levelling> levelling_of(std::shared_ptr<const MeshedModel> base);

/// How adapt() goes about it.
struct AdaptOptions {
  /// Levels (Transition::regular): pieces of a transition are never cut again, and what was cut can become coarser.
  /// False: exactly the flagged hexes are cut, whatever they are.
  bool keep_gradation = true;
  /// Of wished sizes: limits their growth from element to element (Sizes::bias).
  double bias = 1;
  /// Of flags: the technique (Request::method); levels are cut one into 27 by automatic and single, into eight by
  /// parallel. Of changes and sizes: automatic.
  Method method = Method::automatic;
  Concave concave = Concave::templates;  ///< whether more than the flagged hexes may be cut
  bool smooth = false;                   ///< smooth the new hexes and two layers around them (Finish::smooth)
  std::vector<Index> fixed = {};         ///< nodes (0-based) that are not moved (Finish::fixed)
  /// Keep the hex field "level": how often the cell that a hex is, or is a piece of, was cut out of others.
  bool level_field = true;
  /// Fields of hexes whose sum stays; others are copied, and averaged where hexes become coarser.
  std::vector<std::string> extensive = {};
  /// Hex fields whose jumps smoothing leaves in place (Finish::keep_jumps).
  std::vector<std::string> keep_jumps = {};
  /// New nodes that can't be put on the CAD are left off it, and told (Finish::allow_off_cad).
  bool allow_off_cad = false;
  /// AdaptResult::levelling of the call that made the mesh. Null: it is the base.
  std::shared_ptr<const Levelling> levelling = nullptr;
};

/// What adapt() returns.
struct AdaptResult {
  MeshedModel refined;          ///< with the fields of the input, carried over
  std::vector<Index> origin;    ///< per hex: the hex of the input that it lies in; where several became one, the first
  LevelOrigin came_from;        ///< per hex in full: the same, in a coarser one, or made of several
  std::vector<Index> old_node;  ///< per node: the same of the input, -1; empty: those of the input come first
  Report report;                ///< with violations: the mesh is not to be kept
  std::shared_ptr<const Levelling> levelling;  ///< null without gradation
};

/// Throws Error naming the first of these (AdaptOptions::extensive) that no field of hexes is called.
void check_extensive(const Mesh& mesh, std::span<const std::string> names);

/// Flags and wishes of a solver as requests like any other.
/// flags: one per hex, 0 or not. Throws Error when there is not one flag per hex, or an extensive field is not there.
Request adapt_request(const Mesh& mesh, std::span<const std::uint8_t> flags, const AdaptOptions& options = {});
/// changes: one per hex, by how many levels it is to become finer (> 0) or coarser (< 0): LevelChanges. Throws Error
/// when there is not one per hex.
Request adapt_request(const Mesh& mesh, std::span<const std::int8_t> changes, const AdaptOptions& options = {});
/// sizes: one per hex, infinity where there is no wish. Throws Error when there is not one size per hex.
Request adapt_request(const Mesh& mesh, std::span<const double> sizes, const AdaptOptions& options = {});

/// Where the hexes of a result come from in full.
LevelOrigin came_from(const Mesh& input, const RefineResult& result);

/// Cuts the flagged hexes into 27 each. No flag at all: the mesh as it was. Throws as adapt_request(); Cancelled.
AdaptResult adapt(const MeshedModel& input, std::span<const std::uint8_t> flags, const AdaptOptions& options = {},
                  const Progress& progress = {});
/// Makes hexes finer (> 0) and coarser (< 0) by levels (LevelChanges). Throws as adapt_request(); Cancelled.
AdaptResult adapt(const MeshedModel& input, std::span<const std::int8_t> changes, const AdaptOptions& options = {},
                  const Progress& progress = {});

/// Cuts hexes until they have their wished sizes, and with gradation makes those coarser that are finer than wished (of
/// which there is no wish: as coarse as the base), as far as the base allows. Throws as adapt_request(), and when one
/// is not positive; Cancelled.
AdaptResult adapt(const MeshedModel& input, std::span<const double> sizes, const AdaptOptions& options = {},
                  const Progress& progress = {});

}  // namespace hextwist
