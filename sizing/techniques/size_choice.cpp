// What comes nearer to wished sizes: threes alone, or with twos, or with the combination at the target.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/refine/place.h"
#include "hextwist/sizing/levelling.h"
#include "hextwist/sizing/techniques/techniques_internal.h"

namespace hextwist {
namespace {

/// Parts of hexes within a factor sqrt(3), and relative differences between average distances from the wish, that are
/// no more than this count as equal.
constexpr double near_tie = 0.05;

/// Levels that bring so many hexes so near are taken without looking for anything nearer.
constexpr double well_met = 0.6;

/// Nobody should compute on shapes below this where others can be had.
constexpr double poor_shape = 0.1;

struct Candidate {
  RefineResult result;
  std::vector<Vec3> straight;
  Report report;
  double distance = 0;  ///< average of |log(actual / wished size)| at the target
  double worst_shape = 0;
  bool sound = true;
  bool has_done = false;  ///< more than threes alone would have
};

Candidate attempt(const State& from, const Report& start, Approach approach) {
  Candidate candidate;
  candidate.report = start;
  State state(from.input, from.request, candidate.report, from.progress);
  if (approach == Approach::size_by_levels) {
    run_levels(state);
  } else {
    const std::unique_ptr<SizeTechnique> technique = size_technique(state, approach);
    state.run(*technique);
    candidate.has_done = technique->has_done();
  }
  candidate.result = state.take_result();
  candidate.straight = state.take_straight();
  return candidate;
}

void judge(Candidate& candidate) {
  candidate.distance = 0;
  const std::vector<double>& ratio = candidate.report.sizes->ratio;
  for (const double r : ratio) candidate.distance += std::abs(std::log(r)) / static_cast<double>(ratio.size());
  const Mesh& mesh = candidate.result.refined.mesh;
  candidate.worst_shape = summarize(quality(Metric::shape, mesh)).min;
  candidate.sound =
      candidate.report.off_nodes.empty() && candidate.report.sizes->unmet.empty() && inverted_hexes(mesh).empty();
}

bool is_better(const Candidate& a, const Candidate& b) {
  if (a.sound != b.sound) return a.sound;
  const double shape = std::max(a.worst_shape, b.worst_shape);
  const auto is_poor = [&](const Candidate& c) { return c.worst_shape < poor_shape && c.worst_shape < shape / 2; };
  if (is_poor(a) != is_poor(b)) return is_poor(b);
  if (std::abs(a.report.sizes->met() - b.report.sizes->met()) > near_tie)
    return a.report.sizes->met() > b.report.sizes->met();
  if (std::abs(a.distance - b.distance) > near_tie * std::max(a.distance, b.distance)) return a.distance < b.distance;
  return a.worst_shape > b.worst_shape;
}

std::string rounded(double value) {
  const auto hundredths = std::lround(100 * value);
  return std::to_string(hundredths / 100) + (hundredths % 100 < 10 ? ".0" : ".") + std::to_string(hundredths % 100);
}

/// The better one of two, which says why it was taken.
Candidate better_of(Candidate a, Candidate b, const char* says_a, const char* says_b, const Report& start) {
  const bool takes_a = is_better(a, b);
  Candidate& better = takes_a ? a : b;
  const Candidate& other = takes_a ? b : a;
  Report& report = better.report;
  const double wasted = other.report.total_seconds - start.total_seconds;
  report.seconds.push_back({"other technique", wasted});
  report.total_seconds += wasted;
  report.notices.push_back(std::string(takes_a ? says_a : says_b) + ": on average sizes are off by a factor of " +
                           rounded(std::exp(better.distance)) + " (" + rounded(std::exp(other.distance)) +
                           " the other way), the worst shape is " + rounded(better.worst_shape) + " (" +
                           rounded(other.worst_shape) + ")");
  return std::move(better);
}

/// By threes: by levels, nested, or whichever is better.
Candidate by_threes(const State& state, const Report& start) {
  if (!is_regular(state.request)) return attempt(state, start, Approach::size_by_threes);
  Candidate levels = attempt(state, start, Approach::size_by_levels);
  judge(levels);
  if (levels.sound && levels.worst_shape >= poor_shape && levels.report.sizes->met() >= well_met) return levels;
  Candidate nested = attempt(state, start, Approach::size_by_threes);
  judge(nested);
  if (levels.result.refined.mesh.hexes == nested.result.refined.mesh.hexes) return levels;
  return better_of(std::move(levels), std::move(nested), "by levels, no piece of a transition is cut again",
                   "transitions are cut again where sizes ask for it (not with 'transition regular')", start);
}

}  // namespace

void run_nearest_size(State& state) {
  const Request& request = state.request;
  const Sizes& sizes = std::get<Sizes>(request.how);
  const bool varies = sizes.bias > 1;
  const bool may_mix =
      request.method != Method::single && (may_combine(request.target, sizes) || !(varies || sizes.field));
  state.stages.close();  // those of the candidates count
  const Report start = state.report;
  Candidate taken = by_threes(state, start);
  std::optional<Candidate> mixed;
  const bool cuts_anything = taken.result.refined.mesh.n_hexes() > state.input.mesh.n_hexes();
  if (may_mix && cuts_anything)
    mixed = attempt(state, start, varies ? Approach::size_by_combination : Approach::size_by_halves);
  if (mixed && mixed->has_done) {
    judge(*mixed);
    judge(taken);
    taken = better_of(std::move(*mixed), std::move(taken),
                      varies ? "the combination for the last passes at the target, else whole hexes"
                             : "one into eight where that comes nearer, else one into 27",
                      varies ? "whole hexes alone, not the combination at the target as well"
                             : "one into 27 alone, not one into eight as well",
                      start);
  }
  state.report = std::move(taken.report);
  state.adopt(std::move(taken.result), std::move(taken.straight));
}

}  // namespace hextwist
