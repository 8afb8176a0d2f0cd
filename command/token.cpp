#include "hextwist/command/token.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <utility>

#include "hextwist/command/flow.h"

namespace hextwist {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}
// Dots, slashes and the like belong to words, so that a plain file name needs no quotes. Bytes of other alphabets too.
bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || static_cast<unsigned char>(c) >= 0x80 ||
         std::string_view("_./-~:@%").find(c) != std::string_view::npos;
}

/// Length of a backslash, blanks and a line end at `at`; 0 if something else stands there.
std::size_t continuation(std::string_view text, std::size_t at) {
  if (at >= text.size() || text[at] != '\\') return 0;
  std::size_t end = at + 1;
  while (end < text.size() && is_blank(text[end])) ++end;
  return end < text.size() && text[end] == '\n' ? end + 1 - at : 0;
}

Token quoted(std::string_view text, std::size_t at) {
  std::string inside;
  std::size_t end = at + 1;
  while (end < text.size() && text[end] != '\n' && text[end] != text[at]) {
    std::size_t next = end + 1;
    if (text[end] == '\\' && next < text.size() && text[next] == '{') {
      ++end;
      ++next;
    } else if (text[end] == '{') {
      if (const std::size_t close = closing_brace(text, end); close != std::string_view::npos) next = close + 1;
    }
    inside += text.substr(end, next - end);
    end = next;
  }
  if (end >= text.size() || text[end] == '\n')
    return {Token::Kind::bad, "this quote is not closed on its line", 0, at, end - at};
  return {Token::Kind::string, inside, 0, at, end + 1 - at};
}

/// A number when everything up to the next blank or symbol reads as one, else a word ("3rd_part.msh", "1to3").
Token number_or_word(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size()) {
    const char c = text[end];
    const char before = end > at ? text[end - 1] : 'e';
    const bool sign = (c == '+' || c == '-') && (end == at || before == 'e' || before == 'E');
    if (!is_word(c) && !sign) break;
    ++end;
  }
  const std::string_view run = text.substr(at, end - at);
  const std::string_view digits = run.front() == '+' ? run.substr(1) : run;
  Token token{Token::Kind::number, std::string(run), 0, at, run.size()};
  const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), token.value);
  if (rest != digits.data() + digits.size()) {
    token.kind = Token::Kind::word;
  } else if (error == std::errc::result_out_of_range) {
    token.kind = Token::Kind::bad;
    token.text = "this number is out of range";
  }
  return token;
}

Token next_token(std::string_view text, std::size_t at) {
  const char c = text[at];
  const char after = at + 1 < text.size() ? text[at + 1] : ' ';
  if (c == '"' || c == '\'') return quoted(text, at);
  if (c == '{') {
    const std::size_t close = closing_brace(text, at);
    if (close == std::string_view::npos) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      return {Token::Kind::bad, "this brace is not closed on its line", 0, at, end - at};
    }
    return {Token::Kind::braces, std::string(text.substr(at + 1, close - at - 1)), 0, at, close + 1 - at};
  }
  const bool sign_or_dot = c == '+' || c == '-' || c == '.';
  const char second_after = at + 2 < text.size() ? text[at + 2] : ' ';
  if (is_digit(c) || (sign_or_dot && (is_digit(after) || (c != '.' && after == '.' && is_digit(second_after)))))
    return number_or_word(text, at);
  if (is_word(c) && c != '-') {
    std::size_t end = at;
    while (end < text.size() && is_word(text[end])) ++end;
    return {Token::Kind::word, std::string(text.substr(at, end - at)), 0, at, end - at};
  }
  const std::string_view two = text.substr(at, 2);
  if (two == "<=" || two == ">=" || two == "<>" || two == "==")
    return {Token::Kind::symbol, std::string(two), 0, at, 2};
  if (std::string_view("()}[],<>=+-*^!&|$?").find(c) != std::string_view::npos)
    return {Token::Kind::symbol, std::string(1, c), 0, at, 1};
  return {Token::Kind::bad,
          c == '\\' ? "a backslash must be the last of its line" : "this character has no meaning here", 0, at, 1};
}

/// Where the brace of an expression behind a # stands, npos for a plain comment. Right behind the # every brace is
/// one; behind blanks or more # only one that says something: an assignment, or a word like {loop(3)}.
std::size_t brace_of_comment(std::string_view text, std::size_t at) {
  std::size_t open = at + 1;
  while (open < text.size() && (text[open] == '#' || is_blank(text[open]))) ++open;
  if (open >= text.size() || text[open] != '{') return std::string_view::npos;
  if (open == at + 1) return open;
  const std::size_t close = closing_brace(text, open);
  if (close == std::string_view::npos) return close;
  const std::string_view inside = text.substr(open + 1, close - open - 1);
  std::size_t begin = 0;
  while (begin < inside.size() && is_blank(inside[begin])) ++begin;
  std::size_t end = begin;
  while (end < inside.size() && (std::isalnum(static_cast<unsigned char>(inside[end])) || inside[end] == '_')) ++end;
  std::size_t sign = end;
  while (sign < inside.size() && is_blank(inside[sign])) ++sign;
  const std::string_view rest = inside.substr(sign), two = rest.substr(0, 2);
  const bool assigns = end > begin && ((rest.starts_with('=') && two != "==") || two == "+=" || two == "-=" ||
                                       two == "*=" || two == "/=" || two == "^=" || two == "++" || two == "--");
  const bool flows = is_flow_word(inside.substr(begin, end - begin)) && (rest.empty() || rest.starts_with('('));
  return assigns || flows ? open : std::string_view::npos;
}

/// The expressions that follow a # without anything in between but blanks and more #.
void comment(std::string_view text, std::size_t at, std::vector<Token>& tokens) {
  while (at < text.size() && (text[at] == '#' || text[at] == '{' || is_blank(text[at]))) {
    if (text[at] == '{') tokens.push_back(next_token(text, at));
    at = text[at] == '{' ? at + tokens.back().length : at + 1;
  }
}

}  // namespace

std::size_t closing_brace(std::string_view text, std::size_t open) {
  // So that a line of open braces is not searched over and over.
  constexpr std::size_t longest = 10000;
  constexpr int deepest = 30;
  int depth = 0;
  char quote = '\0';
  for (std::size_t at = open; at < std::min(text.size(), open + longest) && text[at] != '\n'; ++at) {
    const char c = text[at];
    if (quote) {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '{') {
      if (++depth > deepest) return std::string_view::npos;
    } else if (c == '}' && --depth == 0) {
      return at;
    }
  }
  return std::string_view::npos;
}

std::vector<Token> tokens_of(std::string_view text) {
  std::vector<Token> result;
  for (std::size_t at = 0; at < text.size();) {
    if (is_blank(text[at]) || text[at] == '\n') {
      ++at;
    } else {
      result.push_back(next_token(text, at));
      at += result.back().length;
    }
  }
  return result;
}

std::vector<Statement> split_statements(std::string_view input, std::string_view source_name, int first_line) {
  const auto source = std::make_shared<const Source>(Source{std::string(source_name), std::string(input), first_line});
  const std::string_view text = source->text;
  std::vector<Statement> result;
  Statement statement{source, {}};
  std::size_t counted = 0;
  int line = first_line;
  const auto finish = [&](std::size_t at) {
    if (statement.tokens.empty()) return;
    const std::size_t begin = statement.tokens.front().offset;
    line += static_cast<int>(std::ranges::count(text.substr(counted, begin - counted), '\n'));
    counted = begin;
    statement.begin = begin;
    statement.line = line;
    // Behind the last token rather than at the line end, so that the caret stays close to the words.
    const Token& last = statement.tokens.back();
    statement.tokens.push_back({Token::Kind::end, "", 0, std::min(at, last.offset + last.length), 0});
    result.push_back(std::exchange(statement, Statement{source, {}}));
  };
  std::size_t at = 0;
  while (at < text.size()) {
    const char c = text[at];
    if (is_blank(c)) {
      ++at;
    } else if (c == '\n' || c == ';') {
      finish(at++);
    } else if (c == '#') {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      if (brace_of_comment(text.substr(0, end), at) != std::string_view::npos) {
        finish(at);
        comment(text.substr(0, end), at, statement.tokens);
        finish(end);
      }
      at = end;
    } else if (const std::size_t joined = continuation(text, at)) {
      at += joined;
    } else {
      statement.tokens.push_back(next_token(text, at));
      at += statement.tokens.back().length;
    }
  }
  finish(text.size());
  return result;
}

std::string text_of(const Statement& statement) {
  std::string result;
  std::size_t end = 0;
  for (const Token& token : statement.tokens) {
    if (token.kind == Token::Kind::end) break;
    if (!result.empty() && token.offset > end) result += ' ';
    result += statement.source->text.substr(token.offset, token.length);
    end = token.offset + token.length;
  }
  return result;
}

}  // namespace hextwist
