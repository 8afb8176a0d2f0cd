// An error in a command: what is wrong, and where the wrong word stands.
#pragma once

#include <string>

#include "hextwist/base/types.h"
#include "hextwist/command/token.h"

namespace hextwist {

/// what() is the message and, where a word is to blame, the line with a caret under that word:
///
///     part.jou:3:8: expected node, edge, face, ... (did you mean 'curve'?)
///       refine crve 3
///              ^~~~
class CommandError : public Error {
 public:
  CommandError(const std::string& whole, std::string message, int line, int column)
      : Error(whole), message_(std::move(message)), line_(line), column_(column) {}

  /// One line without the place.
  const std::string& message() const { return message_; }
  /// Place in the source, 1-based, in characters; column 0: the command as a whole.
  int line() const { return line_; }
  int column() const { return column_; }

 private:
  std::string message_;
  int line_, column_;
};

/// The error for one token of a statement, caret included.
CommandError error_at(const Statement& statement, const Token& token, const std::string& message);

/// The error for a command that could not be done although every word was right: one line.
CommandError error_in(const Statement& statement, const std::string& message);

/// Text from users inside a message: control characters and broken UTF-8 become '?', long text is cut.
std::string printable(std::string_view text, std::size_t max_bytes = 60);

}  // namespace hextwist
