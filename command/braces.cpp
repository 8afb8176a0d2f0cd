#include "hextwist/command/braces.h"

#include <algorithm>

#include "hextwist/command/error_at.h"

namespace hextwist {
namespace {

/// Text with values in it, and for each of its bytes the stretch of the source that it came from.
struct Text {
  std::string text;
  std::vector<std::size_t> begin, end;

  void add(char c, std::size_t at) { add(std::string_view(&c, 1), at, at + 1); }
  void add(std::string_view piece, std::size_t from, std::size_t to) {
    text += piece;
    begin.insert(begin.end(), piece.size(), from);
    end.insert(end.end(), piece.size(), to);
  }
};

class Expansion {
 public:
  Expansion(const Statement& statement, Variables& variables) : statement_(statement), variables_(variables) {}

  Evaluated value(std::size_t open, std::size_t close) {
    const std::string_view inside = source().substr(open + 1, close - open - 1);
    try {
      return evaluate(inside, variables_);
    } catch (const ExpressionError& error) {
      const std::size_t at = open + 1 + error.offset();
      throw error_at(statement_, {Token::Kind::bad, "", 0, at, std::min(error.length(), close - at)}, error.what());
    }
  }

  /// The source from begin to end, braces replaced.
  Text replaced(std::size_t begin, std::size_t end) {
    Text result;
    for (std::size_t at = begin; at < end;) {
      const char c = source()[at], after = at + 1 < end ? source()[at + 1] : '\0';
      if (c == '\\' && after == '{') {
        result.add(c, at);
        result.add(after, at + 1);
        at += 2;
      } else if (c == '$' && after == '{') {
        throw error_at(statement_, {Token::Kind::bad, "", 0, at, 2}, "'${...}' is not supported, only '{...}'");
      } else if (c == '{') {
        const std::size_t close = closing_brace(source(), at);
        if (close >= end)
          throw error_at(statement_, {Token::Kind::bad, "", 0, at, 1},
                         "this brace is not closed (\\{ is a plain brace)");
        result.add(text_of(value(at, close).value), at, close + 1);
        at = close + 1;
      } else {
        result.add(c, at++);
      }
    }
    return result;
  }

  std::string_view source() const { return statement_.source->text; }

 private:
  const Statement& statement_;
  Variables& variables_;
};

bool is_replaced(const Statement& statement, const Token& token) {
  if (token.kind == Token::Kind::braces) return true;
  if (token.kind != Token::Kind::string) return false;
  const std::string_view raw = std::string_view(statement.source->text).substr(token.offset, token.length);
  for (std::size_t i = 0; i < raw.size(); ++i)
    if (raw[i] == '{' && (i == 0 || raw[i - 1] != '\\')) return true;
  return false;
}

void append_tokens(const Text& text, std::vector<Token>& tokens) {
  for (Token token : tokens_of(text.text)) {
    const std::size_t last = token.offset + token.length - 1;
    token.length = text.end[last] - text.begin[token.offset];
    token.offset = text.begin[token.offset];
    tokens.push_back(std::move(token));
  }
}

}  // namespace

bool has_braces(const Statement& statement) {
  return std::ranges::any_of(statement.tokens, [&](const Token& token) { return is_replaced(statement, token); });
}

Value value_within(const Statement& statement, std::size_t offset, std::size_t length, Variables& variables) {
  return Expansion(statement, variables).value(offset - 1, offset + length).value;
}

Expanded expand(const Statement& statement, Variables& variables) {
  Variables changed = variables;
  Expansion expansion(statement, changed);
  Expanded result;
  Statement command{statement.source, {}};
  const auto& tokens = statement.tokens;
  const bool alone = std::ranges::all_of(
      tokens, [](const Token& token) { return token.kind == Token::Kind::braces || token.kind == Token::Kind::end; });
  for (std::size_t i = 0; i + 1 < tokens.size();) {
    // Tokens without a blank between them are replaced together: part_{n}.msh is one word.
    std::size_t end = i + 1;
    const auto ends = [&](std::size_t k) { return tokens[k].offset + tokens[k].length; };
    while (end + 1 < tokens.size() && tokens[end].offset == ends(end - 1)) ++end;
    const bool any =
        std::any_of(tokens.begin() + static_cast<std::ptrdiff_t>(i), tokens.begin() + static_cast<std::ptrdiff_t>(end),
                    [&](const Token& token) { return is_replaced(statement, token); });
    if (alone && end == i + 1) {
      const Evaluated one = expansion.value(tokens[i].offset, ends(i) - 1);
      const auto* text = std::get_if<std::string>(&one.value);
      if (text && one.assigned.empty()) {  // a command in a variable
        Text as_said;
        as_said.add(*text, tokens[i].offset, ends(i));
        append_tokens(as_said, command.tokens);
      } else {
        const std::string shown = text ? "\"" + printable(*text) + "\"" : text_of(one.value);
        result.lines.push_back(one.assigned.empty() ? shown : one.assigned + " = " + shown);
      }
    } else if (any) {
      append_tokens(expansion.replaced(tokens[i].offset, ends(end - 1)), command.tokens);
    } else {
      command.tokens.insert(command.tokens.end(), tokens.begin() + static_cast<std::ptrdiff_t>(i),
                            tokens.begin() + static_cast<std::ptrdiff_t>(end));
    }
    i = end;
  }
  if (!command.tokens.empty()) {
    command.tokens.push_back(tokens.back());
    result.statement = std::move(command);
  } else if (result.lines.empty()) {
    throw error_at(statement, tokens.front(), "this leaves no command");
  }
  variables = std::move(changed);
  return result;
}

}  // namespace hextwist
