// Two meshes on their models that are the same to the bit.
#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "hextwist/mesh/arrays.h"
#include "hextwist/patch/refine.h"

namespace hextwist::test {

/// Names the first array that differs. NaN equals NaN.
inline testing::AssertionResult same_bits(const MeshedModel& a, const MeshedModel& b) {
  std::string differ;
  const auto heads = [](const MeshedModel& of) {
    Mesh result;
    copy_heads(of.mesh, result);
    return result;
  };
  if (heads(a) != heads(b)) differ = "groups or fields";
  const auto compare = [&](const ArrayTag& tag, const auto& x, const auto& y) {
    if (x.size() == y.size() &&
        (x.empty() || std::memcmp(static_cast<const void*>(x.data()), static_cast<const void*>(y.data()),
                                  x.size() * sizeof x[0]) == 0))
      return;
    if (differ.empty()) differ = tag.full_name();
  };
  for_each_array(lists_apart(compare), a, b);
  if (a.model != b.model) differ = "models";
  return differ.empty() ? testing::AssertionSuccess() : testing::AssertionFailure() << differ << " differ";
}

}  // namespace hextwist::test
