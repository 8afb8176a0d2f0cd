// Stopping a long loop from within.
//
// Make an Interruptible before a call that may take long; loops over many items call check_interrupt() now and then.
// Only the thread that made the Interruptible asks, so `ask` need not be thread-safe; on other threads
// check_interrupt() does nothing. That is enough, since the thread takes part in its own loops.
#pragma once

#include <functional>

namespace hextwist {

class Interruptible {
 public:
  /// ask: called now and then until destruction; throws to stop. The innermost one of a thread counts.
  explicit Interruptible(std::function<void()> ask);
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

 private:
  friend void check_interrupt();
  std::function<void()> ask_;
  const Interruptible* outer_;
};

/// Calls `ask` of this thread's innermost Interruptible, which may throw. Almost free when there is none.
void check_interrupt();

}  // namespace hextwist
