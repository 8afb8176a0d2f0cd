// Collects what was measured, by name, for the table at the end.
#pragma once

#include <benchmark/benchmark.h>

#include <filesystem>
#include <map>
#include <string>

namespace hextwist::bench {

/// Best of the repetitions.
struct Result {
  double cpu_seconds = 0;   ///< of the process
  double wall_seconds = 0;  ///< from start to end
  double per_second = 0;    ///< items per CPU second
  double value = 0;         ///< of add_value()
};
using Results = std::map<std::string, Result>;

class Collector : public benchmark::ConsoleReporter {
 public:
  Collector() : ConsoleReporter(OO_None) {}
  void ReportRuns(const std::vector<Run>& runs) override;
  const Results& results() const { return results_; }

 private:
  Results results_;
};

/// Adds lines "name cpu_seconds items" of peers (peers/run.sh) under "peer/name".
void read_peers(const std::filesystem::path& file, Results& results);

}  // namespace hextwist::bench
