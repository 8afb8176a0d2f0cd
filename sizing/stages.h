// Times the stages of a request and lets the caller stop it.
#pragma once

#include <algorithm>
#include <chrono>

#include "hextwist/sizing/report.h"

namespace hextwist {

/// Times stages, passes them to the progress callback and stops the run when that says so.
class Stages {
 public:
  Stages(Report& report, const Progress& progress) : report_(report), progress_(progress) {}
  ~Stages() { close(); }

  void begin(const char* stage, double fraction) {
    close();
    stage_ = stage;
    since_ = Clock::now();
    if (!report(stage, fraction)) throw Cancelled();
  }
  /// False: the run should stop. (Within a stage; begin() throws.)
  bool report(const char* stage, double fraction) const { return !progress_ || progress_(stage, fraction); }
  void close() {
    if (!stage_) return;
    const double seconds = std::chrono::duration<double>(Clock::now() - since_).count();
    const auto found = std::ranges::find(report_.seconds, stage_, &StageTime::stage);
    if (found == report_.seconds.end())
      report_.seconds.push_back({stage_, seconds});
    else
      found->seconds += seconds;  // passes of one request add up
    report_.total_seconds += seconds;
    stage_ = nullptr;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Report& report_;
  const Progress& progress_;
  const char* stage_ = nullptr;
  Clock::time_point since_;
};

}  // namespace hextwist
