#include "hextwist/sizing/factors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace hextwist {

std::vector<int> plan_factors(double factor) {
  if (!(factor > 0)) return {};
  constexpr double largest = 1e6;
  constexpr double same = 1e-12;  // of logarithms
  const double wished = std::log(std::min(factor, largest));
  double best = std::numeric_limits<double>::infinity();
  int best_twos = 0, best_threes = 0;
  for (int threes = 0; threes * std::log(3) < wished + 1; ++threes)
    for (int twos = 0; threes * std::log(3) + twos * std::log(2) < wished + 1; ++twos) {
      const double off = std::abs(threes * std::log(3) + twos * std::log(2) - wished);
      if (off > best + same || (off > best - same && twos + threes >= best_twos + best_threes)) continue;
      std::tie(best, best_twos, best_threes) = std::tuple(off, twos, threes);
    }
  std::vector<int> steps(best_twos, 2);
  steps.insert(steps.end(), best_threes, 3);
  return steps;
}

}  // namespace hextwist
