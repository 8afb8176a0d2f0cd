// Lets somebody stop a long loop from within.
//
// Who can stop it makes an Interruptible and calls what takes long; loops over many items call check_interrupt() now
// and then. Only the thread that made it asks, so `ask` need not be safe for several; in the others check_interrupt()
// does nothing. That is enough: it takes part in its own loops.
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

/// Throws what the innermost Interruptible of this thread throws; costs nothing to speak of where there is none.
void check_interrupt();

}  // namespace hextwist
