// The language as data. Each command is written down once, in the notation of its help text; that text is compiled and
// drives parsing, error messages, help and completion.
//
//   word                must stand there (case ignored, may be cut short)
//   {a|b ...|c}         one of
//   [a ...] [b ...]     each may stand there, in any order, once
//   {a|b} <range> ...   the two before the dots, once or more: further kinds of entities
//   a <name> ...        the same, where further values need not have the word before them
//   <name>              a value: see the command's arguments; <range> takes ids of the kind named before it
//   ~word               known, but not supported yet: an error of its own; never shown
//   =word               another spelling: understood when written out, as an option more than once; never shown
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hextwist/command/select/range.h"
#include "hextwist/command/token.h"

namespace hextwist {

/// What may stand at a <name>.
struct ArgumentSpec {
  enum class Kind { range, integer, number, string, file, word };
  std::string_view name;
  Kind kind = Kind::number;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open = false;  ///< min itself is not allowed
  std::string_view help;
};

struct CommandSpec {
  std::string_view name;    ///< its first word
  std::string_view syntax;  ///< whole, first word included; empty: known, but not supported yet
  std::string_view summary;
  std::string_view details;  ///< paragraphs for help
  std::vector<ArgumentSpec> arguments;
  std::vector<std::string_view> examples;
  std::string_view alias = {};  ///< does the same as that command
  bool may_be_short = true;     ///< its name
};

/// One thing that was said: a word of the syntax (in full) or a value.
struct Item {
  bool is_word = false;
  std::string name;  ///< the word, or the name of the argument
  Token token;
  double number = 0;                  ///< of an integer or number
  std::string text;                   ///< of a string, file or word
  EntityKind kind = EntityKind::hex;  ///< of a range
  Range range;
  /// Of what stands in brackets: the word that the option begins with in the syntax, such as "histogram", and of
  /// "[{shape|skew}]" the first, "shape". Empty outside of options.
  std::string_view option = {};
};

struct Command {
  const CommandSpec* spec = nullptr;
  Statement statement;
  std::vector<Item> items;  ///< in the order said, the command's own name first

  /// Was this word said?
  bool has(std::string_view word) const;
  /// The value of that name, null where there was none.
  const Item* find(std::string_view argument) const;
  /// All values of that name: of several kinds of entities each a range.
  std::vector<const Item*> find_all(std::string_view argument) const;
};

/// The table of all commands, alphabetical.
std::span<const CommandSpec> language();

/// Throws CommandError at the first token that does not fit, saying what could stand there.
Command parse(const Statement& statement);

/// The command in full words, as the language writes it; parsing that gives the same items.
std::string to_string(const Command& command);

/// The end of a beginning of a command: what could stand there.
struct Expected {
  std::vector<Token> before;      ///< the tokens of the command up to there
  std::string beginning;          ///< of the word that stands there already, "" behind a blank
  std::vector<std::string> what;  ///< words, and descriptions such as "a name"; none where the command is wrong already
};
Expected expected_at_end(std::string_view line);

/// Words that could stand at the end of this beginning of a command and start like its last word (all of them after a
/// blank). Sorted.
std::vector<std::string> completions(std::string_view line);

/// The syntax of a command without what is not supported yet.
std::string shown_syntax(const CommandSpec& command);
/// Help on everything; on the command that `word` is (short for), short; on one of its options, or, for "all", with
/// everything that is to be said. Throws Error for an unknown one.
std::string help();
std::string help(std::string_view word);
std::string help(std::string_view word, std::string_view option);

}  // namespace hextwist
