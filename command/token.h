// From text to commands: statements of tokens that remember where they stood.
//
// `;` and line ends separate statements, `#` starts a comment, a backslash at the end of a line joins the next one.
// Strings stand between single or double quotes and may hold anything but a line end; \{ in them is a brace.
// An expression in braces is one token, within a string a part of it; right behind `#` it is a statement of its own,
// and behind `#` and blanks an assignment is.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace hextwist {

/// Text of commands and what to call it in messages: a journal's file name, or "" for text typed in.
struct Source {
  std::string name;
  std::string text;
  int first_line = 1;
};

struct Token {
  enum class Kind {
    word,    ///< starts with a letter or so: refine, x_coord, part.step
    number,  ///< 3, -2.5, 1e-3
    string,  ///< text holds what is between the quotes
    symbol,  ///< one of ( ) , < > = + * ...
    braces,  ///< { expression }; text holds what is between (see braces.h)
    bad,     ///< could not be read; text says why
    end,     ///< behind the last token of a statement
  };
  Kind kind = Kind::end;
  std::string text;
  double value = 0;        ///< of a number
  std::size_t offset = 0;  ///< bytes into the source
  std::size_t length = 0;  ///< bytes; 0 for the end
};

/// One command. The last token is the end; there is at least one other.
struct Statement {
  std::shared_ptr<const Source> source;
  std::vector<Token> tokens;
  /// A place in the source and its line, so that lines need not be counted from the start; 0: not known.
  std::size_t begin = 0;
  int line = 0;
};

/// Splits text into statements. Never throws on any input: what can't be read becomes a bad token, so that the
/// commands before it can run first.
std::vector<Statement> split_statements(std::string_view text, std::string_view source_name = "", int first_line = 1);

/// The tokens of one command, without an end; line ends count as blanks.
std::vector<Token> tokens_of(std::string_view text);

/// Where the brace at `open` is closed on its line, quotes and inner braces skipped; npos if it is not,
/// or not within 10,000 bytes, or if there are more than 30 in one another.
std::size_t closing_brace(std::string_view text, std::size_t open);

/// The statement as written, on one line: line ends become spaces, comments go.
std::string text_of(const Statement& statement);

}  // namespace hextwist
