#include "hextwist/sizing/factors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace hextwist {
namespace {

int product(const std::vector<int>& steps) {
  return std::accumulate(steps.begin(), steps.end(), 1, std::multiplies<>());
}

TEST(factors, the_steps_come_as_near_to_the_wish_as_twos_and_threes_can) {
  std::vector<double> products;
  for (double threes = 1; threes < 1e7; threes *= 3)
    for (double p = threes; p < 1e7; p *= 2) products.push_back(p);
  for (double factor = 0.01; factor < 9e5; factor *= 1.01) {
    const auto steps = plan_factors(factor);
    EXPECT_TRUE(std::ranges::all_of(steps, [](int s) { return s == 2 || s == 3; }));
    EXPECT_TRUE(std::ranges::is_sorted(steps));
    const double off = std::abs(std::log(product(steps) / factor));
    if (!steps.empty()) {  // greedy is right: the rest of the steps is the plan for the rest of the factor
      EXPECT_EQ(plan_factors(factor / steps.front()), std::vector<int>(steps.begin() + 1, steps.end())) << factor;
    }
    for (const double p : products) EXPECT_LE(off, std::abs(std::log(p / factor)) + 1e-9) << factor << ": " << p;
  }
}

TEST(factors, whole_factors_are_met_exactly) {
  EXPECT_EQ(plan_factors(1), std::vector<int>{});
  EXPECT_EQ(plan_factors(2), std::vector<int>{2});
  EXPECT_EQ(plan_factors(3), std::vector<int>{3});
  EXPECT_EQ(plan_factors(4), (std::vector<int>{2, 2}));
  EXPECT_EQ(plan_factors(6), (std::vector<int>{2, 3}));
  EXPECT_EQ(plan_factors(9), (std::vector<int>{3, 3}));
  EXPECT_EQ(plan_factors(12), (std::vector<int>{2, 2, 3}));
  EXPECT_EQ(plan_factors(1.414), std::vector<int>{});
  EXPECT_EQ(plan_factors(1.415), std::vector<int>{2});
}

TEST(factors, a_factor_that_is_no_wish_gives_no_steps_and_a_large_one_ends) {
  for (const double factor : {0.0, -3.0, 0.5, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_TRUE(plan_factors(factor).empty()) << factor;
  EXPECT_NEAR(std::log(product(plan_factors(std::numeric_limits<double>::infinity())) / 1e6), 0, 0.02);
}

}  // namespace
}  // namespace hextwist
