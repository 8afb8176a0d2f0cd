#include "console.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>

namespace hextwist::app {
namespace {

using namespace std::chrono_literals;

std::atomic<bool> interrupted = false;  // lock-free, so a signal handler may set it
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void on_interrupt(int) {
  if (interrupted.exchange(true)) _exit(130);
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
}

bool take_interrupt() {
  return interrupted.exchange(false);
}

Console::Console() {
  if (isatty(STDERR_FILENO)) painter_ = std::jthread([this](const std::stop_token& stop) { paint(stop); });
}

Console::~Console() {
  if (painter_.joinable()) {
    painter_.request_stop();
    painter_.join();
  }
}

SessionCallbacks Console::callbacks() {
  return {
      .output = [this](const std::string& line) { print(stdout, line); },
      .notice = [this](const std::string& line) { print(stdout, "note: " + line); },
      .error = [this](const CommandError& problem) { error(problem.what()); },
      .progress = [this](const char* stage, double fraction) { return progress(stage, fraction); },
  };
}

void Console::error(const std::string& text) {
  print(stderr, "error: " + text);
}

void Console::idle() {
  const std::lock_guard lock(mutex_);
  clear();
  running_ = false;
}

bool Console::progress(const char* stage, double fraction) {
  {
    const std::lock_guard lock(mutex_);
    if (!running_) since_ = std::chrono::steady_clock::now();
    running_ = true;
    stage_ = stage;
    fraction_ = fraction;
  }
  return !interrupted;
}

void Console::print(std::FILE* to, const std::string& text) {
  const std::lock_guard lock(mutex_);
  clear();
  running_ = false;
  std::fprintf(to, "%s\n", text.c_str());
  std::fflush(to);
}

void Console::clear() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

void Console::paint(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    wake_.wait_for(lock, stop, 200ms, [] { return false; });
    const auto elapsed = std::chrono::steady_clock::now() - since_;
    if (!running_ || elapsed < 1s) continue;
    const double seconds = std::chrono::duration<double>(elapsed).count();
    if (fraction_ > 0)
      std::fprintf(stderr, "\r\033[K  %s, %.0f%%, %.1f s", stage_.c_str(), 100 * fraction_, seconds);
    else
      std::fprintf(stderr, "\r\033[K  %s, %.1f s", stage_.c_str(), seconds);
    std::fflush(stderr);
    shown_ = true;
  }
  clear();
}

}  // namespace hextwist::app
