// An error in a command: what is wrong, and where the wrong word stands.
#pragma once

#include <string>

#include "hextwist/base/types.h"

namespace HEXTWIST_API hextwist {

/// A command that is wrong or failed. what() is the message and, where a word is to blame, the line with a caret under
/// that word:
///
///     part.jou:3:8: expected node, edge, face, ... (did you mean 'curve'?)
///       refine crve 3
///              ^~~~
class CommandError : public Error {
 public:
  /// whole: what() is to be; message: one line without the place.
  CommandError(const std::string& whole, std::string message, int line, int column)
      : Error(whole), message_(std::move(message)), line_(line), column_(column) {}

  /// One line without the place.
  const std::string& message() const { return message_; }
  /// Line in the source, 1-based; 0: there is none (adapt(), take()).
  int line() const { return line_; }
  /// Character in that line, 1-based; 0: the command as a whole.
  int column() const { return column_; }

 private:
  std::string message_;
  int line_, column_;
};

}  // namespace hextwist
