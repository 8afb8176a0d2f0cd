// The one loop over passes: a technique says what is cut next, a pass cuts it, the technique follows, until nothing is
// left to cut.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "hextwist/sizing/lift_new.h"
#include "hextwist/sizing/plan.h"
#include "hextwist/sizing/stages.h"
#include "hextwist/sizing/techniques/technique.h"

namespace hextwist {

struct SizesInPart;
struct Split;
class AmongParts;

/// Report::by_whole.
inline constexpr const char* repaired_together = "inverted hexes are repaired together";
inline constexpr const char* smoothed_together = "flat hexes are smoothed together";
inline constexpr const char* enclosed_together = "nodes where targets meet are enclosed one after the other";

/// A mesh on its way through the passes of a request.
class State {
 public:
  State(const MeshedModel& of_input, const Request& of_request, Report& of_report, const Progress& of_progress)
      : input(of_input),
        request(of_request),
        report(of_report),
        progress(of_progress),
        stages(of_report, of_progress),
        current_(&of_input) {}

  const MeshedModel& input;
  const Request& request;
  Report& report;
  const Progress& progress;
  Stages stages;

  /// The mesh after the passes so far.
  const MeshedModel& current() const { return *current_; }
  const Mesh& mesh() const { return current_->mesh; }
  /// How far the request has come, for the progress callback: nobody knows how many passes there will be.
  double fraction() const { return 0.9 * n_passes_ / (n_passes_ + 1); }
  void begin(const char* stage) { stages.begin(stage, fraction()); }
  void note(std::string line) { report.notices.push_back(std::move(line)); }

  /// Called after every pass of a technique with what it did to the mesh before. May be empty.
  std::function<void(const Lineage&, const Mesh& before, const Cut&)> watch;

  /// BoundsOfAll with the mesh and what its hexes come of. May be empty: the mesh is no part of another.
  std::function<Bounds(int freedom, const Mesh& mesh, std::span<const Index> hexes, std::span<const Index> origin,
                       double wanted)>
      bounds_of_all;

  /// The mesh is a part of another, whose sizes are wished for. May be null.
  SizesInPart* part = nullptr;
  /// The mesh is one of several parts that are refined side by side for sizes. May be null.
  AmongParts* among = nullptr;

  /// There is a good result already: pieces of transitions that come out inverted are not worth repairing.
  bool is_second_try = false;
  /// What gets more hexes than this is given up.
  std::int64_t give_up_above = std::numeric_limits<std::int64_t>::max();

  /// Passes until the technique is done. Where there was nothing to cut, the input is the result. False: a second try
  /// that was given up, without a result.
  bool run(Technique& technique);
  /// Goes on with a result of the same request that was made apart, and its straight places.
  void adopt(RefineResult result, std::vector<Vec3> straight);
  /// Where the request is for sizes that the input has already, that is the result, and there is nothing more to do.
  /// Sizes that become coarser, and levels that are numbered, are not looked at.
  bool keep_if_met();
  std::vector<Vec3> take_straight() { return std::move(straight_); }
  /// Gives nodal fields their values at the places where nodes are in the end.
  void evaluate_fields();
  /// Gives hexes that passes have made their part of extensive fields; levels have done so.
  void share_out_extensive();
  /// Smooths the hexes that are new since the input and a few layers around them; without boundary nodes where these
  /// are to stay.
  void smooth_band(bool fix_boundary = false);
  /// smooth_band() and close(), which leave no smaller corner among the new hexes than close() alone would.
  void smooth_and_close();
  /// After close(): nodes may have moved since hexes were cut to size, and old ones may have given way.
  void measure_sizes();
  void tell_of_moved_nodes();
  /// After the last pass: hexes that came out flat are smoothed; fills in what the report says of flat and poor hexes
  /// and of nodes off their owners.
  void close();

  /// Nodes of the input may be gone, so that others have other numbers.
  bool is_renumbered = false;
  const RefineResult& result() const { return result_; }
  RefineResult take_result() { return std::move(result_); }

 private:
  struct Passed {
    MeshedModel before;  ///< empty where that was the input
    Lineage lineage;
  };
  /// Split, carry, place, repair: the result becomes the current one. Nothing: given up.
  std::optional<Passed> pass(const Cut& cut);
  /// Before the next pass cuts them again: thin hexes at a curved surface would end inside out. Where smoothing was not
  /// asked for, nodes inside volumes alone move, and only when shapes have come down too far.
  void smooth_between_passes();
  /// Are children of a pass inverted (in this part's own hexes, where it is one among others)?
  bool comes_out_inverted(const Mesh& mesh, const Split& parts) const;
  /// Moves new nodes for better corners of these new hexes (lift_new.h). Did any move?
  bool lift(std::span<const Index> low);
  /// Makes the input the result.
  void keep();
  /// Hexes of the input that a mesh made of it still has.
  Index n_kept(const Mesh& mesh) const;
  std::vector<Index> new_hexes() const;
  /// Those of these hexes that lie in hexes of the input which are boxes.
  std::vector<Index> of_boxes(std::span<const Index> hexes) const;
  /// What a node of now is in the input, -1: it was not there.
  Index node_before(Index node) const;
  /// Nodes that smoothing is not to move, by the numbers that they have now: pieces of other elements stay as they were
  /// placed, where only the repair of inverted hexes may slide them.
  std::vector<Index> fixed_now() const;
  /// And those that are not where they were.
  std::vector<Index> new_nodes() const;
  /// With those beside them that had been moved for better shapes, together with what is no longer there.
  std::vector<Index> with_moved_neighbours(std::vector<Index> nodes) const;
  /// Images are put where they belong. Throws Error where the result has none.
  void repeat_periodic();
  void smooth_around(std::vector<Index> hexes, bool fix_boundary);

  const MeshedModel* current_;
  /// Where nodes would be if all were straight between those of the pass before: there, nodal fields have their values
  /// already. Empty where there are no such fields, or no passes.
  std::vector<Vec3> straight_;
  RefineResult result_;
  int n_passes_ = 0;
  bool told_between_ = false;
};

/// All passes of a request, and smoothing: everything but the last check.
RefineResult run_passes(State& state, Approach approach);
/// The passes alone.
void make_passes(State& state, Approach approach);
/// What comes after them.
RefineResult finish_passes(State& state);

}  // namespace hextwist
