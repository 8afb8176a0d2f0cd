#include "hextwist/mesh/memory_internal.h"

#include <gtest/gtest.h>

#include "hextwist/geom/types.h"

namespace hextwist::test {
namespace {

TEST(memory, what_cannot_fit_is_refused_with_both_amounts) {
  EXPECT_NO_THROW(check_memory(1'000'000, 1'000'000, 60'000'000));
  try {
    check_memory(387'420'489, 388'000'000, 21'000'000'000);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "the refined mesh would have 387420489 hexes, which take more than 23.3 GB of memory; 21 GB are free");
  }
}

TEST(memory, there_is_some) {
  EXPECT_GT(available_memory(), std::size_t{1} << 24);
  EXPECT_NO_THROW(check_memory(1000, 1000));
}

}  // namespace
}  // namespace hextwist::test
