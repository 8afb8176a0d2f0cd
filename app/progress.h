// The line that a long command shows.
#pragma once

#include <chrono>
#include <string>

namespace hextwist::app {

/// What is known of a command that runs: its stage, the share that is done of the whole, and since when these hold.
class ProgressLine {
 public:
  using Clock = std::chrono::steady_clock;

  void begin(Clock::time_point now);
  void report(const std::string& stage, double share, Clock::time_point now);

  /// "  place [######........]  43%, 3 s left (Ctrl-C cancels)". The share and the time left are shown while the share
  /// moves: one that has stood still for a second says nothing, and is left out. Nothing in the first second.
  std::string text(Clock::time_point now) const;

 private:
  std::string stage_;
  double share_ = 0;
  Clock::time_point begin_, moved_;
};

}  // namespace hextwist::app
