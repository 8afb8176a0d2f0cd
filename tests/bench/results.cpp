#include "results.h"

#include <algorithm>
#include <fstream>

namespace hextwist::bench {

void Collector::ReportRuns(const std::vector<Run>& runs) {
  std::vector<Run> shown;
  for (const Run& run : runs) {
    if (run.run_type == Run::RT_Aggregate) continue;
    if (run.error_occurred) {
      shown.push_back(run);
      continue;
    }
    std::string name = run.run_name.function_name;
    const auto [found, is_new] = results_.try_emplace(name);
    Result& best = found->second;
    const double n = static_cast<double>(run.iterations);
    const double cpu = run.cpu_accumulated_time / n, wall = run.real_accumulated_time / n;
    const auto counter = [&](const char* key) {
      const auto at = run.counters.find(key);
      return at == run.counters.end() ? 0.0 : at->second.value;
    };
    const bool better = is_new || cpu < best.cpu_seconds;
    best.cpu_seconds = is_new ? cpu : std::min(best.cpu_seconds, cpu);
    best.wall_seconds = is_new ? wall : std::min(best.wall_seconds, wall);
    best.per_second = std::max(best.per_second, counter("items_per_second"));
    best.value = counter("value");
    if (better) {
      if (!shown.empty() && shown.back().run_name.function_name == name) shown.pop_back();
      shown.push_back(run);
    }
  }
  ConsoleReporter::ReportRuns(shown);
}

void read_peers(const std::filesystem::path& file, Results& results) {
  std::ifstream in(file);
  std::string name;
  double seconds = 0, items = 0;
  while (in >> name >> seconds >> items)
    results["peer/" + name] = {seconds, seconds, items / seconds, 1e-6 * items / seconds};
}

}  // namespace hextwist::bench
