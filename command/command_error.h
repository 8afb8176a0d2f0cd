// An error in a command: what is wrong, and where the wrong word stands.
#pragma once

#include <string>

#include "hextwist/base/types.h"

namespace HEXTWIST_API hextwist {

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

}  // namespace hextwist
