// What comes nearer to wished sizes: threes alone, or with twos, or with the combination at the target.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "hextwist/base/memory.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/refine/place.h"
#include "hextwist/sizing/among_parts.h"
#include "hextwist/sizing/levelling.h"
#include "hextwist/sizing/size_report.h"
#include "hextwist/sizing/sizes_of_all.h"
#include "hextwist/sizing/targets.h"
#include "hextwist/sizing/techniques/long_directions_internal.h"
#include "hextwist/sizing/techniques/techniques_internal.h"
#include "hextwist/sizing/techniques/wish_internal.h"

namespace hextwist {
namespace {

/// Parts of hexes within a factor sqrt(3), and relative differences between average distances from the wish, that are
/// no more than this count as equal.
constexpr double near_tie = 0.05;

/// Levels that bring so many hexes so near are taken without looking for anything nearer.
constexpr double well_met = 0.6;

/// Cuts of single directions go on through thin layers: not where that makes so many times more new hexes.
constexpr int most_times_more = 8;

/// Nobody should compute on shapes below this where others can be had.
constexpr double poor_shape = 0.1;

struct Candidate {
  RefineResult result;
  std::vector<Vec3> straight;
  Report report;
  double distance = 0;  ///< average of |log(actual / wished size)| at the target
  double met = 0;       ///< part of the hexes there within a factor sqrt(3)
  Index n_hexes = 0;
  double worst_shape = 0;
  bool sound = true;
  bool has_done = false;  ///< more than threes alone would have
  int number = 0;         ///< AmongParts
};

/// Sum of |log(ratio)|, in units so small that the order does not matter: a part adds up to what the whole does.
constexpr double distance_unit = 1e-8;
std::int64_t distances(const SizeReport& sizes) {
  constexpr double most = 1000;
  std::int64_t sum = 0;
  for (const double ratio : sizes.ratio) sum += std::llround(std::min(std::abs(std::log(ratio)), most) / distance_unit);
  return sum;
}

/// Part of the hexes in two reports that are within a factor sqrt(3) of their size.
double part_met(const SizeReport& one, const SizeReport& other = {}) {
  const auto n = static_cast<double>(one.ratio.size() + other.ratio.size());
  return n == 0 ? 1 : 1 - (one.n_coarser + one.n_finer + other.n_coarser + other.n_finer) / n;
}

/// By this part's own hexes and those of all others.
void judge_among(Candidate& candidate, const State& state) {
  AmongParts& among = *state.among;
  const Mesh& mesh = candidate.result.refined.mesh;
  const std::vector<Index>& origin = candidate.result.origin;
  SizeReport sizes;
  for (std::size_t i = 0; i < candidate.report.sizes->hexes.size(); ++i)
    if (among.own[origin[candidate.report.sizes->hexes[i]]]) {
      const double ratio = candidate.report.sizes->ratio[i];
      sizes.ratio.push_back(ratio);
      sizes.n_coarser += is_coarser(ratio) || is_finer(ratio);
    }
  const std::vector<Index> own = indices_where(mesh.n_hexes(), [&](Index h) { return among.own[origin[h]] != 0; });
  std::vector<std::uint8_t> is_own_node(mesh.points.size(), 0);
  mark_nodes(mesh.hexes, own, is_own_node);
  const bool is_off =
      std::ranges::any_of(candidate.report.off_nodes, [&](const OffOwner& row) { return is_own_node[row.node] != 0; });
  const bool is_sound =
      !is_off && among.own_among(candidate.report.sizes->unmet, origin).empty() && inverted_hexes(mesh, own).empty();
  const PartNumbers all =
      among.all({{std::ssize(sizes.ratio), distances(sizes), sizes.n_coarser, std::ssize(own), !is_sound},
                 own.empty() ? PartNumbers().least : summarize(quality(Metric::shape, mesh, own)).min});
  const auto n = static_cast<double>(all.sum[0]);
  candidate.distance = n == 0 ? 0 : distance_unit * static_cast<double>(all.sum[1]) / n;
  candidate.met = n == 0 ? 1 : 1 - static_cast<double>(all.sum[2]) / n;
  candidate.n_hexes = static_cast<Index>(std::min<std::int64_t>(all.sum[3], std::numeric_limits<Index>::max()));
  candidate.worst_shape = all.least;
  candidate.sound = all.sum[4] == 0;
}

void judge(Candidate& candidate, const State& state) {
  if (state.among) return judge_among(candidate, state);
  const SizeReport none, &here = *candidate.report.sizes, &outside = state.part ? state.part->outside : none;
  const auto n = static_cast<double>(here.ratio.size() + outside.ratio.size());
  candidate.distance = n == 0 ? 0 : distance_unit * static_cast<double>(distances(here) + distances(outside)) / n;
  candidate.met = part_met(here, outside);
  const Mesh& mesh = candidate.result.refined.mesh;
  candidate.n_hexes = mesh.n_hexes() + n_outside(state);
  candidate.worst_shape = summarize(quality(Metric::shape, mesh)).min;
  if (state.part) candidate.worst_shape = std::min(candidate.worst_shape, state.part->worst_shape_outside);
  candidate.sound =
      candidate.report.off_nodes.empty() && candidate.report.sizes->unmet.empty() && inverted_hexes(mesh).empty();
}

/// The worst shape before, of the whole mesh.
double worst_shape_before(const State& state) {
  const Mesh& mesh = state.input.mesh;
  if (state.among) {
    const std::vector<Index> own = indices_where(mesh.n_hexes(), [&](Index h) { return state.among->own[h] != 0; });
    return state.among->all({{}, own.empty() ? PartNumbers().least : summarize(quality(Metric::shape, mesh, own)).min})
        .least;
  }
  const double worst = summarize(quality(Metric::shape, mesh)).min;
  return state.part ? std::min(worst, state.part->worst_shape_outside) : worst;
}

std::int64_t n_hexes_before(const State& state) {
  if (state.among) return state.among->all({{std::ranges::count(state.among->own, 1)}}).sum[0];
  return state.input.mesh.n_hexes() + n_outside(state);
}

/// No shape is poor, or much worse than what was there. So that what comes out inverted elsewhere need not be repaired.
bool is_good(const Candidate& candidate, const State& state) {
  return candidate.sound &&
         (candidate.worst_shape >= poor_shape || candidate.worst_shape >= worst_shape_before(state) / 2);
}
/// So that nothing nearer needs to be looked for.
bool is_well_met(const Candidate& candidate, const State& state) {
  return candidate.met >= well_met && is_good(candidate, state);
}

/// give_up_above: there is a good result already, and this is a second try; 0: there is none. Nothing: given up.
std::optional<Candidate> attempt(const State& from, const Report& start, Approach approach,
                                 std::int64_t give_up_above = 0) {
  Candidate candidate;
  candidate.report = start;
  State state(from.input, from.request, candidate.report, from.progress);
  state.is_second_try = give_up_above > 0;
  if (give_up_above > 0 && !from.among) state.give_up_above = give_up_above;
  state.part = from.part;
  state.among = from.among;
  if (from.among) candidate.number = from.among->begin(state);
  bool is_whole = true;
  if (approach == Approach::size_by_levels) {
    run_levels(state);
  } else {
    const std::unique_ptr<SizeTechnique> technique = size_technique(state, approach);
    is_whole = state.run(*technique);
    candidate.has_done = technique->has_done();
    if (from.among) technique->wait_for_others(state);
  }
  if (from.among) {
    const PartNumbers all = from.among->all({{!is_whole, candidate.has_done}});
    is_whole = all.sum[0] == 0;
    candidate.has_done = all.sum[1] > 0;
  }
  if (!is_whole) return std::nullopt;
  candidate.result = state.take_result();
  if (from.among) {
    from.among->end(candidate.result);
    std::string& by_whole = from.among->by_whole;
    if (by_whole.empty()) by_whole = candidate.report.has_smoothed ? smoothed_together : candidate.report.by_whole;
  }
  candidate.straight = state.take_straight();
  judge(candidate, from);
  return candidate;
}

/// As many hexes as a second try may come to, by those that the first one made.
std::int64_t most_hexes(const State& from, const Candidate& there) {
  const std::int64_t before = n_hexes_before(from);
  return before + most_times_more * std::max<std::int64_t>(there.n_hexes - before, 1);
}

/// A second try, which is given up where a result that is good is there and this comes out inverted, or much larger, or
/// where it is too large for memory and limits. What it takes is added to the report of what is there.
struct SecondTry {
  std::optional<Candidate> made;
  bool is_too_large = false;
};
SecondTry second_try(const State& from, const Report& start, Approach approach, Candidate& there) {
  SecondTry result;
  const auto begin = std::chrono::steady_clock::now();
  const std::int64_t most = most_hexes(from, there);
  const bool may_give_up = is_good(there, from);
  try {
    result.made = attempt(from, start, approach, may_give_up ? std::max<std::int64_t>(most - n_outside(from), 1) : 0);
    if (may_give_up && result.made && result.made->n_hexes > most) {  // parts find that out at the end
      result.made.reset();
      result.is_too_large = true;
    }
  } catch (const TooLarge&) {
    if (from.among) throw;  // all parts go on together
    result.is_too_large = true;
  }
  if (!result.made) {
    const double wasted = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    there.report.seconds.push_back({"other technique", wasted});
    there.report.total_seconds += wasted;
  }
  return result;
}

bool is_better(const Candidate& a, const Candidate& b) {
  if (a.sound != b.sound) return a.sound;
  const double shape = std::max(a.worst_shape, b.worst_shape);
  const auto is_poor = [&](const Candidate& c) { return c.worst_shape < poor_shape && c.worst_shape < shape / 2; };
  if (is_poor(a) != is_poor(b)) return is_poor(b);
  if (std::abs(a.met - b.met) > near_tie) return a.met > b.met;
  if (std::abs(a.distance - b.distance) > near_tie * std::max(a.distance, b.distance)) return a.distance < b.distance;
  return a.worst_shape > b.worst_shape;
}

std::string rounded(double value) {
  const auto hundredths = std::lround(100 * value);
  return std::to_string(hundredths / 100) + (hundredths % 100 < 10 ? ".0" : ".") + std::to_string(hundredths % 100);
}

/// The better one, which says why it was taken and how long the other took.
Candidate preferred(Candidate better, const Candidate& other, const char* says, const Report& start) {
  Report& report = better.report;
  const double wasted = other.report.total_seconds - start.total_seconds;
  report.seconds.push_back({"other technique", wasted});
  report.total_seconds += wasted;
  report.notices.push_back(std::string(says) + ": on average sizes are off by a factor of " +
                           rounded(std::exp(better.distance)) + " (" + rounded(std::exp(other.distance)) +
                           " the other way), the worst shape is " + rounded(better.worst_shape) + " (" +
                           rounded(other.worst_shape) + ")");
  return better;
}
Candidate better_of(Candidate a, Candidate b, const char* says_a, const char* says_b, const Report& start) {
  if (is_better(a, b)) return preferred(std::move(a), b, says_a, start);
  return preferred(std::move(b), a, says_b, start);
}

/// Part of the directions of the hexes that were asked for that are within a factor sqrt(3) of the wish.
double part_of_directions(const Candidate& candidate, const State& state, const SizeWish& wish) {
  const std::vector<Index>& hexes = candidate.report.sizes->hexes;
  DirectionSizes off = direction_sizes(candidate.result.refined.mesh, hexes, wish.field());
  std::size_t n = hexes.size();
  if (state.part) {
    const std::vector<Index>& others = state.part->outside.hexes;
    const DirectionSizes outside = direction_sizes(state.part->all.input.mesh, others, wish.field());
    off.n_longer += outside.n_longer;
    off.n_shorter += outside.n_shorter;
    n += others.size();
  }
  return 1 - (off.n_longer + off.n_shorter) / (3.0 * static_cast<double>(std::max<std::size_t>(n, 1)));
}

/// Asked of the whole. A part that does not have all hexes where cuts of single directions begin is no good.
bool are_uneven(const State& state, const SizeWish& wish, int by) {
  const Mesh& here = state.input.mesh;
  if (state.among) {
    std::vector<std::uint8_t> in_zone = wish.zone(here, state.among->region);
    for (std::size_t h = 0; h < in_zone.size(); ++h) in_zone[h] &= state.among->own[h];
    const UnevenHexes mine = uneven_hexes(here, in_zone, wish.field(), by);
    const PartNumbers all = state.among->all({{mine.n_cut, mine.n_uneven}});
    // Cuts of single directions go through sheets.
    if (UnevenHexes{all.sum[0], all.sum[1]}) state.among->by_whole = "what is too long in some directions only";
    return false;
  }
  if (!state.part) {
    std::vector<std::string> told;  // again
    return are_uneven(here, wish.zone(here, region_target(state.input, state.request.target, told)), wish.field(), by);
  }
  const SizesOfAll& all = state.part->all;
  if (!are_uneven(all.input.mesh, all.in_zone, wish.field(), by)) return false;
  state.part->is_too_small = count_uneven(all.input.mesh, all.in_zone, wish.field()) !=
                             count_uneven(here, wish.zone(here, state.part->region), wish.field());
  return !state.part->is_too_small;
}

/// What is too long in some directions only may be cut in these first: where hexes are that uneven, and sizes and
/// shapes come out better, or directions do and sizes well.
Candidate or_by_directions(Candidate taken, const State& state, const Report& start) {
  if (state.request.method != Method::automatic || !is_regular(state.request)) return taken;
  const std::shared_ptr<const SizeWish> wish = size_wish(state);
  if (!are_uneven(state, *wish, is_well_met(taken, state) ? 2 : 1)) return taken;
  SecondTry tried = second_try(state, start, Approach::size_by_directions, taken);
  if (!tried.made) return taken;
  Candidate& directions = *tried.made;
  if (directions.n_hexes > most_hexes(state, taken)) return taken;
  const bool are_nearer =
      part_of_directions(directions, state, *wish) > part_of_directions(taken, state, *wish) + near_tie;
  if (!is_better(directions, taken) && !(are_nearer && is_well_met(directions, state))) return taken;
  return preferred(std::move(directions), taken, "directions that are too long by themselves first, then whole hexes",
                   start);
}

bool is_same(const Candidate& levels, const Candidate& nested, const State& state) {
  if (!state.among) return levels.result.refined.mesh.hexes == nested.result.refined.mesh.hexes;
  return state.among->all({{!state.among->is_same(levels.number, nested.number)}}).sum[0] == 0;
}

/// By threes: by levels, nested, or whichever is better.
Candidate by_threes(const State& state, const Report& start) {
  if (!is_regular(state.request)) return *attempt(state, start, Approach::size_by_threes);
  Candidate levels = *attempt(state, start, Approach::size_by_levels);
  if (is_well_met(levels, state)) return levels;
  SecondTry nested = second_try(state, start, Approach::size_by_threes, levels);
  if (!nested.made) {
    if (!nested.is_too_large)
      levels.report.notices.push_back(
          "by levels, no piece of a transition is cut again: cut again, they would come out inverted");
    return levels;
  }
  if (is_same(levels, *nested.made, state)) return levels;
  return better_of(std::move(levels), std::move(*nested.made), "by levels, no piece of a transition is cut again",
                   "transitions are cut again where sizes ask for it (not with 'transition regular')", start);
}

/// Edges at the target are held to the wish one by one, hexes by their volume: these may all have been near it.
void tell_of_sizes_before(State& state, Candidate& taken) {
  if (state.among) return;
  const double before = state.part ? part_met(state.part->all.report(state.part->all.region)) : [&] {
    const SizesOfAll all(state.input, state.request);
    return part_met(all.report(all.region));
  }();
  if (before > taken.met + near_tie)
    taken.report.notices.push_back(
        "before, " + short_number(100 * before) +
        "% of the hexes there were within a factor of sqrt(3): single edges at the target were "
        "too long; a size a little larger leaves them as they are");
}

/// Sizes are by levels unless another way comes nearer. Levels that there were end with a note of their own.
void tell_of_new_base(const State& state, Candidate& taken) {
  const Request& request = state.request;
  if (state.among || !is_regular(request) || request.method != Method::automatic || has_levels(request)) return;
  if (const LevellingPtr& levels = taken.result.levelling; levels && !levels->forest.is_bare()) return;
  taken.report.notices.push_back("that is not by levels: this mesh is the base of what is refined from now on");
}

}  // namespace

void run_nearest_size(State& state) {
  const Request& request = state.request;
  const Sizes& sizes = std::get<Sizes>(request.how);
  const bool varies = sizes.bias > 1;
  const bool may_mix = may_halve(request) || (request.method != Method::single && may_combine(request.target, sizes));
  state.stages.close();  // those of the candidates count
  const Report start = state.report;
  Candidate taken = by_threes(state, start);
  const bool cuts_anything = taken.n_hexes > n_hexes_before(state);
  SecondTry mixed;
  if (may_mix && cuts_anything)
    mixed = second_try(state, start, varies ? Approach::size_by_combination : Approach::size_by_halves, taken);
  if (mixed.made && mixed.made->has_done)
    taken = better_of(std::move(*mixed.made), std::move(taken),
                      varies ? "the combination for the last passes at the target, else whole hexes"
                             : "one into eight where that comes nearer, else one into 27",
                      varies ? "whole hexes alone, not the combination at the target as well"
                             : "one into 27 alone, not one into eight as well",
                      start);
  if (cuts_anything) taken = or_by_directions(std::move(taken), state, start);
  if (cuts_anything && taken.met < well_met) tell_of_sizes_before(state, taken);
  if (cuts_anything) tell_of_new_base(state, taken);
  if (state.among) state.among->taken = taken.number;
  state.report = std::move(taken.report);
  state.adopt(std::move(taken.result), std::move(taken.straight));
}

}  // namespace hextwist
