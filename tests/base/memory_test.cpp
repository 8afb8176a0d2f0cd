#include "hextwist/base/memory.h"

#include <gtest/gtest.h>

#include <new>
#include <string>
#include <vector>

#include "hextwist/base/types.h"

namespace hextwist::test {
namespace {

TEST(memory, what_cannot_fit_is_refused_with_both_amounts) {
  EXPECT_NO_THROW(check_memory(1'000'000, 1'000'000, 200'000'000));
  try {
    check_memory(387'420'489, 388'000'000, 21'000'000'000);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "the refined mesh would have 387420489 hexes, which take 73.6 GB of memory; 21 GB are free");
  }
}

TEST(memory, more_hexes_than_can_be_counted_are_refused_too) {
  try {
    check_memory(1e27, 1e27, "at least ");
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find("the refined mesh would have at least 1e+27 hexes"), 0u) << error.what();
  }
}

TEST(memory, limits_are_kept) {
  limit_hexes(1000);
  EXPECT_NO_THROW(check_memory(1000, 1e6));
  try {
    check_memory(1001, 1002, "at least ");
    ADD_FAILURE() << "not refused";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "the refined mesh would have at least 1001 hexes, more than the 1000 that are allowed");
  }
  limit_hexes(0);
  EXPECT_NO_THROW(check_memory(1e6, 1e6));

  constexpr std::size_t some = std::size_t{1} << 30, more = 2 * some;
  limit_memory(some);
  EXPECT_LE(available_memory(), some);
  EXPECT_THROW(check_memory(1e7, 1e7), Error);
  if (!is_sanitized) {
    EXPECT_THROW(std::vector<char>(more, 'x'), std::bad_alloc);
  }
  limit_memory(0);
  EXPECT_EQ(std::vector<char>(more, 'x').size(), more);
}

TEST(memory, there_is_some) {
  EXPECT_GT(available_memory(), std::size_t{1} << 24);
  EXPECT_NO_THROW(check_memory(1000, 1000));
}

}  // namespace
}  // namespace hextwist::test
