// Reads the tokens of a statement one by one and keeps account of what could have stood at the current one, so that
// an error can say so. Words are compared without case and may be cut short while they are unambiguous.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hextwist/base/text.h"
#include "hextwist/command/error_at.h"
#include "hextwist/command/select/range.h"
#include "hextwist/command/token.h"

namespace hextwist {

struct Keyword {
  std::string_view word;
  bool shown = true;  ///< in error messages
  bool may_be_short = true;
};

class Reader {
 public:
  explicit Reader(const Statement& statement);

  const Statement& statement() const { return statement_; }
  /// The current token; a bad one throws the CommandError that it stands for.
  const Token& peek() const;
  bool at_end() const { return peek().kind == Token::Kind::end; }
  /// The same, without throwing for bad tokens.
  bool stopped_at_end() const { return tokens_[at_].kind == Token::Kind::end; }
  /// The token so many behind the current one (the end, where there are not so many), good or bad.
  const Token& ahead(std::size_t n = 1) const { return tokens_[std::min(at_ + n, tokens_.size() - 1)]; }
  /// Takes the current token; forgets what could have stood there.
  Token take();

  /// Cuts the current token in two behind so many bytes, as if there were a blank: `x_coord-3` in arithmetic.
  void split(std::size_t length);
  /// The same at the first - or / in a word, where these may only be signs: `x_coord-3`, `2/3`.
  void cut_at_sign();
  bool at_symbol(std::string_view symbol) const { return peek().kind == Token::Kind::symbol && peek().text == symbol; }

  /// Which of the words the current token is: the exact one, else the only one that it is the beginning of.
  /// nullopt when none (they are remembered as expected). Throws where several begin like it. Does not take it.
  std::optional<std::size_t> match(std::span<const Keyword> words);
  /// Takes the current token if it is this word, cut to no fewer than `least` letters (0: not cut at all).
  bool accept(std::string_view word, std::size_t least = 0);

  /// Remembers that this could stand here.
  void expect(std::string what);
  const std::vector<std::string>& expected() const { return expected_; }
  /// Throws: the current token (or the one given) is none of what was expected.
  [[noreturn]] void fail() const;
  [[noreturn]] void fail(const Token& token) const;
  [[noreturn]] void fail(const Token& token, const std::string& message) const;

 private:
  const Statement& statement_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::vector<std::string> expected_;
};

/// What is closest to a mistyped word, within one or two letters; "" if nothing is.
std::string nearest_word(std::string_view word, std::span<const std::string> words);
/// So many of them that are close to it at most, the nearest first.
std::vector<std::string> nearest_words(std::string_view word, std::span<const std::string> words, std::size_t most);
/// "a, b or c".
std::string alternatives(std::span<const std::string> words);

/// Reads a range of ids of a kind. Throws CommandError at the first token that fits neither it nor what may follow.
Range read_range(Reader& reader, EntityKind kind);
/// Reads a kind of entity, nullopt if the current token is none.
std::optional<EntityKind> accept_kind(Reader& reader, bool may_be_short = true);

/// Reads a kind and one id or name, as behind `of`.
RangeTerm read_single(Reader& reader);

/// Without case.
bool begins_word(std::string_view beginning, std::string_view word);

}  // namespace hextwist
