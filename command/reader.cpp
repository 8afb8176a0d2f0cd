#include "hextwist/command/reader.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace hextwist {
namespace {

/// Edits (insert, drop, replace, swap of neighbours) from one short word to another.
int distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = static_cast<int>(i + j);
        continue;
      }
      const bool same = lower_case(a[i - 1]) == lower_case(b[j - 1]);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && lower_case(a[i - 1]) == lower_case(b[j - 2]) &&
          lower_case(a[i - 2]) == lower_case(b[j - 1]))
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::string found(const Token& token) {
  if (token.kind == Token::Kind::end) return "the end of the command";
  if (token.kind == Token::Kind::string) return "\"" + printable(token.text) + "\"";
  return "'" + printable(token.text) + "'";
}

}  // namespace

std::string alternatives(std::span<const std::string> words) {
  std::string result;
  for (std::size_t i = 0; i < words.size(); ++i)
    result += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return result;
}

std::string nearest_word(std::string_view word, std::span<const std::string> words) {
  if (word.size() < 3 || word.size() > 30 || words.empty()) return "";
  const auto best = std::ranges::min_element(words, {}, [&](const std::string& each) { return distance(word, each); });
  return distance(word, *best) <= (word.size() > 5 ? 2 : 1) ? *best : "";
}

std::vector<std::string> nearest_words(std::string_view word, std::span<const std::string> words, std::size_t most) {
  if (word.size() > 30 || word.empty()) return {};
  // Other letters than these, or most of the letters, would be another word.
  const int far = std::max(2, static_cast<int>(word.size()) / 2);
  std::vector<std::pair<int, std::string>> found;
  for (const std::string& each : words)
    if (const int d = distance(word, each); d <= far && d < static_cast<int>(word.size())) found.emplace_back(d, each);
  std::ranges::sort(found);
  std::vector<std::string> result;
  for (std::size_t i = 0; i < std::min(most, found.size()); ++i)
    if (found[i].first <= found[0].first + 1) result.push_back(found[i].second);
  return result;
}

Reader::Reader(const Statement& statement) : statement_(statement), tokens_(statement.tokens) {
  // Bodies of other programs are volumes here.
  for (std::size_t i = 0; i + 1 < tokens_.size(); ++i) {
    const Token& next = tokens_[i + 1];
    const bool goes_on = next.kind == Token::Kind::number || next.kind == Token::Kind::string || next.text == "(" ||
                         std::ranges::any_of(std::array{"all", "in", "with", "except"},
                                             [&](const char* word) { return same_word(next.text, word); });
    if (tokens_[i].kind == Token::Kind::word && same_word(tokens_[i].text, "body") && goes_on)
      tokens_[i].text = "volume";
  }
}

bool begins_word(std::string_view beginning, std::string_view word) {
  return same_word(beginning, word.substr(0, beginning.size()));
}

const Token& Reader::peek() const {
  const Token& token = tokens_[at_];
  if (token.kind == Token::Kind::bad) throw error_at(statement_, token, token.text);
  return token;
}

Token Reader::take() {
  Token token = peek();
  if (token.kind != Token::Kind::end) ++at_;
  expected_.clear();
  return token;
}

void Reader::split(std::size_t length) {
  const Token token = peek();
  const bool verbatim = token.length == token.text.size();
  std::vector<Token> pieces;
  for (const std::size_t begin : {std::size_t{0}, length})
    for (const Statement& alone : split_statements(token.text.substr(begin, begin ? std::string::npos : length)))
      for (Token piece : alone.tokens) {
        if (piece.kind == Token::Kind::end) continue;
        piece.offset = token.offset + (verbatim ? begin + piece.offset : 0);
        if (!verbatim) piece.length = token.length;
        pieces.push_back(std::move(piece));
      }
  const auto at = tokens_.erase(tokens_.begin() + static_cast<std::ptrdiff_t>(at_));
  tokens_.insert(at, pieces.begin(), pieces.end());
}

void Reader::cut_at_sign() {
  const Token& token = peek();
  if (token.kind != Token::Kind::word) return;
  // A number may have a sign of its own, in its exponent.
  double number = 0;
  const char* begin = token.text.data();
  const auto [rest, error] = std::from_chars(begin, begin + token.text.size(), number);
  const std::size_t at = rest > begin ? static_cast<std::size_t>(rest - begin) : token.text.find_first_of("-/", 1);
  if (at < token.text.size() && (token.text[at] == '-' || token.text[at] == '/')) split(at);
}

std::optional<std::size_t> Reader::match(std::span<const Keyword> words) {
  const Token& token = peek();
  if (token.kind == Token::Kind::word) {
    std::vector<std::size_t> candidates;
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (same_word(token.text, words[i].word)) return i;
      const bool known = std::ranges::any_of(candidates, [&](std::size_t c) { return words[c].word == words[i].word; });
      if (words[i].may_be_short && begins_word(token.text, words[i].word) && !known) candidates.push_back(i);
    }
    if (candidates.size() == 1) return candidates.front();
    if (candidates.size() > 1) {
      std::vector<std::string> names;
      for (const std::size_t c : candidates) names.emplace_back(words[c].word);
      fail(token, "'" + token.text + "' may be " + alternatives(names) + ": please write more of it");
    }
  }
  for (const Keyword& keyword : words)
    if (keyword.shown) expect(std::string(keyword.word));
  return std::nullopt;
}

bool Reader::accept(std::string_view word, std::size_t least) {
  const Token& token = peek();
  const bool fits =
      token.kind == Token::Kind::word &&
      (same_word(token.text, word) || (least > 0 && token.text.size() >= least && begins_word(token.text, word)));
  if (fits)
    take();
  else
    expect(std::string(word));
  return fits;
}

void Reader::expect(std::string what) {
  if (std::ranges::find(expected_, what) == expected_.end()) expected_.push_back(std::move(what));
}

void Reader::fail() const {
  fail(peek());
}

void Reader::fail(const Token& token) const {
  if (token.kind == Token::Kind::braces) fail(token, "expressions in braces need a session that knows their values");
  constexpr std::size_t most_shown = 15;  // nobody reads more
  if (expected_.size() > most_shown && token.kind == Token::Kind::word) {
    const std::vector<std::string> near = nearest_words(token.text, expected_, 3);
    const std::string command = statement_.tokens.front().text;
    fail(token, "'" + printable(token.text) + "' cannot stand here" +
                    (near.empty() ? "" : ": did you mean " + alternatives(near) + "?") +
                    (near.empty() ? "; one of " + std::to_string(expected_.size()) + " words could, see 'help "
                                  : " See 'help ") +
                    printable(command) + "'");
  }
  std::vector<std::string> could = expected_;
  std::ranges::replace(could, std::string("to"), std::string("'to'"));  // which reads as one more word of ours
  std::string message = "expected " + alternatives(could) + ", found " + found(token);
  if (token.kind == Token::Kind::word)
    if (const std::string near = nearest_word(token.text, expected_); !near.empty())
      message += " (did you mean '" + near + "'?)";
  fail(token, message);
}

void Reader::fail(const Token& token, const std::string& message) const {
  throw error_at(statement_, token, message);
}

}  // namespace hextwist
