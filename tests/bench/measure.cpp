#include "measure.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>

namespace hextwist::bench {
namespace {

/// A line of /proc/self/status, in bytes.
std::size_t status(const std::string& key) {
  std::ifstream file("/proc/self/status");
  std::string word;
  while (file >> word)
    if (word == key) {
      std::size_t kilobytes = 0;
      file >> kilobytes;
      return kilobytes * 1024;
    }
  return 0;
}

}  // namespace

void add_value(const std::string& name, double (*value)()) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [value](benchmark::State& state) {
                                 double result = 0;
                                 for ([[maybe_unused]] auto _ : state) result = value();
                                 if (std::isnan(result)) return state.SkipWithError("not available here");
                                 state.counters["value"] = result;
                               })
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}

std::size_t peak_memory() {
  return status("VmHWM:");
}
std::size_t memory() {
  return status("VmRSS:");
}

double peak_ratio(const std::string& task) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  std::FILE* out = popen(("'" + program.string() + "' --task " + task).c_str(), "r");
  if (!out) return std::numeric_limits<double>::quiet_NaN();
  double ratio = std::numeric_limits<double>::quiet_NaN();
  if (std::fscanf(out, "%lf", &ratio) != 1) ratio = std::numeric_limits<double>::quiet_NaN();
  pclose(out);
  return ratio;
}

}  // namespace hextwist::bench
