// The unit cube by its corners.
#pragma once

#include <array>

#include "hextwist/base/types.h"

namespace hextwist::test {

using Corners = std::array<Vec3, 8>;

/// Corner c at (c & 1, c >> 1 & 1, c >> 2 & 1), as in a hex.
inline Corners cube() {
  Corners x;
  for (int c = 0; c < 8; ++c) x[c] = Vec3(c & 1, c >> 1 & 1, c >> 2 & 1);
  return x;
}

}  // namespace hextwist::test
