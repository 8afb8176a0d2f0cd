// What comes nearer to wished sizes: threes alone, or with twos, or with the combination at the target.
#include <algorithm>
#include <cmath>
#include <utility>

#include "hextwist/mesh/quality/quality.h"
#include "hextwist/refine/place.h"
#include "hextwist/sizing/techniques/techniques_internal.h"

namespace hextwist {
namespace {

/// Parts of hexes within a factor sqrt(3), and relative differences between average distances from the wish, that are
/// no more than this count as equal.
constexpr double near_tie = 0.05;

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
  const std::unique_ptr<SizeTechnique> technique = size_technique(state, approach);
  state.run(*technique);
  candidate.has_done = technique->has_done();
  candidate.result = state.take_result();
  candidate.straight = state.take_straight();
  return candidate;
}

void judge(Candidate& candidate) {
  const std::vector<double>& ratio = candidate.report.sizes->ratio;
  for (const double r : ratio) candidate.distance += std::abs(std::log(r)) / static_cast<double>(ratio.size());
  const Mesh& mesh = candidate.result.refined.mesh;
  candidate.worst_shape = summarize(quality(Metric::shape, mesh)).min;
  candidate.sound =
      candidate.report.off_nodes.empty() && candidate.report.sizes->unmet.empty() && inverted_hexes(mesh).empty();
}

bool is_better(const Candidate& a, const Candidate& b) {
  if (a.sound != b.sound) return a.sound;
  if (std::abs(a.report.sizes->met() - b.report.sizes->met()) > near_tie)
    return a.report.sizes->met() > b.report.sizes->met();
  if (std::abs(a.distance - b.distance) > near_tie * std::max(a.distance, b.distance)) return a.distance < b.distance;
  return a.worst_shape > b.worst_shape;
}

std::string rounded(double value) {
  const auto hundredths = std::lround(100 * value);
  return std::to_string(hundredths / 100) + (hundredths % 100 < 10 ? ".0" : ".") + std::to_string(hundredths % 100);
}

}  // namespace

void run_nearest_size(State& state) {
  const Sizes& sizes = std::get<Sizes>(state.request.how);
  const bool varies = sizes.bias > 1;
  state.stages.close();  // those of the candidates count
  const Report start = state.report;
  Candidate mixed = attempt(state, start, varies ? Approach::size_by_combination : Approach::size_by_halves);
  if (!mixed.has_done) {
    state.report = std::move(mixed.report);
    return state.adopt(std::move(mixed.result), std::move(mixed.straight));
  }
  Candidate thirds = attempt(state, start, Approach::size_by_threes);
  judge(mixed);
  judge(thirds);
  const bool takes_mixed = is_better(mixed, thirds);
  Candidate& better = takes_mixed ? mixed : thirds;
  const Candidate& other = takes_mixed ? thirds : mixed;
  Report& report = state.report;
  report = std::move(better.report);
  const double wasted = other.report.total_seconds - start.total_seconds;
  report.seconds.push_back({"other technique", wasted});
  report.total_seconds += wasted;
  const char* taken = varies ? takes_mixed ? "the combination for the last passes at the target, else whole hexes"
                                           : "whole hexes alone, not the combination at the target as well"
                      : takes_mixed ? "one into eight where that comes nearer, else one into 27"
                                    : "one into 27 alone, not one into eight as well";
  report.notices.push_back(std::string(taken) + ": sizes are off by a factor of " + rounded(std::exp(better.distance)) +
                           " on average, not " + rounded(std::exp(other.distance)) + "; the worst shape is " +
                           rounded(better.worst_shape) + ", not " + rounded(other.worst_shape));
  state.adopt(std::move(better.result), std::move(better.straight));
}

}  // namespace hextwist
