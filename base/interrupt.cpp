#include "hextwist/base/interrupt.h"

#include <utility>

namespace hextwist {
namespace {

thread_local const Interruptible* innermost = nullptr;

}  // namespace

Interruptible::Interruptible(std::function<void()> ask) : ask_(std::move(ask)), outer_(innermost) {
  innermost = this;
}

Interruptible::~Interruptible() {
  innermost = outer_;
}

void check_interrupt() {
  if (innermost) innermost->ask_();
}

}  // namespace hextwist
