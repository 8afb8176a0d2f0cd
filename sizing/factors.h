// From a wished factor between sizes to passes: one into 27 divides edges by three, one into eight by two.
#pragma once

#include <vector>

namespace hextwist {

/// The steps (2 or 3 each) that divide sizes by about `factor`, in the order to take them: twos first. What a step
/// leaves of the factor asks for the steps that are left. The product is the nearest to `factor` by ratio among all
/// products of twos and threes, 1 (no steps) included: 2 for factors from sqrt(2) to sqrt(6), 3 up to sqrt(12), 4, 6,
/// 8, 9 and so on. Where two are equally near, the one with fewer steps. A factor that is not above 0 gives no steps;
/// factors are taken as at most 1e6.
std::vector<int> plan_factors(double factor);

}  // namespace hextwist
