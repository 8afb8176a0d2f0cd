// The terminal: what commands print, a progress line for long ones, and Ctrl-C.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "hextwist/session/session.h"
#include "progress.h"

namespace hextwist::app {

/// Output and notices go to standard output, errors to standard error. Where that is a terminal, a command that runs
/// for more than a second shows its progress there.
class Console {
 public:
  Console();
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  SessionCallbacks callbacks();
  void error(const std::string& text);
  /// What went wrong where no command failed, "" if nothing did: a journal or standard output that could not be
  /// written.
  std::string problem();
  /// Nothing is running from here on: takes the progress line away.
  void idle();

 private:
  std::mutex mutex_;
  std::condition_variable_any wake_;
  bool running_ = false, shown_ = false;
  ProgressLine line_;
  std::string problem_;
  int write_error_ = 0;  // of standard output; 0: none
  std::jthread painter_;

  bool progress(const char* stage, double fraction);
  void print(std::FILE* to, const std::string& text);
  void clear();  // with the mutex held
  void paint(const std::stop_token& stop);
};

/// From now on the first Ctrl-C asks the running command to stop; a second one before it has ends the program. SIGTERM
/// and SIGHUP do the same, and end the program after the command. A reader that is gone (SIGPIPE) does not.
void catch_interrupts();
/// Was Ctrl-C pressed since the last call?
bool take_interrupt();
/// The signal that the program is to end by; 0: none.
int ending_signal();
/// Standard streams that are closed lead nowhere from now on, so that no file gets their numbers.
void open_standard_streams();

}  // namespace hextwist::app
