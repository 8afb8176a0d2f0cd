// A session as Python holds it: one call at a time, callbacks, Ctrl-C.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <new>
#include <optional>

#include "hextwist/embed/python/convert_internal.h"

namespace hextwist::python {

class PySession {
 public:
  PySession(py::object output, py::object notice, py::object progress)
      : output_(std::move(output)), notice_(std::move(notice)), progress_(std::move(progress)) {
    session_.set_callbacks({
        .output = [this](const std::string& line) { say(output_, line); },
        .notice = [this](const std::string& line) { say(notice_, line); },
        .error = {},
        .progress = [this](const char* stage, double fraction) { return go_on(stage, fraction); },
    });
  }
  PySession(const PySession&) = delete;
  ~PySession() { made_ = 0; }

  /// Session.__new__(Session) without __init__ leaves memory that nothing was made in: zeros, so that it can be told.
  static void* operator new(std::size_t size) {
    if (void* memory = std::calloc(1, size)) return memory;
    throw std::bad_alloc();
  }
  static void* operator new(std::size_t, void* place) { return place; }
  static void operator delete(void* memory) { std::free(memory); }

  /// Calls f(session) with nobody else in it. f must not touch Python: the lock of the interpreter is given up.
  /// An exception of a callback, or KeyboardInterrupt, takes the place of what it made the command throw.
  template <class F>
  auto run(F f) {
    check_made();
    const Busy busy(busy_);
    raised_.reset();
    asked_ = std::chrono::steady_clock::now();
    std::optional<decltype(f(session_))> result;
    try {
      const py::gil_scoped_release release;
      result.emplace(f(session_));
    } catch (...) {
      rethrow_raised();
      throw;
    }
    rethrow_raised();
    return std::move(*result);
  }
  /// The same for what is quick, with the lock.
  template <class F>
  auto look(F f) {
    check_made();
    const Busy busy(busy_);
    return f(session_);
  }

  /// The garbage collector follows these: a callback may hold the session that it is of.
  std::array<py::object*, 3> callbacks() { return {&output_, &notice_, &progress_}; }

 private:
  struct Busy {
    std::atomic<bool>& flag;
    explicit Busy(std::atomic<bool>& busy) : flag(busy) {
      if (flag.exchange(true)) throw Error("the session is busy with another command");
    }
    ~Busy() { flag = false; }
    Busy(const Busy&) = delete;
  };

  void check_made() const {
    if (made_ != has_been_made) throw Error("this session was not made: its __init__ has not run");
  }

  void rethrow_raised() {
    if (!raised_) return;
    py::error_already_set error = std::move(*raised_);
    raised_.reset();
    throw error;
  }

  /// Throws where the callback raises, so that the command is taken back: who called it does not know what it did.
  void say(const py::object& to, const std::string& line) {
    if (raised_) return;
    const py::gil_scoped_acquire lock;
    if (to.is_none()) return;
    try {
      to(text(line));
    } catch (py::error_already_set& error) {
      raised_.emplace(std::move(error));
      throw Cancelled();
    }
  }

  bool go_on(const char* stage, double fraction) {
    using namespace std::chrono_literals;
    if (raised_) return false;
    const auto now = std::chrono::steady_clock::now();
    if (progress_.ptr() == Py_None && now - asked_ < 20ms) return true;  // the interpreter's lock has its price
    asked_ = now;
    const py::gil_scoped_acquire lock;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (progress_.is_none()) return true;
      const py::object said = progress_(stage, fraction);
      const int is_true = said.is_none() ? 1 : PyObject_IsTrue(said.ptr());  // numpy has a False of its own
      if (is_true < 0) throw py::error_already_set();
      return is_true != 0;
    } catch (py::error_already_set& error) {
      raised_.emplace(std::move(error));
      return false;
    }
  }

  Session session_;
  py::object output_, notice_, progress_;
  std::optional<py::error_already_set> raised_;  ///< by a callback of the command that runs
  std::chrono::steady_clock::time_point asked_;
  std::atomic<bool> busy_ = false;
  static constexpr std::uint32_t has_been_made = 0x4e21;
  std::uint32_t made_ = has_been_made;
};

}  // namespace hextwist::python
