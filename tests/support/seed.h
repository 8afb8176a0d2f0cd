// Where random tests begin.
#pragma once

#include <cstdlib>
#include <random>

namespace hextwist::test {

/// Another one each time, unless HEXTWIST_SEED says which. Tests print it when they fail.
inline unsigned random_seed() {
  const char* wished = std::getenv("HEXTWIST_SEED");
  return wished ? static_cast<unsigned>(std::strtoul(wished, nullptr, 10)) : std::random_device{}();
}

}  // namespace hextwist::test
