#include "hextwist/command/token.h"

#include <gtest/gtest.h>

#include "hextwist/command/error_at.h"
#include "hextwist/command/flow.h"

namespace hextwist {
namespace {

std::vector<std::string> texts(std::string_view input) {
  std::vector<std::string> result;
  for (const Statement& statement : split_statements(input)) result.push_back(text_of(statement));
  return result;
}

using List = std::vector<std::string>;

TEST(Tokens, semicolons_and_line_ends_separate_commands) {
  EXPECT_EQ(texts("reset; check\nlist\r\n\n;;quit"), (List{"reset", "check", "list", "quit"}));
}

TEST(Tokens, comments_reach_to_the_line_end) {
  EXPECT_EQ(texts("# all; of it\nreset # rest; here\ncheck"), (List{"reset", "check"}));
}

TEST(Tokens, a_backslash_joins_the_next_line) {
  EXPECT_EQ(texts("refine \\\n curve \\  \r\n 3\ncheck"), (List{"refine curve 3", "check"}));
  EXPECT_TRUE(wants_more("refine \\"));
  EXPECT_TRUE(wants_more("a\nrefine \\ \n"));
  EXPECT_FALSE(wants_more("refine # \\"));
  EXPECT_FALSE(wants_more("refine"));
  EXPECT_FALSE(wants_more(""));
}

TEST(Tokens, quotes_protect_everything_but_line_ends) {
  const auto statements = split_statements("import mesh \"a; #'b.msh\" 'c\"d'");
  ASSERT_EQ(statements.size(), 1u);
  const auto& tokens = statements[0].tokens;
  ASSERT_EQ(tokens.size(), 5u);
  EXPECT_EQ(tokens[2].kind, Token::Kind::string);
  EXPECT_EQ(tokens[2].text, "a; #'b.msh");
  EXPECT_EQ(tokens[3].text, "c\"d");
}

TEST(Tokens, an_open_quote_is_bad_but_the_next_line_is_not) {
  const auto statements = split_statements("import mesh \"a.msh\nreset");
  ASSERT_EQ(statements.size(), 2u);
  EXPECT_EQ(statements[0].tokens[2].kind, Token::Kind::bad);
  EXPECT_EQ(text_of(statements[1]), "reset");
}

TEST(Tokens, numbers_are_the_usual_ones_and_the_rest_are_words) {
  const auto kind_of = [](std::string_view text) { return split_statements(text).at(0).tokens.at(0).kind; };
  for (const auto* number : {"3", "-3", "+3", "2.5", ".5", "-.5", "1e-3", "1E+3", "007"})
    EXPECT_EQ(kind_of(number), Token::Kind::number) << number;
  for (const auto* word : {"a", "1to3", "3rd_part.msh", "../a.msh", "/tmp/a-b.msh", "x_coord"})
    EXPECT_EQ(kind_of(word), Token::Kind::word) << word;
  for (const auto* bad : {"1e999", "\\ x", "\"a"}) EXPECT_EQ(kind_of(bad), Token::Kind::bad) << bad;
  EXPECT_DOUBLE_EQ(split_statements("-2.5e1").at(0).tokens.at(0).value, -25);
}

TEST(Tokens, printable_text_is_valid_and_short) {
  EXPECT_EQ(printable("a\x01\x7f\xff"), "a???");
  EXPECT_EQ(printable("é\xc3"), "é?");
  EXPECT_EQ(printable(std::string(100, 'x')), std::string(60, 'x') + "...");
  EXPECT_EQ(printable("ééé", 3), "é...");
}

}  // namespace
}  // namespace hextwist
