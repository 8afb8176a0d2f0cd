#include "hextwist/geom/incidence.h"

#include <algorithm>
#include <cassert>

#include "hextwist/base/sorted.h"

namespace hextwist {

Incidence::Incidence(const std::array<int, 4>& n) : n_(n) {
  for (int dim = 0; dim < 4; ++dim)
    for (auto& answer : lists_[dim]) answer.resize(n[dim]);
}

void Incidence::add(Owner whole, Owner part) {
  assert(part.dim < whole.dim && part.id >= 1 && part.id <= n_[part.dim] && whole.id <= n_[whole.dim]);
  lists_[whole.dim][part.dim][whole.id - 1].push_back(part.id);
}

void Incidence::close() {
  // Dimensions ascending, and within one entity from its highest parts down: each list that is read is complete.
  for (int dim = 1; dim < 4; ++dim)
    for (int i = 0; i < n_[dim]; ++i)
      for (int middle = dim - 1; middle >= 0; --middle) {
        sort_unique(lists_[dim][middle][i]);
        for (const int part : lists_[dim][middle][i])
          for (int low = 0; low < middle; ++low) {
            const auto& below = lists_[middle][low][part - 1];
            lists_[dim][low][i].insert(lists_[dim][low][i].end(), below.begin(), below.end());
          }
      }
  for (int dim = 1; dim < 4; ++dim)
    for (int low = 0; low < dim; ++low)
      for (int i = 0; i < n_[dim]; ++i)
        for (const int part : lists_[dim][low][i]) lists_[low][dim][part - 1].push_back(i + 1);
}

}  // namespace hextwist
