// What this project uses of oneTBB, made of std::thread: for the thread sanitizer alone (preset tsan), which cannot see
// into the library and takes whatever a loop was given for a race. Four threads, also where the machine has fewer.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <iterator>
#include <mutex>
#include <thread>
#include <vector>

namespace tbb {
namespace tsan {

inline std::atomic<std::size_t> limit{4};
inline thread_local bool is_inside = false;  // loops in loops run on their own thread

/// f(0) ... f(n - 1).
template <class F>
void on_threads(std::size_t n, const F& f) {
  const std::size_t n_threads = std::min(n, limit.load());
  if (n_threads <= 1 || is_inside) {
    for (std::size_t i = 0; i < n; ++i) f(i);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::exception_ptr thrown;
  std::mutex mutex;
  const auto work = [&] {
    is_inside = true;
    try {
      for (std::size_t i; (i = next++) < n;) f(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!thrown) thrown = std::current_exception();
    }
    is_inside = false;
  };
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < n_threads; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace tsan

template <class T>
class blocked_range {
 public:
  blocked_range(T begin, T end, std::size_t grain = 1) : begin_(begin), end_(end), grain_(grain) {}
  T begin() const { return begin_; }
  T end() const { return end_; }
  std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
  std::size_t grainsize() const { return grain_; }

 private:
  T begin_, end_;
  std::size_t grain_;
};

template <class T, class F>
void parallel_for(const blocked_range<T>& range, const F& f) {
  constexpr std::size_t most_pieces = 16;
  const std::size_t n = range.size(), n_pieces = std::clamp<std::size_t>(n / range.grainsize(), 1, most_pieces);
  if (n == 0) return;
  tsan::on_threads(n_pieces, [&](std::size_t i) {
    f(blocked_range<T>(range.begin() + static_cast<T>(n * i / n_pieces),
                       range.begin() + static_cast<T>(n * (i + 1) / n_pieces)));
  });
}
struct static_partitioner {};
template <class T, class F>
void parallel_for(const blocked_range<T>& range, const F& f, const static_partitioner&) {
  parallel_for(range, f);
}
template <class F>
void parallel_for(std::size_t begin, std::size_t end, const F& f) {
  parallel_for(blocked_range<std::size_t>(begin, end), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) f(i);
  });
}

template <class A, class B>
void parallel_invoke(const A& a, const B& b) {
  tsan::on_threads(2, [&](std::size_t i) { i == 0 ? a() : b(); });
}

template <std::random_access_iterator It>
void parallel_sort(It begin, It end) {
  std::sort(begin, end);
}
template <class It, class Less>
void parallel_sort(It begin, It end, const Less& less) {
  std::sort(begin, end, less);
}

template <class List, class Less>
void parallel_sort(List& list, const Less& less) {
  std::sort(list.begin(), list.end(), less);
}

class global_control {
 public:
  enum parameter { max_allowed_parallelism };
  global_control(parameter, std::size_t n) : before_(tsan::limit.exchange(n)) {}
  ~global_control() { tsan::limit = before_; }
  global_control(const global_control&) = delete;
  static std::size_t active_value(parameter) { return tsan::limit; }

 private:
  std::size_t before_;
};

class task_arena {
 public:
  explicit task_arena(int) {}
  template <class F>
  auto execute(F&& f) {
    return f();
  }
};
namespace this_task_arena {
inline int max_concurrency() {
  return static_cast<int>(tsan::limit);
}
}  // namespace this_task_arena

}  // namespace tbb
