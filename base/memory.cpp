#include "hextwist/base/memory.h"

#include <sys/resource.h>

#include <algorithm>
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

double bytes_of(double n_hexes, double n_nodes) {
  constexpr double per_hex = 9 * sizeof(Index);  // its eight nodes and its parent
  return n_hexes * per_hex + n_nodes * sizeof(Vec3);
}

}  // namespace

std::size_t available_memory() {
  std::size_t available = available_to_all();
  // The group's present use is not subtracted: much of it is cached files, which can be given up.
  for (const char* limit : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
    available = std::min(available, number_in(limit));
  return available;
}

std::size_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

void check_memory(double n_hexes, double n_nodes, std::size_t available, const char* how_many) {
  const double needed = bytes_of(n_hexes, n_nodes), free = static_cast<double>(available);
  if (needed <= free) return;
  throw Error("the refined mesh would have " + std::string(how_many) + text_of(n_hexes) +
              " hexes, which take more than " + gigabytes(needed) + " of memory; " + gigabytes(free) + " are free");
}

void check_memory(double n_hexes, double n_nodes, const char* how_many) {
  constexpr double worth_asking = 1e9;
  if (bytes_of(n_hexes, n_nodes) > worth_asking) check_memory(n_hexes, n_nodes, available_memory(), how_many);
}

}  // namespace hextwist
