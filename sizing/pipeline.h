// A mesh on its way through the passes of a request. The techniques are functions over this (refine.cpp chooses one).
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "hextwist/refine/plans/combine.h"
#include "hextwist/refine/plans/eight.h"
#include "hextwist/refine/templates/split_table.h"
#include "hextwist/sizing/request.h"
#include "hextwist/sizing/stages.h"

namespace hextwist {

class Pipeline {
 public:
  Pipeline(const MeshedModel& input, const Request& request, Report& report, const Progress& progress)
      : input_(input),
        current_(&input),
        request_(request),
        report_(report),
        progress_(progress),
        stages_(report, progress) {}

  const MeshedModel& input() const { return input_; }
  /// The mesh after the passes so far.
  const MeshedModel& current() const { return *current_; }
  const Request& request() const { return request_; }
  Report& report() { return report_; }
  Stages& stages() { return stages_; }
  const Progress& progress() const { return progress_; }
  /// Of the last pass.
  const Lineage& lineage() const { return result_.lineage; }
  /// How far the request has come, for the progress callback: nobody knows how many passes there will be.
  double fraction() const { return 0.9 * n_passes_ / (n_passes_ + 1); }

  /// Split, carry, place, repair: the result becomes the current mesh.
  void pass(std::shared_ptr<const SplitTable> table, std::span<const std::uint16_t> codes);
  /// Makes the input the result, for a request that finds nothing to do.
  void keep();
  /// Hexes that are new since the input.
  std::vector<Index> new_hexes() const;
  /// Smooths these and a few layers around them; without boundary nodes where these are to stay.
  void smooth_band(bool fix_boundary = false);
  /// Before the next pass cuts them again: thin hexes at a curved surface would end inside out. Where smoothing was not
  /// asked for, nodes inside volumes alone move, and only when shapes have come down too far.
  void smooth_between_passes();
  /// Before the last pass: per hex the hex of the input that it lay in (empty: itself); the first so many were those of
  /// the input that had not been cut.
  const std::vector<Index>& origin_before() const { return origin_before_; }
  Index n_kept_before() const { return n_kept_before_; }
  /// Goes on with a result of the same request that was made apart.
  void adopt(RefineResult result);
  RefineResult take_result() { return std::move(result_); }

 private:
  /// Hexes of the input that a mesh made of it still has.
  Index n_kept(const Mesh& mesh) const;

  const MeshedModel& input_;
  const MeshedModel* current_;
  const Request& request_;
  Report& report_;
  const Progress& progress_;
  Stages stages_;
  RefineResult result_;
  std::vector<Index> origin_before_;
  Index n_kept_before_ = 0;
  int n_passes_ = 0;
  bool told_between_ = false;
};

/// Throws Error for what cannot be asked for.
void check(const MeshedModel& input, const Request& request);
/// The technique that the request asks for. Throws Error for one that does not fit the target.
Method technique(const Request& request);
/// Its passes, everything but the last check.
RefineResult run_passes(Pipeline& run);

/// Hexes and layers of hexes, every edge cut in three (section 4).
void trisect_passes(Pipeline& run);
/// Hexes and layers of hexes, every edge halved where the region allows it (sections 5.1 to 5.3, eight.h).
void eight_passes(Pipeline& run);
/// One round of it as planned for these hexes (ascending) of the current mesh; returns their children. after_pass,
/// which may be empty, is called after each pass.
std::vector<Index> eight_round(Pipeline& run, EightPlan plan, std::vector<Index> targets,
                               const std::function<void()>& after_pass);
/// Across chosen sheets; through the thickness behind surfaces; in layers along the target.
void sheet_passes(Pipeline& run);
void thickness_passes(Pipeline& run);
void layer_passes(Pipeline& run);
/// What too large hexes are cut by besides threes.
enum class SizeTechnique {
  thirds,       ///< nothing
  halves,       ///< one into eight in regions that come nearer to the wish by factors of two and where that can be
  combination,  ///< at the target, once all that are too large touch it: they are refined towards it only
};
/// Hexes cut until they have the wished size. Returns whether there was anything for the technique to do.
bool size_passes(Pipeline& run, SizeTechnique technique);
/// Sizes with Method::automatic: tries threes and what else there is, takes what is better.
void nearest_sizes(Pipeline& run);
/// Around nodes, edges and faces: parallel or combination (section 5).
void sub_element_passes(Pipeline& run, Method method);
/// One round of the combination around these nodes, edges and faces of the current mesh. after_pass is called after
/// each pass.
void combination_round(Pipeline& run, CombinationTarget target, const std::function<void()>& after_pass);

}  // namespace hextwist
