// ./dev bench: runs the benchmarks and ends with the table of goals. See docs/performance.md.
//
//   hextwist_bench [--benchmark_filter=REGEX]   as Google Benchmark has it
//                  [--peers=FILE]               what other programs took (peers/)
//   hextwist_bench --task NAME N                one memory task; prints peak over arrays
#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iostream>

#include "goals.h"
#include "groups.h"
#include "large.h"

int main(int argc, char** argv) {
  using namespace hextwist::bench;
  if (argc == 4 && std::strcmp(argv[1], "--task") == 0) {
    std::cout << run_task(argv[2], std::atoi(argv[3])) << '\n';
    return 0;
  }
  std::string peers;
  for (int i = 1; i < argc; ++i)
    if (const std::string word = argv[i]; word.starts_with("--peers=")) {
      peers = word.substr(std::strlen("--peers="));
      std::copy(argv + i + 1, argv + argc, argv + i);
      --argc;
      break;
    }
  // Every large array in fresh pages, as in a program that runs once; else what was freed is used again.
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;

  add_split();
  add_small_change();
  add_quality();
  add_associate();
  add_place();
  add_smooth();
  add_files();
  add_memory();
  add_front();
  add_split_threads();
  add_associate_threads();
  add_place_threads();
  add_session();

  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);
  Results results = collector.results();
  if (!peers.empty()) read_peers(peers, results);
  print_goals(results, std::cout);
}
