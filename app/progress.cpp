#include "progress.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace hextwist::app {
namespace {

constexpr double quiet_seconds = 1, stale_seconds = 1;
constexpr int bar_width = 20;
constexpr double least_share = 0.05;  // before that no time left can be told

double seconds(ProgressLine::Clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

/// 7 s, 3 min, 2 h: nobody knows it better.
std::string rough(double time) {
  std::array<char, 40> buffer;
  if (time < 90)
    std::snprintf(buffer.data(), buffer.size(), "%.0f s", std::max(1.0, std::ceil(time)));
  else if (time < 5400)
    std::snprintf(buffer.data(), buffer.size(), "%.0f min", time / 60);
  else
    std::snprintf(buffer.data(), buffer.size(), "%.1f h", time / 3600);
  return buffer.data();
}

}  // namespace

void ProgressLine::begin(Clock::time_point now) {
  *this = {};
  begin_ = moved_ = now;
}

void ProgressLine::report(const std::string& stage, double share, Clock::time_point now) {
  stage_ = stage;
  // Stages that do not know their share say 0, and a command that begins anew has less than before.
  if (share > share_) {
    share_ = std::min(share, 1.0);
    moved_ = now;
  }
}

std::string ProgressLine::text(Clock::time_point now) const {
  const double elapsed = seconds(now - begin_);
  if (elapsed < quiet_seconds) return "";
  std::array<char, 200> buffer;
  if (share_ <= 0 || seconds(now - moved_) > stale_seconds) {
    std::snprintf(buffer.data(), buffer.size(), "  %s, %s so far (Ctrl-C cancels)", stage_.c_str(),
                  rough(elapsed).c_str());
    return buffer.data();
  }
  const int done = static_cast<int>(share_ * bar_width);
  const std::string bar =
      std::string(static_cast<std::size_t>(done), '#') + std::string(static_cast<std::size_t>(bar_width - done), '.');
  std::snprintf(buffer.data(), buffer.size(), "  %s [%s] %3.0f%%%s (Ctrl-C cancels)", stage_.c_str(), bar.c_str(),
                100 * share_,
                share_ >= least_share ? (", " + rough(elapsed * (1 - share_) / share_) + " left").c_str() : "");
  return buffer.data();
}

}  // namespace hextwist::app
