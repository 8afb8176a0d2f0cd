// Numbers that look random, made from numbers that don't.
#pragma once

#include <cstdint>

namespace hextwist {

/// Mixes the bits of a number, one to one (Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators",
/// 2014: splitmix64).
inline std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9U;
  x = (x ^ x >> 27) * 0x94d049bb133111ebU;
  return x ^ x >> 31;
}

}  // namespace hextwist
