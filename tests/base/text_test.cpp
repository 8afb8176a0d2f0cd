#include "hextwist/base/text.h"

#include <gtest/gtest.h>

namespace hextwist {
namespace {

TEST(text, counts_have_their_words) {
  EXPECT_EQ(counted(1, "hex"), "1 hex");
  EXPECT_EQ(counted(0, "hex"), "0 hexes");
  EXPECT_EQ(counted(2, "pass"), "2 passes");
  EXPECT_EQ(counted(3, "node"), "3 nodes");
  EXPECT_EQ(counted(3, "vertex", "vertices"), "3 vertices");
}

TEST(text, numbers_are_short) {
  EXPECT_EQ(short_number(1.0 / 3), "0.3333");
  EXPECT_EQ(short_number(1234567, 6), "1.23457e+06");
  EXPECT_EQ(point_text({1.5, 0, -2}), "(1.5, 0, -2)");
}

TEST(text, case_is_that_of_ascii) {
  EXPECT_EQ(lower_extension("dir.X/Part.VTU"), ".vtu");
  EXPECT_EQ(lower_extension("part"), "");
  EXPECT_EQ(lower_case("\xC3\x84"
                       "Ab"),
            "\xC3\x84"
            "ab");
  EXPECT_TRUE(same_word("Hex8", "hEX8"));
  EXPECT_FALSE(same_word("hex", "hexes"));
}

TEST(text, lists_are_joined) {
  EXPECT_EQ(joined(std::vector<int>{3, 1}), "3 1");
  EXPECT_EQ(joined(std::vector<std::string>{"a", "b"}, ", "), "a, b");
  EXPECT_EQ(joined(std::vector<int>{}), "");
}

}  // namespace
}  // namespace hextwist
