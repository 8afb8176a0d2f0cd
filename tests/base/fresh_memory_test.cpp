#include "hextwist/base/fresh_memory.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include "hextwist/base/large_array.h"

namespace hextwist {
namespace {

constexpr std::size_t n_old = 1000, n_new = 3'000'000;

TEST(fresh_memory, growing_for_overwrite_keeps_what_is_there_and_is_like_resize) {
  std::vector<int> list(n_old);
  std::iota(list.begin(), list.end(), 7);
  const std::vector<int> before = list;
  resize_for_overwrite(list, n_new);
  ASSERT_EQ(list.size(), n_new);
  ASSERT_GE(list.capacity(), n_new);
  EXPECT_TRUE(std::equal(before.begin(), before.end(), list.begin()));
  std::fill(list.begin() + n_old, list.end(), 1);
  std::vector<int> copy = list;
  list.push_back(5);
  EXPECT_EQ(list.size(), n_new + 1);
  EXPECT_EQ(list.back(), 5);
  EXPECT_EQ(copy.back(), 1);
  resize_for_overwrite(list, n_old);
  EXPECT_EQ(list, before);
}

TEST(fresh_memory, items_that_need_construction_are_constructed) {
  std::vector<std::string> list(3, "kept");
  resize_for_overwrite(list, 100'000);
  EXPECT_EQ(list[2], "kept");
  EXPECT_EQ(list[99'999], "");
}

TEST(fresh_memory, large_arrays_get_their_value_everywhere) {
  std::vector<Index> list(n_old, 4);
  resize_large(list, n_new, Index{9});
  EXPECT_EQ(std::ranges::count(list, 4), static_cast<std::ptrdiff_t>(n_old));
  EXPECT_EQ(std::ranges::count(list, 9), static_cast<std::ptrdiff_t>(n_new - n_old));
  resize_large(list, n_new + n_new);
  EXPECT_EQ(std::ranges::count(list, 0), static_cast<std::ptrdiff_t>(n_new));
  resize_large(list, 1);
  EXPECT_EQ(list, std::vector<Index>{4});
}

TEST(fresh_memory, a_large_copy_is_equal_and_has_the_room_asked_for) {
  std::vector<double> list(n_new);
  std::iota(list.begin(), list.end(), 0.5);
  const std::vector<double> copy = copy_large(list, n_new + n_old);
  EXPECT_EQ(copy, list);
  EXPECT_GE(copy.capacity(), n_new + n_old);
  EXPECT_TRUE(copy_large(std::vector<double>{}, 0).empty());
}

TEST(fresh_memory, where_finds_the_same_as_one_loop) {
  for (const Index n : {0, 1, 4095, 4096, 4097, 100'000})
    for (const Index modulus : {1, 2, 97, 1'000'000}) {
      const auto wanted = [&](Index i) { return i % modulus == modulus - 1; };
      std::vector<Index> expected;
      for (Index i = 0; i < n; ++i)
        if (wanted(i)) expected.push_back(i);
      EXPECT_EQ(indices_where(n, wanted), expected) << n << ", " << modulus;
    }
}

}  // namespace
}  // namespace hextwist
