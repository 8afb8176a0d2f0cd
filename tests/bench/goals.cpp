#include "goals.h"

#include <cmath>
#include <cstdio>
#include <optional>
#include <ostream>

namespace hextwist::bench {
namespace {

enum class Unit { million_per_second, cpu_milliseconds, wall_milliseconds, megabytes_per_second, plain };

struct Goal {
  int number;  ///< of the list in docs/performance.md
  const char* what;
  const char* run;
  const char* other;  ///< floor, peer or what to compare with; "" for none
  Unit unit;
  /// Wanted of the measured number and of its ratio to the other: at least (positive) or at most (negative); 0: any.
  double bound = 0;
  double ratio_bound = 0;
};
constexpr Unit rate = Unit::million_per_second, cpu = Unit::cpu_milliseconds, wall = Unit::wall_milliseconds,
               bytes = Unit::megabytes_per_second, plain = Unit::plain;

constexpr Goal goals[] = {
    {1, "split, all one into 27", "split/all27", "floor/all27", rate, 10, 0.5},
    {1, "split, all one into 8", "split/all8", "floor/all8", rate, 10, 0.5},
    {1, "marks to mesh with points, 27", "pass/all27", "floor/all27_points", rate, 10, 0.5},
    {1, "marks to mesh with points, 8", "pass/all8", "floor/all8_points", rate, 10, 0.5},
    {2, "ball of 10% of a million, templates", "split/ball_templates", "peer/dealii_ball", rate, 6, 20},
    {2, "ball of 10% of a million, filled", "split/ball_fill", "peer/dealii_ball", rate, 6, 20},
    {2, "marks to mesh with points, templates", "pass/ball_templates", "peer/dealii_ball", rate, 6, 20},
    {2, "marks to mesh with points, filled", "pass/ball_fill", "peer/dealii_ball", rate, 6, 20},
    {2, "all one into 8 against Gmsh's refine", "pass/all8", "peer/gmsh_refine", rate, 0, 1},
    {2, "all one into 8 against deal.II", "pass/all8", "peer/dealii_uniform", rate, 0, 1},
    {3, "split and carry one hex of a million, to copy", "small/pass", "small/copy", cpu, 0, -3},
    {3, "refine hex of a million, to copy", "small/hex", "small/copy", cpu, 0, -3},
    {3, "refine curve of one edge, depth 1, to copy", "small/short_curve", "small/copy", cpu, 0, -3},
    {3, "the same, depth 0 (two passes)", "small/short_curve_combination", "small/copy", cpu, 0, -3},
    {3, "refine curve of 100 edges, depth 1, to copy", "small/curve", "small/copy", cpu, 0, -3},
    {3, "the same, depth 0 (two passes)", "small/curve_combination", "small/copy", cpu, 0, -3},
    {3, "later hex in a session, median ms", "small/later_hex", "", plain, -10, 0},
    {3, "the same, worst of 11 places", "small/later_hex_worst", "", plain, -10, 0},
    {3, "later curve of one edge, depth 1, ms", "small/later_short_curve", "", plain, -10, 0},
    {3, "the same, worst of 4", "small/later_short_curve_worst", "", plain, -10, 0},
    {3, "later curve of one edge, depth 0, ms", "small/later_short_curve_combination", "", plain, -10, 0},
    {3, "the same, worst of 4", "small/later_short_curve_combination_worst", "", plain, -10, 0},
    {3, "later curve of 100 edges, depth 1, ms", "small/later_curve", "", plain, -10, 0},
    {3, "the same, worst of 3", "small/later_curve_worst", "", plain, -10, 0},
    {3, "later curve of 100 edges, depth 0, ms", "small/later_curve_combination", "", plain, -10, 0},
    {3, "the same, worst of 3", "small/later_curve_combination_worst", "", plain, -10, 0},
    {4, "two threads, all one into 27", "threads/split_all27/2", "threads/split_all27/1", wall, 0, -1 / 1.7},
    {4, "two threads, all one into 8", "threads/split_all8/2", "threads/split_all8/1", wall, 0, -1 / 1.7},
    {4, "two threads, ball", "threads/split_ball/2", "threads/split_ball/1", wall, 0, -1 / 1.7},
    {4, "two threads, marks to mesh, 27", "threads/pass_all27/2", "threads/pass_all27/1", wall, 0, -1 / 1.7},
    {4, "two threads, marks to mesh, 8", "threads/pass_all8/2", "threads/pass_all8/1", wall, 0, -1 / 1.7},
    {4, "two threads, marks to mesh, ball", "threads/pass_ball/2", "threads/pass_ball/1", wall, 0, -1 / 1.7},
    {4, "two threads, association", "threads/associate/2", "threads/associate/1", wall, 0, -1 / 1.7},
    {4, "two threads, placement", "threads/place_ball/2", "threads/place_ball/1", wall, 0, -1 / 1.7},
    {4, "same bytes for 1, 2 and 8 threads", "split/same_bytes", "", plain, 1, 0},
    {5, "peak over arrays, all one into 8", "memory/pass_all8", "", plain, -3, 0},
    {5, "peak over arrays, all one into 27", "memory/pass_all27", "", plain, -3, 0},
    {5, "peak over arrays, ball", "memory/pass_ball", "", plain, -3, 0},
    {5, "peak over arrays, refine uniformly, verified", "memory/refine_uniform", "", plain, -3, 0},
    {5, "peak over arrays, refine hex, verified", "memory/refine_hex", "", plain, -3, 0},
    {6, "associate a million, 36 planes, geometry", "associate/geometry", "", cpu, -3000, 0},
    {6, "associate a million, 36 planes, tags", "associate/tags", "", cpu, -2000, 0},
    {6, "associate 1.2 million, bracket, geometry", "associate/bracket_geometry", "", cpu, -3000, 0},
    {6, "associate 1.2 million, bracket, tags", "associate/bracket_tags", "", cpu, -2000, 0},
    {6, "place on a plane", "place/plane", "", rate, 2, 0},
    {6, "place on a cylinder", "place/cylinder", "", rate, 2, 0},
    {6, "place on a cone", "place/cone", "", rate, 2, 0},
    {6, "place on a sphere", "place/sphere", "", rate, 2, 0},
    {6, "place on a torus", "place/torus", "", rate, 2, 0},
    {6, "place on a B-spline surface", "place/bspline", "", rate, 0.4, 0},
    {7, "vertex updates/s", "smooth/updates", "", plain, 1e6, 0},
    {7, "teapot as good as Mesquite's, us/hex", "smooth/teapot", "", plain, -7, 0},
    {8, "shape of a million", "quality/shape", "peer/vtk_shape", cpu, -150, 0},
    {8, "scaled Jacobian of a million", "quality/scaled_jacobian", "peer/vtk_scaled_jacobian", cpu, -150, 0},
    {9, "write .vtu", "write/vtu", "peer/vtk_write", cpu, 0, -1},
    {9, "read .vtu", "read/vtu", "peer/vtk_read", cpu, 0, -1},
    {9, "write .msh", "write/msh", "peer/gmsh_write", cpu, 0, -1},
    {9, "read .msh", "read/msh", "peer/gmsh_read", cpu, 0, -1},
    {9, "write Exodus, to the library's own calls", "write/e", "floor/exodus_write", cpu, 0, -1.1},
    {9, "read Exodus, to the library's own calls", "read/e", "floor/exodus_read", cpu, 0, -1.1},
    {9, "write Abaqus", "write/inp", "", bytes, 100, 0},
    {9, "read Abaqus", "read/inp", "", bytes, 100, 0},
    {11, "front through a grid, two levels, M hexes/s", "front/levels2", "peer/dealii_front2", plain, 0, 10},
    {11, "the same, three levels", "front/levels3", "peer/dealii_front3", plain, 0, 10},
    {12, "refined, verified, over split + carry + place: all", "session/uniform_parts", "", plain, -1.6, 0},
    {12, "the same, a surface of a million", "session/layers_parts", "", plain, -1.6, 0},
    {12, "the same, a ball", "session/ball_parts", "", plain, -1.6, 0},
    {12, "the same, a surface on CAD", "session/part_parts", "", plain, -1.6, 0},
    {12, "refined, verified, all, M hexes/s and thread", "session/uniform_rate", "", plain, 8, 0},
    {13, "check what is read, s per million", "session/check", "", plain, -0.35, 0},
    {13, "associate it, s per million", "session/associate", "", plain, -0.35, 0},
    {13, "import, two threads, s per million", "session/import", "", plain, -1, 0},
    {14, "sizes, nothing to do on a million, ms", "session/sizes_nothing", "", plain, -20, 0},
    {14, "sizes, a curve of 100 edges, 3 levels, ms", "session/sizes_curve", "", plain, -100, 0},
    {14, "sizes, many passes, s per 100,000 hexes", "session/sizes_deep", "", plain, -1, 0},
    {15, "smooth what is new, us a hex and thread", "session/smooth", "", plain, -5, 0},
    {15, "a part with smooth to without", "session/smooth_part", "", plain, -8, 0},
    {16, "undo of all, over copying what changed", "session/undo_uniform", "", plain, -1, 0},
    {16, "undo of a surface, the same", "session/undo_layers", "", plain, -1, 0},
    {17, "two threads: verify", "session/threads_verify", "", plain, 1.7, 0},
    {17, "two threads: check", "session/threads_check", "", plain, 1.7, 0},
    {17, "two threads: smooth", "session/threads_smooth", "", plain, 1.7, 0},
    {17, "two threads: sizes", "session/threads_sizes", "", plain, 1.7, 0},
    {18, "time a hex, brick of 25 to 160: all", "growth/uniform", "", plain, -1.5, 0},
    {18, "the same: a surface", "growth/layers", "", plain, -1.5, 0},
    {18, "the same: a ball", "growth/ball", "", plain, -1.5, 0},
    {19, "bytes at the peak for a hex made, undo too", "memory/session_uniform", "", plain, -110, 0},
};

double value(const Result& result, Unit unit) {
  switch (unit) {
    case Unit::million_per_second:
      return 1e-6 * result.per_second;
    case Unit::cpu_milliseconds:
      return 1e3 * result.cpu_seconds;
    case Unit::wall_milliseconds:
      return 1e3 * result.wall_seconds;
    case Unit::megabytes_per_second:
      return 1e-6 * result.per_second;
    case Unit::plain:
      return result.value;
  }
  return 0;
}

const char* name(Unit unit) {
  constexpr const char* names[] = {"M/s", "ms", "ms wall", "MB/s", ""};
  return names[static_cast<int>(unit)];
}

std::optional<double> find(const Results& results, const char* run, Unit unit) {
  const auto found = results.find(run);
  return found == results.end() ? std::nullopt : std::optional(value(found->second, unit));
}

bool holds(double value, double bound) {
  return bound == 0 || (bound > 0 ? value >= bound : value <= -bound);
}

std::string number(double value, const char* format = "%.3g") {
  char text[32];
  std::snprintf(text, sizeof text, value >= 1e4 ? "%.0f" : format, value);
  return text;
}

std::string wanted(const Goal& goal) {
  const auto one = [](double bound) { return (bound > 0 ? ">=" : "<=") + number(std::abs(bound)); };
  std::string text;
  if (goal.bound != 0) text += one(goal.bound);
  if (goal.ratio_bound != 0) text += (text.empty() ? "" : ", ") + one(goal.ratio_bound) + "x";
  return text;
}

}  // namespace

void print_goals(const Results& results, std::ostream& out) {
  char line[256];
  std::snprintf(line, sizeof line, "%4s  %-45s %16s %16s %8s  %-14s %s\n", "goal", "what", "measured", "floor or peer",
                "ratio", "wanted", "met");
  out << '\n' << line << std::string(118, '-') << '\n';
  int n_met = 0, n_missed = 0;
  for (const Goal& goal : goals) {
    const auto measured = find(results, goal.run, goal.unit);
    const auto other = find(results, goal.other, goal.unit);
    std::string met = "not run";
    std::string ratio;
    if (measured) {
      bool good = holds(*measured, goal.bound);
      if (other) {
        ratio = number(*measured / *other);
        good &= holds(*measured / *other, goal.ratio_bound);
      }
      const bool open = goal.ratio_bound != 0 && !other;  // what to compare with was not run
      const bool asked = goal.bound != 0 || goal.ratio_bound != 0;
      met = !asked ? "" : !good ? "NO" : open ? (goal.bound != 0 ? "yes, no peer" : "no peer") : "yes";
      if (met.starts_with("yes")) ++n_met;
      if (met == "NO") ++n_missed;
    }
    const std::string unit = name(goal.unit);
    const auto shown = [&](const std::optional<double>& v) {
      return v ? number(*v) + (unit.empty() ? "" : " " + unit) : "-";
    };
    std::snprintf(line, sizeof line, "%4d  %-45s %16s %16s %8s  %-14s %s\n", goal.number, goal.what,
                  shown(measured).c_str(), shown(other).c_str(), ratio.c_str(), wanted(goal).c_str(), met.c_str());
    out << line;
  }
  out << n_met << " met, " << n_missed << " missed\n";
}

}  // namespace hextwist::bench
