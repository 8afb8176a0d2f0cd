// How messages are worded: every text in the sources that a user may read.
#include <gtest/gtest.h>

#include <regex>

#include "project/source_tree.h"

namespace hextwist {
namespace {

struct Text {
  std::string file, text;
};

/// Texts in quotes of more than a few words; pieces that the compiler joins are joined. No comments.
std::vector<Text> texts() {
  std::vector<Text> result;
  std::vector<std::filesystem::path> files;
  for (const std::string& layer : test::layers)
    for (const auto& file : test::files_below(layer, {".h", ".cpp"})) files.push_back(file);
  for (const auto& file : files) {
    const std::string source = test::content(file), name = file.filename().string();
    bool joined = false;
    for (std::size_t at = 0; at < source.size();) {
      const char c = source[at];
      if (c == '/' && source.compare(at, 2, "//") == 0) {
        at = std::min(source.find('\n', at), source.size());
      } else if (c == '\'' && at + 2 < source.size() && (source[at + 1] == '\\' || source[at + 2] == '\'')) {
        at += source[at + 1] == '\\' ? 4 : 3;
      } else if (c == '"') {
        std::size_t end = at + 1;
        while (end < source.size() && source[end] != '"') end += source[end] == '\\' ? 2 : 1;
        const std::string text = source.substr(at + 1, end - at - 1);
        if (joined && !result.empty())
          result.back().text += text;
        else
          result.push_back({name, text});
        joined = true;
        at = end + 1;
      } else {
        if (!std::isspace(static_cast<unsigned char>(c))) joined = false;
        ++at;
      }
    }
  }
  std::erase_if(result, [](const Text& each) { return std::ranges::count(each.text, ' ') < 2; });
  return result;
}

/// Parts of a text between signs: a negation and another one in the next part are not doubled.
std::vector<std::string> clauses(const std::string& text) {
  std::vector<std::string> result(1);
  for (const char c : text) {
    if (std::string_view(";:.,(){}\\").find(c) != std::string_view::npos)
      result.emplace_back();
    else
      result.back() += c;
  }
  return result;
}

TEST(Style, of_messages_has_no_double_negatives) {
  const std::regex negation(
      R"(\b(no|not|nothing|none|nobody|nowhere|never|neither|without|cannot|can't|don't|doesn't)\b)",
      std::regex::icase);
  const auto all = texts();
  EXPECT_GT(all.size(), 500u);
  for (const auto& [file, text] : all)
    for (const std::string& clause : clauses(text))
      EXPECT_LE(std::distance(std::sregex_iterator(clause.begin(), clause.end(), negation), std::sregex_iterator()), 1)
          << file << ": " << clause;
}

TEST(Style, of_messages_is_that_of_a_native_speaker) {
  // Each with what to write instead.
  const std::vector<std::pair<std::regex, const char*>> odd = {
      {std::regex(R"(\b(this|that|it|which|') (is|are) no (?!longer\b|more\b)[a-z]+)"), "is not a ..."},
      {std::regex(R"(\bshall\b)"), "should, will or must"},
      {std::regex(R"(\bno good\b)"), "refused, or what is wrong"},
      {std::regex(R"(\bis no more\b)"), "is gone, was deleted"},
      {std::regex(R"(\bis short for\b)"), "may be"},
      {std::regex(R"(\bmixed[- ]up with\b)"), "taken for"},
      {std::regex(R"(\bnot able to\b)"), "cannot"},
      {std::regex(R"(\bplease be\b|\bsorry\b|\boops\b)", std::regex::icase), "what happened and what to do"},
      {std::regex(R"(!$)"), "no exclamation marks"},
      {std::regex(R"(\bfailed to\b)"), "cannot ..., with the reason"},
      {std::regex(R"(\binvalid (argument|input|value)\b)"), "what would be valid"}};
  for (const auto& [file, text] : texts())
    for (const auto& [pattern, instead] : odd)
      EXPECT_FALSE(std::regex_search(text, pattern)) << file << ": '" << text << "': write " << instead;
}

}  // namespace
}  // namespace hextwist
