#include "hextwist/mesh/smooth/smooth.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <iterator>

#include "hextwist/base/parallel.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/mesh/smooth/problem_internal.h"

namespace hextwist {
namespace {

constexpr const char* scheme_names[] = {"mean ratio", "condition number", "laplacian", "untangle"};

void check(const SmoothOptions& options) {
  if (options.iterations < 0)
    throw Error("smooth: iterations must not be negative, not " + std::to_string(options.iterations));
  if (!(options.tolerance > 0) || !std::isfinite(options.tolerance))
    throw Error("smooth: tolerance must be positive and finite, not " + std::to_string(options.tolerance));
  if (std::isnan(options.average_loss)) throw Error("smooth: average_loss is not a number");
}

Summary shape_summary(const Mesh& mesh, std::span<const Index> hexes) {
  if (static_cast<Index>(hexes.size()) == mesh.n_hexes()) return summarize(quality(Metric::shape, mesh));
  Summary summary = summarize(quality(Metric::shape, mesh, hexes));
  if (summary.count > 0) {
    summary.min_hex = hexes[summary.min_hex];
    summary.max_hex = hexes[summary.max_hex];
  }
  return summary;
}

/// What no hex may fall below: an inverted hex counts as 0.
double least_shape(const SmoothReport& report) {
  return report.inverted_before > 0 ? 0 : report.shape_before.min;
}

/// How hard to pull at the worst hexes: reference = 1 + margin * (worst - 1).
struct Emphasis {
  double weight, margin;
};
constexpr Emphasis no_emphasis = {0, 1};
constexpr Emphasis gentle_emphasis = {1, 2};
constexpr Emphasis rounds[] = {{10, 1.25}, {30, 1.1}, {100, 1.05}};
constexpr Emphasis milder_rounds[] = {{3, 1.5}, {1, 1.5}, {1, 2}};  // when the first of those costs too much
constexpr int first_sweeps = 3;                                     // before the first round
constexpr int max_lifts = 15;                                       // sweeps per round
constexpr double least_gain = 1e-3;                                 // of the average distortion above 1, per sweep
constexpr double enough = 0.3;                                      // scaled Jacobians above are not lifted,
constexpr double as_good_as_square = 0.9;                           // and may fall when above this
constexpr int max_averages = 5;                                     // sweeps per round, until the end

class Smoother {
 public:
  Smoother(SmoothState& state, const SmoothOptions& options, const SmoothProgress& progress, SmoothReport& report)
      : state_(state), options_(options), progress_(progress), report_(report) {}

  void run() {
    record("start");
    if (report_.inverted_before > 0 || options_.scheme == SmoothScheme::untangle) {
      untangle(state_, options_.iterations, [this](const SweepCount& count) { return end_sweep("untangle", count); });
      report_.not_repaired = inverted_hexes(state_.mesh, state_.problem.hexes);
      report_.converged = report_.not_repaired.empty();
    }
    if (options_.scheme == SmoothScheme::untangle) return;
    const Bounds before = bounds_of(state_.mesh, state_.problem.hexes, as_good_as_square);
    least_corner_ = before.scaled_jacobian;
    guarded(before, [&] {
      std::ranges::fill(state_.awake, 1);
      improve();
    });
    // What has good angles may still have bad corners: these are lifted as far as no shape gets worse for it.
    if (options_.scheme != SmoothScheme::mean_ratio || finished()) return;
    const Bounds reached = bounds_of(state_.mesh, state_.problem.hexes, enough);
    if (reached.scaled_jacobian >= enough) return;
    at_no_cost([&] {
      guarded(reached, [&] {
        lift_low(state_, {enough, reached.shape}, max_lifts,
                 [this](const SweepCount& count) { return end_sweep("corners", count); });
      });
    });
  }

  void record(const char* stage) {
    if (!options_.record_history) return;
    const Summary shape = shape_summary(state_.mesh, state_.problem.hexes);
    report_.history.push_back({stage, shape.min, shape.average, average_distortion(state_.mesh, state_.problem.hexes),
                               report_.node_updates, seconds()});
  }
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  using Sweep = SweepCount (*)(SmoothState&, const SweepRule&);

  /// Sweeps look at corners, one by one. Where hexes have become worse than the bounds all the same, or were turned
  /// inside out between their corners, their nodes did not move.
  template <class F>
  void guarded(const Bounds& bounds, const F& move) {
    const std::vector<Vec3> points = state_.mesh.points;
    const std::vector<Parameters> parameters = state_.association.node_parameters;
    move();
    take_back(state_, points, parameters, report_.not_repaired, bounds);
  }

  void improve() {
    switch (options_.scheme) {
      case SmoothScheme::mean_ratio:
        return optimise("shape", sweep_mean_ratio);
      case SmoothScheme::condition_number:
        return optimise("condition number", sweep_condition_number);
      case SmoothScheme::laplacian:
        return settle("laplacian", sweep_laplacian, no_emphasis);
      case SmoothScheme::untangle:
        return;
    }
  }

  bool end_sweep(const char* stage, const SweepCount& count) {
    ++report_.sweeps;
    report_.node_updates += count.updates;
    record(stage);
    if (progress_ && !progress_(stage, std::min(1.0, report_.sweeps / std::max(1.0, double(options_.iterations)))))
      report_.stopped = true;
    return !finished();
  }
  bool finished() const { return report_.stopped || report_.sweeps >= options_.iterations; }

  /// Looks at all hexes again.
  void measure() { hex_distortions(state_.mesh, state_.problem.hexes, distortions_); }
  /// The largest distortion among the hexes that are not inverted.
  double worst() const {
    double result = 1;
    for (const double h : distortions_)
      if (h > result && h < std::numeric_limits<double>::infinity()) result = h;
    return result;
  }
  SweepRule rule(Emphasis emphasis) const {
    SweepRule rule;
    rule.limit = worst();
    rule.least_corner = least_corner_;
    rule.tolerance = options_.tolerance;
    rule.weight = emphasis.weight;
    rule.reference = 1 + emphasis.margin * (rule.limit - 1);
    return rule;
  }

  /// Sweeps until all nodes are at rest, beginning with those that are awake.
  void settle(const char* stage, Sweep sweep, Emphasis emphasis, int max_sweeps = std::numeric_limits<int>::max()) {
    measure();
    const SweepRule fixed_rule = rule(emphasis);
    const bool watched = sweep == sweep_mean_ratio && emphasis.weight == 0;  // the energy measured is its own
    double energy = watched ? average_distortion(state_.mesh, state_.problem.hexes) : 0;
    for (int i = 0; i < max_sweeps && !finished(); ++i) {
      const SweepCount count = sweep(state_, fixed_rule);
      if (!end_sweep(stage, count)) return;
      report_.converged = count.moved * 1000 <= state_.problem.n_nodes();
      if (watched) {
        const double before = energy;
        energy = average_distortion(state_.mesh, state_.problem.hexes);
        report_.converged |= before - energy < least_gain * (energy - 1);
      }
      if (report_.converged) return;
    }
  }

  /// Sweeps over the nodes of bad hexes until the worst improves no more. Those that were visited are awake after it,
  /// beside those that were before.
  void lift(Sweep sweep, Emphasis emphasis) {
    std::vector<std::uint8_t> visited = state_.awake;
    measure();
    int idle = 0;
    for (int i = 0; i < max_lifts && idle < 3 && !finished(); ++i) {
      const SweepRule now = rule(emphasis);
      if (now.limit < 1 + options_.tolerance * options_.tolerance) break;  // as good as cubes
      // Below this the power term is less than a hundredth of what it is for the worst.
      wake_nodes_of_bad_hexes(0.75 * now.limit);
      for (std::size_t s = 0; s < visited.size(); ++s) visited[s] |= state_.awake[s];
      const SweepCount count = sweep(state_, now);
      measure();
      idle = now.limit - worst() > 1e-3 * (now.limit - 1) ? 0 : idle + 1;
      if (!end_sweep("worst", count)) break;
    }
    state_.awake = visited;
  }
  void wake_nodes_of_bad_hexes(double threshold) {
    std::ranges::fill(state_.awake, 0);
    parallel_each(distortions_.size(), [&](std::size_t i) {
      if (!(distortions_[i] > threshold)) return;
      for (const Index node : state_.mesh.hexes[state_.problem.hexes[i]])
        if (const Index slot = state_.problem.slot[node]; slot >= 0)
          std::atomic_ref(state_.awake[slot]).store(1, std::memory_order_relaxed);
    });
  }

  void optimise(const char* stage, Sweep sweep) {
    settle(stage, sweep, gentle_emphasis, first_sweeps);
    if (lift_and_average(sweep, rounds[0])) {
      for (std::size_t i = 1; i < std::size(rounds); ++i)
        if (!lift_and_average(sweep, rounds[i])) break;
    } else {
      for (const Emphasis& emphasis : milder_rounds)
        if (lift_and_average(sweep, emphasis)) break;
    }
    settle("average", sweep, no_emphasis);
  }
  /// One round; taken back when it cost the average too much.
  bool lift_and_average(Sweep sweep, Emphasis emphasis) {
    if (finished()) return true;
    const std::vector<std::uint8_t> awake = state_.awake;
    const bool kept = at_no_cost([&] {
      lift(sweep, emphasis);
      settle("average", sweep, no_emphasis, max_averages);
    });
    if (!kept) state_.awake = awake;
    return kept;
  }
  /// Taken back (false) when it cost the average too much.
  template <class F>
  bool at_no_cost(const F& move) {
    const std::vector<Vec3> points = state_.mesh.points;
    const std::vector<Parameters> parameters = state_.association.node_parameters;
    move();
    const double least = report_.shape_before.average - options_.average_loss;
    if (report_.stopped || shape_summary(state_.mesh, state_.problem.hexes).average >= least) return true;
    state_.mesh.points = points;
    state_.association.node_parameters = parameters;
    return false;
  }

  std::vector<double> distortions_;  // per hex of the problem
  double least_corner_ = 0;          // scaled Jacobian
  SmoothState& state_;
  const SmoothOptions& options_;
  const SmoothProgress& progress_;
  SmoothReport& report_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string lower_words(std::string_view text) {
  std::string result;
  for (const char c : text)
    if (c != ' ' && c != '_' && c != '-') result += lower_case(c);
  return result;
}

}  // namespace

const char* name(SmoothScheme scheme) {
  return scheme_names[static_cast<int>(scheme)];
}

SmoothScheme smooth_scheme(std::string_view name) {
  std::string known;
  for (int i = 0; i < static_cast<int>(std::size(scheme_names)); ++i) {
    if (lower_words(scheme_names[i]) == lower_words(name)) return static_cast<SmoothScheme>(i);
    known += (i > 0 ? ", " : "") + std::string(scheme_names[i]);
  }
  throw Error("unknown smoothing scheme '" + std::string(name) + "': known are " + known);
}

SmoothReport smooth(Mesh& mesh, Association& association, const Model* model, const SmoothOptions& options,
                    const SmoothProgress& progress) {
  check(options);
  SmoothReport report;
  const auto start = std::chrono::steady_clock::now();
  // Tags of a file may name owners without places on them; those are found when they are needed.
  if (!association.empty()) association.node_parameters.resize(mesh.points.size());
  const SmoothProblem problem = make_smooth_problem(mesh, association, model, options);
  SmoothState state{problem, mesh, association, model, std::vector<std::uint8_t>(problem.nodes.size(), 1)};
  report.n_nodes = problem.n_nodes();
  report.shape_before = report.shape_after = shape_summary(mesh, problem.hexes);
  report.not_repaired = inverted_hexes(mesh, problem.hexes);
  report.inverted_before = static_cast<Index>(report.not_repaired.size());
  if (problem.n_nodes() > 0) {
    const std::vector<Vec3> points = mesh.points;
    const std::vector<Parameters> parameters = association.node_parameters;
    Smoother(state, options, progress, report).run();
    report.shape_after = shape_summary(mesh, problem.hexes);
    // Sweeps keep clear of the limit by more than rounding; should that ever not be enough, the guarantee still holds.
    if (report.shape_after.min < least_shape(report)) {
      mesh.points = points;
      association.node_parameters = parameters;
      report.shape_after = report.shape_before;
    }
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace hextwist
