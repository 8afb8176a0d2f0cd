#include "console.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <iostream>

#include "exit_status.h"
#include "hextwist/base/text.h"

namespace hextwist::app {
namespace {

using namespace std::chrono_literals;

std::atomic<bool> interrupted = false;  // lock-free, so a signal handler may set it
std::atomic<int> ending = 0;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

extern "C" void on_interrupt(int signal) {
  if (signal != SIGINT) ending = signal;
  if (interrupted.exchange(true)) _exit(128 + signal);
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    // Who starts a program with nohup wants it to go on.
    if (signal == SIGHUP && sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) continue;
    sigaction(signal, &action, nullptr);
  }
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);  // a file that may grow no further cannot be written, which is told
}

void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0 && errno == EBADF && open("/dev/null", O_RDWR) < 0) _exit(command_failed);
}

int ending_signal() {
  return ending;
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
      .error =
          [this](const CommandError& problem) {
            if (problem_.empty()) problem_ = problem.message();
            error(problem.what());
          },
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
    const auto now = ProgressLine::Clock::now();
    if (!running_) line_.begin(now);
    running_ = true;
    line_.report(stage, fraction, now);
  }
  return !interrupted;
}

void Console::print(std::FILE* to, const std::string& text) {
  const std::lock_guard lock(mutex_);
  clear();
  running_ = false;
  std::fprintf(to, "%s\n", text.c_str());
  if (std::fflush(to) != 0 && to == stdout && write_error_ == 0) write_error_ = errno;
}

std::string Console::problem() {
  if (write_error_ == 0 && std::fflush(stdout) != 0) write_error_ = errno;
  std::cout.flush();
  if (write_error_ == 0 && (std::ferror(stdout) || !std::cout)) write_error_ = EIO;
  if (write_error_ == 0) return problem_;
  const std::string text = "standard output can't be written: " + error_text(write_error_);
  // Who has closed it knows.
  if (write_error_ != EPIPE) error(text);
  return problem_.empty() ? text : problem_;
}

void Console::clear() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

void Console::paint(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    wake_.wait_for(lock, stop, 200ms, [] { return false; });
    const std::string text = running_ ? line_.text(ProgressLine::Clock::now()) : "";
    if (text.empty()) continue;
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    std::fflush(stderr);
    shown_ = true;
  }
  clear();
}

}  // namespace hextwist::app
