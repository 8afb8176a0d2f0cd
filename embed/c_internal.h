// What the C functions are made of.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include "hextwist/embed/c.h"
#include "hextwist/embed/mesh_view.h"
#include "hextwist/session/session.h"

struct hextwist_session {
  hextwist::Session session;
  std::atomic<bool> busy = false;  ///< somebody is in a call
};

struct hextwist_mesh {
  hextwist::MeshView view;
};

namespace hextwist::embed {

/// An array for the caller, who frees it with std::free.
template <class T>
T* given_away(const std::vector<T>& values) {
  T* const array = static_cast<T*>(std::malloc(std::max<std::size_t>(1, values.size()) * sizeof(T)));
  if (!array) throw std::bad_alloc();
  std::copy(values.begin(), values.end(), array);
  return array;
}

/// Keeps the exception that is being handled for hextwist_error() and says what to return for it.
hextwist_status keep_error() noexcept;
hextwist_status keep_error(const char* text) noexcept;

/// Runs f; whatever it throws becomes the thread's error.
template <class F>
hextwist_status guarded(F f) noexcept {
  try {
    f();
    return HEXTWIST_OK;
  } catch (...) {
    return keep_error();
  }
}

/// The same with a session that nobody else is in.
template <class F>
hextwist_status with_session(hextwist_session* session, F f) noexcept {
  if (!session) return keep_error("there is no session: the pointer is null");
  if (session->busy.exchange(true)) return keep_error("the session is busy with another call");
  const hextwist_status status = guarded([&] { f(session->session); });
  session->busy = false;
  return status;
}

}  // namespace hextwist::embed
