// Goals 12 to 19: what a user waits for, through Session::run: everything that a command does, verified.
#include "hextwist/session/session.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "groups.h"
#include "hextwist/io/io.h"
#include "measure.h"
#include "meshes.h"

namespace hextwist::bench {
namespace {

struct Took {
  CommandRecord record;
  double seconds = 0;      ///< wall
  double cpu_seconds = 0;  ///< of all threads
  std::size_t bytes_after = 0;

  /// Wall seconds of these stages.
  double stages(std::initializer_list<const char*> names) const {
    double sum = 0;
    for (const StageTime& each : record.seconds)
      if (std::ranges::find(names, std::string(each.stage)) != names.end()) sum += each.seconds;
    return sum;
  }
  double made() const { return static_cast<double>(record.after.hexes - record.before.hexes); }
};

/// The last of some commands, on so many threads: the quickest of three sessions. Run once.
const Took& took(int threads, const std::vector<std::string>& commands, int n_runs = 3) {
  static std::map<std::pair<int, std::vector<std::string>>, Took> known;
  const auto [at, is_new] = known.try_emplace({threads, commands});
  for (int run = 0; run < n_runs && is_new; ++run) {
    const Threads limit(threads);
    tbb::task_arena(threads).execute([&] {
      Session session;
      for (std::size_t i = 0; i + 1 < commands.size(); ++i) session.run(commands[i]);
      const auto start = std::chrono::steady_clock::now();
      const std::clock_t cpu_start = std::clock();
      session.run(commands.back());
      Took now;
      now.cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
      now.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      now.record = session.records().back();
      now.bytes_after = bytes(session.meshed().mesh) + bytes(session.meshed().association);
      if (run == 0 || now.seconds < at->second.seconds) at->second = std::move(now);
    });
  }
  return at->second;
}

std::string brick(int n) {
  return "create brick x 10 interval " + std::to_string(n);
}
const std::string uniform = "refine volume all numsplit 1", layers = "refine surface 1 depth 1",
                  ball = "refine vertex 1 radius 4";

/// A shipped part of many hexes on its CAD, and the same with a file of it.
const std::vector<std::string>& part() {
  static const std::vector<std::string> commands = [] {
    const std::string folder = std::string(HEXTWIST_SOURCE_DIR) + "/models/";
    return std::vector<std::string>{"import brep \"" + folder + "bracket_fillet.brep\"",
                                    "import mesh \"" + folder + "bracket_fillet.msh\"",
                                    "refine volume all method parallel numsplit 3"};
  }();
  return commands;
}
std::vector<std::string> on_part(const std::string& command) {
  std::vector<std::string> commands = part();
  commands.push_back(command);
  return commands;
}
std::vector<std::string> on_file(const std::string& last) {
  static const std::string file = [] {
    Session session;
    for (const std::string& command : part()) session.run(command);
    const std::string name = output_file("part.msh").string();
    session.export_mesh(name);
    return name;
  }();
  return {part()[0], last.empty() ? "import mesh \"" + file + "\"" : last};
}

/// Wall time of a verified refinement over that of its split, carry and place.
double over_its_parts(const std::vector<std::string>& commands) {
  const Took& run = took(1, commands);
  return run.seconds / run.stages({"split", "carry", "place"});
}
double million_per_second(const std::vector<std::string>& commands) {
  const Took& run = took(1, commands);
  return 1e-6 * static_cast<double>(run.record.after.hexes) / run.seconds;
}
double speedup(const std::vector<std::string>& commands, std::initializer_list<const char*> stages) {
  return took(1, commands).stages(stages) / took(2, commands).stages(stages);
}

const std::vector<std::string>& uniform_run() {
  static const std::vector<std::string> commands = {brick(50), uniform};
  return commands;
}
const std::vector<std::string>& layers_run() {
  static const std::vector<std::string> commands = {brick(100), layers};
  return commands;
}
const std::vector<std::string>& ball_run() {
  static const std::vector<std::string> commands = {brick(80), ball};
  return commands;
}
/// A session that has begun: levels, lists of hexes around nodes.
std::vector<std::string> begun(const std::string& command) {
  return {brick(100), "refine hex 505051", "undo", "refine hex 505051", command};
}

double seconds_per_million(const Took& run, std::initializer_list<const char*> stages) {
  return run.stages(stages) / (1e-6 * static_cast<double>(run.record.after.hexes));
}

/// Over copying what a command changed, once: the arrays of what came out, as undo gives back no more than these.
double undo_over_copy(const std::string& command) {
  const Took& run = took(1, {brick(60), command, "undo", "redo", "undo"});
  const std::size_t changed = took(1, {brick(60), command}).bytes_after + run.bytes_after;
  std::vector<char> from(changed, 1);
  const std::clock_t start = std::clock();
  const std::vector<char> to(from);
  benchmark::DoNotOptimize(to.data());
  return run.cpu_seconds / (static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
}

/// Time for a hex made by a command, on bricks of ever more hexes: the longest over the shortest; each to stderr.
double growth(const std::string& command) {
  double least = 1e300, most = 0;
  for (const int n : {25, 50, 100, 160}) {
    if (command == uniform && n > 50) continue;  // 160 would become 110 million
    const Took& run = took(1, {brick(n), command});
    const double each = run.cpu_seconds / run.made();
    std::fprintf(stderr, "%s on %d^3: %.0f hexes more, %.0f ns each\n", command.c_str(), n, run.made(), 1e9 * each);
    least = std::min(least, each);
    most = std::max(most, each);
  }
  return most / least;
}

}  // namespace

void add_session() {
  add_value("session/uniform_parts", [] { return over_its_parts(uniform_run()); });
  add_value("session/layers_parts", [] { return over_its_parts(layers_run()); });
  add_value("session/ball_parts", [] { return over_its_parts(ball_run()); });
  add_value("session/part_parts", [] { return over_its_parts(on_part("refine surface 3 depth 1")); });
  add_value("session/uniform_rate", [] { return million_per_second(uniform_run()); });
  add_value("session/check", [] { return seconds_per_million(took(1, on_file("")), {"check", "check mesh"}); });
  add_value("session/associate", [] { return seconds_per_million(took(1, on_file("")), {"associate"}); });
  add_value("session/import", [] {
    const Took& run = took(2, on_file(""));
    return run.seconds / (1e-6 * static_cast<double>(run.record.after.hexes));
  });
  add_value("session/sizes_nothing", [] { return 1e3 * took(1, begun("refine curve 1 size 0.2 bias 1.3")).seconds; });
  add_value("session/sizes_curve", [] { return 1e3 * took(1, begun("refine curve 1 size 0.004 bias 1.3")).seconds; });
  add_value("session/sizes_deep", [] {
    const Took& run = took(1, {brick(10), "refine curve 1 size 0.0005 bias 2"}, 1);
    return run.seconds / (1e-5 * static_cast<double>(run.record.after.hexes));
  });
  add_value("session/smooth", [] {
    const Took& run = took(2, on_part("refine surface 3 depth 1 smooth"));
    return 2e6 * run.stages({"smooth", "improve"}) / run.made();
  });
  add_value("session/smooth_part", [] {
    return took(1, on_part("refine surface 5 depth 1 smooth")).seconds /
           took(1, on_part("refine surface 5 depth 1")).seconds;
  });
  add_value("session/undo_uniform", [] { return undo_over_copy(uniform); });
  add_value("session/undo_layers", [] { return undo_over_copy(layers); });
  add_value("growth/uniform", [] { return growth(uniform); });
  add_value("growth/layers", [] { return growth(layers); });
  add_value("growth/ball", [] { return growth(ball); });
  add_value("session/threads_verify", [] { return speedup(uniform_run(), {"verify"}); });
  add_value("session/threads_check", [] { return speedup(on_file(""), {"check", "check mesh"}); });
  add_value("session/threads_smooth", [] {
    return speedup(on_part("refine surface 3 depth 1 smooth"), {"smooth", "improve"});
  });
  add_value("session/threads_sizes", [] {
    const std::vector<std::string> commands = {brick(60), "refine surface 1 size 0.02 bias 1.3"};
    return took(1, commands).seconds / took(2, commands).seconds;
  });
}

}  // namespace hextwist::bench
