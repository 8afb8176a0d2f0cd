#include "hextwist/base/sorted.h"

#include <gtest/gtest.h>

namespace hextwist {
namespace {

using Ids = std::vector<Index>;

TEST(sorted, a_list_becomes_a_set_and_of_equal_keys_the_first_stays) {
  EXPECT_EQ(sorted_unique(Ids{3, 1, 3, 2, 1}), (Ids{1, 2, 3}));
  EXPECT_EQ(sorted_unique(Ids{}), Ids{});
  std::vector<std::pair<int, char>> pairs = {{2, 'a'}, {1, 'b'}, {2, 'c'}, {1, 'd'}};
  sort_unique(pairs, &std::pair<int, char>::first);
  EXPECT_EQ(pairs, (std::vector<std::pair<int, char>>{{1, 'b'}, {2, 'a'}}));
}

TEST(sorted, places_and_values_are_found_and_what_is_missing_is_told) {
  const Ids list = {2, 5, 9}, values = {20, 50, 90};
  EXPECT_EQ(position_in(list, 5), 1);
  for (const Index missing : {1, 3, 10}) EXPECT_EQ(position_in(list, missing), -1);
  EXPECT_EQ(value_of(list, values, 9), 90);
  EXPECT_EQ(value_of(list, values, 8), 0);
}

TEST(sorted, set_operations) {
  const Ids a = {1, 2, 5}, b = {2, 3};
  EXPECT_EQ(intersection(a, b), Ids{2});
  EXPECT_EQ(union_of(a, b), (Ids{1, 2, 3, 5}));
  EXPECT_EQ(difference(a, b), (Ids{1, 5}));
}

TEST(sorted, what_stays_closes_the_gaps_and_finds_back) {
  const Ids gone = {0, 3, 4};
  Index next = 0;
  for (const Index before : {1, 2, 5, 6}) {
    EXPECT_EQ(after_gaps(gone, before), next);
    EXPECT_EQ(before_gaps(gone, next++), before);
  }
}

}  // namespace
}  // namespace hextwist
