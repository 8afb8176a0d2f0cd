#include "hextwist/base/memory.h"

#include <sys/resource.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>

#include "hextwist/base/text.h"
#include "hextwist/base/types.h"

namespace hextwist {
namespace {

constexpr std::size_t unknown = std::numeric_limits<std::size_t>::max();

/// The one number in a file of the kernel.
std::size_t number_in(const char* file) {
  std::ifstream in(file);
  std::size_t number = 0;
  return in >> number ? number : unknown;  // "max" is no number
}

std::size_t available_to_all() {
  std::ifstream in("/proc/meminfo");
  std::size_t sum = 0;
  bool known = false;
  for (std::string line; std::getline(in, line);) {
    std::size_t kilobytes = 0;
    if (std::sscanf(line.c_str(), "MemAvailable: %zu", &kilobytes) == 1)
      known = true;
    else if (std::sscanf(line.c_str(), "SwapFree: %zu", &kilobytes) != 1)
      continue;
    sum += kilobytes * 1024;
  }
  return known ? sum : unknown;
}

std::string text_of(double number) {
  constexpr double round_above = 1e12;
  return number < round_above ? short_number(std::round(number), 12) : short_number(number, 3);
}
std::string gigabytes(double bytes) {
  return short_number(bytes / 1e9, 3) + " GB";
}

/// As measured of refinements of grids, all of it: the mesh before and after, ids, owners, what is checked.
double bytes_of(double n_hexes, double n_nodes) {
  constexpr double per_hex = 130, per_node = 60;
  return n_hexes * per_hex + n_nodes * per_node;
}

std::atomic<bool> keeps_freed = false;
std::atomic<std::size_t> memory_limit = 0;
std::atomic<double> hex_limit = 0;
thread_local int n_without_limit = 0;

/// Data of the process now.
std::size_t data_size() {
  std::ifstream in("/proc/self/statm");
  std::size_t total = 0, resident = 0, shared = 0, text = 0, library = 0, data = 0;
  return in >> total >> resident >> shared >> text >> library >> data
             ? data * static_cast<std::size_t>(sysconf(_SC_PAGESIZE))
             : 0;
}

/// Bytes that this process has from the system and does not use.
std::size_t freed_and_kept() {
#ifdef __GLIBC__
  if (keeps_freed) return mallinfo2().fordblks;
#endif
  return 0;
}

}  // namespace

void keep_freed_memory() {
#ifdef __GLIBC__
  if (is_sanitized) return;
  constexpr int at_once = 64 << 20, alone = 1 << 30;  // larger arrays are mappings of their own
  mallopt(M_MMAP_THRESHOLD, alone);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  mallopt(M_TOP_PAD, at_once);
  keeps_freed = true;
#endif
}

void return_freed_memory() {
#ifdef __GLIBC__
  if (keeps_freed) malloc_trim(0);
#endif
}

std::size_t available_memory() {
  std::size_t available = available_to_all();
  // The group's present use is not subtracted: much of it is cached files, which can be given up.
  for (const char* limit : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
    available = std::min(available, number_in(limit));
  if (const std::size_t limit = memory_limit; limit > 0)
    available = std::min(available, limit - std::min(limit, data_size()));
  return available == unknown ? available : available + freed_and_kept();
}

void limit_memory(std::size_t bytes) {
  memory_limit = bytes;
  rlimit data{};
  if (is_sanitized || getrlimit(RLIMIT_DATA, &data) != 0) return;
  data.rlim_cur = bytes == 0 ? data.rlim_max : std::min<rlim_t>(bytes, data.rlim_max);
  setrlimit(RLIMIT_DATA, &data);
}

void limit_hexes(double n_hexes) {
  hex_limit = n_hexes;
}

std::size_t peak_memory() {
  // What getrusage() calls the peak may be that of the program which started this one.
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);) {
    std::size_t kilobytes = 0;
    if (std::sscanf(line.c_str(), "VmHWM: %zu", &kilobytes) == 1) return kilobytes * 1024;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

void check_memory(double n_hexes, double n_nodes, std::size_t available, const char* how_many) {
  const double needed = bytes_of(n_hexes, n_nodes), free = static_cast<double>(available);
  if (needed <= free) return;
  throw TooLarge("the refined mesh would have " + std::string(how_many) + text_of(n_hexes) + " hexes, which take " +
                 gigabytes(needed) + " of memory; " + gigabytes(free) + " are free");
}

WithoutHexLimit::WithoutHexLimit() {
  ++n_without_limit;
}
WithoutHexLimit::~WithoutHexLimit() {
  --n_without_limit;
}

void check_hexes(double n_hexes, const char* how_many) {
  if (const double limit = hex_limit; limit > 0 && n_hexes > limit && n_without_limit == 0)
    throw TooLarge("the refined mesh would have " + std::string(how_many) + text_of(n_hexes) +
                   " hexes, more than the " + text_of(limit) + " that are allowed");
}

void check_memory(double n_hexes, double n_nodes, const char* how_many) {
  check_hexes(n_hexes, how_many);
  constexpr double worth_asking = 2e8;
  if (bytes_of(n_hexes, n_nodes) > worth_asking) check_memory(n_hexes, n_nodes, available_memory(), how_many);
}

}  // namespace hextwist
