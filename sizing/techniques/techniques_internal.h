// Each technique by itself; make_technique() puts the names to them.
#pragma once

#include <memory>

#include "hextwist/refine/plans/combine.h"
#include "hextwist/refine/plans/eight.h"
#include "hextwist/refine/templates/enclose.h"
#include "hextwist/sizing/loop.h"

namespace hextwist {

std::unique_ptr<Technique> uniform_technique(State& state);
std::unique_ptr<Technique> trisect_technique(State& state);
std::unique_ptr<Technique> eight_technique(State& state);
/// Around nodes, edges and faces: Approach::parallel or combination.
std::unique_ptr<Technique> enclose_technique(State& state, Approach approach);
/// One round of the combination around and along a target of the current mesh.
std::unique_ptr<Technique> enclose_technique(State& state, CombinationTarget target);
std::unique_ptr<Technique> thickness_technique(State& state);
std::unique_ptr<Technique> layers_technique(State& state);
std::unique_ptr<Technique> sheets_technique(State& state);

/// To sizes. has_done(): there was something to do for more than threes.
class SizeTechnique : public Technique {
 public:
  virtual bool has_done() const = 0;
  /// After the last pass of this part, where there are others: takes part in what these ask for still.
  virtual void wait_for_others(State&) {}
};
std::unique_ptr<SizeTechnique> size_technique(State& state, Approach approach);
/// Approach::nearest_size: tries threes and what else there is, goes on with what is better.
void run_nearest_size(State& state);

/// One into eight of targets and, where they lose nothing by it, of hexes around that later rounds need: both
/// ascending.
struct EightStart {
  EightPlan plan;
  std::vector<Index> region;  ///< what it is made for
};
EightStart plan_eight_around(const Mesh& mesh, const std::vector<Index>& targets, const std::vector<Index>& around);

/// One round of one into eight as planned.
class EightRound {
 public:
  /// region: the hexes that the plan was made for, ascending.
  EightRound(EightPlan plan, std::vector<Index> region) : plan_(std::move(plan)), region_(std::move(region)) {}
  std::optional<Cut> next(State& state);
  void follow(const Lineage& lineage, const Mesh& before, const Mesh& after);

 private:
  EightPlan plan_;
  std::vector<Index> region_;
  std::size_t next_pass_ = 0;
};

/// What enclosing did besides what was asked for.
struct Enclosed {
  Index n_added = 0;  ///< nodes that are not of the target
  Index n_first = 0;  ///< nodes that had to go before the others
};
void tell(const Enclosed& done, State& state);

/// One round around nodes, edges and faces: encloses all nodes, in parts where they can't be all at once, and then, at
/// a third, trisects along the edges that this has not cut.
class EncloseRound {
 public:
  EncloseRound(CombinationTarget target, EncloseAt at)
      : target_(std::move(target)), at_(at), rest_(target_.nodes), uncut_(target_edges(target_)) {}
  /// cuts_again is that of the first cut.
  std::optional<Cut> next(State& state, Enclosed& done, bool cuts_again);
  void follow(const Lineage& lineage, const Mesh& after);
  /// What has become of the target.
  CombinationTarget take_target() { return std::move(target_); }

 private:
  CombinationTarget target_;
  EncloseAt at_;
  std::vector<Index> rest_;  // nodes still to be enclosed
  std::vector<Edge> uncut_;
  bool is_first_ = true, has_trisected_ = false;
  int n_parts_ = 0;
};

}  // namespace hextwist
