// How the benchmarks measure: process CPU time (other programs may run), results freed outside of it.
#pragma once

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <string>
#include <utility>

namespace hextwist::bench {

/// Limits oneTBB while it lives.
class Threads {
 public:
  explicit Threads(int n) : control_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(n)) {}

 private:
  tbb::global_control control_;
};

/// Registers `name`: make(prepare()) is run nine times on `threads` threads, prepare() outside of the clock;
/// items(result) is what it made, for the rate. It is first run once so that its own inputs (static locals) exist.
template <class Prepare, class Make, class Items>
void add_prepared_rate(const std::string& name, Prepare prepare, Make make, Items items, int threads = 1) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) {
                                 const Threads limit(threads);
                                 tbb::task_arena arena(threads);  // the implicit one keeps the size that it began with
                                 arena.execute([&] { return make(prepare()); });
                                 double n = 0;
                                 for ([[maybe_unused]] auto _ : state) {
                                   state.PauseTiming();
                                   auto input = prepare();
                                   state.ResumeTiming();
                                   auto result = arena.execute([&] { return make(std::move(input)); });
                                   benchmark::DoNotOptimize(result);
                                   state.PauseTiming();
                                   n += static_cast<double>(items(result));
                                   result = {};
                                   state.ResumeTiming();
                                 }
                                 state.SetItemsProcessed(static_cast<std::int64_t>(n));
                               })
      ->Iterations(1)
      ->Repetitions(9)
      ->MeasureProcessCPUTime()
      ->Unit(benchmark::kMillisecond);
}

/// The same with nothing to prepare: make().
template <class Make, class Items>
void add_rate(const std::string& name, Make make, Items items, int threads = 1) {
  add_prepared_rate(
      name, [] { return 0; }, [=](int) { return make(); }, items, threads);
}

/// The same where only the time counts.
template <class Make>
void add_time(const std::string& name, Make make, int threads = 1) {
  add_rate(
      name, make, [](const auto&) { return 1; }, threads);
}

/// The same on one thread and on two, one after the other so that they meet the same machine: name/1, name/2.
template <class Prepare, class Make, class Items>
void add_on_two_threads(const std::string& name, Prepare prepare, Make make, Items items) {
  for (const int threads : {1, 2})
    add_prepared_rate(name + "/" + std::to_string(threads), prepare, make, items, threads);
}
template <class Make, class Items>
void add_on_two_threads(const std::string& name, Make make, Items items) {
  add_on_two_threads(
      name, [] { return 0; }, [=](int) { return make(); }, items);
}

/// Registers a number that is no time: value() is called once; NaN: could not be had.
void add_value(const std::string& name, double (*value)());

/// Bytes that `task` (main.cpp) takes at its peak beyond what the program had before, in a process of its own, divided
/// by the bytes of its input and output arrays.
double peak_ratio(const std::string& task);
/// Resident bytes of this process at its peak so far, and now.
std::size_t peak_memory();
std::size_t memory();

}  // namespace hextwist::bench
