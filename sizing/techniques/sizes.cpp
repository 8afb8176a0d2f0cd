// Size-driven refinement: cut, look again, until the elements are as small as wished.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/sizing/among_parts.h"
#include "hextwist/sizing/factors.h"
#include "hextwist/sizing/size_report.h"
#include "hextwist/sizing/targets.h"
#include "hextwist/sizing/techniques/long_directions_internal.h"
#include "hextwist/sizing/techniques/techniques_internal.h"
#include "hextwist/sizing/techniques/wish_internal.h"

namespace hextwist {
namespace {

/// How far from the wish (as a logarithm of the ratio) twos and threes can bring a size that is so many times the wish.
double distance_left(double ratio) {
  for (const int step : plan_factors(ratio)) ratio /= step;
  return std::abs(std::log(ratio));
}

/// The hexes of regions of too large ones that come nearer to the wish when they are halved now.
std::vector<Index> hexes_to_halve(const Mesh& mesh, std::span<const Index> too_large, const SizeField& wish) {
  std::vector<Index> wanted;
  for (const std::vector<Index>& region : connected_regions(mesh, too_large)) {
    const std::vector<double> size = actual_sizes(mesh, region), wished = wished_sizes(mesh, region, wish);
    double after_two = 0, after_three = 0;
    for (std::size_t i = 0; i < region.size(); ++i) {
      after_two += distance_left(size[i] / wished[i] / 2);
      after_three += distance_left(size[i] / wished[i] / 3);
    }
    if (after_two < after_three) wanted.insert(wanted.end(), region.begin(), region.end());
  }
  std::ranges::sort(wanted);
  return wanted;
}

/// Those that are to be cut more than once, and one layer around: cut now, no later pass cuts a piece of a transition.
/// By threes alone, or by twos as well.
std::vector<Index> around_those_cut_again(const Mesh& mesh, std::span<const Index> too_large, const SizeField& wish,
                                          bool by_twos) {
  const std::vector<double> size = actual_sizes(mesh, too_large), wished = wished_sizes(mesh, too_large, wish);
  std::vector<Index> again;
  for (std::size_t i = 0; i < too_large.size(); ++i) {
    const double ratio = size[i] / wished[i];
    if (by_twos ? plan_factors(ratio).size() > 1 : ratio > 3 * std::numbers::sqrt3) again.push_back(too_large[i]);
  }
  return with_layers(mesh, std::move(again), 1);
}

/// Nodes, edges and faces of the target at these hexes.
CombinationTarget part_at(const CombinationTarget& target, const Mesh& mesh, std::span<const Index> hexes) {
  std::vector<std::uint8_t> chosen(mesh.points.size(), 0);
  mark_nodes(mesh.hexes, hexes, chosen);
  const auto is_chosen = [&](Index n) { return chosen[n] != 0; };
  CombinationTarget part;
  std::ranges::copy_if(target.nodes, std::back_inserter(part.nodes), is_chosen);
  std::ranges::copy_if(target.edges, std::back_inserter(part.edges),
                       [&](const Edge& edge) { return std::ranges::all_of(edge, is_chosen); });
  std::ranges::copy_if(target.faces, std::back_inserter(part.faces),
                       [&](const Quad& quad) { return std::ranges::all_of(quad, is_chosen); });
  return part;
}

/// Per hex: does it have a node of the target?
std::vector<std::uint8_t> touching(const CombinationTarget& target, const Mesh& mesh) {
  std::vector<std::uint8_t> on_it(mesh.points.size(), 0), result(mesh.hexes.size(), 0);
  for (const Index n : target.nodes) on_it[n] = 1;
  for (const Index h : touching_hexes(mesh.hexes, on_it)) result[h] = 1;
  return result;
}

/// Trisects what is too large; the other two do something else first.
class ByThrees : public SizeTechnique {
 public:
  explicit ByThrees(State& state) : wish_(size_wish(state)) {
    const std::vector<Index> targets = size_region(state);
    in_zone_ = wish_->zone(state.input.mesh, targets);
    in_report_.assign(in_zone_.size(), 0);
    for (const Index h : targets) in_report_[h] = 1;
  }

  bool has_done() const override { return has_done_; }

  std::optional<Cut> next(State& state) override {
    const int max_passes = std::get<Sizes>(state.request.how).max_passes;
    for (;;) {
      if (auto cut = go_on(state)) {
        cut->turn.round = n_passes_ - 1;
        return cut;
      }
      state.begin("sizes");
      const Mesh& mesh = state.mesh();
      std::vector<Index> too_large = wish_->too_large(mesh, in_zone_);
      wish_->check_fits(mesh, too_large, n_outside(state));
      if (n_passes_ < max_passes && begin_round(state, too_large)) {
        ++n_passes_;
        has_done_ = true;
        continue;
      }
      std::vector<std::uint8_t> marked = wish_->marks(mesh, too_large, wish_->nodes_too_far_apart(mesh, in_zone_));
      if (marked.empty()) return std::nullopt;
      if (n_passes_ == max_passes) {
        unmet_ = std::move(too_large);
        return std::nullopt;
      }
      mark_more(mesh, too_large, marked);
      if (state.request.concave == Concave::fill) state.report.filled_hexes += fill_concave(mesh, marked);
      const int pass = n_passes_++;
      return Cut{trisect_table(), trisect_codes(mesh.hexes, marked), pass > 0 && cuts_transitions_, {pass, 0, 0}};
    }
  }

  void follow(const Lineage& lineage, const Mesh&, const Mesh&) override {
    const std::size_t n_kept = lineage.n_old_hexes - lineage.hexes.size();
    std::vector<std::uint8_t> zone(lineage.parent.size()), reported(lineage.parent.size());
    for (std::size_t h = 0; h < lineage.parent.size(); ++h) {
      zone[h] = in_zone_[lineage.parent[h]];
      reported[h] = in_report_[lineage.parent[h]] || (wish_->is_everywhere() && h >= n_kept);
    }
    in_zone_ = std::move(zone);
    in_report_ = std::move(reported);
  }

  void finish(State& state) override {
    SizeReport report =
        size_report(state.mesh(), indices_where(state.mesh().n_hexes(), [&](Index h) { return in_report_[h] != 0; }),
                    wish_->field());
    report.n_passes = n_passes_;
    report.unmet = std::move(unmet_);
    state.report.sizes = std::move(report);
  }

 protected:
  /// The next cut of a round of something else that has begun.
  virtual std::optional<Cut> go_on(State&) { return std::nullopt; }
  /// Begins such a round for what is too large, where that comes nearer to the wish.
  virtual bool begin_round(const State&, const std::vector<Index>&) { return false; }
  /// Marks what is to be trisected for the sake of later passes.
  virtual void mark_more(const Mesh&, const std::vector<Index>& /*too_large*/, std::vector<std::uint8_t>&) {}

  const std::shared_ptr<const SizeWish> wish_;
  std::vector<std::uint8_t> in_zone_, in_report_;
  int n_passes_ = 0;
  bool cuts_transitions_ = true;  // those of earlier passes

 private:
  bool has_done_ = false;
  std::vector<Index> unmet_;
};

/// One into eight in regions that come nearer to the wish by factors of two, where that can be. By levels, as twos come
/// first and what is cut again is known then.
class ByHalves : public ByThrees {
 public:
  explicit ByHalves(State& state) : ByThrees(state) {
    cuts_transitions_ = !(is_regular(state.request) && wish_->is_constant());
  }

  void follow(const Lineage& lineage, const Mesh& before, const Mesh& after) override {
    ByThrees::follow(lineage, before, after);
    if (round_) round_->follow(lineage, before, after);
  }

 protected:
  std::optional<Cut> go_on(State& state) override {
    if (!round_) return std::nullopt;
    auto cut = round_->next(state);
    if (!cut) round_.reset();
    return cut;
  }
  bool begin_round(const State& state, const std::vector<Index>& too_large) override {
    const Mesh& mesh = state.mesh();
    const std::vector<Index> wanted = hexes_to_halve(mesh, too_large, wish_->field());
    if (wanted.empty()) return false;
    std::vector<Index> around;
    if (!cuts_transitions_) around = difference(around_those_cut_again(mesh, wanted, wish_->field(), true), too_large);
    EightStart start = plan_eight_around(mesh, wanted, around);
    std::vector<Index> halved = difference(start.region, start.plan.trisected);
    start.plan.trisected.clear();
    if (halved.empty()) return false;
    round_.emplace(std::move(start.plan), std::move(halved));
    return true;
  }
  void mark_more(const Mesh& mesh, const std::vector<Index>& too_large, std::vector<std::uint8_t>& marked) override {
    if (!cuts_transitions_)
      mark_nodes(mesh.hexes, around_those_cut_again(mesh, too_large, wish_->field(), true), marked);
  }

 private:
  std::optional<EightRound> round_;
};

/// Directions that are too long by themselves, then whole hexes, both by threes: so none comes out too short.
class ByDirections : public ByThrees {
 public:
  explicit ByDirections(State& state) : ByThrees(state) { cuts_transitions_ = !wish_->is_constant(); }

  void finish(State& state) override {
    ByThrees::finish(state);
    SizeReport& report = *state.report.sizes;
    report.directions = direction_sizes(state.mesh(), report.hexes, wish_->field());
  }

 protected:
  std::optional<Cut> go_on(State&) override {
    if (masks_.empty()) return std::nullopt;
    return Cut{trisect_table(), std::exchange(masks_, {})};
  }
  bool begin_round(const State& state, const std::vector<Index>&) override {
    if (is_even_) return false;
    const Mesh& mesh = state.mesh();
    masks_ = cuts_of_long_directions(mesh, in_zone_, wish_->field());
    is_even_ = masks_.empty();
    return !is_even_;
  }
  void mark_more(const Mesh& mesh, const std::vector<Index>& too_large, std::vector<std::uint8_t>& marked) override {
    if (!cuts_transitions_)
      mark_nodes(mesh.hexes, around_those_cut_again(mesh, too_large, wish_->field(), false), marked);
  }

 private:
  bool is_even_ = false;  // no hex needs more cuts in one direction than in another
  std::vector<std::uint16_t> masks_;
};

/// At the target, once all that are too large touch it: they are refined towards it only.
class ByCombination : public ByThrees {
 public:
  explicit ByCombination(State& state) : ByThrees(state), at_(size_target(state)) {}

  void follow(const Lineage& lineage, const Mesh& before, const Mesh& after) override {
    ByThrees::follow(lineage, before, after);
    at_ = carried_target(at_, lineage, after);
    // Depth 0: what touches the target now is all that is wished for.
    if (!wish_->is_everywhere()) in_zone_ = in_report_ = touching(at_, after);
    if (round_) round_->follow(lineage, after);
  }

 protected:
  std::optional<Cut> go_on(State& state) override {
    if (!round_) return std::nullopt;
    auto cut = round_->next(state, done_, n_passes_ > 1);
    if (!cut) {
      tell(done_, state);
      round_.reset();
    }
    return cut;
  }
  bool begin_round(const State& state, const std::vector<Index>& too_large) override {
    const Mesh& mesh = state.mesh();
    if (!state.among && too_large.empty()) return false;
    const std::vector<std::uint8_t> touches = touching(at_, mesh);
    const auto is_touching = [&](Index h) { return touches[h] != 0; };
    if (state.among) {
      const std::vector<Index> own = state.among->own_among(too_large, state.result().origin);
      const PartNumbers all = state.among->all({{1, std::ssize(own), std::ranges::count_if(own, is_touching)}});
      if (all.sum[1] == 0 || all.sum[1] > all.sum[2]) return false;
    } else if (!std::ranges::all_of(too_large, is_touching)) {
      return false;
    }
    round_.emplace(part_at(at_, mesh, too_large), EncloseAt::third);
    done_ = {};
    return true;
  }

  /// Others may still ask whether all that is too large touches the target.
  void wait_for_others(State& state) override {
    while (state.among->all({}).sum[0] > 0) {
    }
  }

 private:
  CombinationTarget at_;
  std::optional<EncloseRound> round_;
  Enclosed done_;
};

}  // namespace

std::unique_ptr<SizeTechnique> size_technique(State& state, Approach approach) {
  if (approach == Approach::size_by_halves) return std::make_unique<ByHalves>(state);
  if (approach == Approach::size_by_directions) return std::make_unique<ByDirections>(state);
  if (approach == Approach::size_by_combination) return std::make_unique<ByCombination>(state);
  return std::make_unique<ByThrees>(state);
}

}  // namespace hextwist
